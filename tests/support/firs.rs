//! A row of firs in front of a camera, on a device with limits.

use super::{capture, headless_app, read_every_frame, update_until};
use bevy::{
    camera::RenderTarget,
    prelude::*,
    render::{RenderApp, mesh::allocator::MeshAllocatorSettings, render_resource::WgpuLimits},
};
use bevy_windwood::{
    prelude::*,
    render::{RenderCapabilities, SwayBuffers, TreeMeshes, TreePart},
};
use image::RgbaImage;
use std::time::Duration;

/// Number of firs.
pub const TREES: usize = 12;
const SIZE: (u32, u32) = (160, 80);
const BACKGROUND: Color = Color::srgb(1.0, 0.0, 1.0);

/// How the firs are drawn.
pub struct Outcome {
    /// What the device can do.
    pub path: RenderCapabilities,
    /// Trees whose wood, and whose leaves, have materials that sway.
    pub swaying: [usize; 2],
    /// Trees with poses.
    pub posed: usize,
    /// Share of the picture that is not background.
    pub covered: f32,
}

/// Draws a row of firs on a device that is held to `limits`.
pub fn draw_firs(limits: WgpuLimits) -> Outcome {
    let binding_bytes = limits.max_storage_buffer_binding_size;
    let mut app = headless_app(Duration::from_millis(16), Some(limits));
    if binding_bytes > 0 {
        limit_mesh_buffers(&mut app, binding_bytes);
    }
    app.insert_resource(ClearColor(BACKGROUND));
    // At lower levels a fir has few poses, and all of them find room.
    app.insert_resource(LevelOfDetail { style: LevelStyle::Full, ..default() });
    app.finish();
    app.cleanup();
    let species = app.world().resource::<AssetServer>().load("species/fir.species.ron");
    for tree in 0..TREES {
        let at = Vec3::X * (6.0 * (tree as f32 - 0.5 * TREES as f32));
        app.world_mut().spawn((Tree::new(species.clone()), Transform::from_translation(at)));
    }
    let target = spawn_camera_and_sun(&mut app);
    let is_ready = update_until(&mut app, |world| {
        let trees = world.query_filtered::<(), (With<Tree>, With<TreeMeshes>)>().iter(world).count();
        trees == TREES && world.resource::<ActiveSway>().is_ready()
    });
    assert!(is_ready, "the trees were not ready in time");
    let path = *app.world().resource::<RenderCapabilities>();
    let rows = path.sways.then(|| {
        let trees = app.world().resource::<SwayBuffers>().trees.clone();
        read_every_frame(app.world_mut(), trees)
    });
    (0..4).for_each(|_| capture::step(&mut app));
    let picture = capture::capture(&mut app, &target, SIZE).expect("the picture comes back");
    let posed = rows.map_or(0, |rows| {
        let rows = rows.lock().expect("the lock is not poisoned").take().expect("the rows come back");
        // A `TreeRow` of `instances.wesl` has 64 bytes. Its number of beams is the tenth word.
        rows.chunks_exact(64).filter(|row| row[36..40] != [0; 4]).count()
    });
    let world = app.world_mut();
    type Still = With<MeshMaterial3d<StandardMaterial>>;
    let still: Vec<TreePart> = world.query_filtered::<&TreePart, Still>().iter(world).copied().collect();
    let swaying = [TreePart::Wood, TreePart::Leaves].map(|part| TREES - still.iter().filter(|it| **it == part).count());
    Outcome { path, swaying, posed, covered: covered_share(&picture) }
}

/// Bevy's mesh buffers have 1 MiB or more by default, and are bound as a whole.
fn limit_mesh_buffers(app: &mut App, bytes: u64) {
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        let mut settings = MeshAllocatorSettings::default();
        settings.min_slab_size = settings.min_slab_size.min(bytes);
        render_app.insert_resource(settings);
    }
}

/// The camera has no depth prepass: not every device under test can have one.
fn spawn_camera_and_sun(app: &mut App) -> Handle<Image> {
    let target = capture::target(app, SIZE);
    app.world_mut().spawn((
        Camera3d::default(),
        Msaa::Off,
        RenderTarget::Image(target.clone().into()),
        Transform::from_xyz(0.0, 11.0, 45.0).looking_at(Vec3::Y * 10.0, Vec3::Y),
    ));
    app.world_mut().spawn((DirectionalLight::default(), Transform::default().looking_to(-Vec3::ONE, Vec3::Y)));
    target
}

/// Share of pixels that are not background: their green is not far below their red.
fn covered_share(picture: &RgbaImage) -> f32 {
    let drawn = picture.pixels().filter(|pixel| i32::from(pixel.0[0]) - i32::from(pixel.0[1]) < 64).count();
    drawn as f32 / picture.pixels().len() as f32
}
