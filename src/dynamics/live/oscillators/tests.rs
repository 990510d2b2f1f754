use super::*;
use crate::dynamics::{
    beam::{BeamSway, BeamWind},
    second_mode::SecondMode,
    test_beams,
};
use rustfft::num_complex::Complex;

const FRAME_S: f64 = 1.0 / 60.0;

fn wind() -> BeamWind {
    test_beams::wind(8.0)
}

/// A beam of a class, with drag that damps it.
fn beam(class: f32) -> LiveBeam {
    let sway = BeamSway {
        gain: 1e-3,
        class,
        drag_damping_s_m: 0.01,
        load_height_m: 10.0,
        averaging_speed_m_s: 0.1,
        drag_exponent: 0.0,
        ..BeamSway::default()
    };
    LiveBeam::new(&test_beams::upright(sway, 1.0), &wind(), 1.0, 1.0)
}

fn steady(load: f32) -> BeamLoad {
    BeamLoad { steady: Some(Vec3A::X * load), pulse: Vec3A::ZERO }
}

/// The transfer function is that of which the table is made, with the table's own weights.
#[test]
fn a_swaying_load_moves_a_beam_as_in_the_table() {
    let grid = wind().grid;
    let hz = 0.5;
    for class in [5.0, 10.0, 12.0, 17.0] {
        let beams = [beam(class)];
        let steps = LiveSteps::new(&grid, FRAME_S).expect("time passes");
        let of = |damping: usize| grid.transfer(class as usize, damping, hz).nth(1).unwrap_or_default();
        let damped = f64::from(beams[0].damped);
        let transfer = of(0) * (1.0 - damped) + of(1) * damped;
        let mut tree = LiveTree::new(&beams, &grid);
        let (mut error, mut size) = (0.0, 0.0);
        for frame in 1..24_000 {
            let phase = Complex::from_polar(1.0, TAU * hz * f64::from(frame) * FRAME_S);
            tree.step(&beams, &steps, |_, _| steady(0.1 * phase.im as f32));
            let expected = 0.1 * (transfer * phase).im;
            if frame > 18_000 {
                error += (f64::from(tree.angle(0).x) - expected).powi(2);
                size += expected * expected;
            }
        }
        // A load that is linear within each frame is a little smaller than the sine.
        assert!((error / size).sqrt() < 2e-3, "class {class}: {}", (error / size).sqrt());
    }
}

/// Loads, blows and bodies move a beam of two modes as the sum of two beams, each of one mode and with its share.
#[test]
fn a_beam_of_two_modes_moves_as_the_sum_of_two_beams() {
    let (grid, share) = (wind().grid, 0.3);
    let sway = BeamSway { gain: 1e-3, class: 9.0, load_height_m: 10.0, ..BeamSway::default() };
    let live = |class: f32, second: SecondMode| {
        let beam = test_beams::upright(BeamSway { class, second, ..sway }, 1.0);
        [LiveBeam::new(&beam, &wind(), 1.0, 1.0)]
    };
    let both = live(9.0, SecondMode { class_offset: 4.0, share });
    let single = [9.0, 13.0].map(|class| live(class, SecondMode::default()));
    let steps = LiveSteps::new(&grid, FRAME_S).expect("time passes");
    let mut trees = [&both, &single[0], &single[1]].map(|beams| LiveTree::new(beams, &grid));
    let mut size = 0.0_f32;
    for frame in 0..600 {
        let load = steady(0.1 * (0.03 * frame as f32).sin());
        for (tree, beams) in trees.iter_mut().zip([&both, &single[0], &single[1]]) {
            tree.step(beams, &steps, |_, _| load);
            match frame {
                200 => tree.strike(0, Vec3A::Z * 0.02),
                400 => drop(tree.push(0, Vec3A::X * 0.05, 1.0)),
                _ => {}
            }
        }
        let [found, a, b] = trees.each_ref().map(|tree| tree.angle(0));
        // A push takes away the motion against it of each oscillator, here and there.
        assert!(found.distance(a * (1.0 - share) + b * share) < 1e-5, "{frame}: {found}, {a} and {b}");
        size = size.max(a.distance(b));
    }
    assert!(size > 0.02, "the modes differ: {size}");
    // While it has the second mode with a share of none, it moves as the first alone.
    trees[0].prepare(&single[0], &grid);
    assert!(!trees[0].is_still(1e-6) && trees[0].angle(0) == trees[0].beams[0].first.angle());
}

