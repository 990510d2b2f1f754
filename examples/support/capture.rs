//! Pictures instead of a window: what the examples share.

// Each of the examples uses a part of it.
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
        render_resource::{PollType, TextureFormat},
        renderer::RenderDevice,
        view::screenshot::{Screenshot, ScreenshotCaptured},
    },
    time::TimeUpdateStrategy,
    window::ExitCondition,
    winit::WinitPlugin,
};
use bevy_windwood::{
    forest::{FarBlocks, ForestCells},
    prelude::*,
    sway::DrawPath,
};
use image::RgbaImage;
use std::{
    path::Path,
    sync::{Arc, Mutex},
    time::Duration,
};

/// Bevy with a window of that title and size, or with none.
pub fn engine(title: &str, (width, height): (u32, u32), headless: bool) -> PluginGroupBuilder {
    let window = Window { title: title.into(), resolution: (width, height).into(), ..default() };
    let plugins = DefaultPlugins.set(LogPlugin { filter: "wgpu=error,naga=warn".into(), ..default() });
    if !headless {
        return plugins.set(WindowPlugin { primary_window: Some(window), ..default() });
    }
    plugins
        .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
        .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
        .disable::<PipelinedRenderingPlugin>()
        .disable::<WinitPlugin>()
}

/// Whether a window can be opened. Only Linux has machines without a display as a rule.
pub fn has_display() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(target_os = "linux") || set("DISPLAY") || set("WAYLAND_DISPLAY")
}

/// Makes the app ready to be updated by hand, with its clock standing still.
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

/// A picture that cameras can draw on.
pub fn canvas(app: &mut App, (width, height): (u32, u32)) -> Handle<Image> {
    let image = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
    app.world_mut().resource_mut::<Assets<Image>>().add(image)
}

/// A camera for pictures.
pub fn camera(target: &Handle<Image>) -> impl Bundle {
    // Software Vulkan shades every sample of every small triangle: more pixels are cheaper than more samples.
    (Camera3d::default(), Msaa::Off, DepthPrepass, RenderTarget::Image(target.clone().into()))
}

/// Whether every forest has all that is wanted from where the viewers are: its trees, their meshes, and its cards.
pub fn forests_are_drawn(world: &mut World) -> bool {
    let draws_cards = world.get_resource::<DrawPath>().is_some_and(|path| path.sways);
    let mut forests = world.query::<(&ForestSettings, Option<&ForestCells>, Option<&FarBlocks>)>();
    let all = forests.iter(world).all(|(settings, cells, blocks)| {
        let has_cards = !draws_cards || settings.far_to_m == 0.0 || blocks.is_some_and(FarBlocks::is_complete);
        cells.is_some_and(ForestCells::is_complete) && has_cards
    });
    let bare = world.query_filtered::<(), (With<Tree>, Without<Mesh3d>)>().iter(world).count();
    all && bare == 0
}

/// One frame, rendered to the end.
pub fn step(app: &mut App) {
    app.update();
    let poll = PollType::Wait { submission_index: None, timeout: None };
    if let Err(error) = app.world().resource::<RenderDevice>().wgpu_device().poll(poll) {
        warn!("waiting for the frame: {error}");
    }
}

/// Renders a frame and scales what is on the canvas down to `size`.
///
/// # Errors
/// If the picture does not come back from the device.
pub fn capture(app: &mut App, target: &Handle<Image>, (width, height): (u32, u32)) -> Result<RgbaImage, String> {
    let slot: Arc<Mutex<Option<Image>>> = Arc::default();
    let filled = slot.clone();
    app.world_mut().spawn(Screenshot::image(target.clone())).observe(move |captured: On<ScreenshotCaptured>| {
        if let Ok(mut slot) = filled.lock() {
            *slot = Some(captured.image.clone());
        }
    });
    for _ in 0..16 {
        step(app);
        let taken = slot.lock().ok().and_then(|mut slot| slot.take());
        if let Some(image) = taken {
            let dynamic = image.try_into_dynamic().map_err(|error| error.to_string())?;
            return Ok(image::imageops::thumbnail(&dynamic.to_rgba8(), width, height));
        }
    }
    Err("the picture did not come back from the graphics device".into())
}

/// Writes a PNG.
///
/// # Errors
/// With the path, if it cannot be written.
pub fn save(picture: &RgbaImage, path: &Path) -> Result<(), String> {
    picture.save(path).map_err(|error| format!("{}: {error}", path.display()))
}
