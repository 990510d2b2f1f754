//! An app that draws without a window, for tests and for `validate`. Needs a Vulkan driver; Mesa's software one will do.

// Each of the programs that take this in uses a part of it.
#![allow(dead_code)]

pub mod firs;
pub mod plants;

use bevy::{
    log::LogPlugin,
    prelude::*,
    render::{
        RenderPlugin,
        pipelined_rendering::PipelinedRenderingPlugin,
        render_resource::{PollType, WgpuLimits},
        renderer::RenderDevice,
        settings::{RenderCreation, WgpuSettings},
    },
    time::TimeUpdateStrategy,
    window::ExitCondition,
    winit::WinitPlugin,
};
use bevy_windwood::prelude::*;
use std::time::Duration;

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
