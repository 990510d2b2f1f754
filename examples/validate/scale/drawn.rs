//! The same flight over a million trees with a renderer: what our systems take then, with levels, tables and cards.

use super::{
    Flight, LARGEST, SIDE_M,
    dearest::{Dearest, median_and_p99},
    leaps::{self, Acts},
    plan,
};
use crate::{capture, report::Report};
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{SystemTimes, forest::FarBlocks, prelude::*, scatter::ForestPlan};
use std::time::{Duration, Instant};

/// Small: what is drawn is not measured.
const SIZE: (u32, u32) = (160, 90);
/// Software Vulkan draws a few frames a second.
const FRAMES: usize = 90;
/// After so long something is amiss.
const PATIENCE_S: f64 = 120.0;

pub fn run(report: &mut Report) -> Result<(), String> {
    let mut app = App::new();
    app.add_plugins((capture::engine("scale", SIZE, true), WindwoodPlugins));
    capture::begin(&mut app)?;
    let canvas = capture::canvas(&mut app, SIZE);
    let watcher = app.world_mut().spawn((Viewpoint, Transform::from_xyz(0.0, 15.0, 0.0))).id();
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan(LARGEST));
    let settings = ForestSettings { far_to_m: SIDE_M, cells_at_once: 16, ..default() };
    app.world_mut().spawn((Forest::new(plan), settings));
    let begun = Instant::now();
    while !is_ready(app.world_mut()) {
        app.update();
        std::thread::sleep(Duration::from_millis(1));
        if begun.elapsed().as_secs_f64() > PATIENCE_S {
            return Err(format!("a forest of a million trees was not drawn in {PATIENCE_S} s"));
        }
    }
    let all_s = begun.elapsed().as_secs_f64();
    app.world_mut().despawn(watcher);
    let mut flight = Flight::begin(&mut app);
    app.world_mut().entity_mut(flight.camera).insert(capture::camera(&canvas));
    (0..8).for_each(|_| capture::step(&mut app));

    let frame = Duration::from_secs_f64(1.0 / 60.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    let (mut ours_ms, mut dearest) = (Vec::new(), Dearest::default());
    for _ in 0..FRAMES {
        flight.fly_on(&mut app);
        capture::step(&mut app);
        let times = app.world().resource::<SystemTimes>();
        ours_ms.push(times.total().as_secs_f64() * 1e3);
        dearest.note(times);
    }
    let mut acts = Acts { app: &mut app, flight: &mut flight, pass: capture::step };
    let slowest_ms = acts.slowest_ms();
    let slowest_leap_ms = acts.slowest_leap_by_processor_ms();
    println!("with a renderer");
    dearest.print();
    let [median_ms, p99_ms] = median_and_p99(&ours_ms);
    report.tell("drawn_frame_ms_median_1e6", median_ms, "all our systems, with a renderer");
    report.tell("drawn_frame_ms_p99_1e6", p99_ms, "the same");
    let keys = [
        ["drawn_turn_ms_1e6", "drawn_turn_ms_worst_1e6"],
        ["drawn_leap_ms_1e6", "drawn_leap_ms_worst_1e6"],
        ["drawn_wind_ms_1e6", "drawn_wind_ms_worst_1e6"],
    ];
    leaps::tell(report, keys, slowest_ms);
    if let Some([median_ms, worst_ms]) = slowest_leap_ms {
        report.tell(
            "drawn_leap_work_ms_1e6",
            median_ms,
            "leaps once more: what the processor has worked, median of five",
        );
        report.at_most("drawn_leap_work_ms_worst_1e6", worst_ms, 2.0, "the worst of the five");
    }
    report.tell("drawn_all_s_1e6", all_s, "until every tree within 10 km stands or has its card");
    let world = app.world_mut();
    let blocks = world.query::<&FarBlocks>().single(world).map_err(|error| error.to_string())?;
    report.tell("drawn_bytes_per_card", blocks.bytes() as f64 / blocks.trees() as f64, "on the graphics processor");
    Ok(())
}

fn is_ready(world: &mut World) -> bool {
    world.resource::<ActiveSway>().is_ready() && capture::forests_are_drawn(world)
}
