//! Trees near the viewers: cells whose plants are entities.

#[cfg(feature = "render")]
use super::extent::Extent;
use super::{
    cell_canopies::CanopyTask,
    components::{ForestCell, ForestSettings},
    forest_stand::StandGenerations,
    near_cell::{NearCell, NearEvent, NearTree, take_tree, tree},
    planted_tile::PlantedTile,
    reach::{reaching, tile_of},
    stem_id::StemId,
};
use crate::{
    background::Work,
    cells::{CellSet, CellStream, Orders, StreamSettings, ViewerPose},
    scatter::Planted,
    setting::SettingError,
    tree::Species,
    wind::Canopy,
};
use bevy::{
    platform::collections::HashMap,
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::sync::Arc;

/// Side of a common cell, m.
const COMMON_CELL_M: f32 = 64.0;

/// A cell that is planted alone.
pub(super) type CellTask = Work<Vec<(StemId, Planted)>>;

/// Where the plants of a cell come from.
pub(super) enum Planting {
    /// From its tile, which is being planted, or has just been.
    Tile,
    /// Planted again, since its tile is known and gone.
    Alone(CellTask),
}

/// The near cells of a forest.
pub(super) struct NearTrees {
    pub(super) cell_m: f32,
    /// Cells along a side of a tile.
    pub(super) tile_cells: i32,
    stream: CellStream,
    orders: Orders,
    pub(super) planting: Vec<(IVec2, Planting)>,
    /// Tiles that came while near cells of them were missing, until none is.
    pub(super) tiles: HashMap<IVec2, Arc<PlantedTile>>,
    pub(super) cells: HashMap<IVec2, NearCell>,
    /// Cells whose trees are still to be spawned, in that order.
    pub(super) unspawned: Vec<IVec2>,
    /// Cells of whose trees some lack the stand of this generation of the forest's.
    pub(super) without_canopies: Vec<IVec2>,
    canopies_of: u64,
    pub(super) changes: u64,
    /// Grows whenever the set of drawn cells may have changed.
    pub(super) drawn_changes: u64,
    /// Trees that have come and gone, of whom is still to be told.
    pub(super) events: Vec<NearEvent>,
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
    pub fn new(
        settings: &ForestSettings,
        cell_m: f32,
        tile_cells: i32,
        bounds: Option<[IVec2; 2]>,
    ) -> Result<Self, SettingError> {
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
            tile_cells,
            stream: CellStream::new(stream, cell_m, bounds)?,
            orders: Orders::default(),
            planting: Vec::new(),
            tiles: HashMap::default(),
            cells: HashMap::default(),
            unspawned: Vec::new(),
            without_canopies: Vec::new(),
            canopies_of: 0,
            changes: 0,
            drawn_changes: 0,
            events: Vec::new(),
        })
    }

    /// Takes over the trees of the plan before. Each cell keeps them until it is planted anew; then those stay that the new plan has too.
    /// Cells of another size are of no use: their entities are returned.
    pub fn take_over(&mut self, before: &mut Self) -> Vec<Entity> {
        self.events.append(&mut before.events);
        if before.cell_m != self.cell_m {
            return self.discard(before);
        }
        self.changes = before.changes + 1;
        self.drawn_changes = before.drawn_changes + 1;
        self.cells = std::mem::take(&mut before.cells);
        for cell in self.cells.values_mut() {
            cell.is_outdated = true;
            cell.planted = Vec::new();
        }
        Vec::new()
    }

    /// Makes no use of what was before: its entities are returned.
    pub fn discard(&mut self, before: &mut Self) -> Vec<Entity> {
        let trees = before.cells.values().flat_map(NearCell::trees).cloned();
        self.events.extend(trees.map(NearEvent::Left));
        before.entities().collect()
    }

    /// Takes a tile that has been planted, if near cells of it are missing.
    pub fn offer(&mut self, place: IVec2, tile: &Arc<PlantedTile>) {
        if !self.stream.is_complete() && tile.cells().any(|(cell, _)| self.stream.keeps(cell)) {
            self.tiles.insert(place, tile.clone());
        }
    }

    /// Finds out which cells are wanted from where the viewers are. Those that are missing come with their tile; where that has come before
    /// and is gone, `plant` has the cell planted again.
    pub fn follow(&mut self, viewers: &[ViewerPose], plant: impl Fn(IVec2) -> Option<CellTask>) {
        self.stream.step(viewers, &UpToDate(&self.cells), &mut self.orders);
        for cell in &self.orders.plant {
            let tile = tile_of(*cell, self.tile_cells);
            let alone = if self.tiles.contains_key(&tile) { None } else { plant(*cell) };
            self.planting.push((*cell, alone.map_or(Planting::Tile, Planting::Alone)));
        }
        if self.stream.is_complete() {
            self.tiles.clear();
        }
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

    /// Whether all trees of a near cell are drawn.
    #[cfg(feature = "render")]
    pub fn is_drawn(&self, cell: IVec2) -> bool {
        self.cells.get(&cell).is_some_and(|cell| cell.is_drawn)
    }

    /// Grows whenever the set of drawn cells may have changed.
    #[cfg(feature = "render")]
    pub fn drawn_changes(&self) -> u64 {
        self.drawn_changes
    }

    /// Every tree that is spawned.
    #[cfg(feature = "render")]
    pub fn trees(&self) -> impl Iterator<Item = &NearTree> {
        self.cells.values().flat_map(NearCell::trees)
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
        let Self { planting, tiles, tile_cells, cells, unspawned, without_canopies, stream, .. } = self;
        let (changes, drawn_changes) = (&mut self.changes, &mut self.drawn_changes);
        planting.retain_mut(|(cell, source)| {
            let planted = match source {
                // It has been planted before; where that cannot be done again, nothing stands there.
                Planting::Alone(task) => block_on(poll_once(task)).map(Result::unwrap_or_default),
                Planting::Tile => {
                    let tile = tiles.get(&tile_of(*cell, *tile_cells));
                    // One that nobody wants any more is waited for no longer.
                    tile.map(|tile| tile.stems(*cell)).or_else(|| (!stream.keeps(*cell)).then(Vec::new))
                }
            };
            let Some(planted) = planted else { return true };
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
            without_canopies.push(*cell);
            *changes += 1;
            *drawn_changes += 1;
            false
        });
    }

    /// Gives trees that lack it the stand of the forest as it is now. `work_out` has that of a cell worked out.
    pub fn give_canopies(
        &mut self,
        generations: &StandGenerations,
        work_out: impl Fn(IVec2) -> CanopyTask,
        mut give: impl FnMut(Entity, Canopy),
    ) {
        let Self { cells, without_canopies, canopies_of, tile_cells, .. } = self;
        let now = generations.newest();
        let since = |cell: IVec2| generations.since(tile_of(cell, *tile_cells));
        if std::mem::replace(canopies_of, now) != now {
            let outdated = cells.iter().filter(|(cell, there)| !there.has_canopies_since(since(**cell)));
            without_canopies.clear();
            without_canopies.extend(outdated.map(|(cell, _)| *cell));
        }
        without_canopies.retain(|cell| {
            let there = cells.get_mut(cell);
            there.is_some_and(|there| !there.give_canopies(since(*cell), || (now, work_out(*cell)), &mut give))
        });
    }

    /// Whether all trees have the stand of the forest as it was in the last frame.
    pub fn has_canopies(&self) -> bool {
        self.without_canopies.is_empty()
    }

    /// Removes cells that nobody is near to any more, and outdated ones once all others are planted.
    pub fn clear(&mut self, commands: &mut Commands) {
        if self.stream.is_complete() && self.planting.is_empty() {
            let outdated = self.cells.iter().filter(|(_, there)| there.is_outdated).map(|(cell, _)| *cell);
            self.orders.drop.extend(outdated);
        }
        for cell in &self.orders.drop {
            if let Some(there) = self.cells.remove(cell) {
                self.events.extend(there.trees().cloned().map(NearEvent::Left));
                commands.entity(there.entity).despawn();
                self.changes += 1;
                self.drawn_changes += 1;
                self.unspawned.retain(|unspawned| unspawned != cell);
            }
        }
    }

    /// Notes cells all of whose trees are drawn. Trees of the plan before go then.
    pub fn note_drawn(&mut self, is_drawn: impl Fn(Entity) -> bool, commands: &mut Commands) {
        let is_due = |cell: &&mut NearCell| cell.planted.is_empty() && (!cell.is_drawn || !cell.outdated.is_empty());
        for cell in self.cells.values_mut().filter(is_due) {
            if cell.spawned.iter().all(|tree| is_drawn(tree.entity)) {
                self.drawn_changes += u64::from(!cell.is_drawn);
                cell.is_drawn = true;
                for tree in cell.outdated.drain(..) {
                    commands.entity(tree.entity).despawn();
                    self.events.push(NearEvent::Left(tree));
                }
            }
        }
    }

    /// Spawns trees, as many as a frame may. `mark` gives each what its forest gives to all.
    pub fn spawn(
        &mut self,
        trees_per_frame: u32,
        species: &[Handle<Species>],
        mark: impl Fn(&mut EntityCommands, &Planted),
        commands: &mut Commands,
    ) {
        let mut left = trees_per_frame as usize;
        while let Some(cell) = self.unspawned.first().and_then(|cell| self.cells.get_mut(cell)).filter(|_| left > 0) {
            let rest = cell.planted.len().saturating_sub(left);
            left -= cell.planted.len() - rest;
            for (id, plant) in cell.planted.drain(rest..) {
                let handle = &species[usize::from(plant.species)];
                let planted = tree(&plant, handle.clone());
                let spawned = match take_tree(&mut cell.altered, id) {
                    Some(there) => {
                        // The game may have despawned it.
                        if let Ok(mut tree) = commands.get_entity(there.entity) {
                            tree.insert(planted);
                            mark(&mut tree, &plant);
                        }
                        NearTree { is_altered: false, ..there }
                    }
                    None => {
                        let mut tree = commands.spawn((planted, id, ChildOf(cell.entity)));
                        mark(&mut tree, &plant);
                        let (species, entity) = (handle.id(), tree.id());
                        let spawned = NearTree { id, plant, species, entity, is_altered: false, canopy_of: 0 };
                        self.events.push(NearEvent::Entered(spawned.clone()));
                        spawned
                    }
                };
                cell.spawned.push(spawned);
            }
            if cell.planted.is_empty() {
                self.unspawned.remove(0);
            }
        }
    }
}
