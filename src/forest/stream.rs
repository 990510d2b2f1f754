//! Plants the cells about the viewpoints in the background, and turns their plants into trees.

use super::{
    components::{Forest, ForestCell, ForestGround, ForestSettings},
    cover::StandingGround,
};
use crate::{
    scatter::{ForestPlan, Ground, LevelGround, Planted, Planter},
    terrain::{Terrain, TerrainSettings},
    tree::{Species, Tree},
    viewpoint::Viewpoints,
};
use bevy::{
    platform::collections::HashMap,
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use std::sync::Arc;

/// Trees stay until a viewer is farther than this from their cell, over the distance at which they come: who walks to and
/// fro at a border makes nobody plant and clear.
const HYSTERESIS: f32 = 1.15;

pub(super) type SharedGround = Arc<dyn Ground + Send + Sync>;

/// The cells of a [`Forest`].
#[derive(Component)]
pub struct ForestCells {
    planter: Arc<Planter>,
    ground: SharedGround,
    species: Vec<Handle<Species>>,
    /// Settings in force: the last that were valid.
    settings: ForestSettings,
    cells: HashMap<IVec2, Cell>,
    planting: Vec<(IVec2, Task<Vec<Planted>>)>,
    /// Cells that are wanted and not there, the nearest last.
    queue: Vec<IVec2>,
    /// Cells whose trees are still to come, the nearest last.
    bare: Vec<IVec2>,
    eyes: Vec<Vec2>,
    looked_from: Vec<Vec2>,
    generation: u64,
}

struct Cell {
    entity: Entity,
    planted: Vec<Planted>,
    /// Plants that have become trees.
    raised: usize,
    /// Whether all of them are drawn.
    dressed: bool,
}

impl ForestCells {
    /// Whether every tree that is wanted from where the viewers are stands.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        !self.looked_from.is_empty() && self.queue.is_empty() && self.planting.is_empty() && self.bare.is_empty()
    }

    #[cfg(feature = "render")]
    pub(super) fn shared_planter(&self) -> Arc<Planter> {
        self.planter.clone()
    }

    #[cfg(feature = "render")]
    pub(super) fn ground(&self) -> SharedGround {
        self.ground.clone()
    }

    /// In the order of the planter's.
    #[cfg(feature = "render")]
    pub(super) fn species(&self) -> &[Handle<Species>] {
        &self.species
    }

    /// Grows whenever the forest begins anew.
    #[cfg(feature = "render")]
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }

    #[cfg(feature = "render")]
    pub(super) fn far_to_m(&self) -> f32 {
        self.settings.far_to_m
    }

    #[cfg(feature = "render")]
    pub(super) fn cells_at_once(&self) -> usize {
        self.settings.cells_at_once as usize
    }

    /// The cell of the first viewer.
    #[cfg(feature = "render")]
    pub(super) fn centre(&self) -> Option<IVec2> {
        self.looked_from.first().map(|eye| self.planter.cell_at(*eye))
    }

    /// Notes those cells all of whose trees have come and are drawn, as `is_dressed` says.
    #[cfg(feature = "render")]
    pub(super) fn note_dressed(&mut self, is_dressed: impl Fn(Entity) -> bool) {
        for cell in self.cells.values_mut().filter(|cell| !cell.dressed && cell.planted.is_empty()) {
            cell.dressed = is_dressed(cell.entity);
        }
    }

    /// Cells all of whose trees are drawn.
    #[cfg(feature = "render")]
    pub(super) fn dressed(&self) -> impl Iterator<Item = IVec2> + '_ {
        self.cells.iter().filter(|(_, cell)| cell.dressed).map(|(cell, _)| *cell)
    }

    /// The plan, ready to be asked what grows where.
    #[must_use]
    pub fn planter(&self) -> &Planter {
        &self.planter
    }
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
        for cell in before.into_iter().flat_map(|before| before.cells.values()) {
            commands.entity(cell.entity).despawn();
        }
        let path = |name: &String| assets.load(format!("{}/{name}.species.ron", settings.species_folder));
        commands.entity(entity).insert(ForestCells {
            species: planter.species().iter().map(path).collect(),
            planter: Arc::new(planter),
            ground,
            settings,
            cells: HashMap::default(),
            planting: Vec::new(),
            queue: Vec::new(),
            bare: Vec::new(),
            eyes: Vec::new(),
            looked_from: Vec::new(),
            generation: before.map_or(0, |before| before.generation + 1),
        });
    }
}

/// Finds out which cells are wanted, clears those that no longer are, and plants what is missing.
pub(super) fn plant_cells(
    mut commands: Commands,
    viewpoints: Viewpoints,
    mut forests: Query<(Entity, &mut ForestCells)>,
) {
    for (entity, mut forest) in &mut forests {
        let forest = &mut *forest;
        forest.look(&viewpoints, &mut commands);
        forest.receive(entity, &mut commands);
        while forest.planting.len() < forest.settings.cells_at_once as usize {
            let Some(cell) = forest.queue.pop() else { break };
            let (planter, ground) = (forest.planter.clone(), forest.ground.clone());
            let task = AsyncComputeTaskPool::get().spawn(async move {
                let mut planted = Vec::new();
                planter.plant(cell, &ground, &mut planted);
                planted
            });
            forest.planting.push((cell, task));
        }
    }
}

