//! Logs in the fire, a ring of stones, and two trunks to sit on.

use crate::ground;
use bevy::{light::NotShadowCaster, math::Affine2, mesh::VertexAttributeValues, prelude::*};
use bevy_windwood::{
    render::repeating_image,
    tree::{
        Species,
        bark::{Bark, bark_textures},
    },
};
use noise::{NoiseFn, OpenSimplex};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::f32::consts::{FRAC_PI_2, TAU};

const OAK: &str = include_str!("../../assets/species/oak.species.ron");
/// Radius and length of the trunks, m.
const TRUNK_M: [f32; 2] = [0.2, 1.7];
/// Logs in the fire are charred: so much darker than bark.
const CHARRED: f32 = 0.16;
/// Height of the lumps of a stone by its radius.
const LUMPS: f64 = 0.28;

/// Spawns all of it.
pub fn spawn_fireplace(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    images: &mut Assets<Image>,
    seed: u64,
) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let bark = bark_material(images, seed);
    let charred = StandardMaterial { base_color: Color::linear_rgb(CHARRED, CHARRED, CHARRED), ..bark.clone() };
    spawn_logs(commands, meshes, materials.add(charred), &mut random);
    let stones = [0, 1, 2, 3].map(|kind| meshes.add(stone_mesh(0.13, seed as u32 + kind)));
    spawn_stones(commands, &stones, materials.add(matt(Color::srgb(0.36, 0.35, 0.34))), &mut random);
    let wood = matt(Color::srgb(0.55, 0.43, 0.29));
    spawn_trunks(commands, meshes, [bark, wood].map(|material| materials.add(material)));
}

/// Spawns logs that lean together.
fn spawn_logs(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    charred: Handle<StandardMaterial>,
    random: &mut impl RngExt,
) {
    let log = meshes.add(barked(0.055, 0.75));
    for number in 0..6 {
        let turn = TAU * (number as f32 + random.random_range(-0.25..0.25)) / 6.0;
        let out = Vec3::new(turn.cos(), 0.0, turn.sin());
        let lying = Quat::from_rotation_arc(Vec3::Y, (-out + Vec3::Y * random.random_range(0.35..0.8)).normalize());
        commands.spawn((
            Mesh3d(log.clone()),
            MeshMaterial3d(charred.clone()),
            Transform::from_translation(out * 0.33 + Vec3::Y * 0.15).with_rotation(lying),
            // The light is between them: their shadows would darken everything.
            NotShadowCaster,
        ));
    }
}

/// Spawns a ring of stones of some shapes, one after another.
fn spawn_stones(
    commands: &mut Commands,
    shapes: &[Handle<Mesh>],
    stone: Handle<StandardMaterial>,
    random: &mut impl RngExt,
) {
    for (number, shape) in shapes.iter().cycle().take(15).enumerate() {
        let turn = TAU * (number as f32 + random.random_range(-0.2..0.2)) / 15.0;
        let place = Vec3::new(turn.cos(), 0.0, turn.sin()) * 0.68 + Vec3::Y * 0.04;
        let size = Vec3::new(random.random_range(0.75..1.2), random.random_range(0.6..0.9), 1.05);
        let turned = Quat::from_rotation_y(random.random_range(0.0..TAU));
        commands.spawn((
            Mesh3d(shape.clone()),
            MeshMaterial3d(stone.clone()),
            Transform::from_translation(place).with_rotation(turned).with_scale(size),
        ));
    }
}

/// Spawns two trunks to sit on, with sawn ends.
fn spawn_trunks(commands: &mut Commands, meshes: &mut Assets<Mesh>, [bark, wood]: [Handle<StandardMaterial>; 2]) {
    let [radius_m, length_m] = TRUNK_M;
    let (trunk, end) = (meshes.add(barked(radius_m, length_m)), meshes.add(Circle::new(radius_m)));
    for (place, turn) in [(Vec2::new(-1.75, -0.35), 1.35), (Vec2::new(1.5, -1.35), -0.75)] {
        let lying = Quat::from_rotation_y(turn) * Quat::from_rotation_z(FRAC_PI_2);
        let at = Vec3::new(place.x, ground::height_m(place) + 0.16, place.y);
        let mut log = commands.spawn((
            Mesh3d(trunk.clone()),
            MeshMaterial3d(bark.clone()),
            Transform::from_translation(at).with_rotation(lying),
        ));
        for side in [-1.0, 1.0] {
            let sawn = Transform::from_xyz(0.0, side * 0.5 * length_m, 0.0)
                .with_rotation(Quat::from_rotation_x(-side * FRAC_PI_2));
            log.with_child((Mesh3d(end.clone()), MeshMaterial3d(wood.clone()), sawn));
        }
    }
}

fn matt(base_color: Color) -> StandardMaterial {
    StandardMaterial { base_color, perceptual_roughness: 0.95, reflectance: 0.1, ..default() }
}

/// A log without ends.
fn barked(radius_m: f32, length_m: f32) -> Mesh {
    let mesh = Cylinder::new(radius_m, length_m).mesh().resolution(24).without_caps().build();
    mesh.clone().with_generated_tangents().unwrap_or(mesh)
}

/// The bark of the shipped oak.
fn bark_material(images: &mut Assets<Image>, seed: u64) -> StandardMaterial {
    let bark = Species::from_ron(OAK).map_or_else(|_| Bark::default(), |species| species.wood.bark);
    let textures = bark_textures(&bark, seed);
    let [radius_m, length_m] = TRUNK_M;
    let repeats = Vec2::new(TAU * radius_m, length_m) / bark.tile_m;
    StandardMaterial {
        base_color_texture: Some(images.add(repeating_image(&textures.base_colour))),
        normal_map_texture: Some(images.add(repeating_image(&textures.normal))),
        uv_transform: Affine2::from_scale(repeats.round().max(Vec2::ONE)),
        ..matt(Color::WHITE)
    }
}

/// A sphere with lumps.
fn stone_mesh(radius_m: f32, seed: u32) -> Mesh {
    let lumps = OpenSimplex::new(seed);
    let mut mesh = Sphere::new(radius_m).mesh().ico(4).unwrap_or_else(|_| Sphere::new(radius_m).into());
    if let Some(VertexAttributeValues::Float32x3(places)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        for place in places {
            let out = (Vec3::from_array(*place) / radius_m).as_dvec3();
            let lump = lumps.get((1.3 * out).to_array()) + 0.35 * lumps.get((3.5 * out).to_array());
            *place = (radius_m * (out * (1.0 + LUMPS * lump)).as_vec3()).to_array();
        }
    }
    mesh.with_computed_smooth_normals()
}
