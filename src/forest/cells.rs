//! The cells of a forest: its voxel grid, planted about the viewers in the background.

use super::{
    components::{Forest, ForestGround, ForestSettings},
    cover::StandingGround,
    near::NearTrees,
};
use crate::{
    cells::{Cell, CellStore, CellStream, Orders, StreamSettings, Viewpoint},
    scatter::{ForestPlan, Ground, LevelGround, Planter},
    setting::SettingError,
    terrain::{Terrain, TerrainSettings},
    tree::Species,
    viewpoint::Viewpoints,
};
use bevy::{
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use std::sync::Arc;

/// What comes stays until a viewer is farther than this from it, over the distance at which it comes: who walks to and fro
/// at a border makes nobody plant and clear.
pub(super) const HYSTERESIS: f32 = 1.15;
/// Cells that a task plants one after another: one alone takes less than to send it away.
const CELLS_OF_A_TASK: usize = 16;
/// No more cells than this lie from a viewer to the border of what is kept: `CellStream` follows at most 512.
const MOST_CELLS: f32 = 500.0;

pub(super) type SharedGround = Arc<dyn Ground + Send + Sync>;

/// A forest that grows: its plan made ready, and its cells about the viewers with every stem that stands there.
#[derive(Component)]
pub struct ForestCells {
    planter: Arc<Planter>,
    ground: SharedGround,
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
    fn new(
        planter: Planter,
        ground: SharedGround,
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

    pub(super) fn ground(&self) -> SharedGround {
        self.ground.clone()
    }

    /// Near trees, and what they are made from.
    pub(super) fn parts(&mut self) -> (&mut NearTrees, &[Handle<Species>], &ForestSettings) {
        (&mut self.near, &self.species, &self.settings)
    }

    /// Grows whenever the forest begins anew.
    #[cfg(feature = "render")]
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }

    /// Takes over what was planted, drops what nobody is near to any more, and has what is missing planted.
    fn step(&mut self, viewpoints: &[Viewpoint]) {
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
        for cells in self.orders.plant.chunks(CELLS_OF_A_TASK) {
            let (planter, ground, cells) = (self.planter.clone(), self.ground.clone(), cells.to_vec());
            self.planting.push(AsyncComputeTaskPool::get().spawn(async move {
                let mut buffer = Vec::new();
                cells.into_iter().map(|cell| (cell, Cell::plant(&planter, cell, &ground, &mut buffer))).collect()
            }));
        }
    }
}

/// Follows viewers over so many metres, with squares of that side.
pub(super) fn reaching(load_m: f32, side_m: f32) -> StreamSettings {
    let load_m = load_m.min(MOST_CELLS / HYSTERESIS * side_m);
    StreamSettings { load_m, keep_m: (HYSTERESIS * load_m).max(load_m + side_m), ..StreamSettings::default() }
}

/// Begins anew with forests that are new, whose plan has been loaded or changed, or whose ground is another.
pub(super) fn begin_forests(
    mut commands: Commands,
    plans: Res<Assets<ForestPlan>>,
    assets: Res<AssetServer>,
    mut events: MessageReader<AssetEvent<ForestPlan>>,
    forests: Query<(Entity, Ref<Forest>, Ref<ForestSettings>, Option<Ref<ForestGround>>, Option<&ForestCells>)>,
    terrains: Query<(Ref<Terrain>, &TerrainSettings)>,
) {
    let changed: Vec<AssetId<ForestPlan>> = events
        .read()
        .filter_map(|event| match event {
            AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(*id),
            _ => None,
        })
        .collect();
    let terrain = terrains.iter().next();
    let other_terrain = terrain.as_ref().is_some_and(|(terrain, _)| terrain.is_changed());
    for (entity, forest, wanted, own_ground, before) in &forests {
        let other_ground = own_ground.as_ref().map_or(other_terrain, Ref::is_changed);
        let due = forest.is_changed() || wanted.is_changed() || other_ground || changed.contains(&forest.plan.id());
        let Some(plan) = plans.get(&forest.plan).filter(|_| due) else { continue };
        let planter = match Planter::new(plan) {
            Ok(planter) => planter,
            Err(error) => {
                warn!("forest: {error}; the last good one stays");
                continue;
            }
        };
        let settings = match wanted.validate() {
            Ok(()) => ForestSettings::clone(&wanted),
            Err(error) => {
                let last = before.map_or_else(ForestSettings::default, |before| before.settings.clone());
                warn!("forest settings: {error}; {last:?} are used");
                last
            }
        };
        let ground: SharedGround = match (own_ground, &terrain) {
            (Some(own), _) => own.0.clone(),
            (None, Some((terrain, settings))) => {
                Arc::new(StandingGround::new(terrain.ground.clone(), settings.finest_cell_m))
            }
            (None, None) => Arc::new(LevelGround::default()),
        };
        let path = |name: &String| assets.load(format!("{}/{name}.species.ron", settings.species_folder));
        let species = planter.species().iter().map(path).collect();
        let generation = before.map_or(0, |before| before.generation + 1);
        match ForestCells::new(planter, ground, species, settings, generation) {
            Ok(cells) => {
                before.into_iter().flat_map(|before| before.near.entities()).for_each(|cell| {
                    commands.entity(cell).despawn();
                });
                commands.entity(entity).insert(cells);
            }
            Err(error) => warn!("forest: {error}; the last good one stays"),
        }
    }
}

/// Keeps the cells about the viewers planted.
pub(super) fn plant_cells(
    viewpoints: Viewpoints,
    mut places: Local<Vec<Viewpoint>>,
    mut forests: Query<&mut ForestCells>,
) {
    viewpoints.fill(&mut places);
    for mut forest in &mut forests {
        forest.step(&places);
    }
}
