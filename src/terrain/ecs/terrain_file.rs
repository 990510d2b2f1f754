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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Ground,
        terrain::{ElevationMapSettings, ElevationSettings, TerrainPlugin},
    };
    use bevy::math::DVec2;
    use std::time::Duration;

    fn app() -> App {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets");
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, AssetPlugin { file_path: folder.to_owned(), ..default() }, TerrainPlugin));
        app
    }

    /// An entity whose terrain comes from the shipped map, with cells of 233 m where they are told.
    fn spawn(app: &mut App, cell_x_m: Option<f64>) -> (Entity, Handle<ElevationMap>) {
        let settings = move |settings: &mut ElevationMapSettings| {
            settings.elevation = ElevationSettings { cell_x_m, ..default() };
            settings.is_centred = true;
        };
        let assets = app.world().resource::<AssetServer>();
        let map: Handle<ElevationMap> =
            assets.load_builder().with_settings(settings).load("terrain/rmnp-dem-16bit.png");
        (app.world_mut().spawn(TerrainFile(map.clone())).id(), map)
    }

    fn wait(app: &mut App, is_so: impl Fn(&World) -> bool) {
        for _ in 0..4000 {
            app.update();
            if is_so(app.world()) {
                return;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        panic!("it did not come about within 20 s");
    }

    #[test]
    fn a_file_becomes_the_terrain_of_its_entity() {
        let mut app = app();
        let (entity, _) = spawn(&mut app, Some(233.0));
        wait(&mut app, |world| world.get::<Terrain>(entity).is_some());
        let terrain = app.world().get::<Terrain>(entity).unwrap();
        // The middle of 152 x 187 samples, between two columns.
        let height_m = terrain.ground.height_m(DVec2::ZERO);
        assert!((2281.0..4261.0).contains(&height_m), "{height_m}");
        assert_ne!(height_m, terrain.ground.height_m(DVec2::new(0.0, 233.0)));
    }

    #[test]
    fn a_file_that_leaves_its_cells_open_fails_to_load() {
        let mut app = app();
        let (entity, map) = spawn(&mut app, None);
        wait(&mut app, |world| world.resource::<AssetServer>().load_state(&map).is_failed());
        assert!(app.world().get::<Terrain>(entity).is_none());
    }
}
