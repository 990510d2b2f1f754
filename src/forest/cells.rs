//! The cells of a forest: its voxel grid, planted about the viewers in the background.

use super::{components::ForestSettings, near::NearTrees, reach::reaching};
use crate::{
    cells::{Cell, CellStore, CellStream, Orders, StreamSettings, ViewerPose},
    ground::Ground,
    scatter::Planter,
    setting::SettingError,
    tree::Species,
    viewpoint::Viewpoints,
};
use bevy::{
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use std::sync::Arc;

/// Cells that a task plants one after another: one alone takes less time than to start a task.
const CELLS_PER_TASK: usize = 16;

/// A forest that grows: its plan made ready, and its cells about the viewers with every stem that stands there.
#[derive(Component)]
pub struct ForestCells {
    planter: Arc<Planter>,
    ground: Arc<dyn Ground>,
    species: Vec<Handle<Species>>,
    /// Settings in force: the last that were valid.
    settings: ForestSettings,
    store: CellStore,
    stream: CellStream,
    orders: Orders,
    planting: Vec<Task<Vec<(IVec2, Cell)>>>,
    pub(super) near: NearTrees,
    generation: u64,
}

impl ForestCells {
    pub(super) fn new(
        planter: Planter,
        ground: Arc<dyn Ground>,
        species: Vec<Handle<Species>>,
        settings: ForestSettings,
        generation: u64,
    ) -> Result<Self, SettingError> {
        let (cell_m, bounds) = (planter.cell_m(), planter.cells());
        let known_m = settings.trees_to_m.max(settings.far_to_m);
        let stream = StreamSettings { plants_per_step: 64, most_ordered: 256, ..reaching(known_m, cell_m) };
        Ok(Self {
            store: CellStore::new(cell_m)?,
            stream: CellStream::new(stream, cell_m, bounds)?,
            near: NearTrees::new(&settings, cell_m, bounds)?,
            planter: Arc::new(planter),
            ground,
            species,
            settings,
            orders: Orders::default(),
            planting: Vec::new(),
            generation,
        })
    }

    /// Takes over the near trees of the plan before; what is of no use is returned. Where impostors have come or gone, trees have to be others.
    pub(super) fn take_over(&mut self, before: &mut Self) -> Vec<Entity> {
        if (before.settings.far_to_m > 0.0) != (self.settings.far_to_m > 0.0) {
            return before.near.entities().collect();
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

    pub(super) fn settings(&self) -> &ForestSettings {
        &self.settings
    }

    pub(super) fn shared_planter(&self) -> Arc<Planter> {
        self.planter.clone()
    }

    pub(super) fn ground(&self) -> Arc<dyn Ground> {
        self.ground.clone()
    }

    /// Near trees, and what they are made from.
    pub(super) fn parts(&mut self) -> (&mut NearTrees, &[Handle<Species>], &ForestSettings) {
        (&mut self.near, &self.species, &self.settings)
    }

    /// Grows whenever the forest begins anew.
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }

    /// Takes over what was planted, drops what nobody is near to any more, and has what is missing planted.
    fn step(&mut self, viewpoints: &[ViewerPose]) {
        let Self { store, stream, planting, .. } = self;
        planting.retain_mut(|task| {
            let Some(planted) = block_on(poll_once(task)) else { return true };
            for (cell, content) in planted {
                stream.deliver(cell, content, store);
            }
            false
        });
        self.stream.step(viewpoints, &self.store, &mut self.orders);
        for cell in &self.orders.drop {
            self.store.remove(*cell);
        }
        for cells in self.orders.plant.chunks(CELLS_PER_TASK) {
            let (planter, ground, cells) = (self.planter.clone(), self.ground.clone(), cells.to_vec());
            self.planting.push(AsyncComputeTaskPool::get().spawn(async move {
                let mut buffer = Vec::new();
                cells.into_iter().map(|cell| (cell, Cell::plant(&planter, cell, &ground, &mut buffer))).collect()
            }));
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
