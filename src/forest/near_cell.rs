//! A near cell: which of its trees stand, which are still to come, and which are of the plan before.

use super::{
    cell_canopies::{CanopyTask, CellCanopies},
    extent::Extent,
    stem_id::StemId,
};
use crate::{
    scatter::Planted,
    tree::{Species, Tree},
    wind::Canopy,
};
use bevy::{
    prelude::*,
    tasks::{block_on, poll_once},
};

/// A cell whose plants are entities.
pub(super) struct NearCell {
    pub entity: Entity,
    /// What is still to be spawned.
    pub planted: Vec<(StemId, Planted)>,
    pub spawned: Vec<NearTree>,
    /// Trees that stand and are to become others, as when they have grown: they are among those that are still to be spawned.
    pub altered: Vec<NearTree>,
    /// Trees of the plan before, or that have become another species, which go when all others are drawn.
    pub outdated: Vec<NearTree>,
    /// Whether it is of the plan before.
    pub is_outdated: bool,
    /// Whether all of its trees are drawn.
    pub is_drawn: bool,
    pub extent: Extent,
    pub is_articulated: bool,
    /// The stand of its trees, of a generation of its forest's.
    pub canopies: Option<(u64, CellCanopies)>,
    pub canopy_task: Option<(u64, CanopyTask)>,
}

/// A tree of a near cell, and the plant that it is.
#[derive(Clone, Debug)]
pub(super) struct NearTree {
    pub id: StemId,
    pub plant: Planted,
    pub species: AssetId<Species>,
    pub entity: Entity,
    /// Whether it has still to become that plant.
    pub is_altered: bool,
    /// The generation of the stand that it was given; 0 before.
    pub canopy_of: u64,
}

/// A tree that has come, or gone.
pub(super) enum NearEvent {
    Entered(NearTree),
    Left(NearTree),
}

impl NearCell {
    pub fn new(entity: Entity, planted: Vec<(StemId, Planted)>) -> Self {
        Self {
            entity,
            extent: Extent::of(planted.iter().map(|(_, plant)| plant)),
            is_drawn: planted.is_empty(),
            planted,
            spawned: Vec::new(),
            altered: Vec::new(),
            outdated: Vec::new(),
            is_outdated: false,
            is_articulated: false,
            canopies: None,
            canopy_task: None,
        }
    }

    /// Whether all of its trees have a stand of that generation or a newer one.
    pub fn has_canopies_since(&self, since: u64) -> bool {
        let is_new = |of: u64| of >= since;
        let has_own = self.canopies.as_ref().is_some_and(|(of, _)| is_new(*of));
        has_own && self.planted.is_empty() && self.spawned.iter().all(|tree| is_new(tree.canopy_of))
    }

    /// Gives its trees that lack it a stand of the generation `since` or a newer one, which `work_out` begins to work out. Returns whether
    /// all of its trees have it.
    pub fn give_canopies(
        &mut self,
        since: u64,
        work_out: impl FnOnce() -> (u64, CanopyTask),
        mut give: impl FnMut(Entity, Canopy),
    ) -> bool {
        if self.canopies.as_ref().is_none_or(|(of, _)| *of < since) {
            let task = self.canopy_task.take().filter(|(of, _)| *of >= since);
            let (generation, mut task) = task.unwrap_or_else(work_out);
            match block_on(poll_once(&mut task)) {
                Some(canopies) => {
                    let canopies = canopies.unwrap_or_else(|panic| {
                        error_once!(
                            "forest: {panic}; trees stand in the open where the wind among them cannot be worked out"
                        );
                        CellCanopies::open()
                    });
                    // Where nothing has changed, trees keep what they have been given.
                    if let Some((before, _)) = self.canopies.as_ref().filter(|(_, others)| *others == canopies) {
                        let same = self.spawned.iter_mut().filter(|tree| tree.canopy_of == *before);
                        same.for_each(|tree| tree.canopy_of = generation);
                    }
                    self.canopies = Some((generation, canopies));
                }
                None => {
                    self.canopy_task = Some((generation, task));
                    return false;
                }
            }
        }
        let Some((generation, canopies)) = &self.canopies else { return false };
        for tree in self.spawned.iter_mut().filter(|tree| tree.canopy_of != *generation) {
            tree.canopy_of = *generation;
            give(tree.entity, canopies.at(tree.plant.position));
        }
        self.planted.is_empty()
    }

    /// All of its trees.
    pub fn trees(&self) -> impl Iterator<Item = &NearTree> {
        self.spawned.iter().chain(&self.altered).chain(&self.outdated)
    }

    /// Takes the tree of a stem out.
    pub fn take(&mut self, id: StemId) -> Option<NearTree> {
        self.planted.retain(|(planted, _)| *planted != id);
        take_tree(&mut self.spawned, id).or_else(|| take_tree(&mut self.altered, id))
    }

    /// The same cell of another plan: trees of the same species that both have stay.
    pub fn planted_anew(mut self, planted: Vec<(StemId, Planted)>, species: &[Handle<Species>]) -> Self {
        let mut before = std::mem::take(&mut self.spawned);
        before.append(&mut self.altered);
        let mut cell = Self { outdated: std::mem::take(&mut self.outdated), ..Self::new(self.entity, planted) };
        cell.planted.retain(|(id, plant)| {
            let species = species[usize::from(plant.species)].id();
            let stands = |tree: &NearTree| tree.id == *id && tree.species == species;
            let Some(place) = before.iter().position(stands) else { return true };
            let tree = before.swap_remove(place);
            let is_altered = tree.is_altered || Planted { species: plant.species, ..tree.plant } != *plant;
            let trees = if is_altered { &mut cell.altered } else { &mut cell.spawned };
            trees.push(NearTree { plant: *plant, is_altered, ..tree });
            is_altered
        });
        cell.outdated.extend(before);
        cell.is_drawn = cell.planted.is_empty() && cell.outdated.is_empty();
        cell
    }
}

/// Takes the tree of a stem out of some.
pub(super) fn take_tree(trees: &mut Vec<NearTree>, id: StemId) -> Option<NearTree> {
    let place = trees.iter().position(|tree| tree.id == id)?;
    Some(trees.swap_remove(place))
}

/// What a plant is as an entity.
pub(super) fn tree(plant: &Planted, species: Handle<Species>) -> impl Bundle {
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
