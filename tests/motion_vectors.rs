//! The motion vectors of the prepass are the motion of the branches. Needs a Vulkan driver. Mesa's software one will do.
//!
//! A leafless oak moves in a storm in front of a still camera. A compute shader reads the texture of the prepass back. The CPU
//! poses the same tree now and one frame ago and projects every vertex that faces the camera: this is what should be there. In a calm the
//! same oak is struck again and again.

mod support;

use bevy::{
    camera::RenderTarget,
    core_pipeline::{
        prepass::{DepthPrepass, MotionVectorPrepass, ViewPrepassTextures},
        schedule::camera_driver,
    },
    prelude::*,
    render::{
        RenderApp,
        extract_resource::{ExtractResource, ExtractResourcePlugin},
        render_asset::RenderAssets,
        render_resource::{
            BindGroupEntries, BindGroupLayoutEntries, ShaderStages, TextureFormat, TextureSampleType,
            binding_types::{storage_buffer_sized, texture_2d},
        },
        renderer::RenderGraph,
        storage::{GpuShaderBuffer, ShaderBuffer},
    },
    shader::Shader,
};
use bevy_windwood::{
    dynamics::BeamPose,
    prelude::*,
    sway::TreePose,
    tree::{TreeModel, foliage::Foliage, species::Wood},
};
use std::time::Duration;
use support::{
    ReadBack, cpu_poses, floats, headless_app,
    probe::{ProbePass, ProbeShader},
    read_every_frame, render_frame, update_until,
};

const SIZE: u32 = 512;
/// Height above which branches move enough, m.
const CROWN_M: f32 = 3.0;
/// Time of a frame in the storm. It is long, so that branches move far.
const STORM_FRAME: Duration = Duration::from_millis(500);
/// Time of a frame of the tree that is struck.
const STRUCK_FRAME: Duration = Duration::from_millis(50);

const READ_SHADER: &str = "
@group(0) @binding(0) var motion: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> read: array<vec2<f32>>;
@compute @workgroup_size(8, 8)
fn read_motion(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(motion);
    if id.x < size.x && id.y < size.y {
        read[id.y * size.x + id.x] = textureLoad(motion, vec2<i32>(id.xy), 0).xy;
    }
}
";

#[derive(Resource, ExtractResource, Clone)]
#[extract_app(RenderApp)]
struct Probe {
    read: Handle<ShaderBuffer>,
    shader: Handle<Shader>,
}

#[test]
fn motion_vectors_are_the_motion_of_the_branches() {
    let storm = Wind { speed: 26.0, seed: 5, ..default() };
    check(storm, STORM_FRAME, |app, tree| {
        let time_s = app.world().resource::<WindClock>().time_s;
        let grown = app.world().get::<Grown>(tree).expect("the tree is grown").model.clone();
        let model = app.world().resource::<Assets<TreeModel>>().get(&grown).expect("its model is there");
        cpu_poses(app.world().resource::<ActiveSway>(), model, &Transform::IDENTITY, &Canopy::default(), time_s)
    });
}

#[test]
fn motion_vectors_of_a_tree_that_is_struck_are_the_motion_of_its_branches() {
    let calm = Wind { speed: 0.0, ..default() };
    check(calm, STRUCK_FRAME, |app, tree| {
        let posed = app.world().get::<TreePose>(tree).expect("it is posed on the CPU").beams().to_vec();
        // It is struck again before it has come to rest.
        let blow = TreeImpulse { tree, place: Vec3::Y * 4.0, impulse_n_s: Vec3::new(150.0, 0.0, 60.0) };
        app.world_mut().write_message(blow);
        posed
    });
}

