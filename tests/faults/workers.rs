//! Work in the background that panics. It reads the ground, which is a game's own.

use super::{
    birches, edit, places,
    server::{server_app, shipped_assets},
    settle, spawn_forest, wait,
};
use bevy::{math::DVec2, prelude::*};
use bevy_windwood::{forest::ForestCells, grass::Meadow, prelude::*};
use std::{sync::Arc, time::Duration};

/// Level ground that nobody may ask for beyond 60 m to the east.
fn ground_with_an_end(at: DVec2) -> f64 {
    assert!(at.x <= 60.0, "the level ends here");
    0.0
}

#[test]
fn where_ground_panics_nothing_grows_and_the_forest_goes_on() {
    let mut app = server_app(&shipped_assets(), Duration::ZERO);
    app.world_mut().spawn(Viewpoint);
    let forest = spawn_forest(&mut app, birches(600.0, 100.0), [140.0, 280.0]);
    app.world_mut().entity_mut(forest).insert(ForestGround(Arc::new(ground_with_an_end)));
    settle(&mut app, forest);
    let west = places(&mut app);
    // A tile of 128 m lies on both sides of the end: none of its trees stands.
    assert!(west.len() > 200 && west.iter().all(|at| at.x <= 0.0), "{} trees", west.len());
    let store = |app: &App| app.world().get::<ForestCells>(forest).expect("it has begun").store().plants();
    assert!(store(&app) >= west.len());

    // It can be changed as any other.
    edit(&mut app, |editor| {
        let (forest, stem) = editor.nearest(Vec2::new(-30.0, 0.0), 30.0).expect("a tree");
        editor.fell(forest, stem.id).expect("it stands");
    });
    settle(&mut app, forest);
    assert_eq!(places(&mut app).len(), west.len() - 1);

    app.world_mut().entity_mut(forest).insert(ForestGround(Arc::new(|_: DVec2| 0.0)));
    settle(&mut app, forest);
    let all = places(&mut app);
    assert!(all.iter().any(|at| at.x > 60.0) && all.len() > 3 * west.len() / 2, "{} trees", all.len());
}

#[test]
fn ground_that_breaks_while_the_forest_stands_leaves_what_is_near_standing_until_it_is_mended() {
    let mut app = server_app(&shipped_assets(), Duration::ZERO);
    let viewer = app.world_mut().spawn(Viewpoint).id();
    let forest = spawn_forest(&mut app, birches(2000.0, 100.0), [60.0, 100.0]);
    app.world_mut().entity_mut(forest).insert(ForestGround(Arc::new(ground_with_an_end)));
    *app.world_mut().get_mut::<Transform>(viewer).expect("a viewer") = Transform::from_xyz(-400.0, 0.0, 0.0);
    settle(&mut app, forest);
    let here = places(&mut app).len();
    assert!(here > 50, "{here} trees");
    // Into the part that panics, and back.
    for x in [400.0, -400.0] {
        *app.world_mut().get_mut::<Transform>(viewer).expect("a viewer") = Transform::from_xyz(x, 0.0, 0.0);
        settle(&mut app, forest);
        (0..200).for_each(|_| app.update());
    }
    assert_eq!(places(&mut app).len(), here);
}

#[test]
fn grass_on_ground_that_panics_stays_as_it_was() {
    let mut app = server_app(&shipped_assets(), Duration::ZERO);
    let sward = Sward { width_m: 2.0, depth_m: 2.0, ..default() };
    let patch = app.world_mut().spawn(GrassPatch { sward, ..default() }).id();
    let blades = |world: &World| world.get::<Meadow>(patch).map(|meadow| meadow.blades.clone());
    wait(&mut app, "the meadow", |world| blades(world).is_some());
    let before = blades(app.world()).expect("a meadow");
    let broken = GrassGround(Arc::new(|_: DVec2| -> f64 { panic!("no ground at all") }));
    app.world_mut().entity_mut(patch).insert(broken);
    for _ in 0..100 {
        app.update();
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(Arc::ptr_eq(&before, &blades(app.world()).expect("a meadow")));
    app.world_mut().entity_mut(patch).insert(GrassGround(Arc::new(|at: DVec2| 0.1 * at.x)));
    wait(&mut app, "the meadow on another ground", |world| {
        blades(world).is_some_and(|blades| !Arc::ptr_eq(&before, &blades))
    });
}
