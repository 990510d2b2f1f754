//! Far trees cover as much of the picture as the trees that they stand for.

mod support;

use bevy::prelude::*;
use bevy_windwood::{
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use std::time::Duration;
use support::capture;

/// Where firs are 35 pixels tall, and twice that.
const SMALL: (u32, u32) = (320, 200);
const LARGE: (u32, u32) = (640, 400);

/// Pixels that trees cover of a picture of the same small wood of mature trees, 250 m away, drawn near or far.
fn covered(size: (u32, u32), settings: ForestSettings, (species, mature_years): (&str, f32), season: Season) -> usize {
    let mut app = support::headless_app(Duration::ZERO, None);
    capture::begin(&mut app).expect("a graphics device");
    let canvas = capture::canvas(&mut app, size);
    let area = Area {
        shape: Shape::Rectangle { min_m: [-60.0, -290.0], max_m: [60.0, -230.0] },
        density_per_ha: 30.0,
        stock: vec![Stock { species: species.into(), age_years: mature_years, age_spread_years: 8.0, ..default() }],
        ..default()
    };
    let plan = ForestPlan { seed: 3, areas: vec![area], ..default() };
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan);
    let world = app.world_mut();
    world.insert_resource(season);
    world.insert_resource(ClearColor(Color::srgb(1.0, 0.0, 1.0)));
    world.insert_resource(GlobalAmbientLight { brightness: 2000.0, ..default() });
    // The trees themselves, and not their lower levels.
    world.resource_mut::<LevelOfDetail>().style = LevelStyle::Full;
    world.spawn((Forest::new(plan), settings));
    world.spawn((
        capture::camera(&canvas),
        Projection::Perspective(PerspectiveProjection { fov: 0.45, ..default() }),
        Transform::from_xyz(0.0, 12.0, 0.0).looking_at(Vec3::new(0.0, 9.0, -250.0), Vec3::Y),
    ));
    let ready = support::update_until(&mut app, capture::forests_are_drawn);
    assert!(ready, "the wood did not come about");
    // Meshes and pipelines of what has come last take frames of their own.
    (0..6).for_each(|_| capture::step(&mut app));
    let picture = capture::capture(&mut app, &canvas, size).expect("a picture");
    picture.pixels().filter(|pixel| !(pixel.0[0] > 200 && pixel.0[1] < 60 && pixel.0[2] > 200)).count()
}

#[test]
fn cards_cover_as_much_as_the_trees_that_they_stand_for() {
    let near = ForestSettings { trees_to_m: 400.0, far_to_m: 0.0, trees_per_frame: 1000, ..default() };
    let far = ForestSettings { trees_to_m: 0.0, far_to_m: 400.0, ..default() };
    // Cards are pictures of mature trees: younger ones have thinner wood, which shows in winter.
    let [fir, oak] = [("fir", 80.0), ("oak", 120.0)];
    for (size, kind, season, least) in [
        (SMALL, fir, Season::SUMMER, 1500),
        (LARGE, fir, Season::SUMMER, 6000),
        (LARGE, oak, Season::SUMMER, 10_000),
        (LARGE, oak, Season::WINTER, 4000),
    ] {
        let [trees, cards] = [&near, &far].map(|settings| covered(size, settings.clone(), kind, season));
        assert!(trees > least, "{kind:?}, {season:?}: {trees} pixels");
        let ratio = cards as f64 / trees as f64;
        println!("{size:?}, {kind:?}, {season:?}: cards over trees {ratio:.3}");
        assert!((0.9..1.1).contains(&ratio), "{kind:?}, {season:?}: cards cover {cards} pixels, trees {trees}");
    }
}