#[test]
fn a_steady_load_bends_by_its_static_angle_at_any_step() {
    let grid = wind().grid;
    for step_s in [1e-3, 0.1, 3.0, 1e9] {
        let beams = [beam(12.0), beam(29.0)];
        let steps = LiveSteps::new(&grid, step_s).expect("time passes");
        let mut tree = LiveTree::new(&beams, &grid);
        for _ in 0..((40.0 / step_s) as u32).max(3) {
            tree.step(&beams, &steps, |_, _| steady(0.3));
            assert!(tree.angle(0).is_finite() && tree.angle(0).length() < 0.7);
        }
        assert!((0..2).all(|beam| (tree.angle(beam) - Vec3A::X * 0.3).length() < 2e-3), "{step_s}");
    }
    assert!([0.0, -1.0, f64::NAN].iter().all(|step_s| LiveSteps::new(&grid, *step_s).is_none()));
}

#[test]
fn a_struck_beam_rings_at_its_frequency_and_comes_to_rest() {
    let grid = wind().grid;
    let mut beams = [beam(12.0)];
    beams[0].damped = 0.0;
    let hz = grid.classes.frequency_hz(12);
    let steps = LiveSteps::new(&grid, FRAME_S).expect("time passes");
    let mut tree = LiveTree::new(&beams, &grid);
    assert!(tree.is_still(1e-6), "one that nothing has touched");
    tree.strike(0, Vec3A::Z * 0.02);
    assert!(!tree.is_still(1e-3));
    let mut crossings: Vec<f64> = Vec::new();
    let mut frame = 0;
    while !tree.is_still(1e-3) {
        let before = tree.angle(0).z;
        tree.step(&beams, &steps, |_, _| BeamLoad::NONE);
        let after = tree.angle(0).z;
        if before < 0.0 && after >= 0.0 {
            crossings.push((f64::from(frame) + f64::from(before / (before - after))) * FRAME_S);
        }
        frame += 1;
        assert!(frame < 6000, "it never rests");
    }
    let periods = (crossings.len() - 1) as f64;
    let found_hz = periods / (crossings[crossings.len() - 1] - crossings[0]);
    assert!(
        periods > 3.0 && (found_hz / f64::from(hz) / (1.0 - 0.05_f64.powi(2)).sqrt() - 1.0).abs() < 2e-3,
        "{found_hz} Hz"
    );
}

/// The whole load of a pulse is felt, wherever in a frame it comes: a slow beam moves as if struck.
#[test]
fn a_pulse_is_a_blow() {
    let grid = wind().grid;
    let beams = [beam(9.0)];
    let steps = LiveSteps::new(&grid, FRAME_S).expect("time passes");
    let [mut pulsed, mut struck] = [LiveTree::new(&beams, &grid), LiveTree::new(&beams, &grid)];
    let load = Vec3A::new(3.0, 0.0, -1.0);
    pulsed.step(&beams, &steps, |_, _| BeamLoad { steady: None, pulse: load });
    struck.strike(0, load * FRAME_S as f32);
    // A pulse acts in the middle of its frame.
    struck.step(&beams, &LiveSteps::new(&grid, 0.5 * FRAME_S).expect("time passes"), |_, _| BeamLoad::NONE);
    for _ in 0..60 {
        let (a, b) = (pulsed.angle(0), struck.angle(0));
        assert!(a.distance(b) < 2e-3 * (1.0 + a.length()), "{a} against {b}");
        for tree in [&mut pulsed, &mut struck] {
            tree.step(&beams, &steps, |_, _| BeamLoad::NONE);
        }
    }
}

#[test]
fn no_load_drives_a_beam_to_what_is_no_number() {
    let grid = wind().grid;
    let beams = [beam(12.0), beam(20.0)];
    let steps = LiveSteps::new(&grid, FRAME_S).expect("time passes");
    for odd in [f32::NAN, f32::INFINITY, f32::MAX, -1e30] {
        let mut tree = LiveTree::new(&beams, &grid);
        for frame in 0..10 {
            tree.step(&beams, &steps, |_, _| steady(if frame < 5 { odd } else { 0.0 }));
            tree.strike(0, Vec3A::splat(odd));
            tree.push(1, Vec3A::splat(odd), odd);
            assert!(tree.angles().all(|angle| angle.is_finite() && angle.length() <= 2.0 * MOST_FREE_RAD));
        }
    }
}
