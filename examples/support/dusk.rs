//! The light of dusk.

use super::sky;
use bevy::{
    camera::{Exposure, Hdr},
    light::CascadeShadowConfigBuilder,
    pbr::{DistanceFog, FogFalloff},
    prelude::*,
};

/// Direction to the sun. It is about to set behind the trees to the left.
const SUN: Vec3 = Vec3::new(-0.75, 0.10, -0.62);
const HAZE: Color = Color::srgb(0.30, 0.29, 0.36);
const ZENITH: Vec3 = Vec3::new(0.012, 0.024, 0.075);
const HORIZON: Vec3 = Vec3::new(0.085, 0.095, 0.16);
/// Exposure at which the meadow is dim and only the hearts of the flames are white.
const EXPOSURE: Exposure = Exposure { ev100: 5.0 };

/// Evening mist and exposure.
pub fn camera_effects() -> impl Bundle {
    let mist = DistanceFog {
        color: HAZE,
        directional_light_color: Color::srgba(1.0, 0.55, 0.25, 0.25),
        directional_light_exponent: 8.0,
        falloff: FogFalloff::ExponentialSquared { density: 1.0 / 160.0 },
    };
    (Hdr, EXPOSURE, mist)
}

/// Spawns the sky, its light and the sun.
pub fn spawn_light(commands: &mut Commands, meshes: &mut Assets<Mesh>, materials: &mut Assets<StandardMaterial>) {
    commands.spawn(sky::bundle(sky::dome(500.0, [64, 48], sky_colour), meshes, materials));
    commands.spawn((
        DirectionalLight { illuminance: 80.0, color: Color::srgb(1.0, 0.62, 0.36), ..default() },
        CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: 40.0, ..default() }.build(),
        Transform::from_translation(SUN).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    commands.insert_resource(GlobalAmbientLight { color: Color::srgb(0.70, 0.77, 1.0), brightness: 28.0, ..default() });
}

/// From the horizon to the zenith, warm near the sun.
fn sky_colour(direction: Vec3) -> Vec3 {
    let towards_sun = (SUN * Vec3::new(1.0, 0.0, 1.0)).normalize();
    let height = direction.y.max(0.0);
    let towards = 0.5 + 0.5 * direction.dot(towards_sun);
    let base = HORIZON.lerp(ZENITH, height.powf(0.5));
    base + Vec3::new(0.75, 0.26, 0.07) * (0.8 * towards.powi(5) * (-6.5 * height).exp())
}
