//! Sky, sun and haze of a clear afternoon: what the scenes share.

// Each of the examples uses a part of it.
#![allow(dead_code)]

use bevy::{
    light::{CascadeShadowConfigBuilder, NotShadowCaster, NotShadowReceiver},
    pbr::{DistanceFog, FogFalloff},
    prelude::*,
};

/// Direction to the sun: mid-afternoon.
pub const SUN: Vec3 = Vec3::new(0.55, 0.62, 0.25);
const HAZE: Color = Color::srgb(0.69, 0.78, 0.88);
const ZENITH: Vec3 = Vec3::new(0.13, 0.32, 0.78);
const HORIZON: Vec3 = Vec3::new(0.75, 0.90, 1.05);

/// Fog by the square of the distance: clear in the wood, blue on the far ridges.
pub fn haze(distance_m: f32) -> DistanceFog {
    DistanceFog {
        color: HAZE,
        directional_light_color: Color::srgba(1.0, 0.9, 0.7, 0.25),
        directional_light_exponent: 12.0,
        falloff: FogFalloff::ExponentialSquared { density: 1.0 / distance_m },
    }
}

/// Spawns the sky's dome about a place, the sun, whose shadows reach so far, and the light of the sky.
pub fn spawn_daylight(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    (centre, radius_m): (Vec3, f32),
    (first_cascade_m, shadows_to_m): (f32, f32),
) {
    commands.spawn((
        Mesh3d(meshes.add(sky(radius_m))),
        MeshMaterial3d(materials.add(StandardMaterial {
            unlit: true,
            fog_enabled: false,
            cull_mode: None,
            ..default()
        })),
        Transform::from_translation(centre),
        NotShadowCaster,
        NotShadowReceiver,
    ));
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
    commands.insert_resource(GlobalAmbientLight {
        color: Color::srgb(0.72, 0.84, 1.0),
        brightness: 620.0,
        ..default()
    });
    commands.insert_resource(bevy::light::DirectionalLightShadowMap { size: 2048 });
}

/// A dome whose colour goes from the horizon's haze to the zenith, and is brighter about the sun.
fn sky(radius: f32) -> Mesh {
    let mut dome = Sphere::new(radius).mesh().uv(48, 24);
    let towards_sun = SUN.normalize();
    let colour = |position: &[f32; 3]| {
        let direction = Vec3::from_array(*position) / radius;
        let height = direction.y.max(0.0);
        let glow = direction.dot(towards_sun).max(0.0);
        let base = HORIZON.lerp(ZENITH, height.powf(0.45));
        let colour = base + Vec3::new(1.0, 0.85, 0.6) * (0.12 * glow.powi(6) + 0.25 * glow.powi(64));
        [colour.x, colour.y, colour.z, 1.0]
    };
    let colours: Vec<[f32; 4]> = match dome.attribute(Mesh::ATTRIBUTE_POSITION) {
        Some(bevy::mesh::VertexAttributeValues::Float32x3(positions)) => positions.iter().map(colour).collect(),
        _ => Vec::new(),
    };
    dome.insert_attribute(Mesh::ATTRIBUTE_COLOR, colours);
    dome
}
