//! Rendering to images, without a window.

// Each program that includes this file uses a part of it.
#![allow(dead_code)]

use bevy::{
    app::PluginGroupBuilder,
    camera::RenderTarget,
    core_pipeline::prepass::DepthPrepass,
    log::LogPlugin,
    prelude::*,
    render::{
        RenderPlugin,
        pipelined_rendering::PipelinedRenderingPlugin,
        render_resource::{PollType, TextureFormat, WgpuLimits},
        renderer::RenderDevice,
        settings::{RenderCreation, WgpuSettings},
        view::screenshot::{Screenshot, ScreenshotCaptured},
    },
    time::TimeUpdateStrategy,
    window::ExitCondition,
    winit::WinitPlugin,
};
use bevy_windwood::{
    forest::{ForestCells, ForestImpostors},
    prelude::*,
    render::RenderCapabilities,
};
use image::RgbaImage;
use std::{
    path::Path,
    sync::{Arc, Mutex},
    time::{Duration, Instant},
};

/// Far plane of cameras: beyond the horizon of any scene, m.
pub const FAR_M: f32 = 60_000.0;

/// Longest wait for a picture that was taken.
const LONGEST_WAIT: Duration = Duration::from_secs(60);

/// Bevy with a window of that title and size.
pub fn engine(title: &str, (width, height): (u32, u32)) -> PluginGroupBuilder {
    let window = Window { title: title.into(), resolution: (width, height).into(), ..default() };
    DefaultPlugins.set(log()).set(WindowPlugin { primary_window: Some(window), ..default() })
}

/// Bevy without a window. Each update renders its frame before it returns. The device is held to `limits`.
pub fn headless_engine(limits: Option<WgpuLimits>) -> PluginGroupBuilder {
    let settings = WgpuSettings { constrained_limits: limits, ..default() };
    let render = RenderPlugin {
        render_creation: RenderCreation::Automatic(Box::new(settings)),
        synchronous_pipeline_compilation: true,
        ..default()
    };
    DefaultPlugins
        .set(log())
        .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
        .set(render)
        .disable::<PipelinedRenderingPlugin>()
        .disable::<WinitPlugin>()
}

fn log() -> LogPlugin {
    LogPlugin { filter: "wgpu=error,naga=warn".into(), ..default() }
}

/// Finishes the app's plugins, so that it can be updated by hand, and stops its clock.
///
/// # Errors
/// Where there is no graphics device.
pub fn begin(app: &mut App) -> Result<(), String> {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    app.finish();
    app.cleanup();
    if app.world().get_resource::<RenderDevice>().is_none() {
        return Err("there is no graphics device; on Linux, Mesa's software Vulkan is one (mesa-vulkan-drivers)".into());
    }
    Ok(())
}

/// An image that cameras can render to.
pub fn target(app: &mut App, (width, height): (u32, u32)) -> Handle<Image> {
    let image = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
    app.world_mut().resource_mut::<Assets<Image>>().add(image)
}

/// A camera that renders to an image.
pub fn camera(target: &Handle<Image>) -> impl Bundle + use<> {
    // Software Vulkan shades every sample of every small triangle: more pixels are cheaper than more samples.
    (Camera3d::default(), Msaa::Off, DepthPrepass, RenderTarget::Image(target.clone().into()))
}

/// Whether every forest has all that is wanted from where the viewers are: its trees, their meshes, and its impostors.
pub fn forests_are_drawn(world: &mut World) -> bool {
    let draws_impostors = world.get_resource::<RenderCapabilities>().is_some_and(|path| path.sways);
    let mut forests = world.query::<(&ForestSettings, Option<&ForestCells>, Option<&ForestImpostors>)>();
    let are_complete = forests.iter(world).all(|(settings, cells, blocks)| {
        let has_impostors =
            !draws_impostors || settings.far_to_m == 0.0 || blocks.is_some_and(ForestImpostors::is_complete);
        cells.is_some_and(ForestCells::is_complete) && has_impostors
    });
    let without_mesh = world.query_filtered::<(), (With<Tree>, Without<TreeMeshes>)>().iter(world).count();
    are_complete && without_mesh == 0
}

/// One update, and its frame rendered to the end. A device that fails is warned of.
pub fn step(app: &mut App) {
    if let Err(error) = render_frame(app) {
        warn!("waiting for the frame: {error}");
    }
}

/// One update, and its frame rendered to the end.
///
/// # Errors
/// What the device says.
pub fn render_frame(app: &mut App) -> Result<(), String> {
    app.update();
    finish_drawing(app)
}

/// Waits until the device has drawn all that it was given.
///
/// # Errors
/// What the device says.
pub fn finish_drawing(app: &App) -> Result<(), String> {
    let poll = PollType::Wait { submission_index: None, timeout: None };
    let polled = app.world().resource::<RenderDevice>().wgpu_device().poll(poll);
    polled.map(drop).map_err(|error| error.to_string())
}

/// Renders a frame and scales the target's image down to `size`.
///
/// # Errors
/// If the image does not come back from the device.
pub fn capture(app: &mut App, target: &Handle<Image>, (width, height): (u32, u32)) -> Result<RgbaImage, String> {
    let slot: Arc<Mutex<Option<Image>>> = Arc::default();
    let filled = slot.clone();
    app.world_mut().spawn(Screenshot::image(target.clone())).observe(move |captured: On<ScreenshotCaptured>| {
        if let Ok(mut slot) = filled.lock() {
            *slot = Some(captured.image.clone());
        }
    });
    // It is taken of the first frame. The next ones only wait for it, however busy the machine is.
    let start = Instant::now();
    while start.elapsed() < LONGEST_WAIT {
        step(app);
        let taken = slot.lock().ok().and_then(|mut slot| slot.take());
        if let Some(image) = taken {
            let dynamic = image.try_into_dynamic().map_err(|error| error.to_string())?;
            return Ok(image::imageops::thumbnail(&dynamic.to_rgba8(), width, height));
        }
    }
    Err("the picture did not come back from the graphics device".into())
}

/// Creates a folder and those above it.
///
/// # Errors
/// With the path, if it cannot be created.
pub fn create_folder(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))
}

/// Writes a PNG.
///
/// # Errors
/// With the path, if it cannot be written.
pub fn save(picture: &RgbaImage, path: &Path) -> Result<(), String> {
    picture.save(path).map_err(|error| format!("{}: {error}", path.display()))
}
