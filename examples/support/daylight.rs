//! Sky, sun and haze: of a clear afternoon, of a morning, of dusk, of a storm.

use super::sky::{self, SkyLight};
use bevy::{
    light::CascadeShadowConfigBuilder,
    pbr::{DistanceFog, FogFalloff},
    prelude::*,
};

/// A state of the sky, and the light from it.
#[derive(Clone, Copy)]
pub struct Daylight {
    /// Direction to the sun, of any length.
    pub sun: Vec3,
    sun_colour: [f32; 3],
    /// On what faces the sun, lx.
    sun_illuminance: f32,
    /// Linear RGB of the dome overhead, at the horizon, and about the sun.
    zenith: Vec3,
    horizon: Vec3,
    glow: Vec3,
    haze_colour: [f32; 3],
    /// By how much farther one sees than in the afternoon.
    sight: f32,
    light: SkyLight,
}

impl Daylight {
    /// The middle of a clear afternoon.
    pub const AFTERNOON: Self = Self {
        sun: Vec3::new(0.55, 0.62, 0.25),
        sun_colour: [1.0, 0.94, 0.84],
        sun_illuminance: 13_500.0,
        zenith: Vec3::new(0.13, 0.32, 0.78),
        horizon: Vec3::new(0.75, 0.90, 1.05),
        glow: Vec3::new(1.0, 0.85, 0.6),
        haze_colour: [0.69, 0.78, 0.88],
        sight: 1.0,
        // Of that sky, and of grass in the sun below it.
        light: SkyLight {
            zenith: Vec3::new(0.62, 0.80, 1.10),
            horizon: Vec3::new(0.52, 0.58, 0.60),
            ground: Vec3::new(0.20, 0.22, 0.10),
            brightness: 1050.0,
        },
    };

    /// The sun two hands' breadths above the horizon.
    pub const MORNING: Self = Self {
        sun: Vec3::new(0.55, 0.36, 0.25),
        sun_colour: [1.0, 0.80, 0.56],
        sun_illuminance: 15_000.0,
        zenith: Vec3::new(0.16, 0.32, 0.66),
        horizon: Vec3::new(0.85, 0.84, 0.80),
        glow: Vec3::new(1.8, 1.2, 0.6),
        haze_colour: [0.80, 0.80, 0.80],
        sight: 0.4,
        light: SkyLight {
            zenith: Vec3::new(0.58, 0.74, 1.02),
            horizon: Vec3::new(0.60, 0.60, 0.58),
            ground: Vec3::new(0.18, 0.18, 0.10),
            brightness: 1100.0,
        },
    };

    /// The sun a hand's breadth above the horizon, as an eye sees it that has got used to it.
    pub const DUSK: Self = Self {
        sun: Vec3::new(0.55, 0.13, 0.25),
        sun_colour: [1.0, 0.58, 0.28],
        sun_illuminance: 19_000.0,
        zenith: Vec3::new(0.10, 0.17, 0.40),
        horizon: Vec3::new(0.85, 0.55, 0.42),
        glow: Vec3::new(2.6, 1.1, 0.3),
        haze_colour: [0.80, 0.62, 0.55],
        sight: 0.6,
        light: SkyLight {
            zenith: Vec3::new(0.42, 0.50, 0.85),
            horizon: Vec3::new(0.70, 0.52, 0.44),
            ground: Vec3::new(0.14, 0.11, 0.07),
            brightness: 1900.0,
        },
    };

    /// Under the clouds of a storm, through which a little of the sun comes, likewise.
    pub const STORM: Self = Self {
        sun: Vec3::new(0.35, 0.85, 0.15),
        sun_colour: [0.92, 0.96, 1.0],
        sun_illuminance: 6_000.0,
        zenith: Vec3::new(0.20, 0.24, 0.29),
        horizon: Vec3::new(0.52, 0.57, 0.60),
        glow: Vec3::new(0.05, 0.05, 0.05),
        haze_colour: [0.60, 0.64, 0.67],
        sight: 0.25,
        light: SkyLight {
            zenith: Vec3::new(0.72, 0.80, 0.88),
            horizon: Vec3::new(0.50, 0.54, 0.56),
            ground: Vec3::new(0.12, 0.13, 0.09),
            brightness: 2400.0,
        },
    };

    /// Fog that grows with the square of the distance: clear near by, in the sky's colour on far ridges. At `distance_m` it takes two
    /// thirds of a clear afternoon's view, and more at dusk and in a storm.
    pub fn haze(&self, distance_m: f32) -> DistanceFog {
        let [red, green, blue] = self.sun_colour;
        DistanceFog {
            color: self.haze_colour(),
            directional_light_color: Color::srgba(red, green, blue, 0.25),
            directional_light_exponent: 12.0,
            falloff: FogFalloff::ExponentialSquared { density: 1.0 / (distance_m * self.sight) },
        }
    }

    /// Spawns the sky's dome about a place, the sky's light, and the sun with its shadows, which is returned.
    pub fn spawn(
        self,
        commands: &mut Commands,
        meshes: &mut Assets<Mesh>,
        materials: &mut Assets<StandardMaterial>,
        (centre, radius_m): (Vec3, f32),
        (first_cascade_m, shadows_to_m): (f32, f32),
    ) -> Entity {
        let dome = sky::dome(radius_m, [48, 24], |direction| self.sky_colour(direction));
        commands.spawn((sky::bundle(dome, meshes, materials), Transform::from_translation(centre)));
        self.light.give_to_cameras(commands);
        commands.insert_resource(bevy::light::DirectionalLightShadowMap { size: 2048 });
        let sun = (
            DirectionalLight {
                illuminance: self.sun_illuminance,
                color: Color::srgb_from_array(self.sun_colour),
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
            Transform::from_translation(self.sun).looking_at(Vec3::ZERO, Vec3::Y),
        );
        commands.spawn(sun).id()
    }

    /// The colour of the haze.
    pub fn haze_colour(&self) -> Color {
        Color::srgb_from_array(self.haze_colour)
    }

    /// From the haze at the horizon to the zenith, and brighter about the sun.
    fn sky_colour(&self, direction: Vec3) -> Vec3 {
        let height = direction.y.max(0.0);
        let glow = direction.dot(self.sun.normalize()).max(0.0);
        let base = self.horizon.lerp(self.zenith, height.powf(0.45));
        base + self.glow * (0.12 * glow.powi(6) + 0.25 * glow.powi(64))
    }
}
