//! Hides near cells that nobody sees, and whose shadows nobody sees.
//!
//! A hidden cell's trees are neither culled one by one nor drawn into shadow maps. A cell that is seen no more stays for a
//! second, so that looking about moves nothing to and fro; one that comes into view is there in the same frame.

use super::{cells::ForestCells, components::ForestCell, extent::Reach};
use crate::{
    cells::{Culler, CullingView, SunShadows},
    render::wind_exposure::WindExposure,
    tree::{SpeciesModels, TreeModel},
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
    /// Whether what is hidden stays hidden and what is shown stays shown, to look at it from elsewhere.
    pub is_frozen: bool,
}

impl Default for ForestCulling {
    fn default() -> Self {
        Self { enabled: true, around_m: 50.0, lingering_frames: 60, is_frozen: false }
    }
}

/// The shadows of a camera end at a depth, which in the corners of a wide picture lies farther away by up to this factor.
const CORNERS: f32 = 1.6;

/// The near cells of a forest, as they are culled.
#[derive(Component, Default)]
pub(super) struct CulledCells {
    /// By the number of the species.
    reaches: Vec<Reach>,
    /// Side by side in memory, since all are tested in every frame.
    cells: Vec<CulledCell>,
    /// The forest's generation and changes that `cells` was made for.
    made_for: Option<(u64, u64)>,
}

/// A near cell with trees.
struct CulledCell {
    /// Of the box around its trees, m.
    corners: [Vec3; 2],
    entity: Entity,
    /// Frames since it was last seen.
    unseen_frames: u8,
    /// Whether it was last shown.
    shown: Option<bool>,
}

impl CulledCells {
    /// Cells with trees that were seen in the last frame.
    pub fn seen(&self) -> usize {
        self.cells.iter().filter(|cell| cell.unseen_frames == 0).count()
    }

    /// The box around the trees of each cell, and whether it was seen in the last frame.
    pub fn boxes(&self) -> impl Iterator<Item = ([Vec3; 2], bool)> {
        self.cells.iter().map(|cell| (cell.corners, cell.unseen_frames == 0))
    }

    /// Updates the list of cells when one has come or gone.
    fn update_cells(&mut self, forest: &ForestCells) {
        let wanted = Some((forest.generation(), forest.near.changes()));
        if self.made_for == wanted {
            return;
        }
        self.made_for = wanted;
        let before: HashMap<Entity, u8> = self.cells.drain(..).map(|cell| (cell.entity, cell.unseen_frames)).collect();
        let cell_m = forest.planter().cell_m();
        self.cells.extend(forest.near.planted().map(|(cell, entity, extent)| CulledCell {
            corners: extent.corners(cell.as_vec2() * cell_m, cell_m, &self.reaches),
            entity,
            unseen_frames: before.get(&entity).copied().unwrap_or(0),
            shown: None,
        }));
    }

    /// Tests every cell. `show` is called with the entity of each cell that is to be shown from now on, or to be hidden since it has not been
    /// seen for a while.
    fn cull(&mut self, settings: ForestCulling, views: &[Culler], mut show: impl FnMut(Entity, bool)) {
        for cell in &mut self.cells {
            let [min, max] = cell.corners;
            let is_near = |view: &Culler| view.eye_m().distance(view.eye_m().clamp(min, max)) <= settings.around_m;
            let is_seen = |view: &Culler| is_near(view) || view.sees(min, max);
            // Where nobody looks, what is there stays.
            let seen = !settings.enabled || views.is_empty() || views.iter().any(is_seen);
            cell.unseen_frames = if seen { 0 } else { cell.unseen_frames.saturating_add(1) };
            let shown = cell.unseen_frames <= settings.lingering_frames;
            if cell.shown != Some(shown) {
                cell.shown = Some(shown);
                show(cell.entity, shown);
            }
        }
    }
}

/// Notes how far the trees of a species may reach, when more of them have been baked or another wind blows.
pub(super) fn measure_species(
    mut commands: Commands,
    species_models: Res<SpeciesModels>,
    models: Res<Assets<TreeModel>>,
    exposure: Option<Res<WindExposure>>,
    mut forests: Query<(Entity, Ref<ForestCells>, Option<&mut CulledCells>)>,
) {
    let has_other_exposure = exposure.as_ref().is_some_and(DetectChanges::is_changed);
    for (entity, forest, cells) in &mut forests {
        let Some(mut cells) = cells else {
            commands.entity(entity).insert(CulledCells::default());
            continue;
        };
        let is_other_plan = cells.made_for.is_none_or(|(generation, _)| generation != forest.generation());
        if !species_models.is_changed() && !has_other_exposure && !is_other_plan {
            continue;
        }
        // Without a renderer trees have all the room that they may ever need.
        let exposure = exposure.as_deref().copied().unwrap_or_default();
        cells.made_for = None;
        cells.reaches.clear();
        cells.reaches.extend(forest.species().iter().map(|species| {
            let Some(entry) = species_models.get(species.id()) else { return Reach::default() };
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
    mut views: Local<Vec<Culler>>,
    mut forests: Query<(&ForestCells, &mut CulledCells)>,
    mut cells: Query<&mut Visibility, With<ForestCell>>,
) {
    if settings.is_frozen {
        return;
    }
    // One for each camera, and one more for each of its suns.
    views.clear();
    for (_, frustum, at) in cameras.iter().filter(|(camera, ..)| camera.is_active) {
        let view = CullingView {
            planes: frustum.half_spaces.map(|plane| plane.normal_d()),
            eye_m: at.translation(),
            distance_m: f32::MAX,
            sun: None,
        };
        views.push(Culler::new(&view));
        let shadows = suns.iter().filter(|(light, ..)| light.shadow_maps_enabled);
        views.extend(
            shadows.map(|(_, at, cascades)| Culler::new(&CullingView { sun: Some(sun(at, cascades)), ..view })),
        );
    }
    for (forest, mut culled) in &mut forests {
        let culled = culled.bypass_change_detection();
        culled.update_cells(forest);
        culled.cull(*settings, &views, |cell, shown| {
            if let Ok(mut visibility) = cells.get_mut(cell) {
                *visibility = if shown { Visibility::Inherited } else { Visibility::Hidden };
            }
        });
    }
}

fn sun(at: &GlobalTransform, cascades: &CascadeShadowConfig) -> SunShadows {
    let shadow_distance_m = CORNERS * cascades.bounds.last().copied().unwrap_or(0.0);
    SunShadows {
        direction: at.forward().as_vec3(),
        shadow_distance_m,
        // Ground may lie anywhere below.
        lowest_m: f32::MIN,
        longest_m: 2.0 * shadow_distance_m,
    }
}
