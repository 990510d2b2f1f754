//! Trees near the viewers: cells whose plants are entities.

use super::{
    components::{ForestCell, ForestSettings},
    extent::Extent,
    reach::reaching,
};
use crate::{
    cells::{CellSet, CellStream, Orders, StreamSettings, ViewerPose},
    scatter::Planted,
    setting::SettingError,
    tree::{Species, Tree},
};
use bevy::{
    platform::collections::HashMap,
    prelude::*,
    tasks::{Task, block_on, poll_once},
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
    /// Cells whose trees are still to be spawned, in that order.
    unspawned: Vec<IVec2>,
    changes: u64,
}

struct NearCell {
    entity: Entity,
    /// What is still to be spawned.
    planted: Vec<Planted>,
    spawned: Vec<NearTree>,
    /// Trees of the plan before, which go when all of this one are drawn.
    outdated: Vec<Entity>,
    /// Whether it is of the plan before.
    is_outdated: bool,
    /// Whether all of its trees are drawn.
    is_drawn: bool,
    extent: Extent,
    is_articulated: bool,
}

/// A tree of a near cell, and the plant that it is.
struct NearTree {
    plant: Planted,
    species: AssetId<Species>,
    entity: Entity,
}

/// The cells that are up to date.
struct UpToDate<'a>(&'a HashMap<IVec2, NearCell>);

impl CellSet for UpToDate<'_> {
    fn contains(&self, cell: IVec2) -> bool {
        self.0.get(&cell).is_some_and(|cell| !cell.is_outdated)
    }

    fn visit(&self, visit: impl FnMut(IVec2)) {
        self.0.iter().filter(|(_, cell)| !cell.is_outdated).map(|(cell, _)| *cell).for_each(visit);
    }
}