/// Compares what is drawn with the poses of the tree that `pose` has after each frame.
fn check(wind: Wind, frame_time: Duration, pose: impl Fn(&mut App, Entity) -> Vec<BeamPose>) {
    let mut app = headless_app(frame_time, None);
    app.insert_resource(wind).add_plugins(ExtractResourcePlugin::<Probe>::default());
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        render_app.add_systems(RenderGraph, read_motion.after(camera_driver));
    }
    app.finish();
    app.cleanup();

    // Without leaves to catch the wind, only soft wood moves far.
    let wood = Wood { young_modulus_pa: 1.0e8, ..default() };
    let species = Species { wood, foliage: Foliage { first_order: 5, size_m: 0.02, ..default() }, ..default() };
    let species = app.world_mut().resource_mut::<Assets<Species>>().add(species);
    let tree = app.world_mut().spawn((Tree::new(species).with_seed(2), only_the_trunk(), Transform::default())).id();
    let image = Image::new_target_texture(SIZE, SIZE, TextureFormat::Rgba8UnormSrgb, None);
    let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
    let eye = Transform::from_xyz(0.0, 8.0, 22.0).looking_at(Vec3::Y * 8.0, Vec3::Y);
    app.world_mut().spawn((
        Camera3d::default(),
        Msaa::Off,
        RenderTarget::Image(target.into()),
        (DepthPrepass, MotionVectorPrepass),
        eye,
    ));
    let ready =
        |world: &mut World| world.resource::<ActiveSway>().is_settled() && world.get::<TreeMeshes>(tree).is_some();
    assert!(update_until(&mut app, ready), "the tree was not ready in time");
    let read = install_probe(&mut app);

    let grown = app.world().get::<Grown>(tree).expect("the tree is grown").model.clone();
    let model = app.world().resource::<Assets<TreeModel>>().get(&grown).cloned().expect("its model is there");
    let clip_from_world = {
        let mut cameras = app.world_mut().query::<&Camera>();
        let camera = cameras.iter(app.world()).next().expect("there is one");
        camera.clip_from_view() * eye.to_matrix().inverse()
    };

    // What is read back is some frames old, so the poses of each frame are kept.
    let mut poses: Vec<Vec<BeamPose>> = Vec::new();
    let mut seen: Vec<(usize, Vec<Vec2>)> = Vec::new();
    for frame in 0..14 {
        render_frame(&mut app).expect("the frame is rendered");
        poses.push(pose(&mut app, tree));
        if let Some(bytes) = read.lock().expect("the lock is not poisoned").take() {
            seen.push((frame, vectors(&bytes)));
        }
    }
    let (frame, last) = seen.last().expect("the texture was read back");
    // The latency of reading back is whole frames: the one that fits is found among the last, and must fit closely.
    let pairs = (0..6).filter_map(|ago| Some((&poses[frame.checked_sub(ago)?], &poses[frame.checked_sub(ago + 1)?])));
    let fits = pairs.map(|(now, before)| compare(&model, clip_from_world, [now, before], last));
    let best = fits.min_by(|a, b| a.median_error.total_cmp(&b.median_error)).expect("there are frames");
    assert!(best.compared > 100, "{} vertices were compared", best.compared);
    // The wood moves by more than a tenth of a pixel a frame.
    assert!(best.median_motion > 0.1 / SIZE as f32, "{}", best.median_motion);
    // The middle of a texel lies up to 0.7 texels from the vertex, where the wood moves by a few per cent more or less.
    assert!(best.median_error < 0.05 * best.median_motion, "{} of {}", best.median_error, best.median_motion);
}

/// Agreement of the texture with the CPU, in widths of the picture.
struct Agreement {
    compared: usize,
    median_error: f32,
    median_motion: f32,
}

fn only_the_trunk() -> Articulated {
    Articulated { deepest_order: 0, leaves: false }
}

fn compare(model: &TreeModel, clip: Mat4, [now, before]: [&Vec<BeamPose>; 2], read: &[Vec2]) -> Agreement {
    let project = |point: Vec3| {
        let ndc = clip.project_point3(point);
        Vec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y)
    };
    let (mut errors, mut motions) = (Vec::new(), Vec::new());
    let wood = &model.wood;
    for ((at, sway), normal) in wood.positions.iter().zip(&wood.sway).zip(&wood.normals) {
        let (beam, s, at) = (sway[0] as usize, sway[1], Vec3::from_array(*at));
        if normal[2] < 0.3 || at.y < CROWN_M {
            continue;
        }
        let here = project(now[beam].carry(&model.beams[beam], s, at).0);
        let there = project(before[beam].carry(&model.beams[beam], s, at).0);
        let texel = (here * SIZE as f32).floor();
        if texel.cmplt(Vec2::ZERO).any() || texel.cmpge(Vec2::splat(SIZE as f32)).any() {
            continue;
        }
        let written = read[texel.y as usize * SIZE as usize + texel.x as usize];
        // A vertex at the rim of a thin branch may round to a texel of the background.
        if written != Vec2::ZERO {
            errors.push((here - there).distance(written));
            motions.push((here - there).length());
        }
    }
    Agreement { compared: errors.len(), median_error: median(errors), median_motion: median(motions) }
}

fn median(mut values: Vec<f32>) -> f32 {
    values.sort_by(f32::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f32::NAN)
}

fn vectors(bytes: &[u8]) -> Vec<Vec2> {
    floats(bytes).chunks_exact(2).map(Vec2::from_slice).collect()
}

fn install_probe(app: &mut App) -> ReadBack {
    let world = app.world_mut();
    let shader = world.resource_mut::<Assets<Shader>>().add(Shader::from_wgsl(READ_SHADER, "read_motion.wgsl"));
    let buffer = ShaderBuffer::from(vec![Vec2::ZERO; (SIZE * SIZE) as usize]);
    let buffer = world.resource_mut::<Assets<ShaderBuffer>>().add(buffer);
    world.insert_resource(Probe { read: buffer.clone(), shader });
    read_every_frame(world, buffer)
}

fn read_motion(
    mut pass: ProbePass,
    probe: Option<Res<Probe>>,
    views: Query<&ViewPrepassTextures>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
) {
    let Some(probe) = probe else { return };
    let Some(buffer) = buffers.get(&probe.read) else { return };
    let Some(motion) = views.iter().find_map(ViewPrepassTextures::motion_vectors_view) else { return };
    let entries = (texture_2d(TextureSampleType::Float { filterable: false }), storage_buffer_sized(false, None));
    pass.run(
        ProbeShader { entry_point: "read_motion", shader: &probe.shader },
        &BindGroupLayoutEntries::sequential(ShaderStages::COMPUTE, entries),
        &BindGroupEntries::sequential((motion, buffer.buffer.as_entire_buffer_binding())),
        [SIZE.div_ceil(8); 2],
    );
}
