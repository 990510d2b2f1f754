//! Sky, sun and haze of a clear afternoon.

use super::sky::{self, SkyLight};
use bevy::{
    light::CascadeShadowConfigBuilder,
    pbr::{DistanceFog, FogFalloff},
    prelude::*,
};

/// Direction to the sun in the middle of the afternoon.
pub const SUN: Vec3 = Vec3::new(0.55, 0.62, 0.25);
const HAZE: Color = Color::srgb(0.69, 0.78, 0.88);
const ZENITH: Vec3 = Vec3::new(0.13, 0.32, 0.78);
const HORIZON: Vec3 = Vec3::new(0.75, 0.90, 1.05);
/// The light of that sky, and of grass in the sun below it.
const SKY_LIGHT: SkyLight = SkyLight {
    zenith: Vec3::new(0.62, 0.80, 1.10),
    horizon: Vec3::new(0.52, 0.58, 0.60),
    ground: Vec3::new(0.20, 0.22, 0.10),
    brightness: 1050.0,
};

/// Fog that grows with the square of the distance: clear near by, blue on far ridges. At `distance_m` it takes two thirds.
pub fn haze(distance_m: f32) -> DistanceFog {
    DistanceFog {
        color: HAZE,
        directional_light_color: Color::srgba(1.0, 0.9, 0.7, 0.25),
        directional_light_exponent: 12.0,
        falloff: FogFalloff::ExponentialSquared { density: 1.0 / distance_m },
    }
}

/// Spawns the sky's dome about a place, the sky's light, and the sun with its shadows.
pub fn spawn_daylight(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    (centre, radius_m): (Vec3, f32),
    (first_cascade_m, shadows_to_m): (f32, f32),
) {
    let dome = sky::dome(radius_m, [48, 24], sky_colour);
    commands.spawn((sky::bundle(dome, meshes, materials), Transform::from_translation(centre)));
    commands.spawn((
        DirectionalLight {
            illuminance: 13_500.0,
            color: Color::srgb(1.0, 0.94, 0.84),
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            num_cascades: 2,
            first_cascade_far_bound: first_cascade_m,
            maximum_distance: shadows_to_m,
            ..default()
        }
        .build(),
        Transform::from_translation(SUN).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    SKY_LIGHT.give_to_cameras(commands);
    commands.insert_resource(bevy::light::DirectionalLightShadowMap { size: 2048 });
}

/// From the haze at the horizon to the zenith, and brighter about the sun.
fn sky_colour(direction: Vec3) -> Vec3 {
    let height = direction.y.max(0.0);
    let glow = direction.dot(SUN.normalize()).max(0.0);
    let base = HORIZON.lerp(ZENITH, height.powf(0.45));
    base + Vec3::new(1.0, 0.85, 0.6) * (0.12 * glow.powi(6) + 0.25 * glow.powi(64))
}
