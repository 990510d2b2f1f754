//! The cells of a forest: planted about the viewers in the background, a tile at a time. Stems go into the store, near trees and impostors
//! take what they need of each tile when it comes.

#[cfg(feature = "render")]
use super::tree_impostors::ImpostorSize;
use super::{
    cell_planter::CellPlanter,
    change_index::ChangeIndex,
    components::ForestSettings,
    forest_stand::ForestStand,
    known_tiles::{KnownTile, UpToDate},
    near::{CellTask, NearTrees},
    planted_tile::{PlantedTile, cells_of_tile},
    reach::{known_m, tile_of, tile_stream},
};
use crate::{
    background::{Work, WorkerPanic, spawn_work, take_finished},
    cells::{Cell, CellSet, CellStore, CellStream, Orders, ViewerPose},
    ground::Ground,
    scatter::Planter,
    setting::SettingError,
    tree::Species,
    viewpoint::Viewpoints,
};
use bevy::{platform::collections::HashMap, prelude::*};
use std::{collections::BTreeMap, sync::Arc};

/// A tile's plants, and its cells packed for the store.
pub(super) type PackedTile = (Arc<PlantedTile>, Vec<(IVec2, Cell)>);

/// A known tile that is planted again, and the cells of it in which near trees may have become others.
pub(super) struct Replanting {
    pub tile: IVec2,
    pub cells: Vec<IVec2>,
}

/// A forest that grows: its plan made ready, and its cells about the viewers with every stem that stands there.
#[derive(Component)]
pub struct ForestCells {
    pub(super) planter: Arc<Planter>,
    pub(super) ground: Arc<dyn Ground>,
    pub(super) species: Vec<Handle<Species>>,
    /// Settings in force: the last that were valid.
    pub(super) settings: ForestSettings,
    pub(super) store: CellStore,
    /// Cells along a side of a tile.
    pub(super) tile_cells: i32,
    pub(super) stream: CellStream,
    pub(super) orders: Orders,
    pub(super) planting: Vec<(IVec2, Work<PackedTile>)>,
    pub(super) tiles: HashMap<IVec2, KnownTile>,
    /// What is other than in the plan; none until that has been found out.
    pub(super) changes: Option<ChangeIndex>,
    /// Tiles with changes that are still to be planted again, by row and column, and the cells of each in which near trees may be others.
    pub(super) changed_tiles: BTreeMap<(i32, i32), Vec<IVec2>>,
    pub(super) replanting: Vec<(Replanting, Work<PackedTile>)>,
    /// Tiles of the plan before, whose cells are in the store.
    pub(super) outdated: usize,
    /// Tiles that impostors have still to be made of, where there are impostors.
    #[cfg(feature = "render")]
    pub(super) for_impostors: Option<Vec<(IVec2, Arc<PlantedTile>)>>,
    pub(super) near: NearTrees,
    /// How high and dense its trees stand, as the wind and the light meet them.
    pub(super) stand: ForestStand,
    /// From where on impostors stand for its trees, m; none until they are drawn.
    #[cfg(feature = "render")]
    pub(super) impostors_from_m: Option<f32>,
    /// How large the impostors of each species are; none of those that have none.
    #[cfg(feature = "render")]
    pub(super) impostor_sizes: Arc<[Option<ImpostorSize>]>,
    /// Whether it was told that a worker has panicked.
    has_told: bool,
    generation: u64,
    /// The generation since which tiles and numbers of species are the same.
    pub(super) tiles_since: u64,
}

impl ForestCells {
    pub(super) fn new(
        planter: Planter,
        ground: Arc<dyn Ground>,
        species: Vec<Handle<Species>>,
        settings: ForestSettings,
        generation: u64,
    ) -> Result<Self, SettingError> {
        let cell_m = planter.cell_m();
        let tile_cells = cells_of_tile(known_m(&settings), cell_m);
        Ok(Self {
            store: CellStore::new(cell_m)?,
            tile_cells,
            stream: tile_stream(&planter, &settings, tile_cells)?,
            near: NearTrees::new(&settings, cell_m, tile_cells, planter.cells())?,
            planter: Arc::new(planter),
            ground,
            stand: ForestStand::default(),
            species,
            settings,
            orders: Orders::default(),
            planting: Vec::new(),
            tiles: HashMap::default(),
            changes: None,
            changed_tiles: BTreeMap::new(),
            replanting: Vec::new(),
            outdated: 0,
            #[cfg(feature = "render")]
            for_impostors: None,
            #[cfg(feature = "render")]
            impostors_from_m: None,
            #[cfg(feature = "render")]
            impostor_sizes: Arc::default(),
            has_told: false,
            generation,
            tiles_since: generation,
        })
    }

