//! Draws the panels over the world, and takes over what was changed in them.

use super::workbench::Workbench;
use crate::{
    editor::ui::{self, GroundFacts, LevelSettings, Subjects, WindFacts, WoodsFacts},
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
    let mut new_season = *season;
    let forest = forests.iter_mut().next();
    workbench.wind.follow(&wind);
    let of_forest = forest.as_ref().map(|forest| (**forest).clone());
    workbench.levels.follow(&LevelSettings { levels: levels.clone(), forest: of_forest });
    workbench.ui.panel = workbench.panel;
    let drawn = ui::draw(
        &mut ui,
        &mut workbench.ui,
        Subjects {
            session: &mut workbench.session,
            stage: &mut workbench.stage,
            season: &mut new_season,
            wind: &mut workbench.wind,
            wind_table: &workbench.wind_table,
            wind_facts: WindFacts {
                measures: workbench.measures.as_ref(),
                tip: workbench.tip.as_ref().map(|(name, tip)| (name.as_str(), tip)),
                is_changing: !active_wind.is_settled() || !sway.is_settled(),
            },
            woods: &mut workbench.woods,
            woods_facts: WoodsFacts {
                histogram: workbench.land.histogram.as_ref(),
                stems: workbench.land.stems,
                is_growing: workbench.land.is_growing,
                planted_share: workbench.land.planted_share,
            },
            ground: &mut workbench.ground,
            ground_facts: GroundFacts {
                variogram: workbench.land.variogram.as_ref(),
                is_building: workbench.land.is_building,
            },
            pose: &mut workbench.pose,
            view: workbench.land.view.as_ref(),
            levels: &mut workbench.levels,
            level_tables: &workbench.level_tables,
            is_frozen: &mut workbench.is_frozen,
            costs: &workbench.costs,
            tree: &workbench.tree,
            is_exporting: workbench.is_exporting,
            legend: &workbench.legend,
            has_turntable: workbench.has_turntable,
        },
    );
    workbench.panel = workbench.ui.panel;
    workbench.picture = Some((drawn.picture, context.pixels_per_point()));
    workbench.pointer = drawn.pointer.map(|at| Vec2::new(at.x, at.y));
    workbench.is_quitting |= drawn.is_quitting;
    workbench.is_cancelled |= drawn.cancelled.growing;
    workbench.is_export_cancelled |= drawn.cancelled.exporting;
    workbench.export_to = drawn.export_to.or(workbench.export_to.take());
    season.set_if_neq(new_season);
    if let Some(changed) = workbench.wind.take_change() {
        *wind = changed;
    }
    if let Some(changed) = workbench.levels.take_change() {
        levels.set_if_neq(changed.levels);
        if let Some((mut forest, changed)) = forest.zip(changed.forest) {
            forest.set_if_neq(changed);
        }
    }
}
