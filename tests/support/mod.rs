//! An app that draws without a window, for tests and for `validate`. Needs a Vulkan driver; Mesa's software one will do.

// Each of the programs that take this in uses a part of it.
#![allow(dead_code)]

#[path = "../../examples/support/capture.rs"]
pub mod capture;
pub mod firs;
pub mod plants;
pub mod wood;

use bevy::{
    log::LogPlugin,
    prelude::*,
    render::{
        RenderPlugin,
        gpu_readback::{Readback, ReadbackComplete},
        pipelined_rendering::PipelinedRenderingPlugin,
        render_resource::{PollType, WgpuLimits},
        renderer::RenderDevice,
        settings::{RenderCreation, WgpuSettings},
        storage::ShaderBuffer,
    },
    time::TimeUpdateStrategy,
    window::ExitCondition,
    winit::WinitPlugin,
};
use bevy_windwood::{
    dynamics::{BeamPose, TreePoser},
    prelude::*,
    tree::TreeModel,
};
use std::{
    sync::{Arc, Mutex},
    time::Duration,
};

/// The default plugins and ours, without a window, every frame rendered before the next begins; the clock advances by
/// `frame` at each update. `limits` are those that the device is held to.
pub fn headless_app(frame: Duration, limits: Option<WgpuLimits>) -> App {
    let mut app = App::new();
    let settings = WgpuSettings { constrained_limits: limits, ..default() };
    let render = RenderPlugin {
        render_creation: RenderCreation::Automatic(Box::new(settings)),
        synchronous_pipeline_compilation: true,
        ..default()
    };
    let plugins = DefaultPlugins
        .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
        .set(render)
        .set(LogPlugin { filter: "error".into(), ..default() })
        .disable::<PipelinedRenderingPlugin>()
        .disable::<WinitPlugin>();
    app.add_plugins((plugins, WindwoodPlugins)).insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    app
}

/// Updates until `done`; whether it came about within some ten seconds of background work.
pub fn update_until(app: &mut App, done: impl Fn(&mut World) -> bool) -> bool {
    (0..2000).any(|_| {
        app.update();
        std::thread::sleep(Duration::from_millis(5));
        done(app.world_mut())
    })
}

/// One frame, rendered to the end.
pub fn render_frame(app: &mut App) -> Result<(), String> {
    app.update();
    let poll = PollType::Wait { submission_index: None, timeout: None };
    let polled = app.world().resource::<RenderDevice>().wgpu_device().poll(poll);
    polled.map(drop).map_err(|error| error.to_string())
}

/// What last came back from the graphics processor.
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

/// A tree that stands at `stands`, posed by the processor in the wind that blows at `time_s`.
pub fn processor_poses(sway: &ActiveSway, model: &TreeModel, stands: &Transform, time_s: f64) -> Vec<BeamPose> {
    let mut poses = vec![BeamPose::REST; model.beams.len()];
    if let Some(wind) = sway.now().next().map(|wind| wind.response) {
        let frame = wind.field.frame();
        let to_wind = Quat::from_mat3(&Mat3::from_cols(frame.along, Vec3::Y, frame.across)).inverse() * stands.rotation;
        let classes = &wind.table.classes;
        let poser = TreePoser::new(&model.beams, wind.basis.map(), classes, to_wind, stands.scale.y);
        let (column, tau_s) = wind.place(stands.translation, time_s);
        let mut responses = vec![Vec4::ZERO; classes.count];
        wind.table.responses(column, tau_s, &mut responses);
        poser.pose(&responses, &mut poses);
    }
    poses
}