    /// Cells along a side of a tile.
    pub(super) fn tile_cells(&self) -> i32 {
        self.tile_cells
    }

    /// Takes over what the forest before has; near cells that are of no use are returned. What stands there stays until it is known what
    /// stands there now, and only that is changed which is another.
    pub(super) fn take_over(&mut self, before: &mut Self) -> Vec<Entity> {
        let has_same_tiles = (before.planter.cell_m(), before.tile_cells) == (self.planter.cell_m(), self.tile_cells);
        // Stems in the store have numbers of species.
        if has_same_tiles && self.species.starts_with(&before.species) {
            self.tiles_since = before.tiles_since;
            std::mem::swap(&mut self.store, &mut before.store);
            self.tiles = std::mem::take(&mut before.tiles);
            self.tiles.values_mut().for_each(|tile| tile.is_outdated = true);
            self.outdated = self.tiles.len();
            #[cfg(feature = "render")]
            {
                self.for_impostors = before.for_impostors.take();
            }
        }
        // Trees that stay have the stand of the plan before until this one's is worked out.
        self.stand = ForestStand::after(&before.stand);
        // Where impostors have come or gone, trees have to be others.
        if (before.settings.far_to_m > 0.0) != (self.settings.far_to_m > 0.0) {
            return self.near.discard(&mut before.near);
        }
        #[cfg(feature = "render")]
        {
            self.impostors_from_m = before.impostors_from_m;
        }
        self.near.take_over(&mut before.near)
    }

