//! The turntable: the trees that are edited and compared, and the camera that looks at them.

use super::{show_ground::BuiltGround, workbench::Workbench};
use crate::{
    editor::{
        diagram::View,
        stage::{Stand, places_m},
    },
    tree::{Grown, Season, Species, Tree, TreeModel},
};
use bevy::{camera::Viewport, prelude::*};

/// The camera of the turntable. It is moved by the workbench, and its picture is what the panels leave free.
#[derive(Component, Clone, Copy, Debug, Default)]
#[require(Camera3d)]
pub struct StageCamera;

/// A tree of the turntable.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub(super) struct StageTree {
    /// Its place in the row.
    pub place: usize,
    pub stand: Stand,
}

/// One turn takes so long, s.
const TURN_S: f32 = 24.0;
/// A wood or ground is seen as far as this, m.
const FARTHEST_M: f32 = 40_000.0;

/// Gives the trees what the stage wants of them; spawns those that are missing, and removes those that are too many. A tree that becomes
/// another one stays until that is grown.
pub(super) fn arrange_trees(
    mut commands: Commands,
    workbench: Res<Workbench>,
    season: Res<Season>,
    mut trees: Query<(Entity, &mut StageTree, &mut Tree)>,
) {
    let wanted = workbench.stage.stands(*season);
    let mut there: Vec<_> = trees.iter_mut().collect();
    there.sort_by_key(|(_, staged, _)| staged.place);
    for (place, stand) in wanted.iter().copied().enumerate() {
        let tree = tree_of(&workbench, &stand);
        match there.get_mut(place) {
            Some((_, staged, own)) => {
                staged.set_if_neq(StageTree { place, stand });
                own.set_if_neq(tree);
            }
            None => {
                commands.spawn((StageTree { place, stand }, tree, Transform::default()));
            }
        }
    }
    for (entity, ..) in there.into_iter().skip(wanted.len()) {
        commands.entity(entity).despawn();
    }
}

fn tree_of(workbench: &Workbench, stand: &Stand) -> Tree {
    let species = workbench.species();
    let handle = if stand.is_saved { &workbench.saved } else { &workbench.shown };
    let variants = workbench.stage.variants();
    let seed = (0..).find(|seed| Tree::variant_of(*seed, variants) == stand.variant).unwrap_or_default();
    Tree::new(handle.clone())
        .with_seed(seed)
        .with_age(stand.age_share * species.age.mature_years)
        .with_season(stand.season_days)
        .with_tint(0.0)
}

/// A model's height and width, m.
fn extent_m(model: &TreeModel) -> [f32; 2] {
    let points = model.leaves.positions.iter().chain(&model.wood.positions);
    let reach_m = points.clone().map(|at| at[0].hypot(at[2])).fold(0.1, f32::max);
    [points.map(|at| at[1]).fold(0.2, f32::max), 2.0 * reach_m]
}

/// Stands the trees side by side, and puts the camera where it sees all.
pub(super) fn place_trees(
    mut workbench: ResMut<Workbench>,
    models: Res<Assets<TreeModel>>,
    ground: Res<BuiltGround>,
    mut trees: Query<(&StageTree, &Grown, &mut Transform), Without<StageCamera>>,
    mut cameras: Query<(&mut Transform, &mut Projection, &mut Camera), With<StageCamera>>,
    mut whole_m: Local<[f32; 2]>,
) {
    let mut grown: Vec<_> = trees.iter_mut().collect();
    grown.sort_by_key(|(staged, ..)| staged.place);
    let extents: Vec<[f32; 2]> =
        grown.iter().map(|(_, grown, _)| models.get(&grown.model).map_or([10.0; 2], extent_m)).collect();
    let widths: Vec<f32> = extents.iter().map(|[_, width]| *width).collect();
    let (places, width_m) = places_m(&widths);
    for ((_, _, transform), place) in grown.iter_mut().zip(places) {
        transform.set_if_neq(Transform::from_xyz(place, 0.0, 0.0));
    }
    if !extents.is_empty() {
        *whole_m = [extents.iter().map(|[height, _]| *height).fold(0.2, f32::max), width_m];
    }
    let picture = workbench.picture;
    let Ok((mut transform, mut projection, mut camera)) = cameras.single_mut() else { return };
    if let Some(viewport) = picture.and_then(|(points, scale)| viewport(points, scale, &camera)) {
        let before = camera.viewport.as_ref().map(|it| (it.physical_position, it.physical_size));
        if before != Some((viewport.physical_position, viewport.physical_size)) {
            camera.viewport = Some(viewport);
        }
    }
    let size = camera.physical_viewport_size().unwrap_or(UVec2::ONE).as_vec2();
    let Projection::Perspective(perspective) = projection.bypass_change_detection() else { return };
    if workbench.panel.is_of_land() {
        let [eye, middle] = workbench.pose.eye(|place| ground.height_m(place));
        transform.set_if_neq(Transform::from_translation(eye).looking_at(middle, Vec3::Y));
        if perspective.far < FARTHEST_M {
            perspective.far = FARTHEST_M;
            projection.set_changed();
        }
        return;
    }
    let stage = &mut workbench.bypass_change_detection().stage;
    let columns = if stage.view == View::Levels { 3.2 } else { 1.0 };
    let [eye, middle] = stage.eye(whole_m[0], whole_m[1] * columns, size.x / size.y, perspective.fov);
    transform.set_if_neq(Transform::from_translation(eye).looking_at(middle, Vec3::Y));
}

/// The picture between the panels, in pixels.
fn viewport(points: bevy_egui::egui::Rect, scale: f32, camera: &Camera) -> Option<Viewport> {
    let whole = camera.physical_target_size()?;
    let pixels = |x: f32, y: f32| (Vec2::new(x, y) * scale).max(Vec2::ZERO).round().as_uvec2().min(whole);
    let (min, max) = (pixels(points.min.x, points.min.y), pixels(points.max.x, points.max.y));
    let size = max.saturating_sub(min);
    let has_area = size.x > 8 && size.y > 8;
    has_area.then(|| Viewport { physical_position: min, physical_size: size, ..default() })
}

/// Has the trees turn by themselves.
pub(super) fn turn(time: Res<Time<Real>>, mut workbench: ResMut<Workbench>) {
    let workbench = workbench.bypass_change_detection();
    if workbench.stage.turns && !workbench.panel.is_of_land() {
        let turn_rad = workbench.stage.turn_rad + time.delta_secs() / TURN_S * std::f32::consts::TAU;
        workbench.stage.turn_rad = turn_rad % std::f32::consts::TAU;
    }
}

/// A species with another number of variants: no more are grown than are shown.
pub(super) fn with_variants(species: &Species, variants: u32) -> Species {
    Species { variants, ..species.clone() }
}