/// Turns plants into trees: the nearest first, as many as a frame may.
pub(super) fn raise_trees(mut commands: Commands, mut forests: Query<&mut ForestCells>) {
    for mut forest in &mut forests {
        if forest.bare.is_empty() {
            continue;
        }
        let ForestCells { cells, bare, species, settings, .. } = &mut *forest;
        let mut left = settings.trees_per_frame as usize;
        while let Some(cell) = bare.last().and_then(|cell| cells.get_mut(cell)).filter(|_| left > 0) {
            let batch = left.min(cell.planted.len() - cell.raised);
            commands.entity(cell.entity).with_children(|parent| {
                for plant in &cell.planted[cell.raised..cell.raised + batch] {
                    parent.spawn(tree(plant, species));
                }
            });
            (cell.raised, left) = (cell.raised + batch, left - batch);
            if cell.raised == cell.planted.len() {
                cell.planted = Vec::new();
                cell.raised = 0;
                bare.pop();
            }
        }
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

impl ForestCells {
    /// Looks again when a viewer has moved by a quarter of a cell.
    fn look(&mut self, viewpoints: &Viewpoints, commands: &mut Commands) {
        self.eyes.clear();
        self.eyes.extend(viewpoints.iter().map(Vec3::xz));
        let quarter_m = 0.25 * self.planter.cell_m();
        let rests = |(now, then): (&Vec2, &Vec2)| now.distance(*then) < quarter_m;
        // Where nobody looks, what is there stays.
        let nobody = self.eyes.is_empty();
        if nobody || self.eyes.len() == self.looked_from.len() && self.eyes.iter().zip(&self.looked_from).all(rests) {
            return;
        }
        self.looked_from.clone_from(&self.eyes);

        let keep_m = HYSTERESIS * self.settings.trees_to_m;
        let (planter, eyes) = (self.planter.clone(), std::mem::take(&mut self.eyes));
        let distance_m = |cell: IVec2| distance_m(&planter, cell, &eyes);
        let is_near = |cell: &IVec2| distance_m(*cell) <= keep_m;
        self.planting.retain(|(cell, _)| is_near(cell));
        self.cells.retain(|cell, there| {
            let stays = is_near(cell);
            if !stays {
                commands.entity(there.entity).despawn();
            }
            stays
        });
        self.queue.clear();
        let Some([least, greatest]) = planter.cells() else { return };
        for eye in &eyes {
            let reach = Vec2::splat(self.settings.trees_to_m);
            let (from, to) = (planter.cell_at(eye - reach).max(least), planter.cell_at(eye + reach).min(greatest));
            let square = (from.y..=to.y).flat_map(|row| (from.x..=to.x).map(move |column| IVec2::new(column, row)));
            let missing = square
                .filter(|cell| distance_m(*cell) <= self.settings.trees_to_m)
                .filter(|cell| !self.cells.contains_key(cell) && self.planting.iter().all(|(other, _)| other != cell));
            self.queue.extend(missing);
        }
        let far_first = |cell: &IVec2| (std::cmp::Reverse(distance_m(*cell) as u32), cell.x, cell.y);
        self.queue.sort_by_cached_key(far_first);
        self.queue.dedup();
        self.bare.retain(is_near);
        self.bare.sort_by_cached_key(far_first);
        self.eyes = eyes;
    }

    /// Takes over cells that have been planted.
    fn receive(&mut self, forest: Entity, commands: &mut Commands) {
        let Self { planting, cells, bare, .. } = self;
        planting.retain_mut(|(cell, task)| {
            let Some(planted) = block_on(poll_once(task)) else { return true };
            let entity =
                commands.spawn((ForestCell(*cell), ChildOf(forest), Transform::default(), Visibility::default()));
            if !planted.is_empty() {
                bare.push(*cell);
            }
            cells.insert(*cell, Cell { entity: entity.id(), dressed: planted.is_empty(), planted, raised: 0 });
            false
        });
    }
}

/// From the nearest viewpoint to the nearest place of a cell, m.
fn distance_m(planter: &Planter, cell: IVec2, eyes: &[Vec2]) -> f32 {
    distance_to_square_m(planter.corner_m(cell).as_vec2(), planter.cell_m(), eyes)
}

/// From the nearest viewpoint to the nearest place of a square, m.
pub(super) fn distance_to_square_m(corner: Vec2, side_m: f32, eyes: &[Vec2]) -> f32 {
    let to_eye = |eye: &Vec2| eye.clamp(corner, corner + side_m).distance(*eye);
    eyes.iter().map(to_eye).fold(f32::INFINITY, f32::min)
}
