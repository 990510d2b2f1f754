//! A wood and its ground on the turntable, and the picture of them.

use super::{
    mesh::DiagramOf,
    show_ground::{BuiltGround, LandTerrain},
    show_woods::AppliedPlan,
    turntable::{StageCamera, StageTree},
    workbench::Workbench,
};
use crate::{
    editor::{scene_view::SceneView, ui::Panel},
    forest::{Forest, ForestGround, ForestSettings, StandingGround},
    ground::{Ground, LevelGround},
    terrain::{Terrain, TerrainSettings},
};
use bevy::prelude::*;
use std::sync::Arc;

/// The forest of the turntable.
#[derive(Component)]
pub(super) struct LandForest;

/// On the turntable a wood is mostly seen from afar.
const TREES_TO_M: f32 = 100.0;
const FAR_TO_M: f32 = 6000.0;

type Hideable = (Without<LandForest>, Without<LandTerrain>);

/// Shows trees, a wood or ground, as the panel asks; plants the wood when it is first asked for, and has it follow the ground.
pub(super) fn show_land(
    mut commands: Commands,
    workbench: Res<Workbench>,
    applied: Res<AppliedPlan>,
    built: Res<BuiltGround>,
    terrains: Query<&TerrainSettings, With<LandTerrain>>,
    mut forests: Query<(Entity, &mut Visibility), With<LandForest>>,
    mut grounds: Query<&mut Visibility, (With<LandTerrain>, Without<LandForest>)>,
    mut trees: Query<&mut Visibility, (With<StageTree>, Without<DiagramOf>, Hideable)>,
    mut diagrams: Query<&mut Visibility, (With<DiagramOf>, Hideable)>,
    mut stands_on: Local<Option<Arc<dyn Ground>>>,
) {
    let panel = workbench.panel;
    let shown = |is_shown: bool| if is_shown { Visibility::Inherited } else { Visibility::Hidden };
    for mut tree in &mut trees {
        tree.set_if_neq(shown(!panel.is_of_land()));
    }
    for mut diagram in &mut diagrams {
        diagram.set_if_neq(if panel.is_of_land() { Visibility::Hidden } else { Visibility::Visible });
    }
    for mut ground in &mut grounds {
        ground.set_if_neq(shown(panel.is_of_land()));
    }
    for (_, mut forest) in &mut forests {
        forest.set_if_neq(shown(panel == Panel::Woods));
    }
    let Some(ground) = built.ground.clone().filter(|_| panel == Panel::Woods) else { return };
    if stands_on.as_ref().is_some_and(|known| Arc::ptr_eq(known, &ground)) {
        return;
    }
    let cell_m = terrains.iter().next().copied().unwrap_or_default().finest_cell_m;
    let stands = ForestGround(Arc::new(StandingGround::new(ground.clone(), cell_m)));
    match forests.iter().next() {
        Some((forest, _)) => {
            commands.entity(forest).insert(stands);
        }
        None => {
            let settings = ForestSettings { trees_to_m: TREES_TO_M, far_to_m: FAR_TO_M, ..default() };
            commands.spawn((LandForest, Forest::new(applied.handle.clone()), settings, stands));
        }
    }
    *stands_on = Some(ground);
}

/// Notes the picture of the land: the camera of the turntable, or else the game's first.
pub(super) fn note_view(
    mut workbench: ResMut<Workbench>,
    built: Res<BuiltGround>,
    terrains: Query<&Terrain>,
    cameras: Query<(&Camera, &GlobalTransform, Has<StageCamera>), With<Camera3d>>,
) {
    let workbench = workbench.bypass_change_detection();
    let active = || cameras.iter().filter(|(camera, ..)| camera.is_active || workbench.has_turntable);
    let camera = active().find(|(.., is_stage)| *is_stage).or_else(|| active().next());
    let points = workbench.picture.map_or(1.0, |(_, pixels)| pixels);
    workbench.land.view = camera.and_then(|(camera, at, _)| {
        let pixels = camera.physical_viewport_rect()?;
        let clip_from_world = camera.clip_from_view() * at.to_matrix().inverse();
        let terrain = || terrains.iter().next().map(|terrain| terrain.ground.clone());
        let ground = if workbench.has_turntable { built.ground.clone() } else { terrain() };
        Some(SceneView {
            clip_from_world,
            world_from_clip: clip_from_world.inverse(),
            eye: at.translation(),
            min: pixels.min.as_vec2() / points,
            max: pixels.max.as_vec2() / points,
            ground: ground.unwrap_or_else(|| Arc::new(LevelGround::default())),
        })
    });
}
