//! Wind and bent blades of grass are the same on the GPU and on the CPU. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::{math::DVec2, prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{
    dynamics::SweptCapsule,
    grass::{
        blades::{Blade, layout_blades},
        spine::{LINKS, push_bend, tip_bend},
        swing::Swing,
    },
    prelude::*,
    render::SwayBuffers,
};
use std::time::Duration;
use support::{
    ReadBack, headless_app,
    probe::{self, Bound, ProbeSource},
    render_frame, update_until,
};

const HALF_BEND_SPEED_M_S: f32 = 10.0;
/// Rows of results a blade.
const ROWS: usize = LINKS + 5;
/// One source of each kind.
const SOURCES: [(SourceKind, Vec3); 4] = [
    (SourceKind::Blast { charge_kg: 20.0 }, Vec3::new(-20.0, 1.0, 8.0)),
    (SourceKind::Downwash { rotor_radius_m: 5.0, thrust_n: 2e4, ground_m: 0.0 }, Vec3::new(20.0, 12.0, 0.0)),
    (SourceKind::Cone { speed_m_s: 30.0, nozzle_radius_m: 1.0, half_angle_deg: 12.0 }, Vec3::new(0.0, 1.0, 10.0)),
    (
        SourceKind::Vortex { speed_m_s: 20.0, core_radius_m: 3.0, length_m: 30.0, spreading_m2_s: 0.2 },
        Vec3::new(-30.0, 2.0, -9.0),
    ),
];
/// The ends of a body that pushes blades, as the shader has them.
const BODY: [Vec3; 2] = [Vec3::new(0.5, 0.4, -0.2), Vec3::new(0.1, 1.0, 0.3)];

/// Where that body was, and where it will be, how long ago, and how blades swing behind it, as the shader has them.
const STRETCH: SweptCapsule = SweptCapsule {
    ends: [[Vec3::new(-1.0, 0.4, -0.2), Vec3::new(-1.4, 1.0, 0.3)], BODY],
    radius_m: 0.6,
    ages_s: [0.9, 0.1],
};
const SWING: Swing = Swing { frequency_hz: 1.7, damping_ratio: 0.15 };

/// Time of the comparison, s: any will do.
const TIME_S: f64 = 37.3;
/// The height of the wind tables, m.
const TABLE_HEIGHT_M: f32 = 10.0;

/// A blade is three rows: root and length; azimuth, lean, droop; a wind that bends it and a place at which the wind of the tables
/// is sampled, both as (x, z). The results are its joints, that wind, what sources blow near by, and how a body turns its tip that is there
/// and that has come from elsewhere.
const BEND_SHADER: &str = "
import bevy_windwood::{
    grass::shaders::blade::{Blade, LINKS, Stretch, Swing, hold, joint_at, left_by, push_bend, tip_bend},
    render::shaders::{wind::velocity_at, wind_sources::source_velocity_at},
};
@group(0) @binding(0) var<storage, read> blades: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> results: array<vec4<f32>>;
@compute @workgroup_size(64)
fn bend(@builtin(global_invocation_id) id: vec3<u32>) {
    let first = (LINKS + 5u) * id.x;
    if first >= arrayLength(&results) {
        return;
    }
    let a = blades[3u * id.x];
    let b = blades[3u * id.x + 1u];
    let c = blades[3u * id.x + 2u];
    let tip = tip_bend(c.xy, 10.0);
    for (var link = 0u; link <= LINKS; link += 1u) {
        let joint = joint_at(Blade(a.xyz, a.w, b.x, b.y, b.z), tip, link);
        results[first + link] = vec4(joint.position, 1.0);
    }
    results[first + LINKS + 1u] = vec4(velocity_at(vec3(c.z, 0.0, c.w), 0u), 1.0);
    results[first + LINKS + 2u] = vec4(source_velocity_at(vec3(0.05 * c.z, 1.5, 0.05 * c.w), 0u), 1.0);
    let turned = push_bend(a.xyz, a.w, vec3(0.5, 0.4, -0.2), vec3(0.1, 1.0, 0.3), 0.6, vec2(1.0, 0.0));
    results[first + LINKS + 3u] = vec4(turned, 0.0, 1.0);
    let stretch = Stretch(
        vec3(-1.0, 0.4, -0.2), vec3(-1.4, 1.0, 0.3), vec3(0.5, 0.4, -0.2), vec3(0.1, 1.0, 0.3), 0.6, vec2(0.9, 0.1),
    );
    let left = left_by(stretch, a.xyz, a.w, Swing(1.7, 0.15), vec2(1.0, 0.0));
    results[first + LINKS + 4u] = vec4(hold(left.tip, turned), 0.0, 1.0);
}
";

