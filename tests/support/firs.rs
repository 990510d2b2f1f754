//! A row of firs before a camera: what became of them on a device that can do less than ours.

use super::{headless_app, read_every_frame, render_frame, update_until};
use bevy::{
    camera::RenderTarget,
    prelude::*,
    render::{
        render_resource::{TextureFormat, WgpuLimits},
        view::screenshot::{Screenshot, ScreenshotCaptured},
    },
};
use bevy_windwood::{
    prelude::*,
    sway::{DrawPath, Foliage, StandTables},
};
use std::{
    sync::{Arc, Mutex},
    time::Duration,
};

/// Number of firs.
pub const TREES: usize = 12;
const BACKGROUND: Color = Color::srgb(1.0, 0.0, 1.0);

/// What became of a row of firs.
pub struct Outcome {
    /// What the device was found to be able to do.
    pub path: DrawPath,
    /// Trees whose wood, and whose leaves, have materials that sway.
    pub swaying: [usize; 2],
    /// Trees that are posed.
    pub posed: usize,
    /// Share of the picture that is not background.
    pub covered: f32,
}

/// Draws a row of firs on a device that is held to `limits`.
pub fn draw_firs(limits: WgpuLimits) -> Outcome {
    let mut app = headless_app(Duration::from_millis(16), Some(limits));
    app.insert_resource(ClearColor(BACKGROUND));
    app.finish();
    app.cleanup();
    let species = app.world().resource::<AssetServer>().load("species/fir.species.ron");
    for tree in 0..TREES {
        let at = Vec3::X * (6.0 * (tree as f32 - 0.5 * TREES as f32));
        app.world_mut().spawn((Tree::new(species.clone()), Transform::from_translation(at)));
    }
    let target = camera_on_a_picture(&mut app);
    let dressed = update_until(&mut app, |world| {
        let trees = world.query_filtered::<(), (With<Tree>, With<Mesh3d>)>().iter(world).count();
        trees == TREES && world.resource::<ActiveSway>().is_ready()
    });
    assert!(dressed, "the trees did not get ready");
    let path = *app.world().resource::<DrawPath>();
    let rows = path.sways.then(|| {
        let trees = app.world().resource::<StandTables>().trees.clone();
        read_every_frame(app.world_mut(), trees)
    });
    let picture = photograph(&mut app, &target);
    let posed = rows.map_or(0, |rows| {
        let rows = rows.lock().expect("nobody panics with it").take().expect("the rows come back");
        // `TreeRow` of `instances.wesl` has 48 bytes; its number of beams is the tenth of its words.
        rows.chunks_exact(48).filter(|row| row[36..40] != [0; 4]).count()
    });
    let world = app.world_mut();
    type Still = With<MeshMaterial3d<StandardMaterial>>;
    let wood = TREES - world.query_filtered::<(), (With<Tree>, Still)>().iter(world).count();
    let leaves = TREES - world.query_filtered::<(), (With<Foliage>, Still)>().iter(world).count();
    Outcome { path, swaying: [wood, leaves], posed, covered: covered_share(&picture) }
}

fn camera_on_a_picture(app: &mut App) -> Handle<Image> {
    let image = Image::new_target_texture(160, 80, TextureFormat::Rgba8UnormSrgb, None);
    let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
    app.world_mut().spawn((
        Camera3d::default(),
        Msaa::Off,
        RenderTarget::Image(target.clone().into()),
        Transform::from_xyz(0.0, 11.0, 45.0).looking_at(Vec3::Y * 10.0, Vec3::Y),
    ));
    app.world_mut().spawn((DirectionalLight::default(), Transform::default().looking_to(-Vec3::ONE, Vec3::Y)));
    target
}

fn photograph(app: &mut App, target: &Handle<Image>) -> Image {
    for _ in 0..4 {
        render_frame(app).expect("the frame is rendered");
    }
    let slot: Arc<Mutex<Option<Image>>> = Arc::default();
    let filled = slot.clone();
    app.world_mut().spawn(Screenshot::image(target.clone())).observe(move |captured: On<ScreenshotCaptured>| {
        *filled.lock().expect("nobody panics with it") = Some(captured.image.clone());
    });
    for _ in 0..16 {
        render_frame(app).expect("the frame is rendered");
        if let Some(picture) = slot.lock().expect("nobody panics with it").take() {
            return picture;
        }
    }
    panic!("the picture did not come back");
}

/// Share of texels in which green is not far below red and blue, as it is in the background.
fn covered_share(picture: &Image) -> f32 {
    let texels = picture.data.as_ref().expect("it was read back").chunks_exact(4);
    let count = texels.len();
    let drawn = texels.filter(|texel| i32::from(texel[0]) - i32::from(texel[1]) < 64).count();
    drawn as f32 / count as f32
}
