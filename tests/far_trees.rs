//! Impostors cover as much of the picture as their trees. Needs a Vulkan driver. Mesa's software one will do.

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

/// Sizes at which firs are 35 and 70 pixels tall.
const SMALL: (u32, u32) = (320, 200);
const LARGE: (u32, u32) = (640, 400);

/// Number of pixels of a small forest of mature trees, 250 m away, drawn as trees or as impostors.
fn covered(size: (u32, u32), settings: ForestSettings, (species, mature_years): (&str, f32), season: Season) -> usize {
    let mut app = support::headless_app(Duration::ZERO, None);
    capture::begin(&mut app).expect("a graphics device");
    let target = capture::target(&mut app, size);
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
    // The full trees, not coarser levels.
    world.resource_mut::<LevelOfDetail>().style = LevelStyle::Full;
    world.spawn((Forest::new(plan), settings));
    world.spawn((
        capture::camera(&target),
        Projection::Perspective(PerspectiveProjection { fov: 0.45, ..default() }),
        Transform::from_xyz(0.0, 12.0, 0.0).looking_at(Vec3::new(0.0, 9.0, -250.0), Vec3::Y),
    ));
    let ready = support::update_until(&mut app, capture::forests_are_drawn);
    assert!(ready, "the forest was not drawn in time");
    // Meshes and pipelines of the latest trees take some frames.
    (0..6).for_each(|_| capture::step(&mut app));
    let picture = capture::capture(&mut app, &target, size).expect("a picture");
    picture.pixels().filter(|pixel| !support::is_background(pixel)).count()
}

#[test]
fn impostors_cover_as_much_as_their_trees() {
    let near = ForestSettings { trees_to_m: 400.0, far_to_m: 0.0, trees_per_frame: 1000, ..default() };
    let far = ForestSettings { trees_to_m: 0.0, far_to_m: 400.0, ..default() };
    // Impostors are made from mature trees. Younger ones have thinner branches, which shows in winter.
    let [fir, oak] = [("fir", 80.0), ("oak", 120.0)];
    for (size, kind, season, least) in [
        (SMALL, fir, Season::SUMMER, 1500),
        (LARGE, fir, Season::SUMMER, 6000),
        (LARGE, oak, Season::SUMMER, 10_000),
        (LARGE, oak, Season::WINTER, 4000),
    ] {
        let [trees, impostors] = [&near, &far].map(|settings| covered(size, settings.clone(), kind, season));
        assert!(trees > least, "{kind:?}, {season:?}: {trees} pixels");
        let ratio = impostors as f64 / trees as f64;
        println!("{size:?}, {kind:?}, {season:?}: impostors over trees {ratio:.3}");
        assert!((0.9..1.1).contains(&ratio), "{kind:?}, {season:?}: impostors cover {impostors} pixels, trees {trees}");
    }
}
