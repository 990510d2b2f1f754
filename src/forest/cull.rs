//! Hides near cells that nobody sees, and whose shadows nobody sees.
//!
//! A hidden cell's trees are neither culled one by one nor drawn into shadow maps. A cell that is seen no more stays for a
//! second, so that looking about moves nothing to and fro; one that comes into view is there in the same frame.

use super::{cells::ForestCells, components::ForestCell, extent::Reach};
use crate::{
    cells::{Sun, View, Watch},
    sway::Exposure,
    tree::{Grove, TreeModel},
};
use bevy::{
    camera::primitives::Frustum,
    light::{CascadeShadowConfig, DirectionalLight},
    platform::collections::HashMap,
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

/// The near cells of a forest as they are looked at.
#[derive(Component, Default)]
pub(super) struct Sights {
    /// By the number of the species.
    reaches: Vec<Reach>,
    /// Side by side, for all of them are looked at in every frame.
    sights: Vec<Sight>,
    /// The forest's generation and changes that `sights` was made for.
    made_for: Option<(u64, u64)>,
}

/// A near cell with trees.
struct Sight {
    /// Of the box around its trees, m.
    corners: [Vec3; 2],
    entity: Entity,
    /// For so many frames nobody has seen it.
    unseen_frames: u8,
    /// What was last told of it.
    shown: Option<bool>,
}

impl Sights {
    /// Cells with trees that were seen in the last frame.
    pub fn seen(&self) -> usize {
        self.sights.iter().filter(|sight| sight.unseen_frames == 0).count()
    }

    /// The box around the trees of each cell, and whether it was seen in the last frame.
    pub fn boxes(&self) -> impl Iterator<Item = ([Vec3; 2], bool)> {
        self.sights.iter().map(|sight| (sight.corners, sight.unseen_frames == 0))
    }

    /// Puts the cells in order again when one has come or gone.
    fn renew(&mut self, forest: &ForestCells) {
        let wanted = Some((forest.generation(), forest.near.changes()));
        if self.made_for == wanted {
            return;
        }
        self.made_for = wanted;
        let before: HashMap<Entity, u8> =
            self.sights.drain(..).map(|sight| (sight.entity, sight.unseen_frames)).collect();
        let cell_m = forest.planter().cell_m();
        self.sights.extend(forest.near.planted().map(|(cell, entity, extent)| Sight {
            corners: extent.corners(cell.as_vec2() * cell_m, cell_m, &self.reaches),
            entity,
            unseen_frames: before.get(&entity).copied().unwrap_or(0),
            shown: None,
        }));
    }

    /// Looks at every cell, and shows by its entity those that are seen; those that have not been for a while are hidden.
    fn look(&mut self, settings: ForestCulling, views: &[Watch], mut show: impl FnMut(Entity, bool)) {
        for sight in &mut self.sights {
            let [min, max] = sight.corners;
            let is_near = |view: &Watch| view.eye_m().distance(view.eye_m().clamp(min, max)) <= settings.around_m;
            let is_seen = |view: &Watch| is_near(view) || view.sees(min, max).is_some();
            // Where nobody looks, what is there stays.
            let seen = !settings.enabled || views.is_empty() || views.iter().any(is_seen);
            sight.unseen_frames = if seen { 0 } else { sight.unseen_frames.saturating_add(1) };
            let shown = sight.unseen_frames <= settings.lingering_frames;
            if sight.shown != Some(shown) {
                sight.shown = Some(shown);
                show(sight.entity, shown);
            }
        }
    }
}

/// Notes how far the trees of a species may reach, when more of them have been baked or another wind blows.
pub(super) fn measure_species(
    mut commands: Commands,
    grove: Res<Grove>,
    models: Res<Assets<TreeModel>>,
    exposure: Option<Res<Exposure>>,
    mut forests: Query<(Entity, Ref<ForestCells>, Option<&mut Sights>)>,
) {
    let exposed_anew = exposure.as_ref().is_some_and(DetectChanges::is_changed);
    for (entity, forest, sights) in &mut forests {
        let Some(mut sights) = sights else {
            commands.entity(entity).insert(Sights::default());
            continue;
        };
        if !grove.is_changed() && !exposed_anew && !sights.is_added() && !forest.is_added() {
            continue;
        }
        // Without a renderer trees have all the room that they may ever need.
        let exposure = exposure.as_deref().copied().unwrap_or_default();
        sights.made_for = None;
        sights.reaches.clear();
        sights.reaches.extend(forest.species().iter().map(|species| {
            let Some(entry) = grove.get(species.id()) else { return Reach::default() };
            let grown = entry.stages.values().flat_map(|stage| &stage.models);
            let bounds = |model| exposure.bounds(model, &entry.species.phenology);
            grown
                .filter_map(|model| models.get(model))
                .map(bounds)
                .fold(Reach::default(), |reach, bounds| reach.with(bounds.min, bounds.max))
        }));
    }
}

/// Shows the near cells that are seen, and hides those that are not.
pub(super) fn cull_cells(
    settings: Res<ForestCulling>,
    cameras: Query<(&Camera, &Frustum, &GlobalTransform), With<Camera3d>>,
    suns: Query<(&DirectionalLight, &GlobalTransform, &CascadeShadowConfig)>,
    mut views: Local<Vec<Watch>>,
    mut forests: Query<(&ForestCells, &mut Sights)>,
    mut cells: Query<&mut Visibility, With<ForestCell>>,
) {
    // One for each camera, and one more for each of its suns.
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
    for (forest, mut sights) in &mut forests {
        let sights = sights.bypass_change_detection();
        sights.renew(forest);
        sights.look(*settings, &views, |cell, shown| {
            if let Ok(mut visibility) = cells.get_mut(cell) {
                *visibility = if shown { Visibility::Inherited } else { Visibility::Hidden };
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
