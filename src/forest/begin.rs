//! Begins forests from their plans.

use super::{
    cells::ForestCells,
    components::{Forest, ForestGround, ForestSettings},
    cover::StandingGround,
};
use crate::{
    ground::{Ground, LevelGround},
    scatter::{ForestPlan, Planter},
    setting::valid_or_last,
    terrain::{Terrain, TerrainSettings},
};
use bevy::prelude::*;
use std::sync::Arc;

/// Begins anew with forests that are new, whose plan has been loaded or changed, or whose ground is another.
pub(super) fn begin_forests(
    mut commands: Commands,
    plans: Res<Assets<ForestPlan>>,
    assets: Res<AssetServer>,
    mut events: MessageReader<AssetEvent<ForestPlan>>,
    mut forests: Query<(Entity, Ref<Forest>, Ref<ForestSettings>, Option<Ref<ForestGround>>, Option<&mut ForestCells>)>,
    terrains: Query<(Ref<Terrain>, Ref<TerrainSettings>)>,
) {
    let changed: Vec<(AssetId<ForestPlan>, bool)> = events
        .read()
        .filter_map(|event| match event {
            AssetEvent::Added { id } => Some((*id, true)),
            AssetEvent::Modified { id } => Some((*id, false)),
            _ => None,
        })
        .collect();
    let terrain = terrains.iter().next();
    // Stems stand on the drawn ground, whose cells the settings give.
    let other_terrain =
        terrain.as_ref().is_some_and(|(terrain, settings)| terrain.is_changed() || settings.is_changed());
    for (entity, forest, wanted, own_ground, before) in &mut forests {
        let other_ground = own_ground.as_ref().map_or(other_terrain, Ref::is_changed);
        // A plan that is made in code is there before its event comes: the forest has just begun with it.
        let has_just_begun = before.as_ref().is_some_and(Mut::is_added);
        let has_other_plan =
            changed.iter().any(|(plan, is_new)| *plan == forest.plan.id() && !(*is_new && has_just_begun));
        let due = forest.is_changed() || wanted.is_changed() || other_ground || has_other_plan;
        let Some(plan) = plans.get(&forest.plan).filter(|_| due) else { continue };
        let planter = match Planter::new(plan) {
            Ok(planter) => planter,
            Err(error) => {
                warn!("forest: {error}; the last good one stays");
                continue;
            }
        };
        let last = before.as_ref().map(|before| before.settings());
        let settings = valid_or_last("forest settings", &*wanted, ForestSettings::validate, last);
        let ground: Arc<dyn Ground> = match (own_ground, &terrain) {
            (Some(own), _) => own.0.clone(),
            (None, Some((terrain, settings))) => {
                Arc::new(StandingGround::new(terrain.ground.clone(), settings.finest_cell_m))
            }
            (None, None) => Arc::new(LevelGround::default()),
        };
        let path = |name: &String| assets.load(format!("{}/{name}.species.ron", settings.species_folder));
        let species = planter.species().iter().map(path).collect();
        let generation = before.as_ref().map_or(0, |before| before.generation() + 1);
        match ForestCells::new(planter, ground, species, settings, generation) {
            Ok(mut cells) => {
                let of_no_use = before.map(|mut before| cells.take_over(&mut before));
                of_no_use.into_iter().flatten().for_each(|cell| commands.entity(cell).despawn());
                commands.entity(entity).insert(cells);
            }
            Err(error) => warn!("forest: {error}; the last good one stays"),
        }
    }
}
