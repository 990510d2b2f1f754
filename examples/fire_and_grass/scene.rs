//! Meadow, fire, logs, trees, and the light of dusk.

use crate::{
    ground,
    options::{Options, View},
};
use bevy::{
    camera::{Exposure, Hdr},
    light::{CascadeShadowConfigBuilder, NotShadowCaster, NotShadowReceiver},
    pbr::{DistanceFog, FogFalloff},
    prelude::*,
};
use bevy_windwood::prelude::*;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::{f32::consts::TAU, sync::Arc};

/// What pictures of it are called.
pub fn name(_: &Options) -> &'static str {
    "fire_and_grass"
}

/// What the scene is made from.
#[derive(Resource)]
pub struct Setting {
    pub options: Options,
}

/// Direction to the sun, which has all but set, behind the trees to the left.
const SUN: Vec3 = Vec3::new(-0.75, 0.10, -0.62);
const HAZE: Color = Color::srgb(0.30, 0.29, 0.36);
const ZENITH: Vec3 = Vec3::new(0.012, 0.024, 0.075);
const HORIZON: Vec3 = Vec3::new(0.085, 0.095, 0.16);
/// Of a camera at dusk: the meadow is dim, the flames just burn out at their hearts.
const EXPOSURE: Exposure = Exposure { ev100: 5.0 };

/// The wind blows across the view and a little towards the viewer.
pub fn wind_direction() -> Dir2 {
    Dir2::new(Vec2::new(0.93, 0.36)).unwrap_or(Dir2::X)
}

/// Where the camera stands for a view.
pub fn camera_transform(setting: &Setting) -> Transform {
    let (eye, target) = match setting.options.view {
        View::Fire => (Vec3::new(0.9, 1.15, 5.2), Vec3::new(0.0, 0.72, 0.0)),
        View::Meadow => (Vec3::new(2.5, 2.3, 9.0), Vec3::new(0.0, 0.2, -4.0)),
        View::Close => (Vec3::new(0.3, 0.75, 2.2), Vec3::new(0.0, 0.5, 0.0)),
    };
    Transform::from_translation(eye).looking_at(target, Vec3::Y)
}

/// What every camera has: evening mist, and the exposure of the hour.
pub fn haze() -> impl Bundle {
    let mist = DistanceFog {
        color: HAZE,
        directional_light_color: Color::srgba(1.0, 0.55, 0.25, 0.25),
        directional_light_exponent: 8.0,
        falloff: FogFalloff::ExponentialSquared { density: 1.0 / 160.0 },
    };
    (Hdr, EXPOSURE, mist)
}

/// Whether the wind blows and everything is drawn; an error if that will never be.
pub fn is_ready(world: &mut World, options: &Options) -> Result<bool, String> {
    let assets = world.resource::<AssetServer>().clone();
    if let Some(tree) = world.query::<&Tree>().iter(world).find(|tree| assets.load_state(&tree.species).is_failed()) {
        return Err(format!("{:?} could not be loaded; the reason stands above", tree.species.path()));
    }
    type Bare<T> = (With<T>, Without<Mesh3d>);
    let trees = world.query_filtered::<(), Bare<Tree>>().iter(world).count();
    let patches = world.query_filtered::<(), Bare<GrassPatch>>().iter(world).count();
    let fires = world.query_filtered::<(), Bare<Fire>>().iter(world).count();
    let is_planted = options.no_trees || world.query::<&Tree>().iter(world).next().is_some();
    Ok(is_planted && world.resource::<ActiveSway>().is_ready() && trees + patches + fires == 0)
}

/// Spawns everything but the camera.
pub fn build(
    mut commands: Commands,
    setting: Res<Setting>,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let options = &setting.options;
    let earth = StandardMaterial { perceptual_roughness: 1.0, reflectance: 0.05, ..default() };
    commands.spawn((Mesh3d(meshes.add(ground::mesh())), MeshMaterial3d(materials.add(earth))));
    spawn_meadow(&mut commands, options.seed);
    commands.spawn((
        Fire {
            shape: FireShape { seed: options.seed, ..default() },
            look: FireLook { casts_shadows: true, ..default() },
        },
        Transform::from_xyz(0.0, 0.03, 0.0),
    ));
    spawn_hearth(&mut commands, &mut meshes, &mut materials, options.seed);
    if !options.no_trees {
        spawn_trees(&mut commands, &assets);
    }
    spawn_dusk(&mut commands, &mut meshes, &mut materials);
}

/// A dense patch about the fire and a thin one with broader blades behind it.
fn spawn_meadow(commands: &mut Commands, seed: u64) {
    let tuft = Tuft { shortest_m: 0.10, longest_m: 0.42, narrowest_m: 0.006, widest_m: 0.013, ..default() };
    let near = Sward { width_m: 14.0, depth_m: 11.0, tufts_per_m2: 11.0, tuft: tuft.clone(), seed, ..default() };
    let broad = Tuft { blades: 12, narrowest_m: 0.025, widest_m: 0.045, radius_m: 0.4, longest_m: 0.5, ..tuft };
    let far = Sward { width_m: 60.0, depth_m: 34.0, tufts_per_m2: 0.6, tuft: broad, seed: seed + 1, ..near.clone() };
    for (sward, middle) in [(near, Vec2::new(0.0, 0.3)), (far, Vec2::new(0.0, -22.2))] {
        let ground = GrassGround(Arc::new(move |at| ground::meadow_height_m(at + middle)));
        commands.spawn((
            GrassPatch { sward, ..default() },
            ground,
            Transform::from_xyz(middle.x, 0.0, middle.y),
            NotShadowCaster,
        ));
    }
}

