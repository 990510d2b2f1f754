//! A near cell: which of its trees stand, which are still to come, and which are of the plan before.

use super::extent::Extent;
use crate::{
    scatter::Planted,
    tree::{Species, Tree},
};
use bevy::prelude::*;

/// A cell whose plants are entities.
pub(super) struct NearCell {
    pub entity: Entity,
    /// What is still to be spawned.
    pub planted: Vec<Planted>,
    pub spawned: Vec<NearTree>,
    /// Trees of the plan before, which go when all of this one are drawn.
    pub outdated: Vec<Entity>,
    /// Whether it is of the plan before.
    pub is_outdated: bool,
    /// Whether all of its trees are drawn.
    pub is_drawn: bool,
    pub extent: Extent,
    pub is_articulated: bool,
}

/// A tree of a near cell, and the plant that it is.
pub(super) struct NearTree {
    pub plant: Planted,
    pub species: AssetId<Species>,
    pub entity: Entity,
}

impl NearCell {
    pub fn new(entity: Entity, planted: Vec<Planted>) -> Self {
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
    pub fn planted_anew(mut self, planted: Vec<Planted>, species: &[Handle<Species>]) -> Self {
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
