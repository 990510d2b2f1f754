//! An app without a window, and pictures of it.

use bevy::{
    camera::RenderTarget,
    core_pipeline::prepass::DepthPrepass,
    light::{CascadeShadowConfigBuilder, GlobalAmbientLight},
    prelude::*,
    render::{
        RenderPlugin,
        pipelined_rendering::PipelinedRenderingPlugin,
        render_resource::TextureFormat,
        view::screenshot::{Screenshot, ScreenshotCaptured},
    },
    time::TimeUpdateStrategy,
    window::ExitCondition,
};
use image::RgbaImage;
use std::{
    sync::{Arc, Mutex},
    time::{Duration, Instant},
};

const TIMEOUT: Duration = Duration::from_secs(400);
const SETTLING_FRAMES: usize = 6;

/// An app without a window whose clock stands.
pub fn app(assets: AssetPlugin) -> App {
    let mut app = App::new();
    app.add_plugins(
        DefaultPlugins
            .set(assets)
            .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
            .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
            .disable::<PipelinedRenderingPlugin>(),
    );
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    app
}

/// Updates the app until something holds.
pub fn update_until(app: &mut App, mut holds: impl FnMut(&mut World) -> bool) -> Result<(), String> {
    if app.plugins_state() != bevy::app::PluginsState::Cleaned {
        while app.plugins_state() == bevy::app::PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
    }
    let start = Instant::now();
    while !holds(app.world_mut()) {
        app.update();
        if start.elapsed() > TIMEOUT {
            return Err("it did not get ready".into());
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    Ok(())
}

/// A sun, a sky of one colour, and a camera that sees all of a tree.
pub fn spawn_studio(app: &mut App, (width, height): (u32, u32), tree_m: f32) -> Handle<Image> {
    let image = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
    let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
    app.insert_resource(ClearColor(Color::srgb(0.62, 0.74, 0.88)));
    app.insert_resource(GlobalAmbientLight { brightness: 900.0, ..default() });
    app.world_mut().spawn((
        DirectionalLight { illuminance: 11_000.0, shadow_maps_enabled: true, ..default() },
        CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: 160.0, ..default() }.build(),
        Transform::from_xyz(0.65, 0.75, 0.55).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let middle = Vec3::new(0.0, 0.5 * tree_m, 0.0);
    let eye = middle + Vec3::new(0.0, 0.1 * tree_m, 1.9 * tree_m);
    app.world_mut().spawn((
        Camera3d::default(),
        Msaa::Off,
        DepthPrepass,
        RenderTarget::Image(target.clone().into()),
        Transform::from_translation(eye).looking_at(middle, Vec3::Y),
    ));
    target
}

/// A picture of what the camera sees.
pub fn picture(app: &mut App, target: &Handle<Image>, (width, height): (u32, u32)) -> Result<RgbaImage, String> {
    (0..SETTLING_FRAMES).for_each(|_| app.update());
    let slot: Arc<Mutex<Option<Image>>> = Arc::default();
    let filled = slot.clone();
    app.world_mut().spawn(Screenshot::image(target.clone())).observe(move |captured: On<ScreenshotCaptured>| {
        *filled.lock().expect("no thread has failed") = Some(captured.image.clone());
    });
    update_until(app, |_| slot.lock().expect("no thread has failed").is_some())?;
    let image = slot.lock().expect("no thread has failed").take().ok_or("no picture")?;
    let picture = image.try_into_dynamic().map_err(|error| error.to_string())?.to_rgba8();
    assert_eq!(picture.dimensions(), (width, height));
    Ok(picture)
}

/// Mean difference of the channels of two pictures, 0 to 255.
pub fn difference(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let sum: u64 = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.as_raw().len() as f64
}

/// Pictures of one size in a row.
pub fn side_by_side(pictures: &[RgbaImage]) -> RgbaImage {
    let (width, height) = pictures[0].dimensions();
    let mut sheet = RgbaImage::new(width * pictures.len() as u32, height);
    for (column, picture) in (0..).zip(pictures) {
        image::imageops::replace(&mut sheet, picture, i64::from(column * width), 0);
    }
    sheet
}
