//! Trees near the viewers: cells whose plants are entities.

#[cfg(feature = "render")]
use super::cull::{ForestCulling, Reach};
use super::{
    cells::{ForestCells, reaching},
    components::{ForestCell, ForestSettings},
};
#[cfg(feature = "render")]
use crate::cells::Watch;
use crate::{
    cells::{CellSet, CellStream, Orders, StreamSettings, Viewpoint},
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
    #[cfg_attr(not(feature = "render"), expect(dead_code))]
    cell_m: f32,
    stream: CellStream,
    orders: Orders,
    planting: Vec<(IVec2, Task<Vec<Planted>>)>,
    cells: NearCells,
    /// Cells whose trees are still to come, the first first.
    bare: Vec<IVec2>,
    /// By the number of the species.
    #[cfg(feature = "render")]
    reaches: Vec<Reach>,
    #[cfg(feature = "render")]
    sights: Vec<Sight>,
    /// Whether cells or reaches have changed since `sights` was made.
    #[cfg(feature = "render")]
    stale: bool,
}

/// The cells that are there.
#[derive(Default)]
struct NearCells(HashMap<IVec2, NearCell>);

struct NearCell {
    entity: Entity,
    planted: Vec<Planted>,
    /// Plants that have become trees.
    raised: usize,
    /// Whether all of them are drawn.
    #[cfg_attr(not(feature = "render"), expect(dead_code))]
    dressed: bool,
    #[cfg_attr(not(feature = "render"), expect(dead_code))]
    extent: Extent,
}

/// A cell with trees, as it is looked at.
#[cfg(feature = "render")]
struct Sight {
    /// Of the box around its trees, m.
    corners: [Vec3; 2],
    entity: Entity,
    /// For so many frames nobody has seen it.
    unseen_frames: u8,
    /// What was last told of it.
    shown: Option<bool>,
}

/// How low, how high and how large the plants of a cell are.
#[cfg_attr(not(feature = "render"), expect(dead_code))]
struct Extent {
    lowest_m: f32,
    highest_m: f32,
    /// Number of a species, and the greatest scale of its plants.
    largest: Box<[(u8, f32)]>,
}

impl Extent {
    fn of(planted: &[Planted]) -> Self {
        let mut largest: Vec<(u8, f32)> = Vec::new();
        for plant in planted {
            match largest.iter_mut().find(|(species, _)| *species == plant.species) {
                Some((_, scale)) => *scale = scale.max(plant.vigour),
                None => largest.push((plant.species, plant.vigour)),
            }
        }
        let heights_m = || planted.iter().map(|plant| plant.position.y);
        Self {
            lowest_m: heights_m().fold(f32::INFINITY, f32::min),
            highest_m: heights_m().fold(f32::NEG_INFINITY, f32::max),
            largest: largest.into(),
        }
    }

    /// The corners of the box around the cell's trees, swaying.
    #[cfg(feature = "render")]
    fn corners(&self, corner: Vec2, cell_m: f32, reaches: &[Reach]) -> [Vec3; 2] {
        let [mut up_m, mut down_m, mut aside_m] = [0.0_f32; 3];
        for (species, scale) in &self.largest {
            let reach = reaches.get(usize::from(*species)).copied().unwrap_or_default();
            (up_m, down_m) = (up_m.max(scale * reach.up_m), down_m.max(scale * reach.down_m));
            aside_m = aside_m.max(scale * reach.aside_m);
        }
        let (min, max) = (corner - aside_m, corner + cell_m + aside_m);
        [Vec3::new(min.x, self.lowest_m - down_m, min.y), Vec3::new(max.x, self.highest_m + up_m, max.y)]
    }
}

impl CellSet for NearCells {
    fn contains(&self, cell: IVec2) -> bool {
        self.0.contains_key(&cell)
    }

