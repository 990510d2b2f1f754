//! The plugins as a game uses them, without rendering. The tests set the clock.

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{prelude::*, tree::SpeciesModels, tree::TreeModel};
use server::{server_app, shipped_assets};
use std::time::Duration;

#[path = "ecs/live.rs"]
mod live;
#[path = "support/server.rs"]
mod server;
#[path = "ecs/wind_changes.rs"]
mod wind_changes;

const FRAME_S: f32 = 1.0 / 30.0;

fn frame() -> Duration {
    Duration::from_secs_f32(FRAME_S)
}

fn app() -> App {
    server_app(&shipped_assets(), frame())
}

/// Lets background work finish, with the clock standing still, until `done`.
fn wait_until(app: &mut App, what: &str, done: impl Fn(&mut World) -> bool) {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    for _ in 0..6000 {
        app.update();
        if done(app.world_mut()) {
            app.insert_resource(TimeUpdateStrategy::ManualDuration(frame()));
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("{what} did not come about within 30 s");
}

fn wait_for_wind(app: &mut App) {
    wait_until(app, "the wind", |world| world.resource::<ActiveSway>().is_ready());
}

fn wait_for_trees(app: &mut App) {
    wait_until(app, "the trees", |world| {
        let without_model = world.query_filtered::<(), (With<Tree>, Without<Grown>)>().iter(world).count();
        without_model == 0 && !world.resource::<SpeciesModels>().is_baking()
    });
}

fn plant(app: &mut App, species: &str, at: Vec3) -> Entity {
    let species = app.world().resource::<AssetServer>().load(format!("species/{species}.species.ron"));
    app.world_mut().spawn((Tree::new(species), Transform::from_translation(at))).id()
}

fn only_the_trunk() -> Articulated {
    Articulated { deepest_order: 0, leaves: false }
}

fn beam_places(app: &mut App) -> Vec<Vec3> {
    let world = app.world_mut();
    world.query::<(&Beam, &Transform)>().iter(world).map(|(_, transform)| transform.translation).collect()
}

/// The highest of the beams' tips.
fn stem_tip(app: &mut App) -> Vec3 {
    let places = beam_places(app).into_iter();
    places.max_by(|a, b| a.y.total_cmp(&b.y)).expect("the tree has beams")
}

#[test]
fn wind_cells_get_the_wind_at_their_place() {
    let mut app = app();
    let place = Vec3::new(30.0, 112.0, -7.0);
    let cell = app.world_mut().spawn((WindCell::above(100.0), Transform::from_translation(place))).id();
    let ground = app.world_mut().spawn((WindCell::above(112.0), Transform::from_translation(place))).id();
    wait_for_wind(&mut app);
    app.update();
    app.update();
    let clock = *app.world().resource::<WindClock>();
    let wind = app.world().resource::<ActiveWind>().sample(Vec3::new(30.0, 12.0, -7.0), clock.time_s);
    let sampled = app.world().get::<WindCell>(cell).expect("the cell is there").velocity;
    assert_eq!(sampled, wind);
    assert!(sampled.length() > 1.0, "8 m/s were asked for, not {sampled}");
    let at_ground = app.world().get::<WindCell>(ground).expect("the cell is there").velocity;
    assert!(at_ground.length() < sampled.length(), "the wind is weaker at the ground");
}

#[test]
fn beams_of_an_articulated_tree_move_and_stay_near_it() {
    let mut app = app();
    let tree = plant(&mut app, "fir", Vec3::new(5.0, 2.0, 1.0));
    app.world_mut().entity_mut(tree).insert(Articulated::default());
    wait_for_wind(&mut app);
    wait_for_trees(&mut app);
    app.update();
    let model = app.world().get::<Grown>(tree).expect("it has grown").model.clone();
    let model = app.world().resource::<Assets<TreeModel>>().get(&model).expect("the model is there").clone();
    let world = app.world_mut();
    assert_eq!(world.query::<&Beam>().iter(world).count(), model.beams.len());
    assert_eq!(world.query::<&Leaf>().iter(world).count(), model.skeleton.clusters.len());
    let before = beam_places(&mut app);
    (0..15).for_each(|_| app.update());
    let after = beam_places(&mut app);
    let moved = before.iter().zip(&after).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(moved > 0.01, "the wind moves the beams, by {moved} m");
    let reach = model.height_m() * 1.5;
    assert!(after.iter().all(|at| at.is_finite() && at.distance(Vec3::new(5.0, 2.0, 1.0)) < reach));
}

#[test]
fn a_beam_entity_is_at_its_place_along_the_beam() {
    let mut app = app();
    let tree = plant(&mut app, "fir", Vec3::ZERO);
    app.world_mut().entity_mut(tree).insert(only_the_trunk());
    wait_for_wind(&mut app);
    wait_for_trees(&mut app);
    app.update();
    let world = app.world_mut();
    for mut beam in world.query::<&mut Beam>().iter_mut(world) {
        beam.at = 0.0;
    }
    app.update();
    let places = beam_places(&mut app);
    assert!(places[0].length() < 1e-4, "the root of the trunk stands still, at {}", places[0]);
}

#[test]
fn despawning_a_tree_despawns_its_beams_and_leaves() {
    let mut app = app();
    let tree = plant(&mut app, "oak", Vec3::ZERO);
    app.world_mut().entity_mut(tree).insert(Articulated::default());
    wait_for_trees(&mut app);
    app.update();
    let world = app.world_mut();
    assert!(world.query::<&Leaf>().iter(world).count() > 100);
    world.despawn(tree);
    app.update();
    let world = app.world_mut();
    assert_eq!(world.query_filtered::<(), Or<(With<Beam>, With<Leaf>)>>().iter(world).count(), 0);
}

#[test]
fn removing_articulated_despawns_the_beams() {
    let mut app = app();
    let tree = plant(&mut app, "oak", Vec3::ZERO);
    app.world_mut().entity_mut(tree).insert(only_the_trunk());
    wait_for_trees(&mut app);
    app.update();
    app.world_mut().entity_mut(tree).remove::<Articulated>();
    app.update();
    app.update();
    assert!(beam_places(&mut app).is_empty());
    assert!(app.world().get::<Tree>(tree).is_some());
}

#[test]
fn a_new_wind_fades_in_without_a_jump() {
    let mut app = app();
    let tree = plant(&mut app, "fir", Vec3::ZERO);
    app.world_mut().entity_mut(tree).insert(only_the_trunk());
    wait_for_wind(&mut app);
    wait_for_trees(&mut app);
    (0..5).for_each(|_| app.update());
    app.world_mut().resource_mut::<Wind>().speed = 16.0;
    app.world_mut().resource_mut::<Wind>().seed = 99;
    // Builds run in the background while the clock stands; the fade begins when they are done.
    let at_change = stem_tip(&mut app);
    wait_until(&mut app, "the new tables", |world| world.resource::<ActiveSway>().now().count() == 2);
    let at_begin = stem_tip(&mut app);
    assert!(at_change.distance(at_begin) < 1e-5, "nothing has moved while the clock stood");
    let longest_step = |app: &mut App, frames: usize| {
        let mut last = stem_tip(app);
        let mut longest = 0.0_f32;
        for _ in 0..frames {
            app.update();
            let now = stem_tip(app);
            longest = longest.max(now.distance(last));
            last = now;
        }
        longest
    };
    // The fade takes 3 s; after it half a minute of the new wind shows how far a frame moves the tree by itself.
    let fading = longest_step(&mut app, 100);
    assert!(app.world().resource::<ActiveSway>().is_settled());
    let settled = longest_step(&mut app, 900);
    assert!(settled > 0.01, "the new wind moves the tree, by {settled} m a frame");
    assert!(fading < 1.2 * settled, "a frame of the fade moves it by {fading} m, a frame of the wind by {settled} m");
}

#[test]
fn poses_are_the_same_bits_in_two_apps() {
    let run = || {
        let mut app = app();
        for (index, species) in ["oak", "fir", "oak"].into_iter().enumerate() {
            let tree = plant(&mut app, species, Vec3::new(17.0 * index as f32, 0.0, 3.0));
            app.world_mut().entity_mut(tree).insert(Articulated { deepest_order: 1, leaves: true });
        }
        wait_for_wind(&mut app);
        wait_for_trees(&mut app);
        app.world_mut().resource_mut::<WindClock>().time_s = 12.5;
        (0..10).for_each(|_| app.update());
        let world = app.world_mut();
        let mut bits: Vec<_> = world
            .query::<(&Transform, AnyOf<(&Beam, &Leaf)>)>()
            .iter(world)
            .map(|(transform, _)| transform.to_matrix().to_cols_array().map(f32::to_bits))
            .collect();
        bits.sort_unstable();
        bits
    };
    let (first, second) = (run(), run());
    assert!(first.len() > 1000);
    assert!(first == second);
}

#[test]
fn spawning_and_despawning_trees_leaks_nothing() {
    let mut app = app();
    let mut entities = None;
    for _ in 0..10 {
        for index in 0..1000 {
            let species = if index % 2 == 0 { "oak" } else { "fir" };
            plant(&mut app, species, Vec3::new((index % 40) as f32 * 6.0, 0.0, (index / 40) as f32 * 6.0));
        }
        wait_for_trees(&mut app);
        let world = app.world_mut();
        let trees: Vec<Entity> = world.query_filtered::<Entity, With<Tree>>().iter(world).collect();
        assert_eq!(trees.len(), 1000);
        trees.into_iter().for_each(|tree| assert!(world.despawn(tree)));
        (0..4).for_each(|_| app.update());
        assert!(app.world().resource::<SpeciesModels>().is_empty(), "a species that nobody grows is dropped");
        assert_eq!(app.world().resource::<Assets<TreeModel>>().len(), 0);
        let count = app.world().entities().count_spawned();
        assert_eq!(*entities.get_or_insert(count), count);
    }
}

#[test]
fn a_changed_species_file_is_baked_again_and_a_broken_one_is_ignored() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    std::fs::create_dir(folder.path().join("species")).expect("it can be made");
    let file = folder.path().join("species/oak.species.ron");
    let good = std::fs::read_to_string(shipped_assets().join("species/oak.species.ron")).expect("the oak is shipped");
    std::fs::write(&file, &good).expect("written");
    let mut app = server_app(folder.path(), frame());
    let tree = plant(&mut app, "oak", Vec3::ZERO);
    wait_for_trees(&mut app);
    let first = app.world().get::<Grown>(tree).expect("grown").model.clone();
    let height = |app: &App, model: &Handle<TreeModel>| {
        app.world().resource::<Assets<TreeModel>>().get(model).expect("the model is there").height_m()
    };
    let first_height_m = height(&app, &first);

    std::fs::write(&file, good.replacen("name: \"oak\"", "name: 7", 1)).expect("written");
    app.world().resource::<AssetServer>().reload("species/oak.species.ron");
    for _ in 0..40 {
        app.update();
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(app.world().get::<Grown>(tree).expect("still grown").model, first);

    let shorter = good.replacen("variants: 4", "variants: 1", 1);
    assert_ne!(shorter, good);
    std::fs::write(&file, shorter).expect("written");
    app.world().resource::<AssetServer>().reload("species/oak.species.ron");
    wait_until(&mut app, "the new oak", |world| {
        let model = world.query::<&Grown>().iter(world).next().map(|grown| grown.model.clone());
        model.is_some_and(|model| model != first)
    });
    let second = app.world().get::<Grown>(tree).expect("grown").model.clone();
    assert!(height(&app, &second) > 0.5 * first_height_m);
    assert_eq!(app.world().get::<Grown>(tree).expect("grown").variant, 0);
}

#[test]
fn winds_out_of_range_are_clamped_or_refused() {
    let mut app = app();
    wait_for_wind(&mut app);
    let speed = |app: &App| app.world().resource::<ActiveWind>().newest().expect("a field").settings().speed;
    let good = speed(&app);
    app.world_mut().resource_mut::<Wind>().speed = f32::NAN;
    for _ in 0..40 {
        app.update();
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(speed(&app), good, "the last good wind stays in force");
    app.world_mut().resource_mut::<Wind>().speed = 300.0;
    wait_until(&mut app, "a wind at the limit", |world| wind_changes::blows_at(world, 75.0));
    for _ in 0..200 {
        app.update();
    }
    let wind = app.world().resource::<ActiveWind>().sample(Vec3::new(1.0, 10.0, 2.0), 7.0);
    assert!(wind.is_finite() && wind.length() > 20.0);
}

#[test]
fn an_unknown_species_gives_no_model() {
    let mut app = app();
    plant(&mut app, "there_is_no_such_tree", Vec3::ZERO);
    wait_for_wind(&mut app);
    (0..20).for_each(|_| app.update());
    let world = app.world_mut();
    assert_eq!(world.query::<&Grown>().iter(world).count(), 0);
}
