//! Apps that render without a window, for tests and for `validate`. They need a Vulkan driver. Mesa's software one will do.

// Each program that includes this folder uses a part of it.
#![allow(dead_code)]

#[path = "../../examples/support/capture.rs"]
pub mod capture;
pub mod firs;
pub mod forest;
pub mod plants;
pub mod probe;

use bevy::{
    log::LogPlugin,
    prelude::*,
    render::{
        gpu_readback::{Readback, ReadbackComplete},
        render_resource::WgpuLimits,
        storage::ShaderBuffer,
    },
    time::TimeUpdateStrategy,
};
use bevy_windwood::{
    dynamics::{BeamPose, TreeInWind, TreePoser},
    prelude::*,
    tree::TreeModel,
};
#[allow(unused_imports, reason = "not every test renders frame by frame")]
pub use capture::render_frame;
use image::{Rgba, RgbaImage};
use std::{
    sync::{Arc, Mutex},
    time::Duration,
};

/// An app with the default plugins and ours, without a window. Each update renders its frame before it returns, and advances
/// the clock by `frame`. The device is held to `limits`.
pub fn headless_app(frame: Duration, limits: Option<WgpuLimits>) -> App {
    let engine = capture::headless_engine(limits).set(LogPlugin { filter: "error".into(), ..default() });
    let mut app = App::new();
    app.add_plugins((engine, WindwoodPlugins)).insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    app
}

/// Updates until `is_done`, for ten seconds or more. Returns whether it was.
pub fn update_until(app: &mut App, is_done: impl Fn(&mut World) -> bool) -> bool {
    (0..2000).any(|_| {
        app.update();
        std::thread::sleep(Duration::from_millis(5));
        is_done(app.world_mut())
    })
}

/// The clear colour of our pictures, magenta, which nothing else has.
pub const BACKGROUND: Color = Color::srgb(1.0, 0.0, 1.0);

/// Has everything stand before the background, in light from all sides.
pub fn light_plainly(world: &mut World) {
    world.insert_resource(ClearColor(BACKGROUND));
    world.insert_resource(GlobalAmbientLight { brightness: 900.0, ..default() });
}

/// Whether a pixel is of the background.
pub fn is_background(pixel: &Rgba<u8>) -> bool {
    pixel.0[0] > 200 && pixel.0[1] < 60 && pixel.0[2] > 200
}

/// Share of a picture that is not background.
pub fn covered(picture: &RgbaImage) -> f32 {
    let drawn = picture.pixels().filter(|pixel| !is_background(pixel)).count();
    drawn as f32 / (picture.width() * picture.height()) as f32
}

/// The latest bytes that were read back from the GPU.
pub type ReadBack = Arc<Mutex<Option<Vec<u8>>>>;

/// Reads a buffer back after every frame.
pub fn read_every_frame(world: &mut World, buffer: Handle<ShaderBuffer>) -> ReadBack {
    let read = ReadBack::default();
    let filled = read.clone();
    world.spawn(Readback::buffer(buffer)).observe(move |complete: On<ReadbackComplete>| {
        if let Ok(mut slot) = filled.lock() {
            *slot = Some(complete.data.clone());
        }
    });
    read
}

/// The floats of a buffer.
pub fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

/// Poses of the beams of a tree in the wind at a time, computed on the CPU.
pub fn cpu_poses(
    sway: &ActiveSway,
    model: &TreeModel,
    tree: &Transform,
    canopy: &Canopy,
    time_s: f64,
) -> Vec<BeamPose> {
    let mut poses = vec![BeamPose::REST; model.beams.len()];
    if let Some(wind) = sway.now().next().map(|wind| wind.response) {
        let to_wind = wind.field.frame().wind_from_world() * Mat3::from_quat(tree.rotation);
        let (map, scale, beam_wind) = (wind.basis.map(), tree.scale.y, wind.beam_wind_in(canopy));
        let poser = TreePoser::new(&model.beams, &TreeInWind { map, wind: beam_wind, to_wind, scale, leaf_share: 1.0 });
        let mut responses = Vec::new();
        let place = wind.place(tree.translation, time_s);
        wind.table.responses(&place, poser.rows(), &mut responses);
        let blowing = wind.wind_at(&beam_wind.stand, &place, model.height_m() * scale);
        poser.pose(&responses, tree.rotation.inverse() * blowing, &mut poses);
    }
    poses
}