    /// Whether every tree that is wanted from where the viewers are stands as an entity.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.near.is_complete()
    }

    /// Whether every cell that is wanted from where the viewers are is planted.
    #[must_use]
    pub fn is_planted(&self) -> bool {
        self.stream.is_complete()
    }

    /// The share of the tiles about the viewers that are planted as the plan says, 0 to 1.
    #[cfg(feature = "editor")]
    pub(crate) fn planted_share(&self) -> f32 {
        let planted = self.tiles.len() - self.outdated;
        let wanted = planted + self.stream.waiting() + self.stream.ordered();
        planted as f32 / wanted.max(1) as f32
    }

    /// The stems about the viewers, as far as trees of any kind are drawn: ask it who stands where, and what a ray hits.
    #[must_use]
    pub fn store(&self) -> &CellStore {
        &self.store
    }

    /// The plan, ready to be asked what grows where.
    #[must_use]
    pub fn planter(&self) -> &Planter {
        &self.planter
    }

    /// The species that grow here, in the order of the [`planter`](Self::planter)'s.
    #[must_use]
    pub fn species(&self) -> &[Handle<Species>] {
        &self.species
    }

    /// The plan and the ground, for what is worked out in the background.
    pub(super) fn planting(&self) -> (Arc<Planter>, Arc<dyn Ground>) {
        (self.planter.clone(), self.ground.clone())
    }

    pub(super) fn settings(&self) -> &ForestSettings {
        &self.settings
    }

    /// Near trees, and what they are made from: the species, the settings, and how one of their cells is planted alone, where its tile is
    /// known already.
    pub(super) fn parts(
        &mut self,
    ) -> (&mut NearTrees, &[Handle<Species>], &ForestSettings, impl Fn(IVec2) -> Option<CellTask>) {
        let Self { near, species, settings, tiles, tile_cells, planter, ground, changes, .. } = self;
        let plant = |cell: IVec2| {
            let tile = tile_of(cell, *tile_cells);
            UpToDate(tiles).contains(tile).then(|| {
                let changes = changes.as_ref().and_then(|changes| changes.tile(tile));
                let planter = CellPlanter { planter: planter.clone(), ground: ground.clone(), changes };
                spawn_work(move || planter.plants(cell))
            })
        };
        (near, species, settings, plant)
    }

    /// Grows whenever the forest begins anew.
    pub(crate) fn generation(&self) -> u64 {
        self.generation
    }

    /// Takes over what was planted, drops what nobody is near to any more, and has what is missing planted.
    fn step(&mut self, viewpoints: &[ViewerPose]) {
        self.receive();
        self.stream.step(viewpoints, &UpToDate(&self.tiles), &mut self.orders);
        self.drop_tiles();
        for number in 0..self.orders.plant.len() {
            let tile = self.orders.plant[number];
            self.planting.push((tile, self.plant_tile(tile)));
        }
        self.replant_changed_tiles();
    }

    /// Has a tile planted.
    pub(super) fn plant_tile(&self, tile: IVec2) -> Work<PackedTile> {
        let (planter, side) = (self.cell_planter(tile), self.tile_cells);
        spawn_work(move || {
            let planted = PlantedTile::plant(&planter, tile, side);
            let packed = planted.cells().map(|(cell, plants)| (cell, planter.pack(cell, plants))).collect();
            (Arc::new(planted), packed)
        })
    }

    /// What plants the cells of a tile.
    pub(super) fn cell_planter(&self, tile: IVec2) -> CellPlanter {
        let changes = self.changes.as_ref().and_then(|changes| changes.tile(tile));
        CellPlanter { planter: self.planter.clone(), ground: self.ground.clone(), changes }
    }

    /// Takes over tiles that were planted.
    fn receive(&mut self) {
        for (place, packed) in take_finished(&mut self.planting) {
            if self.stream.fulfil(place) {
                let packed = packed.unwrap_or_else(|panic| self.bare_tile(place, &panic));
                self.take_tile(place, packed);
            }
        }
    }

    /// What stands in place of a tile whose worker has panicked: the ground is a game's own, and would do so again. It is told once.
    fn bare_tile(&mut self, tile: IVec2, panic: &WorkerPanic) -> PackedTile {
        self.tell(panic);
        let (planter, bare) = (self.cell_planter(tile), PlantedTile::bare(tile, self.tile_cells));
        let packed = bare.cells().map(|(cell, plants)| (cell, planter.pack(cell, plants))).collect();
        (Arc::new(bare), packed)
    }

    /// Tells once that workers panic.
    pub(super) fn tell(&mut self, panic: &WorkerPanic) {
        if !std::mem::replace(&mut self.has_told, true) {
            error!("forest: {panic}; what its workers cannot plant stays as it is");
        }
    }

    /// Takes over a tile that was planted. One that has the plants that it had stays as it is.
    pub(super) fn take_tile(&mut self, place: IVec2, (planted, packed): PackedTile) {
        self.near.offer(place, &planted);
        // Cells that were changed while it was being planted will come again. Those that have been changed at once stay so until then.
        let changed = self.changed_tiles.get(&(place.y, place.x)).map_or(&[][..], Vec::as_slice);
        let fingerprint = changed.is_empty().then(|| planted.fingerprint());
        let before = self.tiles.insert(place, KnownTile { fingerprint, is_outdated: false });
        self.outdated -= usize::from(before.as_ref().is_some_and(|before| before.is_outdated));
        if fingerprint.is_some() && before.is_some_and(|before| before.fingerprint == fingerprint) {
            return;
        }
        for (cell, content) in packed {
            if !changed.contains(&cell) || !self.store.contains(cell) {
                self.store.insert(cell, content);
            }
        }
        #[cfg(feature = "render")]
        if let Some(tiles) = &mut self.for_impostors {
            tiles.retain(|(other, _)| *other != place);
            tiles.push((place, planted));
        }
    }

    /// Drops tiles that nobody is near to any more, and outdated ones once all others are planted.
    fn drop_tiles(&mut self) {
        if self.outdated > 0 && self.stream.is_complete() {
            let outdated = self.tiles.iter().filter(|(_, tile)| tile.is_outdated).map(|(tile, _)| *tile);
            self.orders.drop.extend(outdated);
        }
        for place in &self.orders.drop {
            let Some(tile) = self.tiles.remove(place) else { continue };
            self.outdated -= usize::from(tile.is_outdated);
            let cells = (0..self.tile_cells).flat_map(|z| (0..self.tile_cells).map(move |x| IVec2::new(x, z)));
            for cell in cells {
                self.store.remove(*place * self.tile_cells + cell);
            }
            #[cfg(feature = "render")]
            if let Some(tiles) = &mut self.for_impostors {
                tiles.retain(|(other, _)| other != place);
            }
        }
    }
}

/// Keeps the cells about the viewers planted.
pub(super) fn plant_cells(
    viewpoints: Viewpoints,
    mut places: Local<Vec<ViewerPose>>,
    mut forests: Query<&mut ForestCells>,
) {
    viewpoints.fill(&mut places);
    for mut forest in &mut forests {
        forest.step(&places);
    }
}