impl NearTrees {
    pub fn new(settings: &ForestSettings, cell_m: f32, bounds: Option<[IVec2; 2]>) -> Result<Self, SettingError> {
        let at_once = settings.cells_at_once;
        // To clear a cell takes as long as to fill one, and nothing waits for it: in a frame no more ground than a common cell's, which
        // keeps up with any flight.
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
            unspawned: Vec::new(),
            changes: 0,
        })
    }

    /// Takes over the trees of the plan before. Each cell keeps them until it is planted anew; then those stay that the new plan has too.
    /// Cells of another size are of no use: their entities are returned.
    pub fn take_over(&mut self, before: &mut Self) -> Vec<Entity> {
        if before.cell_m != self.cell_m {
            return before.entities().collect();
        }
        self.changes = before.changes + 1;
        self.cells = std::mem::take(&mut before.cells);
        for cell in self.cells.values_mut() {
            cell.is_outdated = true;
            cell.planted = Vec::new();
        }
        Vec::new()
    }

    /// Finds out which cells are wanted from where the viewers are, and has those planted that are missing.
    pub fn follow(&mut self, viewers: &[ViewerPose], plant: impl Fn(IVec2) -> Task<Vec<Planted>>) {
        self.stream.step(viewers, &UpToDate(&self.cells), &mut self.orders);
        self.planting.extend(self.orders.plant.iter().map(|cell| (*cell, plant(*cell))));
    }

    pub fn is_complete(&self) -> bool {
        self.stream.is_complete() && self.unspawned.is_empty()
    }

    pub fn entities(&self) -> impl Iterator<Item = Entity> {
        self.cells.values().map(|cell| cell.entity)
    }

    /// Cells all of whose trees are drawn.
    #[cfg(feature = "render")]
    pub fn drawn_cells(&self) -> impl Iterator<Item = IVec2> {
        self.cells.iter().filter(|(_, cell)| cell.is_drawn).map(|(cell, _)| *cell)
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

    /// Tells of each cell whose trees are to be articulated, or no longer: from nearer than the first distance, m, up to the second.
    pub fn articulate(&mut self, eyes: &[Vec2], [from_m, to_m]: [f32; 2], mut tell: impl FnMut(Entity, bool)) {
        let Self { cells, cell_m, .. } = self;
        for (cell, there) in cells.iter_mut().filter(|(_, there)| there.planted.is_empty()) {
            let corner = cell.as_vec2() * *cell_m;
            let to_eye = |eye: &Vec2| eye.clamp(corner, corner + *cell_m).distance(*eye);
            let distance_m = eyes.iter().map(to_eye).fold(f32::INFINITY, f32::min);
            let wanted = distance_m < if there.is_articulated { to_m } else { from_m };
            if wanted != there.is_articulated {
                there.is_articulated = wanted;
                tell(there.entity, wanted);
            }
        }
    }

    /// Takes over cells that have been planted.
    pub fn receive(&mut self, forest: Entity, species: &[Handle<Species>], commands: &mut Commands) {
        let Self { planting, cells, unspawned, stream, changes, .. } = self;
        planting.retain_mut(|(cell, task)| {
            let Some(planted) = block_on(poll_once(task)) else { return true };
            if !stream.fulfil(*cell) {
                return false;
            }
            let near = match cells.remove(cell) {
                Some(before) => before.planted_anew(planted, species),
                None => {
                    let bundle = (ForestCell(*cell), ChildOf(forest), Transform::default(), Visibility::default());
                    NearCell::new(commands.spawn(bundle).id(), planted)
                }
            };
            if !near.planted.is_empty() {
                unspawned.push(*cell);
            }
            cells.insert(*cell, near);
            *changes += 1;
            false
        });
    }

    /// Removes cells that nobody is near to any more, and outdated ones once all others are planted.
    pub fn clear(&mut self, commands: &mut Commands) {
        if self.stream.is_complete() && self.planting.is_empty() {
            let outdated = self.cells.iter().filter(|(_, there)| there.is_outdated).map(|(cell, _)| *cell);
            self.orders.drop.extend(outdated);
        }
        for cell in &self.orders.drop {
            if let Some(there) = self.cells.remove(cell) {
                commands.entity(there.entity).despawn();
                self.changes += 1;
                self.unspawned.retain(|unspawned| unspawned != cell);
            }
        }
    }

    /// Notes cells all of whose trees are drawn. Trees of the plan before go then.
    pub fn note_drawn(&mut self, is_drawn: impl Fn(Entity) -> bool, commands: &mut Commands) {
        for cell in self.cells.values_mut().filter(|cell| !cell.is_drawn && cell.planted.is_empty()) {
            cell.is_drawn = cell.spawned.iter().all(|tree| is_drawn(tree.entity));
            if cell.is_drawn {
                cell.outdated.drain(..).for_each(|tree| commands.entity(tree).despawn());
            }
        }
    }

    /// Spawns trees, as many as a frame may.
    pub fn spawn(&mut self, settings: &ForestSettings, species: &[Handle<Species>], commands: &mut Commands) {
        let mut left = settings.trees_per_frame as usize;
        while let Some(cell) = self.unspawned.first().and_then(|cell| self.cells.get_mut(cell)).filter(|_| left > 0) {
            let rest = cell.planted.len().saturating_sub(left);
            left -= cell.planted.len() - rest;
            for plant in cell.planted.drain(rest..) {
                let handle = &species[usize::from(plant.species)];
                #[cfg_attr(not(feature = "render"), expect(unused_mut))]
                let mut tree = commands.spawn((tree(&plant, handle.clone()), ChildOf(cell.entity)));
                #[cfg(feature = "render")]
                if settings.far_to_m > 0.0 {
                    tree.insert(crate::render::instances::components::HasImpostor);
                }
                cell.spawned.push(NearTree { plant, species: handle.id(), entity: tree.id() });
            }
            if cell.planted.is_empty() {
                self.unspawned.remove(0);
            }
        }
    }
}

impl NearCell {
    fn new(entity: Entity, planted: Vec<Planted>) -> Self {
        Self {
            entity,
            extent: Extent::of(&planted),
            is_drawn: planted.is_empty(),
            planted,
            spawned: Vec::new(),
            outdated: Vec::new(),
            is_outdated: false,
            is_articulated: false,
        }
    }

    /// The same cell of another plan: trees that both have stay.
    fn planted_anew(mut self, planted: Vec<Planted>, species: &[Handle<Species>]) -> Self {
        let mut before = std::mem::take(&mut self.spawned);
        let mut cell = Self { outdated: std::mem::take(&mut self.outdated), ..Self::new(self.entity, planted) };
        cell.planted.retain(|plant| {
            let id = species[usize::from(plant.species)].id();
            let is_same =
                |tree: &NearTree| tree.species == id && Planted { species: plant.species, ..tree.plant } == *plant;
            let Some(place) = before.iter().position(is_same) else { return true };
            cell.spawned.push(NearTree { plant: *plant, ..before.swap_remove(place) });
            false
        });
        cell.outdated.extend(before.into_iter().map(|tree| tree.entity));
        cell.is_drawn = cell.planted.is_empty() && cell.outdated.is_empty();
        cell
    }
}

fn tree(plant: &Planted, species: Handle<Species>) -> impl Bundle {
    let place = Transform::from_translation(plant.position)
        .with_rotation(Quat::from_rotation_y(plant.turn_rad))
        .with_scale(Vec3::splat(plant.vigour));
    (
        Tree::new(species)
            .with_age(plant.age_years)
            .with_seed(u64::from(plant.seed))
            .with_season(plant.season_days)
            .with_tint(plant.tint),
        place,
    )
}