/// Logs that lean together in the fire, a ring of stones, and two trunks to sit on.
fn spawn_hearth(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    seed: u64,
) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let matt =
        |base_color: Color| StandardMaterial { base_color, perceptual_roughness: 0.95, reflectance: 0.1, ..default() };
    let charred = materials.add(matt(Color::srgb(0.10, 0.075, 0.06)));
    let bark = materials.add(matt(Color::srgb(0.29, 0.22, 0.16)));
    let stone = materials.add(matt(Color::srgb(0.36, 0.35, 0.34)));
    let log = meshes.add(Cylinder::new(0.055, 0.75).mesh().resolution(10));
    for number in 0..6 {
        let turn = TAU * (number as f32 + random.random_range(-0.25..0.25)) / 6.0;
        let out = Vec3::new(turn.cos(), 0.0, turn.sin());
        let lying = Quat::from_rotation_arc(Vec3::Y, (-out + Vec3::Y * random.random_range(0.35..0.8)).normalize());
        let place = out * 0.33 + Vec3::Y * 0.15;
        commands.spawn((
            Mesh3d(log.clone()),
            MeshMaterial3d(charred.clone()),
            Transform::from_translation(place).with_rotation(lying),
            // The light stands among them: their shadows would be all there is.
            NotShadowCaster,
        ));
    }
    let pebble = meshes.add(Sphere::new(0.13).mesh().ico(2).unwrap_or_else(|_| Sphere::new(0.13).into()));
    for number in 0..15 {
        let turn = TAU * (number as f32 + random.random_range(-0.2..0.2)) / 15.0;
        let place = Vec3::new(turn.cos(), 0.0, turn.sin()) * 0.68 + Vec3::Y * 0.04;
        let size = Vec3::new(random.random_range(0.7..1.15), random.random_range(0.55..0.85), 1.0);
        let turned = Quat::from_rotation_y(random.random_range(0.0..TAU));
        commands.spawn((
            Mesh3d(pebble.clone()),
            MeshMaterial3d(stone.clone()),
            Transform::from_translation(place).with_rotation(turned).with_scale(size),
        ));
    }
    let seat = meshes.add(Cylinder::new(0.2, 1.7).mesh().resolution(20));
    for (place, turn) in [(Vec2::new(-1.75, -0.35), 1.35), (Vec2::new(1.5, -1.35), -0.75)] {
        let lying = Quat::from_rotation_y(turn) * Quat::from_rotation_z(0.5 * std::f32::consts::PI);
        let at = Vec3::new(place.x, ground::height_m(place) + 0.16, place.y);
        commands.spawn((
            Mesh3d(seat.clone()),
            MeshMaterial3d(bark.clone()),
            Transform::from_translation(at).with_rotation(lying),
        ));
    }
}

fn spawn_trees(commands: &mut Commands, assets: &AssetServer) {
    let places = [("oak", -9.5, -15.0, 0.9), ("fir", 8.0, -17.0, 0.75), ("fir", 12.5, -21.0, 0.95)];
    for (species, x, z, scale) in places {
        let at = Vec3::new(x, ground::height_m(Vec2::new(x, z)) - 0.1, z);
        commands.spawn((
            Tree::new(assets.load(format!("species/{species}.species.ron"))),
            Transform::from_translation(at).with_scale(Vec3::splat(scale)),
            NotShadowCaster,
        ));
    }
}

fn spawn_dusk(commands: &mut Commands, meshes: &mut Assets<Mesh>, materials: &mut Assets<StandardMaterial>) {
    let air = StandardMaterial { unlit: true, fog_enabled: false, cull_mode: None, ..default() };
    commands.spawn((Mesh3d(meshes.add(sky())), MeshMaterial3d(materials.add(air)), NotShadowCaster, NotShadowReceiver));
    commands.spawn((
        DirectionalLight { illuminance: 80.0, color: Color::srgb(1.0, 0.62, 0.36), ..default() },
        CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: 40.0, ..default() }.build(),
        Transform::from_translation(SUN).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    commands.insert_resource(GlobalAmbientLight { color: Color::srgb(0.70, 0.77, 1.0), brightness: 28.0, ..default() });
}

/// A dome whose colour goes from the horizon to the zenith, warm where the sun has set.
fn sky() -> Mesh {
    let radius = 500.0;
    let mut dome = Sphere::new(radius).mesh().uv(64, 48);
    let towards_sun = (SUN * Vec3::new(1.0, 0.0, 1.0)).normalize();
    let colour = |position: &[f32; 3]| {
        let direction = Vec3::from_array(*position) / radius;
        let height = direction.y.max(0.0);
        let towards = 0.5 + 0.5 * direction.dot(towards_sun);
        let base = HORIZON.lerp(ZENITH, height.powf(0.5));
        let afterglow = Vec3::new(0.75, 0.26, 0.07) * (0.8 * towards.powi(5) * (-6.5 * height).exp());
        let colour = base + afterglow;
        [colour.x, colour.y, colour.z, 1.0]
    };
    let colours: Vec<[f32; 4]> = match dome.attribute(Mesh::ATTRIBUTE_POSITION) {
        Some(bevy::mesh::VertexAttributeValues::Float32x3(positions)) => positions.iter().map(colour).collect(),
        _ => Vec::new(),
    };
    dome.insert_attribute(Mesh::ATTRIBUTE_COLOR, colours);
    dome
}
