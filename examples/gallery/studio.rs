//! Neutral surroundings: a level green floor, a plain sky, a sun behind the camera to the right, and where to look from.

use crate::support::sky::{self, SkyLight};
use bevy::{light::CascadeShadowConfigBuilder, prelude::*};

/// Direction to the sun.
const SUN: Vec3 = Vec3::new(0.65, 0.75, 0.55);
const HORIZON: Vec3 = Vec3::new(1.45, 1.55, 1.65);
const ZENITH: Vec3 = Vec3::new(0.55, 0.85, 1.45);
const SKY_LIGHT: SkyLight = SkyLight {
    zenith: Vec3::new(0.68, 0.84, 1.10),
    horizon: Vec3::new(0.62, 0.66, 0.68),
    ground: Vec3::new(0.24, 0.26, 0.14),
    brightness: 850.0,
};
/// Vertical field of view, rad.
const FIELD_OF_VIEW_RAD: f32 = 0.6;

/// The projection of every camera.
pub fn projection() -> Projection {
    Projection::Perspective(PerspectiveProjection { fov: FIELD_OF_VIEW_RAD, far: 2000.0, ..default() })
}

/// Spawns floor, sky and lights.
pub fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.spawn((
        Mesh3d(meshes.add(Circle::new(400.0))),
        MeshMaterial3d(materials.add(StandardMaterial {
            base_color: Color::srgb(0.36, 0.40, 0.26),
            perceptual_roughness: 1.0,
            reflectance: 0.05,
            ..default()
        })),
        Transform::from_rotation(Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2)),
    ));
    let dome = sky::dome(900.0, [32, 16], |direction| HORIZON.lerp(ZENITH, direction.y.max(0.0).sqrt()));
    commands.spawn(sky::bundle(dome, &mut meshes, &mut materials));
    commands.spawn((
        DirectionalLight {
            illuminance: 12_500.0,
            color: Color::srgb(1.0, 0.95, 0.86),
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: 160.0, ..default() }.build(),
        Transform::from_translation(SUN).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    SKY_LIGHT.give_to_cameras(&mut commands);
    commands.insert_resource(bevy::light::DirectionalLightShadowMap { size: 2048 });
}

/// What a picture of a tree shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// All of it.
    Whole,
    /// Its crown from near by.
    Crown,
    /// Its trunk at eye height.
    Trunk,
}

/// A view of a tree of that height and width (m) in a picture of that aspect ratio.
pub fn camera_transform(subject: Subject, height_m: f32, width_m: f32, aspect: f32) -> Transform {
    let towards = Vec3::new(0.25, 0.0, 1.0).normalize();
    match subject {
        Subject::Whole => {
            let extent_m = (1.12 * height_m).max(1.08 * width_m / aspect);
            let distance_m = 0.5 * extent_m / (0.5 * FIELD_OF_VIEW_RAD).tan() + 0.3 * width_m;
            let middle = Vec3::Y * 0.48 * height_m;
            let eye = towards * distance_m + Vec3::Y * (0.25 * height_m).max(0.4);
            Transform::from_translation(eye).looking_at(middle, Vec3::Y)
        }
        Subject::Crown => {
            let middle = Vec3::Y * 0.62 * height_m;
            let eye = middle + towards * (0.5 * width_m + 4.0) - Vec3::Y * 0.12 * height_m;
            Transform::from_translation(eye).looking_at(middle + towards * 0.2 * width_m, Vec3::Y)
        }
        Subject::Trunk => {
            let eye = towards * 3.4 + Vec3::Y * 1.5;
            Transform::from_translation(eye).looking_at(Vec3::Y * 1.1, Vec3::Y)
        }
    }
}
