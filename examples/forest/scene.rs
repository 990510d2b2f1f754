//! Ground, sky, sun and trees.

use crate::{
    ground::Ground,
    options::{Options, View},
    planting,
};
use bevy::{
    asset::RenderAssetUsages,
    image::{ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor},
    light::{CascadeShadowConfigBuilder, NotShadowCaster, NotShadowReceiver},
    pbr::{DistanceFog, FogFalloff},
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};
use bevy_windwood::prelude::*;
use bevy_windwood::texture::fourier::FourierTexture;

/// What pictures of it are called.
pub const NAME: &str = "forest";

/// What the scene is made from.
#[derive(Resource)]
pub struct Setting {
    pub options: Options,
    pub ground: Ground,
}

/// Direction to the sun: mid-afternoon, over the viewer's right shoulder.
const SUN: Vec3 = Vec3::new(0.55, 0.62, 0.25);
const HAZE: Color = Color::srgb(0.69, 0.78, 0.88);
const ZENITH: Vec3 = Vec3::new(0.13, 0.32, 0.78);
const HORIZON: Vec3 = Vec3::new(0.75, 0.90, 1.05);

/// The wind blows across the view, a little up the slope.
pub fn wind_direction(ground: &Ground) -> Dir2 {
    let uphill = *ground.uphill();
    Dir2::new(uphill.perp() + 0.35 * uphill).unwrap_or(Dir2::X)
}

/// Where the camera stands for a view.
pub fn camera_transform(setting: &Setting) -> Transform {
    let Setting { options, ground } = setting;
    let uphill = *ground.uphill();
    let half = planting::half_side_m(options.trees);
    let on_ground = |at: Vec2, height: f32| Vec3::new(at.x, ground.height_m(at.x, at.y) + height, at.y);
    let (eye, target) = match options.view {
        View::Hillside => {
            let eye = -uphill * (half * 1.12 + 30.0) + uphill.perp() * 0.2 * half;
            (on_ground(eye, 0.16 * half + 5.0), on_ground(uphill * 0.2 * half, 14.0))
        }
        View::Edge => {
            let eye = -uphill * (half + 17.0);
            (on_ground(eye, 1.8), on_ground(-uphill * (half - 4.0) + uphill.perp() * 3.0, 6.0))
        }
        View::Aerial => (on_ground(-uphill * half * 0.9, 1.1 * half + 20.0), on_ground(Vec2::ZERO, 4.0)),
    };
    Transform::from_translation(eye).looking_at(target, Vec3::Y)
}

/// Fog by the square of the distance: clear in the wood, blue on the far ridges.
pub fn haze() -> DistanceFog {
    DistanceFog {
        color: HAZE,
        directional_light_color: Color::srgba(1.0, 0.9, 0.7, 0.25),
        directional_light_exponent: 12.0,
        falloff: FogFalloff::ExponentialSquared { density: 1.0 / 6500.0 },
    }
}

/// Whether the wind blows and every tree is drawn; an error if that will never be.
pub fn is_ready(world: &mut World, options: &Options) -> Result<bool, String> {
    let assets = world.resource::<AssetServer>().clone();
    if let Some(tree) = world.query::<&Tree>().iter(world).find(|tree| assets.load_state(&tree.species).is_failed()) {
        return Err(format!("{:?} could not be loaded; the reason stands above", tree.species.path()));
    }
    let bare = world.query_filtered::<(), (With<Tree>, Without<Mesh3d>)>().iter(world).count();
    let trees = world.query_filtered::<(), With<Tree>>().iter(world).count();
    let planted = trees > 0 || options.trees == 0;
    Ok(world.resource::<ActiveSway>().is_ready() && planted && bare == 0)
}

/// Spawns everything but the camera.
pub fn build(
    mut commands: Commands,
    setting: Res<Setting>,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let Setting { options, ground } = &*setting;
    let places = planting::places(ground, options.trees, options.seed);
    planting::plant(&mut commands, &assets, &places);
    commands.spawn((
        Mesh3d(meshes.add(ground.mesh())),
        MeshMaterial3d(materials.add(StandardMaterial {
            base_color_texture: Some(images.add(turf())),
            perceptual_roughness: 1.0,
            reflectance: 0.1,
            ..default()
        })),
    ));
    commands.spawn((
        Mesh3d(meshes.add(sky())),
        MeshMaterial3d(materials.add(StandardMaterial {
            unlit: true,
            fog_enabled: false,
            cull_mode: None,
            ..default()
        })),
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
            first_cascade_far_bound: 55.0,
            maximum_distance: 420.0,
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
fn sky() -> Mesh {
    let radius = 40_000.0;
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

/// Blades and tufts of light and dark by a Fourier texture, neutral in colour: the ground's vertices have that. Mips are made here, because
/// nothing else makes them.
fn turf() -> Image {
    const SIZE: u32 = 256;
    let first_frequency_rad = 5.0 * std::f32::consts::TAU;
    let waves = FourierTexture { first_frequency_rad, tiles: true, seed: 3, ..default() }.waves();
    let blades = |place: Vec2| waves.as_ref().map_or(0.5, |waves| waves.at(place));
    let mut level: Vec<f32> = (0..SIZE * SIZE)
        .map(|index| Vec2::new((index % SIZE) as f32, (index / SIZE) as f32) / SIZE as f32)
        .map(|place| (0.55 + 0.55 * blades(place)).clamp(0.25, 1.0))
        .collect();
    let mut bytes = Vec::new();
    let mut side = SIZE as usize;
    loop {
        bytes.extend(level.iter().flat_map(|value| {
            let value = (value * 255.0) as u8;
            [value, value, value, 255]
        }));
        if side == 1 {
            break;
        }
        let half = side / 2;
        let pixel = |x: usize, y: usize| level[y * side + x];
        level = (0..half * half)
            .map(|index| (2 * (index % half), 2 * (index / half)))
            .map(|(x, y)| 0.25 * (pixel(x, y) + pixel(x + 1, y) + pixel(x, y + 1) + pixel(x + 1, y + 1)))
            .collect();
        side = half;
    }
    let extent = Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 };
    let format = TextureFormat::Rgba8UnormSrgb;
    let mut image = Image::new_uninit(extent, TextureDimension::D2, format, RenderAssetUsages::RENDER_WORLD);
    image.texture_descriptor.mip_level_count = SIZE.ilog2() + 1;
    image.data = Some(bytes);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        mag_filter: ImageFilterMode::Linear,
        min_filter: ImageFilterMode::Linear,
        mipmap_filter: ImageFilterMode::Linear,
        ..default()
    });
    image
}
