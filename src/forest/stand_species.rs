//! Makes the stand of each forest ready once its species are known: of each one mature tree is grown in the background and measured.

use super::{
    cells::ForestCells,
    stand::{Stand, StandSpecies},
};
use crate::{
    background::{Work, spawn_work},
    tree::{
        LeafSeason, Season, Species, frontal_area_m2, growth::age::Age, individual::grow, no_longer_used,
        skeleton::Skeleton, tree_pieces,
    },
};
use bevy::{
    asset::LoadState,
    platform::collections::HashMap,
    prelude::*,
    tasks::{block_on, poll_once},
};

/// Seed of the tree that is measured.
const SEED: u64 = 1;

/// The species that have been measured.
#[derive(Resource, Default)]
pub(super) struct StandSpeciesLibrary {
    known: HashMap<AssetId<Species>, StandSpecies>,
    measuring: Vec<(AssetId<Species>, Work<StandSpecies>)>,
}

fn measure(species: &Species) -> StandSpecies {
    let tree = grow(species, species.age.mature_years, SEED);
    StandSpecies {
        age: species.age,
        height_m: tree.height_m(),
        frontal_area_m2: frontal_area_m2(&tree),
        bare_share: bare_share(species, &tree),
        leaves: LeafSeason::of(&species.phenology),
        leaf_share: 1.0,
    }
}

/// The share of a tree's drag that is its wood's.
fn bare_share(species: &Species, tree: &Skeleton) -> f32 {
    let [wood, all] = tree_pieces(species, tree).fold([0.0; 2], |[wood, all], piece| {
        [wood + if piece.is_leaf { 0.0 } else { piece.drag_kg_m }, all + piece.drag_kg_m]
    });
    if all > 0.0 { (wood / all) as f32 } else { 1.0 }
}

impl StandSpeciesLibrary {
    /// Has a species measured, in place of what was known of it.
    fn measure(&mut self, id: AssetId<Species>, species: &Species) {
        let species = species.clone();
        self.measuring.retain(|(other, _)| *other != id);
        self.measuring.push((id, spawn_work(move || measure(&species))));
    }

    fn is_asked_for(&self, id: AssetId<Species>) -> bool {
        self.known.contains_key(&id) || self.measuring.iter().any(|(other, _)| *other == id)
    }
}

/// Measures the species of forests, and gives each forest its stand when each of them is known, cannot be loaded or is not valid.
pub(super) fn prepare_stands(
    mut library: ResMut<StandSpeciesLibrary>,
    mut events: MessageReader<AssetEvent<Species>>,
    species: Res<Assets<Species>>,
    assets: Res<AssetServer>,
    season: Res<Season>,
    mut forests: Query<&mut ForestCells>,
) {
    let valid = |id: AssetId<Species>| species.get(id).filter(|species| species.validate().is_ok());
    for event in events.read() {
        if let Some(id) = no_longer_used(event) {
            library.known.remove(&id);
            library.measuring.retain(|(other, _)| *other != id);
        }
        if let AssetEvent::Modified { id } = event
            && library.is_asked_for(*id)
            && let Some(species) = valid(*id)
        {
            library.measure(*id, species);
        }
    }
    // One that was not valid, or could not be loaded, may be so now.
    let may_be_new = species.is_changed();
    for handle in forests.iter().filter(|it| may_be_new || it.stand.get().is_none()).flat_map(ForestCells::species) {
        if !library.is_asked_for(handle.id())
            && let Some(species) = valid(handle.id())
        {
            library.measure(handle.id(), species);
        }
    }
    let StandSpeciesLibrary { known, measuring } = &mut *library;
    let mut measured: Vec<AssetId<Species>> = Vec::new();
    measuring.retain_mut(|(id, task)| {
        let Some(found) = block_on(poll_once(task)) else { return true };
        let found = found.unwrap_or_else(|panic| {
            error!("species {id}: {panic}; its trees give no shelter from the wind");
            StandSpecies {
                age: Age::default(),
                height_m: 0.0,
                frontal_area_m2: 0.0,
                bare_share: 1.0,
                leaves: LeafSeason::EVERGREEN,
                leaf_share: 1.0,
            }
        });
        if known.insert(*id, found) != Some(found) {
            measured.push(*id);
        }
        false
    });
    for mut forest in &mut forests {
        let has_other = forest.species().iter().any(|species| measured.contains(&species.id()));
        if forest.stand.get().is_some() && !has_other {
            continue;
        }
        let is_settled = |handle: &Handle<Species>| {
            known.contains_key(&handle.id())
                || matches!(assets.get_load_state(handle), Some(LoadState::Failed(_)))
                || species.contains(handle) && valid(handle.id()).is_none()
        };
        if forest.species().iter().all(is_settled) {
            let now = |handle: &Handle<Species>| known.get(&handle.id()).map(|known| known.in_season(season.wrapped()));
            let species = forest.species().iter().map(now).collect();
            let (planter, ground) = forest.planting();
            let is_changed = forest.changes.as_ref().is_some_and(|changes| !changes.is_empty());
            forest.stand.begin(Stand { planter, ground, species, balances: default() }, is_changed);
        }
    }
}
