//! Measures the wind, the motion of the tree, and what frames cost.

use super::{turntable::StageTree, workbench::Workbench};
use crate::{
    editor::{costs::Frame, tip_motion::TipMotion, ui::Panel, wind_measures::WindMeasures},
    render::draw::counts::TreesByLod,
    sway::{ActiveSway, WindResponse},
    timing::SystemTimes,
    tree::{Grown, Season, Tree, TreeModel},
    wind::{ActiveWind, REFERENCE_HEIGHT_M, WindCell, WindField, WindGizmos},
};
use bevy::{
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use std::sync::Arc;

/// Measurements that are under way, and of what the last ones were.
#[derive(Resource, Default)]
pub(super) struct Measuring {
    wind: Option<Task<WindMeasures>>,
    wind_of: Option<Arc<WindField>>,
    tip: Option<Task<Option<TipMotion>>>,
    tip_of: Option<(Arc<WindResponse>, AssetId<TreeModel>, i32)>,
}

/// Leaves are counted in so many steps.
const LEAF_STEPS: f32 = 50.0;

/// Measures the wind in force, while its panel is open.
pub(super) fn measure_wind(mut workbench: ResMut<Workbench>, wind: Res<ActiveWind>, mut measuring: ResMut<Measuring>) {
    if let Some(task) = &mut measuring.wind {
        let Some(measures) = block_on(poll_once(task)) else { return };
        measuring.wind = None;
        workbench.measures = Some(measures);
    }
    let Some(field) = wind.newest().filter(|_| workbench.panel == Panel::Wind) else { return };
    if measuring.wind_of.as_ref().is_none_or(|of| !Arc::ptr_eq(of, field)) {
        measuring.wind_of = Some(field.clone());
        let field = field.clone();
        let measure = async move { WindMeasures::of(&field, REFERENCE_HEIGHT_M) };
        measuring.wind = Some(AsyncComputeTaskPool::get().spawn(measure));
    }
}

/// Works out how the top of the edited tree moves in the wind in force.
pub(super) fn measure_tip(
    mut workbench: ResMut<Workbench>,
    sway: Res<ActiveSway>,
    season: Res<Season>,
    models: Res<Assets<TreeModel>>,
    trees: Query<(&StageTree, &Tree, &Grown)>,
    mut measuring: ResMut<Measuring>,
) {
    if let Some(task) = &mut measuring.tip {
        let Some(motion) = block_on(poll_once(task)) else { return };
        measuring.tip = None;
        workbench.tip = motion;
    }
    let response = sway.slots().into_iter().flatten().last().filter(|_| workbench.panel == Panel::Wind);
    let edited = trees.iter().find(|(staged, ..)| !staged.stand.is_saved);
    let Some((response, (_, tree, grown))) = response.zip(edited) else { return };
    let Some(model) = models.get(&grown.model) else { return };
    let leaf_share = model.leaf_season.share(season.wrapped() + tree.season_shift());
    let leaf_step = (leaf_share * LEAF_STEPS).round() as i32;
    let is_known = measuring
        .tip_of
        .as_ref()
        .is_some_and(|(of, id, step)| Arc::ptr_eq(of, response) && (*id, *step) == (grown.model.id(), leaf_step));
    if is_known {
        return;
    }
    measuring.tip_of = Some((response.clone(), grown.model.id(), leaf_step));
    let (response, model) = (response.clone(), model.clone());
    let motion = async move { TipMotion::of(&model, &response, Vec3::ZERO, leaf_share) };
    measuring.tip = Some(AsyncComputeTaskPool::get().spawn(motion));
}

/// Adds what the frame has cost.
pub(super) fn note_costs(
    time: Res<Time<Real>>,
    times: Option<Res<SystemTimes>>,
    trees: TreesByLod,
    mut workbench: ResMut<Workbench>,
) {
    let systems = times.map(|times| times.iter().collect()).unwrap_or_default();
    let frame = Frame { length: time.delta(), systems, trees: trees.count().0, bytes: trees.table_bytes() };
    workbench.bypass_change_detection().costs.add(frame);
}

/// An arrow of the wind about the turntable.
#[derive(Component)]
pub(super) struct StageArrow;

/// Places of the arrows along each axis, and between them, m.
const ARROWS: [i32; 3] = [5, 3, 3];
const BETWEEN_M: f32 = 4.0;

/// Shows or hides the arrows.
pub(super) fn show_arrows(
    mut commands: Commands,
    workbench: Res<Workbench>,
    gizmos: Option<ResMut<WindGizmos>>,
    arrows: Query<Entity, With<StageArrow>>,
) {
    let wanted = workbench.stage.shows_wind && workbench.is_open;
    if wanted != arrows.is_empty() {
        return;
    }
    if let Some(mut gizmos) = gizmos {
        gizmos.enabled = wanted;
    }
    if !wanted {
        arrows.iter().for_each(|arrow| commands.entity(arrow).despawn());
        return;
    }
    let [across, up, deep] = ARROWS;
    for x in 0..across {
        for y in 0..up {
            for z in 0..deep {
                let middle = Vec3::new((across - 1) as f32, 0.0, (deep - 1) as f32) * 0.5;
                let place = (Vec3::new(x as f32, y as f32 + 0.5, z as f32) - middle) * BETWEEN_M;
                commands.spawn((StageArrow, WindCell::above(0.0), Transform::from_translation(place)));
            }
        }
    }
}