    fn visit(&self, visit: impl FnMut(IVec2)) {
        self.0.keys().copied().for_each(visit);
    }
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
            cells: NearCells::default(),
            bare: Vec::new(),
            #[cfg(feature = "render")]
            reaches: Vec::new(),
            #[cfg(feature = "render")]
            sights: Vec::new(),
            #[cfg(feature = "render")]
            stale: false,
        })
    }

    pub fn is_complete(&self) -> bool {
        self.stream.is_complete() && self.bare.is_empty()
    }

    pub fn entities(&self) -> impl Iterator<Item = Entity> {
        self.cells.0.values().map(|cell| cell.entity)
    }

    /// Notes those cells all of whose trees have come and are drawn, as `is_dressed` says.
    #[cfg(feature = "render")]
    pub fn note_dressed(&mut self, is_dressed: impl Fn(Entity) -> bool) {
        for cell in self.cells.0.values_mut().filter(|cell| !cell.dressed && cell.planted.is_empty()) {
            cell.dressed = is_dressed(cell.entity);
        }
    }

    /// Cells all of whose trees are drawn.
    #[cfg(feature = "render")]
    pub fn dressed(&self) -> impl Iterator<Item = IVec2> {
        self.cells.0.iter().filter(|(_, cell)| cell.dressed).map(|(cell, _)| *cell)
    }

    /// Notes how far the trees of each species reach.
    #[cfg(feature = "render")]
    pub fn measure(&mut self, reaches: impl Iterator<Item = Reach>) {
        self.reaches.clear();
        self.reaches.extend(reaches);
        self.stale = true;
    }

    /// Looks at every cell, and shows by its entity those that are seen; those that have not been for a while are hidden.
    #[cfg(feature = "render")]
    pub fn show_seen(&mut self, settings: ForestCulling, views: &[Watch], mut show: impl FnMut(Entity, bool)) {
        self.renew_sights();
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

    /// The boxes of the cells lie side by side, for they are all looked at in every frame; they are put in order again when a
    /// cell comes or goes.
    #[cfg(feature = "render")]
    fn renew_sights(&mut self) {
        if !std::mem::take(&mut self.stale) {
            return;
        }
        let Self { cells, reaches, cell_m, sights, .. } = self;
        let before: HashMap<Entity, u8> = sights.iter().map(|sight| (sight.entity, sight.unseen_frames)).collect();
        sights.clear();
        let planted = cells.0.iter().filter(|(_, there)| !there.extent.largest.is_empty());
        sights.extend(planted.map(|(cell, there)| Sight {
            corners: there.extent.corners(cell.as_vec2() * *cell_m, *cell_m, reaches),
            entity: there.entity,
            unseen_frames: before.get(&there.entity).copied().unwrap_or(0),
            shown: None,
        }));
    }

    /// Cells that are there, and those that were seen in the last frame.
    #[cfg(feature = "render")]
    pub fn count(&self) -> (usize, usize) {
        (self.cells.0.len(), self.sights.iter().filter(|sight| sight.unseen_frames == 0).count())
    }

    /// The box around the trees of each cell, and whether it was seen in the last frame.
    #[cfg(feature = "render")]
    pub fn boxes(&self) -> impl Iterator<Item = ([Vec3; 2], bool)> {
        self.sights.iter().map(|sight| (sight.corners, sight.unseen_frames == 0))
    }

    /// Takes over cells that have been planted.
    fn receive(&mut self, forest: Entity, commands: &mut Commands) {
        let Self {
            planting,
            cells,
            bare,
            stream,
            #[cfg(feature = "render")]
            stale,
            ..
        } = self;
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
            };
            cells.0.insert(*cell, near);
            #[cfg(feature = "render")]
            {
                *stale = true;
            }
            false
        });
    }

    /// Clears what nobody is near to any more.
    fn clear(&mut self, commands: &mut Commands) {
        for cell in &self.orders.drop {
            if let Some(there) = self.cells.0.remove(cell) {
                commands.entity(there.entity).despawn();
                #[cfg(feature = "render")]
                {
                    self.stale = true;
                }
                self.bare.retain(|bare| bare != cell);
            }
        }
    }

    /// Turns plants into trees, as many as a frame may.
    fn raise(&mut self, settings: &ForestSettings, species: &[Handle<Species>], commands: &mut Commands) {
        #[cfg(feature = "render")]
        let has_cards = settings.far_to_m > 0.0;
        let mut left = settings.trees_per_frame as usize;
        while let Some(cell) = self.bare.first().and_then(|cell| self.cells.0.get_mut(cell)).filter(|_| left > 0) {
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

/// Keeps the cells near the viewers raised: trees come nearest first, and go one cell a frame.
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
