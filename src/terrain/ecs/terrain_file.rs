//! Raises terrains from files.

use crate::terrain::{
    components::{Terrain, TerrainFile},
    elevation_map::ElevationMap,
};
use bevy::prelude::*;

/// Gives entities the [`Terrain`] of their [`TerrainFile`], as soon as it is loaded and whenever it is loaded anew. Woods that the terrain
/// had before stay.
pub(in crate::terrain) fn raise_terrains_from_files(
    mut commands: Commands,
    mut events: MessageReader<AssetEvent<ElevationMap>>,
    maps: Res<Assets<ElevationMap>>,
    files: Query<(Entity, Ref<TerrainFile>, Option<&Terrain>)>,
) {
    let loaded: Vec<AssetId<ElevationMap>> = events
        .read()
        .filter_map(|event| match event {
            AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(*id),
            _ => None,
        })
        .collect();
    for (entity, file, before) in &files {
        if !file.is_changed() && !loaded.contains(&file.0.id()) {
            continue;
        }
        if let Some(map) = maps.get(&file.0) {
            let cover = before.and_then(|before| before.cover.clone());
            commands.entity(entity).insert(Terrain { cover, ..Terrain::new(map.clone()) });
        }
    }
}
