//! A graphics device that is lost, as by an update of its driver, and another in its place: all is drawn again as it was. Needs a Vulkan
//! driver. Mesa's software one will do.

mod support;

use bevy::{
    prelude::*,
    render::{
        error_handler::{RenderErrorHandler, RenderErrorPolicy},
        render_resource::PollType,
        renderer::RenderDevice,
    },
};
use bevy_windwood::{LevelGround, prelude::*, terrain::TerrainChunks};
use image::RgbaImage;
use support::{capture, covered, forest::TestForest, update_until};

/// The renderer has another device than before.
#[derive(Resource)]
struct DeviceIsNew;

/// A forest with trees and impostors on drawn ground, with grass and a fire in front.
fn forest() -> TestForest {
    let settings = ForestSettings { trees_to_m: 80.0, far_to_m: 300.0, ..default() };
    let mut forest = TestForest::new(settings, None);
    let world = forest.app.world_mut();
    world.spawn((Terrain::new(LevelGround(0.0)), TerrainSettings { reach_m: 400.0, builds_at_once: 64, ..default() }));
    let sward = Sward { width_m: 4.0, depth_m: 4.0, ..default() };
    world.spawn((GrassPatch { sward, ..default() }, Transform::from_xyz(0.0, 9.0, -9.0)));
    world.spawn((Fire::default(), Transform::from_xyz(3.0, 11.0, -9.0)));
    forest
}

/// Whether all of it has its meshes, and these have their vertices.
fn is_drawn(world: &mut World) -> bool {
    let are_there = |world: &mut World, wanted: Vec<AssetId<Mesh>>| {
        let meshes = world.resource::<Assets<Mesh>>();
        !wanted.is_empty() && wanted.iter().all(|mesh| meshes.contains(*mesh))
    };
    let grass = world.query_filtered::<&Mesh3d, With<GrassPatch>>().iter(world).map(AssetId::from).collect();
    let fires = world.query_filtered::<&Mesh3d, With<Fire>>().iter(world).map(AssetId::from).collect();
    let is_ground_complete = world.query::<&TerrainChunks>().iter(world).all(TerrainChunks::is_complete);
    is_ground_complete && are_there(world, grass) && are_there(world, fires) && capture::forests_are_drawn(world)
}

fn drawn_picture(forest: &mut TestForest) -> RgbaImage {
    assert!(update_until(&mut forest.app, is_drawn), "not everything was drawn in time");
    forest.picture()
}

/// Share of the pixels that are another colour: the order in which trees are drawn may change a few by as much as 8 of 255.
fn difference(one: &RgbaImage, other: &RgbaImage) -> f32 {
    let apart = |a: &image::Rgba<u8>, b: &image::Rgba<u8>| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 8);
    let differs = one.pixels().zip(other.pixels()).filter(|(a, b)| apart(a, b)).count();
    differs as f32 / one.pixels().len() as f32
}

#[test]
fn everything_is_drawn_again_on_another_device() {
    let mut forest = forest();
    forest.app.insert_resource(RenderErrorHandler(|_, _, _| RenderErrorPolicy::Recover(default())));
    let before = drawn_picture(&mut forest);
    let tell = |mut commands: Commands| commands.insert_resource(DeviceIsNew);
    forest.app.add_systems(Last, tell.run_if(resource_changed::<RenderDevice>));
    capture::step(&mut forest.app);
    for time in 1..=2 {
        let world = forest.app.world_mut();
        world.remove_resource::<DeviceIsNew>();
        let device = world.resource::<RenderDevice>().wgpu_device();
        device.destroy();
        // It tells of its end only when it is asked.
        let _ = device.poll(PollType::Poll);
        let is_new = update_until(&mut forest.app, |world| world.contains_resource::<DeviceIsNew>());
        assert!(is_new, "there is no other device");
        let after = drawn_picture(&mut forest);
        let difference = difference(&before, &after);
        println!("{difference} of the picture is another on device {time}; {} is covered", covered(&after));
        assert!(covered(&before) > 0.5 && difference < 0.002, "{difference}");
    }
}
