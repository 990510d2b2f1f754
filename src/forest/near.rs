//! Trees near the viewers: cells whose plants are entities.

use super::{
    cells::{ForestCells, reaching},
    components::{ForestCell, ForestSettings},
    extent::Extent,
};
use crate::{
    cells::{CellStream, Orders, StreamSettings, Viewpoint},
    scatter::Planted,
    setting::SettingError,
    tree::{Species, Tree},
    viewpoint::Viewpoints,
};
use bevy::{
    platform::collections::HashMap,
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};

/// Side of a common cell, m.
const COMMON_CELL_M: f32 = 64.0;

/// The near cells of a forest.
pub(super) struct NearTrees {
    cell_m: f32,
    stream: CellStream,
    orders: Orders,
    planting: Vec<(IVec2, Task<Vec<Planted>>)>,
    cells: HashMap<IVec2, NearCell>,
    /// Cells whose trees are still to come, the first first.
    bare: Vec<IVec2>,
    changes: u64,
}

struct NearCell {
    entity: Entity,
    planted: Vec<Planted>,
    /// Plants that have become trees.
    raised: usize,
    /// Whether all of them are drawn.
    #[cfg_attr(not(feature = "render"), expect(dead_code))]
    dressed: bool,
    extent: Extent,
    articulated: bool,
}

impl NearTrees {
    pub fn new(settings: &ForestSettings, cell_m: f32, bounds: Option<[IVec2; 2]>) -> Result<Self, SettingError> {
        let at_once = settings.cells_at_once;
        // To clear a cell takes as long as to raise one, and nobody waits for it: in a frame no more ground than a common
        // cell's, which keeps up with any flight.
        let drops_per_step = (COMMON_CELL_M / cell_m).powi(2).max(1.0) as u32;
        let stream = StreamSettings {
            plants_per_step: at_once,
            most_ordered: at_once,
            drops_per_step,
            ..reaching(settings.trees_to_m, cell_m)
        };
        Ok(Self {
            cell_m,
            stream: CellStream::new(stream, cell_m, bounds)?,
            orders: Orders::default(),
            planting: Vec::new(),
            cells: HashMap::default(),
            bare: Vec::new(),
            changes: 0,
        })
    }

    pub fn is_complete(&self) -> bool {
        self.stream.is_complete() && self.bare.is_empty()
    }

    pub fn entities(&self) -> impl Iterator<Item = Entity> {
        self.cells.values().map(|cell| cell.entity)
    }

    /// Notes those cells all of whose trees have come and are drawn, as `is_dressed` says.
    #[cfg(feature = "render")]
    pub fn note_dressed(&mut self, is_dressed: impl Fn(Entity) -> bool) {
        for cell in self.cells.values_mut().filter(|cell| !cell.dressed && cell.planted.is_empty()) {
            cell.dressed = is_dressed(cell.entity);
        }
    }

    /// Cells all of whose trees are drawn.
    #[cfg(feature = "render")]
    pub fn dressed(&self) -> impl Iterator<Item = IVec2> {
        self.cells.iter().filter(|(_, cell)| cell.dressed).map(|(cell, _)| *cell)
    }

    /// Grows whenever a cell comes or goes.
    #[cfg(feature = "render")]
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Every cell in which something stands: its place, its entity and its extent.
    #[cfg(feature = "render")]
    pub fn planted(&self) -> impl Iterator<Item = (IVec2, Entity, &Extent)> {
        let cells = self.cells.iter().map(|(cell, there)| (*cell, there.entity, &there.extent));
        cells.filter(|(.., extent)| !extent.is_empty())
    }

    /// Mean height of the ground where a cell's trees stand, m; none where nothing grows.
    pub fn ground_m(&self, cell: IVec2) -> Option<f32> {
        let extent = &self.cells.get(&cell)?.extent;
        (!extent.is_empty()).then(|| extent.mean_m())
    }

    /// Tells of each cell whose trees are to be articulated, or no longer: from nearer than the first distance, m, up to the
    /// second.
    pub fn articulate(&mut self, eyes: &[Vec2], [from_m, to_m]: [f32; 2], mut tell: impl FnMut(Entity, bool)) {
        let Self { cells, cell_m, .. } = self;
        for (cell, there) in cells.iter_mut().filter(|(_, there)| there.planted.is_empty()) {
            let corner = cell.as_vec2() * *cell_m;
            let to_eye = |eye: &Vec2| eye.clamp(corner, corner + *cell_m).distance(*eye);
            let distance_m = eyes.iter().map(to_eye).fold(f32::INFINITY, f32::min);
            let wanted = distance_m < if there.articulated { to_m } else { from_m };
            if wanted != there.articulated {
                there.articulated = wanted;
                tell(there.entity, wanted);
            }
        }
    }

