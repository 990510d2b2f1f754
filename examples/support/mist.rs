//! Mist among trees, in which shafts of sunlight are seen.

use super::cameras;
use bevy::{
    light::{FogVolume, VolumetricFog, VolumetricLight},
    prelude::*,
};

/// How much of the light a metre of mist takes.
const TAKEN_PER_M: f32 = 0.008;
/// Steps along each ray.
const STEPS: u32 = 64;
/// Light of the sky in the mist.
const SKY_INTENSITY: f32 = 0.02;

/// Lays a box of mist about a place, which the sun and every camera see.
pub fn lay(commands: &mut Commands, sun: Entity, sky: Color, centre: Vec3, size_m: Vec3) {
    commands.entity(sun).insert(VolumetricLight);
    let mist = FogVolume {
        density_factor: TAKEN_PER_M,
        absorption: 0.15,
        scattering: 0.85,
        // Droplets scatter forward: the mist is bright towards the sun.
        scattering_asymmetry: 0.6,
        ..default()
    };
    commands.spawn((mist, Transform::from_translation(centre).with_scale(size_m)));
    let fog = VolumetricFog { ambient_color: sky, ambient_intensity: SKY_INTENSITY, step_count: STEPS, jitter: 0.5 };
    commands.queue(move |world: &mut World| cameras::give(world, fog));
}
