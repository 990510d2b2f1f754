//! The contact sheet.

use crate::{
    options::{Columns, Options},
    studio::{Subject, camera_transform, projection},
    support::capture,
};
use bevy::prelude::*;
use bevy_windwood::{prelude::*, tree::TreeModel};
use image::RgbaImage;
use std::time::{Duration, Instant};

/// Longest wait for the tree of a picture.
const TIMEOUT: Duration = Duration::from_secs(240);
/// Pipelines and instances of a tree that comes into view take some frames.
const WARM_UP_FRAMES: usize = 4;
/// Time of the pictures, s.
const TIME_S: f64 = 47.0;
/// Ages of the columns, as shares of the mature age.
const AGES: [f32; 5] = [0.08, 0.2, 0.45, 1.0, 1.8];

/// One picture of the sheet.
struct Shot {
    species: String,
    age_share: f32,
    season: Season,
    subject: Subject,
    /// Whether the camera's distance suits the mature tree instead of this one, so that ages can be compared.
    to_scale: bool,
}

/// Renders all pictures and writes the sheet.
///
/// # Errors
/// If a tree does not get ready, or the file cannot be written.
pub fn render(app: &mut App, options: &Options) -> Result<(), String> {
    capture::begin(app)?;
    let (width, height) = options.image.size;
    let target = capture::target(app, options.image.render_size());
    app.world_mut().spawn((capture::camera(&target), projection()));

    let rows = rows(options);
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0) as u32;
    let mut sheet = RgbaImage::from_pixel(width * columns, height * rows.len() as u32, image::Rgba([255; 4]));
    for (y, row) in (0u32..).zip(&rows) {
        for (x, shot) in (0u32..).zip(row) {
            let picture = render_shot(app, options, &target, shot)?;
            image::imageops::replace(&mut sheet, &picture, i64::from(x * width), i64::from(y * height));
        }
    }
    if let Some(folder) = options.out.parent() {
        capture::create_folder(folder)?;
    }
    capture::save(&sheet, &options.out)?;
    println!("{}", options.out.display());
    Ok(())
}

/// The pictures, row by row.
fn rows(options: &Options) -> Vec<Vec<Shot>> {
    let shot = |species: &String| Shot {
        species: species.clone(),
        age_share: 1.0,
        season: Season::SUMMER,
        subject: Subject::Whole,
        to_scale: false,
    };
    let species = &options.species;
    match options.columns {
        Columns::Seasons => {
            let seasons = [Season::WINTER, Season::SPRING, Season::SUMMER, Season::AUTUMN];
            let row = |species| seasons.map(|season| Shot { season, ..shot(species) }).into();
            species.iter().map(row).collect()
        }
        Columns::Ages => {
            let row = |species| AGES.map(|age_share| Shot { age_share, to_scale: true, ..shot(species) }).into();
            species.iter().map(row).collect()
        }
        Columns::Close => {
            let subjects = [Subject::Whole, Subject::Crown, Subject::Trunk];
            let row = |species| subjects.map(|subject| Shot { subject, ..shot(species) }).into();
            species.iter().map(row).collect()
        }
        Columns::Summer => species.chunks(across(species.len())).map(|row| row.iter().map(shot).collect()).collect(),
    }
}

/// Pictures in a row of so many: the sheet is up to twice as wide as it is high, and as full as it can be.
fn across(pictures: usize) -> usize {
    let side = (pictures as f32).sqrt();
    let widths = side.ceil().max(1.0) as usize..=(1.4 * side).ceil().max(1.0) as usize;
    widths.min_by_key(|across| pictures.next_multiple_of(*across)).unwrap_or(1)
}

/// Spawns the tree of a picture, waits for it, renders it, and despawns it.
fn render_shot(app: &mut App, options: &Options, target: &Handle<Image>, shot: &Shot) -> Result<RgbaImage, String> {
    let start = Instant::now();
    let handle: Handle<Species> =
        app.world().resource::<AssetServer>().load(format!("species/{}.species.ron", shot.species));
    *app.world_mut().resource_mut::<Season>() = shot.season;
    *app.world_mut().resource_mut::<WindClock>() = WindClock { time_s: TIME_S, previous_s: TIME_S };
    let mature =
        app.world_mut().spawn((Tree::new(handle.clone()).with_seed(options.wind.seed), Visibility::Hidden)).id();
    wait_until(app, start, &shot.species, |world| world.get::<Grown>(mature).is_some())?;
    let years =
        app.world().resource::<Assets<Species>>().get(&handle).map_or(100.0, |species| species.age.mature_years);
    let tree = Tree::new(handle).with_seed(options.wind.seed).with_age(shot.age_share * years);
    let tree = app.world_mut().spawn((tree, Transform::default())).id();
    wait_until(app, start, &shot.species, |world| {
        world.get::<TreeMeshes>(tree).is_some() && world.resource::<ActiveSway>().is_ready()
    })?;
    let (height_m, width_m) = extent(app, if shot.to_scale { mature } else { tree });
    let aspect = options.image.size.0 as f32 / options.image.size.1 as f32;
    let view = camera_transform(shot.subject, height_m, width_m, aspect);
    let world = app.world_mut();
    world.query_filtered::<&mut Transform, With<Camera3d>>().iter_mut(world).for_each(|mut camera| *camera = view);
    (0..WARM_UP_FRAMES).for_each(|_| capture::step(app));
    let picture = capture::capture(app, target, options.image.size)?;
    app.world_mut().despawn(tree);
    app.world_mut().despawn(mature);
    Ok(picture)
}

/// Updates until `is_done`.
fn wait_until(
    app: &mut App,
    start: Instant,
    species: &str,
    is_done: impl Fn(&mut World) -> bool,
) -> Result<(), String> {
    while !is_done(app.world_mut()) {
        app.update();
        if start.elapsed() > TIMEOUT {
            return Err(format!("`{species}` did not get ready; see the warnings above"));
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    Ok(())
}

/// Height and width of a tree, m.
fn extent(app: &App, tree: Entity) -> (f32, f32) {
    let model = app.world().get::<Grown>(tree).and_then(|grown| {
        let models: &Assets<TreeModel> = app.world().resource();
        models.get(&grown.model)
    });
    model.map_or((10.0, 10.0), |model| {
        let leaves = model.leaves.positions.iter().chain(&model.wood.positions);
        let reach_m = leaves.clone().map(|at| at[0].hypot(at[2])).fold(0.0, f32::max);
        (leaves.map(|at| at[1]).fold(0.3, f32::max), 2.0 * reach_m)
    })
}
