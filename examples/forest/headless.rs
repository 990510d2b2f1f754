//! Pictures instead of a window, of any scene that has a name, a camera and a way to tell when it is ready.

use crate::{
    capture,
    options::Options,
    scene::{Setting, camera_transform, haze, is_ready, name},
};
use bevy::prelude::*;
use bevy_windwood::prelude::*;
use image::RgbaImage;
use std::{
    process::ExitCode,
    time::{Duration, Instant},
};

/// Longest that wind and trees may take to get ready.
const PATIENCE: Duration = Duration::from_secs(600);

/// Frames that are drawn before the first picture: pipelines and instances of what is seen for the first time take frames of
/// their own, and so do the levels of trees that a camera looks at for the first time.
const WARM_UP_FRAMES: usize = 6;

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
    capture::begin(app)?;
    // Until all is there somebody stands where the camera will be, so that nothing has to be drawn meanwhile.
    let place = camera_transform(app.world().resource::<Setting>());
    let watcher = app.world_mut().spawn((Viewpoint, place)).id();
    app.world_mut().resource_mut::<LevelOfDetail>().changes_per_frame = 1_000_000;
    while !is_ready(app.world_mut(), options)? {
        app.update();
        if begun.elapsed() > PATIENCE {
            return Err("the wind or a species did not get ready; see the warnings above".into());
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    app.world_mut().despawn(watcher);
    let target = spawn_camera(app, options);
    (0..WARM_UP_FRAMES).for_each(|_| capture::step(app));
    println!("ready after {:.1} s", begun.elapsed().as_secs_f32());

    let mut pictures = Vec::new();
    for frame in 0..options.frames {
        let time_s = options.start + f64::from(frame) * options.interval;
        *app.world_mut().resource_mut::<WindClock>() = WindClock { time_s, previous_s: time_s };
        let picture = capture::capture(app, &target, options.size)?;
        if options.strip {
            pictures.push(picture);
            continue;
        }
        let path = options.out.join(format!("{}_{frame:03}.png", name(options)));
        capture::save(&picture, &path)?;
        println!("{} after {:.1} s", path.display(), begun.elapsed().as_secs_f32());
    }
    if options.strip {
        capture::save(&strip(&pictures), &options.out.join("strip.png"))?;
    }
    Ok(())
}

fn spawn_camera(app: &mut App, options: &Options) -> Handle<Image> {
    let (width, height) = options.size;
    let target = capture::canvas(app, (width * options.supersample, height * options.supersample));
    let world = app.world_mut();
    let transform = camera_transform(world.resource::<Setting>());
    let lens = PerspectiveProjection { far: 60_000.0, ..default() };
    world.spawn((capture::camera(&target), Projection::Perspective(lens), transform, haze()));
    target
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
