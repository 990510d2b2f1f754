//! The drawn ground has no holes and no cracks. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::{math::DVec2, prelude::*};
use bevy_windwood::{
    prelude::*,
    terrain::{CovarianceModel, TerrainChunks, TurningBands, TurningBandsSettings},
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::time::Duration;
use support::capture;

const SIZE: (u32, u32) = (240, 160);

/// Colour of the background.
const BACKGROUND: Color = Color::srgb(1.0, 0.0, 1.0);

fn rough_ground() -> TurningBands {
    let settings = TurningBandsSettings {
        model: CovarianceModel::Exponential,
        scale_m: 150.0,
        deviation_m: 40.0,
        finest_wavelength_m: 6.0,
        seed: 2,
        ..default()
    };
    TurningBands::new(&settings).expect("valid")
}

#[test]
fn ground_hides_the_background_from_any_place() {
    let ground = rough_ground();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
    let mut app = support::headless_app(Duration::ZERO, None);
    capture::begin(&mut app).expect("a graphics device");
    let target = capture::target(&mut app, SIZE);
    let world = app.world_mut();
    world.insert_resource(ClearColor(BACKGROUND));
    world.insert_resource(GlobalAmbientLight { brightness: 3000.0, ..default() });
    let settings = TerrainSettings { reach_m: 3000.0, builds_at_once: 64, chunks_per_frame: 64, ..default() };
    world.spawn((Terrain::new(rough_ground()), settings));
    let camera = world.spawn((capture::camera(&target), Transform::default())).id();

    let mut seen = 0;
    for view in 0..8 {
        let place = DVec2::new(random.random_range(-800.0..800.0), random.random_range(-800.0..800.0));
        let eye =
            Vec3::new(place.x as f32, ground.height_m(place) as f32 + random.random_range(3.0..60.0), place.y as f32);
        // Far enough down that no horizon is in the picture.
        let (yaw, pitch) = (random.random_range(0.0..std::f32::consts::TAU), random.random_range(-1.5..-0.9));
        let turned = Quat::from_euler(EulerRot::YXZ, yaw, pitch, 0.0);
        *app.world_mut().get_mut::<Transform>(camera).expect("the camera") =
            Transform::from_translation(eye).with_rotation(turned);
        // Also before everything is built: coarse ground must have no holes either.
        let complete = |app: &mut App| {
            let world = app.world_mut();
            world.query::<&TerrainChunks>().iter(world).all(TerrainChunks::is_complete)
        };
        let settle = view % 2 == 0 || view < 2;
        for _ in 0..if settle { 600 } else { 3 } {
            capture::step(&mut app);
            if settle && complete(&mut app) {
                break;
            }
        }
        assert!(!settle || complete(&mut app));
        let picture = capture::capture(&mut app, &target, SIZE).expect("a picture");
        let through = picture.pixels().filter(|pixel| support::is_background(pixel)).count();
        assert_eq!(through, 0, "view {view} from {eye}, yaw {yaw}, pitch {pitch}");
        seen += picture.pixels().filter(|pixel| pixel.0[1] > 20).count();
    }
    assert!(seen > 8 * 30_000, "the ground is lit: {seen} pixels");
}
