//! The contact sheet.

use crate::{
    capture,
    options::{Columns, Options},
    studio::{FIELD_OF_VIEW, Look, viewpoint},
};
use bevy::prelude::*;
use bevy_windwood::{prelude::*, tree::TreeModel};
use image::RgbaImage;
use std::time::{Duration, Instant};

/// Longest that a picture's tree may take to get ready.
const PATIENCE: Duration = Duration::from_secs(240);
/// Pipelines, instances and looks that are seen for the first time take frames of their own.
const WARM_UP_FRAMES: usize = 4;
/// When the pictures are taken, s.
const MOMENT_S: f64 = 47.0;
/// Ages in the columns, as shares of the mature age.
const AGES: [f32; 5] = [0.08, 0.2, 0.45, 1.0, 1.8];

/// One picture of the sheet.
struct Shot {
    species: String,
    age_share: f32,
    season: Season,
    look: Look,
    /// Size by which the camera chooses its distance, if not this tree's own: the mature tree's, so that ages compare.
    to_scale: bool,
}

/// Renders all pictures and writes the sheet.
pub fn print(mut app: App, options: &Options) -> Result<(), String> {
    capture::begin(&mut app)?;
    let (width, height) = options.size;
    let target = capture::canvas(&mut app, (width * options.supersample, height * options.supersample));
    let lens = PerspectiveProjection { fov: FIELD_OF_VIEW, far: 2000.0, ..default() };
    app.world_mut().spawn((capture::camera(&target), Projection::Perspective(lens)));

    let rows = rows(options);
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0) as u32;
    let mut sheet = RgbaImage::from_pixel(width * columns, height * rows.len() as u32, image::Rgba([255; 4]));
    for (y, row) in (0u32..).zip(&rows) {
        for (x, shot) in (0u32..).zip(row) {
            let picture = take(&mut app, options, &target, shot)?;
            image::imageops::replace(&mut sheet, &picture, i64::from(x * width), i64::from(y * height));
        }
    }
    if let Some(folder) = options.out.parent() {
        std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
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
        look: Look::Whole,
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
            let looks = [Look::Whole, Look::Crown, Look::Trunk];
            let row = |species| looks.map(|look| Shot { look, ..shot(species) }).into();
            species.iter().map(row).collect()
        }
        Columns::Summer => {
            // As many rows as make the sheet about as wide as it is high.
            let across = (species.len() as f32).sqrt().ceil().max(1.0) as usize;
            species.chunks(across).map(|row| row.iter().map(shot).collect()).collect()
        }
    }
}

/// Plants the tree of a picture, waits for it, looks at it, and takes it away.
fn take(app: &mut App, options: &Options, target: &Handle<Image>, shot: &Shot) -> Result<RgbaImage, String> {
    let begun = Instant::now();
    let handle: Handle<Species> =
        app.world().resource::<AssetServer>().load(format!("species/{}.species.ron", shot.species));
    *app.world_mut().resource_mut::<Season>() = shot.season;
    *app.world_mut().resource_mut::<WindClock>() = WindClock { time_s: MOMENT_S, previous_s: MOMENT_S };
    let mature = app.world_mut().spawn((Tree::new(handle.clone()).with_seed(options.seed), Visibility::Hidden)).id();
    wait(app, begun, &shot.species, |world| world.get::<Grown>(mature).is_some())?;
    let years =
        app.world().resource::<Assets<Species>>().get(&handle).map_or(100.0, |species| species.age.mature_years);
    let tree = Tree::new(handle).with_seed(options.seed).with_age(shot.age_share * years);
    let tree = app.world_mut().spawn((tree, Transform::default())).id();
    wait(app, begun, &shot.species, |world| {
        world.get::<Mesh3d>(tree).is_some() && world.resource::<ActiveSway>().is_ready()
    })?;
    let (height_m, width_m) = extent(app, if shot.to_scale { mature } else { tree });
    let aspect = options.size.0 as f32 / options.size.1 as f32;
    let view = viewpoint(shot.look, height_m, width_m, aspect);
    let world = app.world_mut();
    world.query_filtered::<&mut Transform, With<Camera3d>>().iter_mut(world).for_each(|mut camera| *camera = view);
    (0..WARM_UP_FRAMES).for_each(|_| capture::step(app));
    let picture = capture::capture(app, target, options.size)?;
    app.world_mut().despawn(tree);
    app.world_mut().despawn(mature);
    Ok(picture)
}

fn wait(app: &mut App, begun: Instant, species: &str, done: impl Fn(&mut World) -> bool) -> Result<(), String> {
    while !done(app.world_mut()) {
        app.update();
        if begun.elapsed() > PATIENCE {
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
