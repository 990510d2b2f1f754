//! Lesson 7: a server and a client.
//!
//! A forest is never sent. Server and client have the same plan with the same seed, and so the same trees: same places, ages, individuals,
//! branches. They have the same `Wind`, and it is a function of place and time: once the client has set its `WindClock` to the server's time,
//! the same gust is at the same tree, and every branch is where it is on the server. It does not matter which way a player came, in which
//! order cells were planted, or how many threads there were.
//!
//! What a game changes is sent, and nothing else. Every stem has a `StemId` that is the same everywhere. `ForestEditor` fells, plants, ages and
//! makes others of them, and refuses what cannot be. All changes are in one component of the forest, `ForestChanges`, the difference to the
//! plan: some bytes for each. Any format of `serde` writes and reads it. It is a saved game, and it is what a client gets that joins.
//!
//! This lesson has no window and no renderer: `WindwoodMinimalPlugins` stand on three plugins of Bevy, and the crate may be built with
//! `default-features = false`. Two apps in one program are the two machines. The server's player stays where the trees are felled, the client's
//! comes from 400 m away. In the end both hash all that stands about them, trees and branches, and the bits are the same.

use bevy::{ecs::system::SystemState, prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{
    SettingError,
    forest::ForestCells,
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use std::{error::Error, time::Duration};

fn main() -> Result<(), Box<dyn Error>> {
    let mut server = machine(ForestChanges::default(), Vec3::ZERO);
    settle(&mut server);
    println!("server: {} trees stand about the player", trees(&mut server));

    change_the_wood(&mut server)?;
    settle(&mut server);
    let journal = ron::to_string(changes(&mut server))?;
    println!("server: {} trees after 3 were felled and 1 was planted", trees(&mut server));
    println!("sent to the client, {} bytes: {journal}", journal.len());

    let mut client = machine(ron::from_str(&journal)?, Vec3::new(400.0, 0.0, 0.0));
    settle(&mut client);
    move_the_player(&mut client, Vec3::ZERO);
    settle(&mut client);

    // The only other thing that is sent: what time it is in the wind.
    let time_s = 12_345.678;
    let hashes = [&mut server, &mut client].map(|machine| hash_at(machine, time_s));
    println!("server: {:#018x}\nclient: {:#018x}", hashes[0], hashes[1]);
    if hashes[0] == hashes[1] { Ok(()) } else { Err("server and client differ".into()) }
}

/// The same program runs on every machine.
fn machine(changes: ForestChanges, player: Vec3) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(16)))
        .insert_resource(Wind { speed: 11.0, seed: 7, ..default() });
    app.finish();
    app.cleanup();
    let stock = |species: &str| Stock { species: species.into(), age_years: 12.0, age_spread_years: 3.0, ..default() };
    let area = Area {
        shape: Shape::Rectangle { min_m: [-500.0; 2], max_m: [500.0; 2] },
        density_per_ha: 160.0,
        stock: vec![stock("birch"), stock("fir")],
        ..default()
    };
    let plan = ForestPlan { seed: 3, cell_m: 32.0, areas: vec![area], ..default() };
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan);
    // Branches near the player are entities, for whatever the server has to know of them.
    let settings = ForestSettings { trees_to_m: 30.0, far_to_m: 0.0, articulated_to_m: 200.0, ..default() };
    app.world_mut().spawn((Forest::new(plan), settings, changes));
    app.world_mut().spawn((Viewpoint, Transform::from_translation(player)));
    app
}

/// What the game does: three trees are felled, and a birch is planted.
fn change_the_wood(machine: &mut App) -> Result<(), SettingError> {
    let mut state = SystemState::<ForestEditor>::new(machine.world_mut());
    let Ok(mut editor) = state.get_mut(machine.world_mut()) else { return Ok(()) };
    let mut of = None;
    for place in [Vec2::ZERO, Vec2::new(18.0, 8.0), Vec2::new(-15.0, 12.0)] {
        let Some((forest, stem)) = editor.nearest(place, 30.0) else { continue };
        editor.fell(forest, stem.id)?;
        of = Some(forest);
    }
    let sapling = NewStem { place_m: Vec2::new(2.0, 1.0), species: "birch".into(), age_years: 4.0 };
    of.map_or(Ok(()), |forest| editor.plant(forest, &sapling).map(drop))
}

fn changes(machine: &mut App) -> &ForestChanges {
    let world = machine.world_mut();
    world.query::<&ForestChanges>().single(world).expect("one forest")
}

fn move_the_player(machine: &mut App, to: Vec3) {
    let world = machine.world_mut();
    for mut at in world.query_filtered::<&mut Transform, With<Viewpoint>>().iter_mut(world) {
        at.translation = to;
    }
}

/// Updates until everything stands that is wanted about the player, has its branches, and knows what shelters it.
fn settle(machine: &mut App) {
    let mut still_frames = 0;
    while still_frames < 100 {
        machine.update();
        std::thread::sleep(Duration::from_millis(1));
        let world = machine.world_mut();
        let stands = world.query::<&ForestCells>().iter(world).all(|it| it.is_complete() && it.is_up_to_date());
        let mut growing = world.query_filtered::<(), (With<StemId>, Or<(Without<TreeBeams>, Without<InCanopy>)>)>();
        let is_still = stands && growing.iter(world).count() == 0 && world.resource::<ActiveSway>().is_settled();
        still_frames = if is_still { still_frames + 1 } else { 0 };
    }
}

fn trees(machine: &mut App) -> usize {
    let world = machine.world_mut();
    world.query_filtered::<(), With<StemId>>().iter(world).count()
}

/// FNV-1a of the places of all standing trees and of their branches, at a time of the wind.
fn hash_at(machine: &mut App, time_s: f64) -> u64 {
    machine.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    *machine.world_mut().resource_mut::<WindClock>() = WindClock { time_s, previous_s: time_s };
    machine.update();
    let world = machine.world_mut();
    let mut standing: Vec<(StemId, Entity)> =
        world.query::<(&StemId, Entity)>().iter(world).map(|(id, tree)| (*id, tree)).collect();
    standing.sort_unstable();
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |at: &Transform| {
        for value in at.translation.to_array().into_iter().chain(at.rotation.to_array()) {
            hash = (hash ^ u64::from(value.to_bits())).wrapping_mul(0x0100_0000_01b3);
        }
    };
    for (_, tree) in standing {
        world.get::<Transform>(tree).into_iter().for_each(&mut add);
        let beams = world.get::<TreeBeams>(tree).into_iter().flat_map(TreeBeams::iter);
        beams.filter_map(|beam| world.get::<Transform>(beam)).for_each(&mut add);
    }
    hash
}
