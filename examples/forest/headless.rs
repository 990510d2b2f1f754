//! Pictures instead of a window, of any scene that has a `NAME`, a camera and a way to tell when it is ready.

use crate::{
    options::Options,
    scene::{NAME, Setting, camera_transform, haze, is_ready},
};
use bevy::{
    camera::RenderTarget,
    core_pipeline::prepass::DepthPrepass,
    prelude::*,
    render::{
        render_resource::{PollType, TextureFormat},
        renderer::RenderDevice,
        view::screenshot::{Screenshot, ScreenshotCaptured},
    },
    time::TimeUpdateStrategy,
};
use bevy_windwood::prelude::*;
use image::RgbaImage;
use std::{
    path::Path,
    process::ExitCode,
    sync::{Arc, Mutex},
    time::{Duration, Instant},
};

/// Longest that wind and trees may take to get ready.
const PATIENCE: Duration = Duration::from_secs(600);

/// Frames that are drawn before the first picture.
const WARM_UP_FRAMES: usize = 3;

/// Renders the pictures that the options ask for.
pub fn render(mut app: App, options: &Options) -> ExitCode {
    match run(&mut app, options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(app: &mut App, options: &Options) -> Result<(), String> {
    std::fs::create_dir_all(&options.out).map_err(|error| format!("{}: {error}", options.out.display()))?;
    let begun = Instant::now();
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    app.finish();
    app.cleanup();
    if app.world().get_resource::<RenderDevice>().is_none() {
        return Err("there is no graphics device; on Linux, Mesa's software Vulkan is one (mesa-vulkan-drivers)".into());
    }
    let target = spawn_camera(app, options);
    while !is_ready(app.world_mut(), options)? {
        app.update();
        if begun.elapsed() > PATIENCE {
            return Err("the wind or a species did not get ready; see the warnings above".into());
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    // Pipelines and instances of what is seen for the first time take frames of their own.
    (0..WARM_UP_FRAMES).for_each(|_| step(app));
    println!("ready after {:.1} s", begun.elapsed().as_secs_f32());

    let mut pictures = Vec::new();
    for frame in 0..options.frames {
        let time_s = options.start + f64::from(frame) * options.interval;
        *app.world_mut().resource_mut::<WindClock>() = WindClock { time_s, previous_s: time_s };
        let picture = capture(app, options, &target)?;
        let path = options.out.join(format!("{NAME}_{frame:03}.png"));
        save(&picture, &path)?;
        println!("{} after {:.1} s", path.display(), begun.elapsed().as_secs_f32());
        if options.strip {
            pictures.push(picture);
        }
    }
    if options.strip {
        save(&strip(&pictures), &options.out.join("strip.png"))?;
    }
    Ok(())
}

fn spawn_camera(app: &mut App, options: &Options) -> Handle<Image> {
    let world = app.world_mut();
    let (width, height) = options.size;
    let (width, height) = (width * options.supersample, height * options.supersample);
    let image = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
    let target = world.resource_mut::<Assets<Image>>().add(image);
    let transform = camera_transform(world.resource::<Setting>());
    world.spawn((
        Camera3d::default(),
        // Software Vulkan shades every sample of every small triangle: more pixels are cheaper than more samples.
        Msaa::Off,
        DepthPrepass,
        Projection::Perspective(PerspectiveProjection { far: 60_000.0, ..default() }),
        RenderTarget::Image(target.clone().into()),
        transform,
        haze(),
    ));
    target
}

/// One frame, rendered to the end.
fn step(app: &mut App) {
    app.update();
    let poll = PollType::Wait { submission_index: None, timeout: None };
    if let Err(error) = app.world().resource::<RenderDevice>().wgpu_device().poll(poll) {
        warn!("waiting for the frame: {error}");
    }
}

fn capture(app: &mut App, options: &Options, target: &Handle<Image>) -> Result<RgbaImage, String> {
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
            let (width, height) = options.size;
            return Ok(image::imageops::thumbnail(&dynamic.to_rgba8(), width, height));
        }
    }
    Err("the picture did not come back from the graphics device".into())
}

fn save(picture: &RgbaImage, path: &Path) -> Result<(), String> {
    picture.save(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// The pictures side by side, and at the end how much each place changed from the first to the last.
fn strip(pictures: &[RgbaImage]) -> RgbaImage {
    let (Some(first), Some(last)) = (pictures.first(), pictures.last()) else { return RgbaImage::new(1, 1) };
    let change = RgbaImage::from_fn(first.width(), first.height(), |x, y| {
        let (a, b) = (first.get_pixel(x, y).0, last.get_pixel(x, y).0);
        let difference = |channel: usize| a[channel].abs_diff(b[channel]).saturating_mul(3);
        image::Rgba([difference(0), difference(1), difference(2), 255])
    });
    let panels = pictures.len() as u32 + 1;
    let mut strip = RgbaImage::new(first.width() * panels, first.height());
    for (panel, picture) in (0u32..).zip(pictures.iter().chain([&change])) {
        image::imageops::replace(&mut strip, picture, i64::from(panel * first.width()), 0);
    }
    strip
}
