//! The flight over a million trees with a renderer: times of our systems, with levels of detail, tables and impostors.

use super::{
    LARGEST, SIDE_M,
    flight::Flight,
    plan,
    stress::{self, StressTest},
    system_costs::{SystemCosts, median_and_p99},
};
use crate::{report::Report, support::capture};
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{SystemTimes, forest::ForestImpostors, prelude::*, scatter::ForestPlan};
use std::time::{Duration, Instant};

/// Size of the picture. It is small because rendering is not measured.
const SIZE: (u32, u32) = (160, 90);
/// Frames of the flight: software Vulkan renders a few per second.
const FRAMES: usize = 90;
/// Longest wait for the forest, s.
const TIMEOUT_S: f64 = 120.0;

pub fn run(report: &mut Report) -> Result<(), String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins));
    capture::begin(&mut app)?;
    let target = capture::target(&mut app, SIZE);
    let viewpoint = app.world_mut().spawn((Viewpoint, Transform::from_xyz(0.0, 15.0, 0.0))).id();
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan(LARGEST));
    let settings = ForestSettings { far_to_m: SIDE_M, cells_at_once: 16, ..default() };
    app.world_mut().spawn((Forest::new(plan), settings));
    let start = Instant::now();
    while !is_ready(app.world_mut()) {
        app.update();
        std::thread::sleep(Duration::from_millis(1));
        if start.elapsed().as_secs_f64() > TIMEOUT_S {
            return Err(format!("a forest of a million trees was not drawn in {TIMEOUT_S} s"));
        }
    }
    let all_s = start.elapsed().as_secs_f64();
    app.world_mut().despawn(viewpoint);
    let mut flight = Flight::start(&mut app);
    app.world_mut().entity_mut(flight.camera).insert(capture::camera(&target));
    (0..8).for_each(|_| capture::step(&mut app));

    let frame = Duration::from_secs_f64(1.0 / 60.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    let (mut systems_ms, mut costs) = (Vec::new(), SystemCosts::default());
    for _ in 0..FRAMES {
        flight.advance(&mut app);
        capture::step(&mut app);
        let times = app.world().resource::<SystemTimes>();
        systems_ms.push(times.total().as_secs_f64() * 1e3);
        costs.add(times);
    }
    let mut test = StressTest { app: &mut app, flight: &mut flight, run_frame: capture::step };
    let slowest_ms = test.slowest_frames_ms();
    let slowest_teleport_ms = test.slowest_teleport_cpu_ms();
    println!("with a renderer");
    costs.print();
    let [median_ms, p99_ms] = median_and_p99(&systems_ms);
    report.record("drawn_frame_ms_median_1e6", median_ms, "all our systems, with a renderer");
    report.record("drawn_frame_ms_p99_1e6", p99_ms, "the same");
    let keys = [
        ["drawn_turn_ms_1e6", "drawn_turn_ms_worst_1e6"],
        ["drawn_teleport_ms_1e6", "drawn_teleport_ms_worst_1e6"],
        ["drawn_wind_ms_1e6", "drawn_wind_ms_worst_1e6"],
    ];
    stress::record(report, keys, slowest_ms);
    if let Some([median_ms, worst_ms]) = slowest_teleport_ms {
        report.record(
            "drawn_teleport_work_ms_1e6",
            median_ms,
            "teleports again, CPU time of our systems, median of five",
        );
        report.at_most("drawn_teleport_work_ms_worst_1e6", worst_ms, 2.0, "the worst of the five");
    }
    report.record("drawn_all_s_1e6", all_s, "until every tree within 10 km is an entity or has its impostor");
    let world = app.world_mut();
    let blocks = world.query::<&ForestImpostors>().single(world).map_err(|error| error.to_string())?;
    report.record("drawn_bytes_per_impostor", blocks.bytes() as f64 / blocks.trees() as f64, "on the GPU");
    Ok(())
}

fn is_ready(world: &mut World) -> bool {
    world.resource::<ActiveSway>().is_ready() && capture::forests_are_drawn(world)
}
