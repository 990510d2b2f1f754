//! Hides near cells that nobody sees, and whose shadows nobody sees.
//!
//! A hidden cell's trees are neither culled one by one nor drawn into shadow maps. A cell that is seen no more stays for a
//! second, so that looking about moves nothing to and fro; one that comes into view is there in the same frame.

use super::{cells::ForestCells, components::ForestCell};
use crate::{
    cells::{Sun, View, Watch},
    tree::{Grove, TreeModel},
};
use bevy::{
    camera::primitives::Frustum,
    light::{CascadeShadowConfig, DirectionalLight},
    prelude::*,
};

/// Whether near cells that are out of view are hidden.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct ForestCulling {
    /// Turn it off where other lights than the sun throw shadows of trees from afar, or something looks that is no camera.
    pub enabled: bool,
    /// Nearer to a camera than this nothing is hidden: what stands there may be lit by lamps. units: m.
    pub around_m: f32,
    /// A cell that is seen no more stays for so many frames, so that looking about moves nothing to and fro.
    pub lingering_frames: u8,
}

impl Default for ForestCulling {
    fn default() -> Self {
        Self { enabled: true, around_m: 50.0, lingering_frames: 60 }
    }
}

/// The shadows of a camera end at a depth, which in the corners of a wide picture lies farther away by up to this factor.
const CORNERS: f32 = 1.6;

/// Notes how far the trees of a species may reach, when more of them have been baked.
pub(super) fn measure_species(grove: Res<Grove>, models: Res<Assets<TreeModel>>, mut forests: Query<&mut ForestCells>) {
    let baked = grove.is_changed();
    for mut forest in &mut forests {
        if !baked && !forest.is_added() {
            continue;
        }
        let (near, species, _) = forest.bypass_change_detection().parts();
        near.measure(species.iter().map(|species| {
            let stages = grove.get(species.id()).into_iter().flat_map(|entry| entry.stages.values());
            let models = stages.flat_map(|stage| &stage.models).filter_map(|model| models.get(model));
            models.fold(Reach::default(), |reach, model| reach.with(model.bounds.min, model.bounds.max))
        }));
    }
}

/// How far trees of a species reach while their scale is 1, swaying.
#[derive(Clone, Copy, Default)]
pub(super) struct Reach {
    /// Above and below their foot, m.
    pub up_m: f32,
    pub down_m: f32,
    /// Sideways, m.
    pub aside_m: f32,
}

impl Reach {
    fn with(self, min: Vec3, max: Vec3) -> Self {
        let aside = min.abs().max(max.abs());
        Self {
            up_m: self.up_m.max(max.y),
            down_m: self.down_m.max(-min.y),
            aside_m: self.aside_m.max(aside.x.hypot(aside.z)),
        }
    }
}

/// What is looked with in this frame: one view for each camera and sun.
#[derive(Default)]
pub(super) struct Views(Vec<Watch>);

/// Shows the near cells that are seen, and hides those that are not.
pub(super) fn cull_cells(
    settings: Res<ForestCulling>,
    cameras: Query<(&Camera, &Frustum, &GlobalTransform), With<Camera3d>>,
    suns: Query<(&DirectionalLight, &GlobalTransform, &CascadeShadowConfig)>,
    mut views: Local<Views>,
    mut forests: Query<&mut ForestCells>,
    mut cells: Query<&mut Visibility, With<ForestCell>>,
) {
    let views = &mut views.0;
    views.clear();
    for (_, frustum, at) in cameras.iter().filter(|(camera, ..)| camera.is_active) {
        let view = View {
            planes: frustum.half_spaces.map(|plane| plane.normal_d()),
            eye_m: at.translation(),
            distance_m: f32::MAX,
            sun: None,
        };
        views.push(Watch::new(&view));
        let shadows = suns.iter().filter(|(light, ..)| light.shadow_maps_enabled);
        views.extend(shadows.map(|(_, at, cascades)| Watch::new(&View { sun: Some(sun(at, cascades)), ..view })));
    }
    for mut forest in &mut forests {
        forest.bypass_change_detection().near.show_seen(*settings, views, |cell, shown| {
            if let Ok(mut visibility) = cells.get_mut(cell) {
                let wanted = if shown { Visibility::Inherited } else { Visibility::Hidden };
                visibility.set_if_neq(wanted);
            }
        });
    }
}

fn sun(at: &GlobalTransform, cascades: &CascadeShadowConfig) -> Sun {
    let shadow_distance_m = CORNERS * cascades.bounds.last().copied().unwrap_or(0.0);
    Sun {
        direction: at.forward().as_vec3(),
        shadow_distance_m,
        // Ground may lie anywhere below.
        lowest_m: f32::MIN,
        longest_m: 2.0 * shadow_distance_m,
    }
}
