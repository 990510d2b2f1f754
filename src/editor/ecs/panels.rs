//! Draws the panels over the world, and takes over what was changed in them.

use super::workbench::Workbench;
use crate::{
    editor::ui::{self, GroundFacts, Subjects, WindFacts, WoodsFacts},
    forest::ForestSettings,
    render::LevelOfDetail,
    sway::ActiveSway,
    tree::Season,
    wind::{ActiveWind, Wind},
};
use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts,
    egui::{Id, LayerId, Ui, UiBuilder},
};

/// What the panels edit besides the species.
#[derive(SystemParam)]
pub(super) struct Edited<'w, 's> {
    season: ResMut<'w, Season>,
    wind: ResMut<'w, Wind>,
    levels: ResMut<'w, LevelOfDetail>,
    forests: Query<'w, 's, &'static mut ForestSettings>,
    active_wind: Res<'w, ActiveWind>,
    sway: Res<'w, ActiveSway>,
}

/// Draws the panels, and takes over what was changed in them. What was not changed does not count as changed.
pub(super) fn draw_panels(mut contexts: EguiContexts, mut workbench: ResMut<Workbench>, edited: Edited) {
    let Ok(context) = contexts.ctx_mut().cloned() else { return };
    let Edited { mut season, mut wind, mut levels, mut forests, active_wind, sway } = edited;
    let whole = UiBuilder::new().layer_id(LayerId::background()).max_rect(context.viewport_rect());
    let mut ui = Ui::new(context.clone(), Id::new("windwood workbench"), whole);
    let workbench = workbench.bypass_change_detection();
    let (mut new_season, mut new_wind, mut new_levels) = (*season, wind.clone(), levels.clone());
    let forest = forests.iter_mut().next();
    let mut new_forest = forest.as_ref().map(|forest| (**forest).clone());
    workbench.ui.panel = workbench.panel;
    let drawn = ui::draw(
        &mut ui,
        &mut workbench.ui,
        Subjects {
            session: &mut workbench.session,
            stage: &mut workbench.stage,
            season: &mut new_season,
            wind: &mut new_wind,
            wind_table: &workbench.wind_table,
            wind_facts: WindFacts {
                measures: workbench.measures.as_ref(),
                tip: workbench.tip.as_ref(),
                is_changing: !active_wind.is_settled() || !sway.is_settled(),
            },
            woods: &mut workbench.woods,
            woods_facts: WoodsFacts {
                histogram: workbench.land.histogram.as_ref(),
                stems: workbench.land.stems,
                is_growing: workbench.land.is_growing,
            },
            ground: &mut workbench.ground,
            ground_facts: GroundFacts {
                variogram: workbench.land.variogram.as_ref(),
                is_building: workbench.land.is_building,
            },
            pose: &mut workbench.pose,
            view: workbench.land.view.as_ref(),
            levels: &mut new_levels,
            forest: new_forest.as_mut(),
            level_tables: &workbench.level_tables,
            is_frozen: &mut workbench.is_frozen,
            costs: &workbench.costs,
            tree: &workbench.tree,
            legend: &workbench.legend,
            has_turntable: workbench.has_turntable,
        },
    );
    workbench.panel = workbench.ui.panel;
    workbench.picture = Some((drawn.picture, context.pixels_per_point()));
    workbench.is_quitting |= drawn.is_quitting;
    workbench.is_cancelled |= drawn.is_cancelled;
    season.set_if_neq(new_season);
    wind.set_if_neq(new_wind);
    levels.set_if_neq(new_levels);
    if let Some((mut forest, new)) = forest.zip(new_forest) {
        forest.set_if_neq(new);
    }
}
