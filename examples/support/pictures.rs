//! Renders a scene to a series of pictures.

use super::{
    capture::{self, FAR_M},
    options::SceneOptions,
    scene::Scene,
};
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{grass::GrassFieldPatches, prelude::*, terrain::TerrainChunks};
use image::RgbaImage;
use std::time::{Duration, Instant};

/// Longest wait for wind, ground and trees.
pub const TIMEOUT: Duration = Duration::from_secs(600);

/// Frames before the first picture. Pipelines, instances and levels of detail of what comes into view take some frames.
pub const WARM_UP_FRAMES: usize = 6;

/// Renders the pictures that the options ask for.
///
/// # Errors
/// If the scene does not get ready, or a file cannot be written.
pub fn render<S: Scene>(app: &mut App) -> Result<(), String> {
    let start = Instant::now();
    let scene = app.world().resource::<S>();
    let (name, SceneOptions { image, series, .. }) = (scene.picture_name(), scene.options().clone());
    capture::create_folder(&series.out)?;
    capture::begin(app)?;
    app.world_mut().resource_mut::<LevelOfDetail>().changes_per_frame = 1_000_000;
    wait_until_ready::<S>(app)?;
    let target = spawn_camera::<S>(app);
    (0..WARM_UP_FRAMES).for_each(|_| capture::step(app));
    println!("ready after {:.1} s", start.elapsed().as_secs_f32());

    let mut pictures = Vec::new();
    for frame in 0..series.frames {
        if S::RUNS && frame > 0 {
            run(app, series.interval);
        } else {
            let time_s = series.start + f64::from(frame) * series.interval;
            *app.world_mut().resource_mut::<WindClock>() = WindClock { time_s, previous_s: time_s };
        }
        let picture = capture::capture(app, &target, image.size)?;
        if series.strip {
            pictures.push(picture);
            continue;
        }
        let path = series.out.join(format!("{name}_{frame:03}.png"));
        capture::save(&picture, &path)?;
        println!("{} after {:.1} s", path.display(), start.elapsed().as_secs_f32());
    }
    if series.strip {
        capture::save(&strip(&pictures), &series.out.join("strip.png"))?;
    }
    Ok(())
}

/// Lets time go by, 60 frames a second, none of which is rendered.
fn run(app: &mut App, seconds: f64) {
    set_cameras(app, false);
    let_time_pass(app, seconds);
    set_cameras(app, true);
}

/// Lets time go by, 60 frames a second, and stops it again.
pub fn let_time_pass(app: &mut App, seconds: f64) {
    let frames = (60.0 * seconds).ceil().max(1.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(seconds / frames)));
    (0..frames as u32).for_each(|_| app.update());
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
}

fn set_cameras(app: &mut App, is_active: bool) {
    let world = app.world_mut();
    world.query::<&mut Camera>().iter_mut(world).for_each(|mut camera| camera.is_active = is_active);
}

/// Updates until the scene is ready. Until then a [`Viewpoint`] stands in for the camera, so that nothing is rendered.
fn wait_until_ready<S: Scene>(app: &mut App) -> Result<(), String> {
    let start = Instant::now();
    let place = app.world().resource::<S>().camera_transform();
    let viewpoint = app.world_mut().spawn((Viewpoint, place)).id();
    while !is_ready::<S>(app.world_mut())? {
        app.update();
        if start.elapsed() > TIMEOUT {
            return Err("the wind or a species did not get ready; see the warnings above".into());
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    app.world_mut().despawn(viewpoint);
    Ok(())
}

/// Whether the scene is spawned, and drawn as far as it is.
fn is_ready<S: Scene>(world: &mut World) -> Result<bool, String> {
    Ok(is_drawn(world)? && world.resource_scope(|world, scene: Mut<S>| scene.is_spawned(world))?)
}

/// Whether the wind blows and everything has its meshes.
///
/// # Errors
/// If a species could not be loaded.
pub fn is_drawn(world: &mut World) -> Result<bool, String> {
    let assets = world.resource::<AssetServer>().clone();
    if let Some(tree) = world.query::<&Tree>().iter(world).find(|tree| assets.load_state(&tree.species).is_failed()) {
        return Err(format!("{:?} could not be loaded; see the error above", tree.species.path()));
    }
    type Pending<T> = (With<T>, Without<Mesh3d>);
    let patches = world.query_filtered::<(), Pending<GrassPatch>>().iter(world).count();
    let fields = world.query::<&GrassFieldPatches>().iter(world).all(GrassFieldPatches::is_complete);
    let fires = world.query_filtered::<(), Pending<Fire>>().iter(world).count();
    let has_ground = world.query::<&TerrainChunks>().iter(world).all(TerrainChunks::is_complete);
    Ok(world.resource::<ActiveSway>().is_ready()
        && has_ground
        && fields
        && patches + fires == 0
        && capture::forests_are_drawn(world))
}

fn spawn_camera<S: Scene>(app: &mut App) -> Handle<Image> {
    let size = app.world().resource::<S>().options().image.render_size();
    let target = capture::target(app, size);
    let world = app.world_mut();
    let scene = world.resource::<S>();
    let (transform, effects) = (scene.camera_transform(), scene.camera_effects());
    let projection = Projection::Perspective(PerspectiveProjection { far: FAR_M, ..default() });
    world.spawn((capture::camera(&target), projection, transform, effects));
    target
}

/// The pictures side by side, and at the end three times the difference of the first and the last.
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