    /// Takes over cells that have been planted.
    fn receive(&mut self, forest: Entity, commands: &mut Commands) {
        let Self { planting, cells, bare, stream, changes, .. } = self;
        planting.retain_mut(|(cell, task)| {
            let Some(planted) = block_on(poll_once(task)) else { return true };
            if !stream.fulfil(*cell) {
                return false;
            }
            let entity =
                commands.spawn((ForestCell(*cell), ChildOf(forest), Transform::default(), Visibility::default()));
            if !planted.is_empty() {
                bare.push(*cell);
            }
            let near = NearCell {
                entity: entity.id(),
                dressed: planted.is_empty(),
                extent: Extent::of(&planted),
                planted,
                raised: 0,
                articulated: false,
            };
            cells.insert(*cell, near);
            *changes += 1;
            false
        });
    }

    /// Clears what nobody is near to any more.
    fn clear(&mut self, commands: &mut Commands) {
        for cell in &self.orders.drop {
            if let Some(there) = self.cells.remove(cell) {
                commands.entity(there.entity).despawn();
                self.changes += 1;
                self.bare.retain(|bare| bare != cell);
            }
        }
    }

    /// Turns plants into trees, as many as a frame may.
    fn raise(&mut self, settings: &ForestSettings, species: &[Handle<Species>], commands: &mut Commands) {
        #[cfg(feature = "render")]
        let has_cards = settings.far_to_m > 0.0;
        let mut left = settings.trees_per_frame as usize;
        while let Some(cell) = self.bare.first().and_then(|cell| self.cells.get_mut(cell)).filter(|_| left > 0) {
            let batch = left.min(cell.planted.len() - cell.raised);
            commands.entity(cell.entity).with_children(|parent| {
                for plant in &cell.planted[cell.raised..cell.raised + batch] {
                    #[cfg_attr(not(feature = "render"), expect(unused_variables, unused_mut))]
                    let mut tree = parent.spawn(tree(plant, species));
                    #[cfg(feature = "render")]
                    if has_cards {
                        tree.insert(crate::sway::CardBehind);
                    }
                }
            });
            (cell.raised, left) = (cell.raised + batch, left - batch);
            if cell.raised == cell.planted.len() {
                cell.planted = Vec::new();
                cell.raised = 0;
                self.bare.remove(0);
            }
        }
    }
}

/// Keeps the cells near the viewers raised: trees come nearest first, and go a cell or so a frame.
pub(super) fn raise_trees(
    mut commands: Commands,
    viewpoints: Viewpoints,
    mut places: Local<Vec<Viewpoint>>,
    mut forests: Query<(Entity, &mut ForestCells)>,
) {
    viewpoints.fill(&mut places);
    for (entity, mut forest) in &mut forests {
        let (planter, ground) = (forest.shared_planter(), forest.ground());
        let (near, species, settings) = forest.parts();
        near.receive(entity, &mut commands);
        near.stream.step(&places, &near.cells, &mut near.orders);
        near.clear(&mut commands);
        for &cell in &near.orders.plant {
            let (planter, ground) = (planter.clone(), ground.clone());
            let task = AsyncComputeTaskPool::get().spawn(async move {
                let mut planted = Vec::new();
                planter.plant(cell, &ground, &mut planted);
                planted
            });
            near.planting.push((cell, task));
        }
        near.raise(settings, species, &mut commands);
    }
}

fn tree(plant: &Planted, species: &[Handle<Species>]) -> impl Bundle {
    let place = Transform::from_translation(plant.position)
        .with_rotation(Quat::from_rotation_y(plant.turn_rad))
        .with_scale(Vec3::splat(plant.vigour));
    let species = species[usize::from(plant.species)].clone();
    (
        Tree::new(species)
            .with_age(plant.age_years)
            .with_seed(u64::from(plant.seed))
            .with_season(plant.season_days)
            .with_tint(plant.tint),
        place,
    )
}