#[test]
fn wind_and_bent_blades_agree_on_gpu_and_cpu() {
    let sward = Sward { width_m: 4.0, depth_m: 4.0, seed: 2, ..default() };
    let blades = layout_blades(&sward, &|at: DVec2| 0.1 * at.x);
    let winds: Vec<Vec2> = (0..blades.len()).map(|k| Vec2::from_angle(k as f32) * (k % 40) as f32).collect();
    // The wind blows along x, and its columns are 8 m apart in z.
    let places: Vec<Vec2> =
        (0..blades.len()).map(|k| Vec2::new(1.7 * k as f32 - 900.0, 7.3 * (k % 137) as f32 - 296.0)).collect();
    let mut app = headless_app(Duration::ZERO, None);
    app.add_plugins(probe::plugin);
    app.finish();
    app.cleanup();
    assert!(update_until(&mut app, |world| world.resource::<ActiveSway>().is_settled()), "no wind");
    *app.world_mut().resource_mut::<WindClock>() = WindClock { time_s: TIME_S, previous_s: TIME_S };
    for (kind, at) in SOURCES {
        app.world_mut().spawn((WindSource::new(kind).with_reach(300.0), Transform::from_translation(at)));
    }
    // Sources swell for a moment, and the front of the blast is on its way.
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(110)));
    app.update();
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    *app.world_mut().resource_mut::<WindClock>() = WindClock { time_s: TIME_S, previous_s: TIME_S };
    let read = install_probe(&mut app, &blades, &winds, &places);
    let mut results = Vec::new();
    for _ in 0..20 {
        render_frame(&mut app).expect("the frame is rendered");
        results = probe::rows(&read).unwrap_or(results);
    }
    assert_eq!(results.len(), blades.len() * ROWS);
    assert!(results.iter().all(|row| row.w == 1.0), "every row was written");
    let active = app.world().resource::<ActiveWind>();
    let sources = app.world().resource::<WindSources>();
    let (mut bend_error, mut wind_error, mut source_error) = (0.0_f32, 0.0_f32, 0.0_f32);
    let (mut push_error, mut swing_error) = (0.0_f32, 0.0_f32);
    let (mut blown, mut pushed, mut swinging) = (0, 0, 0);
    for (number, there) in results.chunks_exact(ROWS).enumerate() {
        let (blade, place) = (&blades[number], places[number]);
        for (here, there) in blade.spine(tip_bend(winds[number], HALF_BEND_SPEED_M_S)).iter().zip(there) {
            bend_error = bend_error.max(here.distance(there.truncate()) / blade.length_m);
        }
        let sampled = active.sample(Vec3::new(place.x, TABLE_HEIGHT_M, place.y), TIME_S);
        wind_error = wind_error.max(sampled.distance(there[LINKS + 1].truncate()));
        let added = sources.velocity(Vec3::new(0.05 * place.x, 1.5, 0.05 * place.y));
        blown += usize::from(added.length() > 1.0);
        let difference = added.distance(there[LINKS + 2].truncate()) / (1.0 + added.length());
        source_error = source_error.max(difference);
        let turned = push_bend(blade.root, blade.length_m, BODY, 0.6, Vec2::X);
        pushed += usize::from(turned.length() > 0.1);
        push_error = push_error.max(turned.distance(there[LINKS + 3].xy()));
        let swung = SWING.tip(turned, blade.root, blade.length_m, &[STRETCH], Vec2::X);
        swinging += usize::from(turned == Vec2::ZERO && swung.length() > 0.1);
        swing_error = swing_error.max(swung.distance(there[LINKS + 4].xy()));
    }
    assert!(blown > 100 && source_error < 2e-3, "of {blown} places the two blow differently by {source_error}");
    assert!(pushed > 100 && push_error < 1e-3, "{pushed} blades are pushed, differently by {push_error} rad");
    assert!(swinging > 100 && swing_error < 1e-3, "{swinging} blades swing back, differently by {swing_error} rad");
    assert!(bend_error < 1e-3, "the two bend differently by {bend_error} of a blade's length");
    // The shader computes the time in 32 bits, to some 1e-4 s. Gusts change by less than this in that time.
    assert!(wind_error < 1e-2, "the two winds differ by {wind_error} m/s");
}

fn install_probe(app: &mut App, blades: &[Blade], winds: &[Vec2], places: &[Vec2]) -> ReadBack {
    let inputs = blades.iter().zip(winds).zip(places).flat_map(|((blade, wind), place)| {
        let turn = Vec4::new(blade.azimuth_rad, blade.lean_rad, blade.droop_rad, 0.0);
        [blade.root.extend(blade.length_m), turn, Vec4::new(wind.x, wind.y, place.x, place.y)]
    });
    let inputs = inputs.collect();
    let world = app.world_mut();
    let SwayBuffers { frame, winds: [wind_a, wind_b], .. } = world.resource::<SwayBuffers>().clone();
    let tables = [(103, frame), (105, wind_a), (106, wind_b)].map(|(binding, table)| (binding, Bound::Table(table)));
    let shader = ProbeSource { entry_point: "bend", wesl: BEND_SHADER };
    probe::install(world, shader, inputs, [blades.len(), ROWS], tables)
}
