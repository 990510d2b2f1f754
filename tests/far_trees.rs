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
use image::RgbaImage;
use std::{f32::consts::FRAC_PI_2, time::Duration};
use support::capture;

/// Sizes at which firs are 35 and 70 pixels tall.
const SMALL: (u32, u32) = (320, 200);
const LARGE: (u32, u32) = (640, 400);

/// A small forest of mature trees, 250 m away, drawn as trees or as impostors, with what else is spawned.
fn picture(
    size: (u32, u32),
    settings: ForestSettings,
    (species, mature_years): (&str, f32),
    season: Season,
    spawn: impl FnOnce(&mut World),
) -> RgbaImage {
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
    world.insert_resource(ClearColor(support::BACKGROUND));
    world.insert_resource(GlobalAmbientLight { brightness: 2000.0, ..default() });
    // The full trees, not coarser levels.
    world.resource_mut::<LevelOfDetail>().style = LevelStyle::Full;
    world.spawn((Forest::new(plan), settings));
    spawn(world);
    world.spawn((
        capture::camera(&target),
        Projection::Perspective(PerspectiveProjection { fov: 0.45, ..default() }),
        Transform::from_xyz(0.0, 12.0, 0.0).looking_at(Vec3::new(0.0, 9.0, -250.0), Vec3::Y),
    ));
    // On a loaded machine the forest may be there before its response to the wind is.
    let ready = support::update_until(&mut app, |world| {
        capture::forests_are_drawn(world) && world.resource::<ActiveSway>().is_ready()
    });
    assert!(ready, "the forest was not drawn in time");
    // Meshes and pipelines of the latest trees take some frames.
    (0..6).for_each(|_| capture::step(&mut app));
    capture::capture(&mut app, &target, size).expect("a picture")
}

/// Number of pixels of that forest.
fn covered(size: (u32, u32), settings: ForestSettings, kind: (&str, f32), season: Season) -> usize {
    let picture = picture(size, settings, kind, season, |_| {});
    picture.pixels().filter(|pixel| !support::is_background(pixel)).count()
}

/// The mean column of what is not background.
fn middle_px(picture: &RgbaImage) -> f64 {
    let drawn = picture.enumerate_pixels().filter(|(.., pixel)| !support::is_background(pixel));
    let (sum, count) = drawn.fold((0.0, 0), |(sum, count), (x, ..)| (sum + f64::from(x), count + 1));
    sum / f64::from(count.max(1))
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

/// They lean away from what a game blows at them, to either side. Two pixels are a metre there, and a fir is 70 pixels tall.
#[test]
fn impostors_lean_before_a_jet() {
    let far = ForestSettings { trees_to_m: 0.0, far_to_m: 400.0, ..default() };
    let blown_from = |side: f32| {
        let picture = picture(LARGE, far.clone(), ("fir", 80.0), Season::SUMMER, |world| {
            world.insert_resource(Wind { speed: 1.0, ..default() });
            // In the middle of the forest it has 0.65 of this speed, and there it is 30 m wide to either side.
            let kind = SourceKind::Cone { speed_m_s: 100.0 * side.abs(), nozzle_radius_m: 20.0, half_angle_deg: 5.0 };
            let jet = WindSource { age_s: 10.0, ..WindSource::new(kind).with_reach(600.0) };
            let ahead = Quat::from_rotation_y(-side.signum() * FRAC_PI_2);
            world.spawn((jet, Transform::from_xyz(-120.0 * side.signum(), 12.0, -260.0).with_rotation(ahead)));
        });
        middle_px(&picture)
    };
    let [from_left, still, from_right] = [1.0, 0.0, -1.0].map(blown_from);
    println!("in the middle of the picture at {from_left} px, {still} px, {from_right} px");
    assert!(from_left > still + 4.0 && from_right < still - 4.0, "{from_left}, {still}, {from_right}");
    assert!(((from_left - still) / (still - from_right) - 1.0).abs() < 0.3, "{from_left}, {still}, {from_right}");
}
