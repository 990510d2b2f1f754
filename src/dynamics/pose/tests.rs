use super::super::bend::mode_shape;
use super::super::{
    beam::{BeamSway, NO_PARENT},
    direction_map::LoadCoefficients,
    frequency_classes::FrequencyClasses,
    mean_wind::MeanWind,
    oracle::cantilever::CantileverMode,
    oscillator_grid::OscillatorGrid,
    second_mode::SecondMode,
    stand_wind::StandWind,
};
use super::{beam_group::held_to_wind, *};
use bevy::math::{DVec3, Quat};

/// A sway that feels the table's wind as it is.
const fn sway(gain: f32, class: f32) -> BeamSway {
    BeamSway {
        gain,
        class,
        averaging_speed_m_s: 0.0,
        drag_damping_s_m: 0.0,
        load_height_m: 10.0,
        drag_exponent: 0.0,
        second: SecondMode { class_offset: 0.0, share: 0.0 },
    }
}

fn wind() -> BeamWind {
    BeamWind {
        stand: StandWind::open(MeanWind::open_country(8.0)),
        grid: OscillatorGrid::new(FrequencyClasses::default(), 0.1, 8.0, 10.0),
    }
}

fn poser(beams: &[BeamDynamics], map: &DirectionMap, to_wind: Mat3, scale: f32) -> TreePoser {
    TreePoser::new(beams, &TreeInWind { map, wind: wind(), to_wind, scale, leaf_share: 1.0 })
}

const BEAM: BeamDynamics = BeamDynamics {
    stiff_axis: Vec3::ZERO,
    base: Vec3::new(0.5, 1.0, -2.0),
    length_m: 3.0,
    direction: Vec3::new(0.36, 0.8, 0.48),
    attach: 0.0,
    parent: NO_PARENT,
    angle_limit_rad: TIP_ANGLE_LIMIT,
    compliance_rad_n_m: 1e-6,
    in_leaf: sway(0.004, 7.0),
    bare: sway(0.006, 8.0),
};

/// A trunk, a branch and a twig.
fn hierarchy() -> [BeamDynamics; 3] {
    let trunk = BeamDynamics { base: Vec3::ZERO, length_m: 6.0, direction: Vec3::Y, ..BEAM };
    let branch = BeamDynamics {
        base: Vec3::new(0.0, 4.2, 0.0),
        direction: Vec3::new(0.8, 0.6, 0.0),
        attach: 0.7,
        parent: 0,
        in_leaf: sway(0.006, 7.0),
        ..BEAM
    };
    let twig = BeamDynamics {
        base: branch.base + 0.5 * branch.length_m * branch.direction,
        length_m: 1.0,
        direction: Vec3::new(0.0, 0.28, -0.96),
        attach: 0.5,
        parent: 1,
        angle_limit_rad: TIP_ANGLE_LIMIT,
        compliance_rad_n_m: 1e-3,
        stiff_axis: Vec3::ZERO,
        in_leaf: sway(0.02, 20.0),
        bare: sway(0.02, 20.0),
    };
    [trunk, branch, twig]
}

/// A load of `pressure` m^2/s^2 along the wind.
fn steady_map(pressure: f32) -> DirectionMap {
    DirectionMap::new(65, |direction| {
        LoadCoefficients { mean: pressure * Vec3::X, moving: [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO] }
            .perpendicular_to(direction)
    })
}

fn posed(beams: &[BeamDynamics], pressure: f32) -> Vec<BeamPose> {
    posed_in(beams, pressure, Vec3::ZERO)
}

fn posed_in(beams: &[BeamDynamics], pressure: f32, wind: Vec3) -> Vec<BeamPose> {
    let poser = poser(beams, &steady_map(pressure), Mat3::IDENTITY, 1.0);
    let mut poses = vec![BeamPose::REST; beams.len()];
    poser.pose(&[], wind, &mut poses);
    poses
}

/// By how much the beams bend further than into a wind along x, at worst, rad.
fn past_the_wind(beams: &[BeamDynamics], poses: &[BeamPose]) -> f32 {
    let past = |(beam, pose): (&BeamDynamics, &BeamPose)| {
        let carried = pose.rotation * beam.direction;
        let tip = pose.carry(beam, 1.0, axis_point(beam, 1.0)).1 * beam.direction;
        carried.angle_between(tip) - carried.angle_between(Vec3::X)
    };
    beams.iter().zip(poses).map(past).fold(f32::NEG_INFINITY, f32::max)
}

#[test]
fn no_beam_bends_past_the_wind() {
    // Two orders point half downwind already, and the trunk carries them there.
    let beams = hierarchy();
    for pressure in [30.0, 300.0, 1e4, 1e20] {
        let past = past_the_wind(&beams, &posed_in(&beams, pressure, 40.0 * Vec3::X));
        assert!(past < 1e-3, "{past} rad at {pressure}");
    }
    assert!(past_the_wind(&beams, &posed(&beams, 1e4)) > 0.3, "the test has something to find");
}

#[test]
fn a_wind_holds_only_beams_that_bend_most_of_the_way_into_it() {
    let beams = hierarchy();
    let (held, free) = (posed_in(&beams, 30.0, 7.0 * Vec3::X), posed(&beams, 30.0));
    for (held, free) in held.iter().zip(&free) {
        let change = held.tip_angle.distance(free.tip_angle) / free.tip_angle.length();
        assert!(free.tip_angle.length() > 0.1 && change < 5e-4, "{change} of {}", free.tip_angle.length());
    }
    // An angle of 1 rad, held to a chord of 0.5 rad.
    let carried = Vector([1.0 - 0.125, (1.0_f32 - 0.875 * 0.875).sqrt(), 0.0]);
    let angle = held_to_wind(Vector([0.0, 0.0, 1.0]), carried, Vector([1.0, 0.0, 0.0])).length_squared().sqrt();
    assert!((angle - 257.0_f32.powf(-0.125)).abs() < 1e-4, "{angle}");
    for odd in [Vec3::NAN, Vec3::INFINITY, Vec3::splat(1e-30)] {
        assert_eq!(posed_in(&beams, 30.0, odd), free);
    }
}

fn axis_point(beam: &BeamDynamics, s: f32) -> Vec3 {
    beam.base + beam.length_m * s * beam.direction
}

/// The mode's slope by its slope at the tip, without the fit.
fn exact_slope(s: f64) -> f64 {
    let mode = CantileverMode::nth(1);
    mode.slope(s) / mode.slope(1.0)
}

#[test]
fn polynomials_match_the_exact_mode() {
    assert!((f64::from(SLOPE_TIP) - CantileverMode::nth(1).slope(1.0)).abs() < 1e-6);
    // What each integral is multiplied by at the greatest angle, in the direction of a bend.
    let t = f64::from(TIP_ANGLE_LIMIT).powi(2);
    let factors = [1.0, 1.0, t / 2.0, t / 6.0, t * t / 24.0, t * t / 120.0, t.powi(3) / 720.0];
    const STEPS: usize = 1000;
    let mut integrals = [0.0; 7];
    for step in 1..=STEPS {
        let s = step as f64 / STEPS as f64;
        let middle = exact_slope(s - 0.5 / STEPS as f64);
        let fitted = mode_shape(s as f32).map(f64::from);
        for k in 1..7 {
            integrals[k] += middle.powi(k as i32) / STEPS as f64;
            // The fit leaves 5e-5; the midpoint rule of the test less than 1e-6.
            assert!((fitted[k] - integrals[k]).abs() * factors[k] < 5e-5, "H_{k}({s})");
        }
        // The best cubic leaves 2.1e-4, a hundredth of a degree.
        assert!((fitted[0] - exact_slope(s)).abs() < 2.2e-4, "h({s})");
    }
}

#[test]
fn pose_in_a_calm_is_exactly_the_rest_pose() {
    let beams = hierarchy();
    for (pose, beam) in posed(&beams, 0.0).iter().zip(&beams) {
        assert_eq!(*pose, BeamPose::REST);
        let point = Vec3::new(0.3, 4.7, 0.1);
        assert_eq!(pose.carry(beam, 0.6, point), (point, Quat::IDENTITY));
    }
}

#[test]
fn beams_keep_their_length() {
    for angle in [0.1, 0.5, TIP_ANGLE_LIMIT] {
        let tip_angle = Vec3A::from(BEAM.direction.any_orthonormal_vector() * angle);
        let pose = BeamPose { tip_angle, ..BeamPose::REST };
        let point = |step: i32| {
            let s = step as f32 / 200.0;
            pose.carry(&BEAM, s, axis_point(&BEAM, s)).0
        };
        let length: f32 = (0..200).map(|step| point(step).distance(point(step + 1))).sum();
        // What the fits of h and its integrals leave; the polygon of 200 sides lacks (angle / 200)^2 / 24.
        assert!((length / BEAM.length_m - 1.0).abs() < 1e-3, "{length} at {angle} rad");
    }
}

#[test]
fn deflection_grows_with_the_wind_and_saturates() {
    let angles: Vec<f32> = (0..60).map(|step| posed(&[BEAM], 1.5f32.powi(step) * 0.01)[0].tip_angle.length()).collect();
    // Near the limit the rounding of f32 stops the growth.
    assert!(angles.windows(2).all(|pair| pair[1] > pair[0] || pair[0] > 0.999 * TIP_ANGLE_LIMIT));
    assert!(angles.windows(2).all(|pair| pair[1] >= pair[0] * (1.0 - 1e-6)));
    assert!(angles.iter().all(|&angle| angle <= TIP_ANGLE_LIMIT * (1.0 + 1e-6)));
    // A light wind: the deflection by length is gain times load across the beam.
    let across = (Vec3::X - BEAM.direction.x * BEAM.direction).length();
    assert!((angles[0] / (SLOPE_TIP * BEAM.in_leaf.gain * 0.01 * across) - 1.0).abs() < 1e-2);
}

/// Half as far along the stiff axis, and as far across it.
#[test]
fn a_beam_bends_less_along_its_stiff_axis() {
    // At 45 degrees from the wind.
    let to_wind = Vec3::X.reject_from(BEAM.direction).normalize();
    let beside = BEAM.direction.cross(to_wind);
    let (along, across) = ((to_wind + beside).normalize(), (to_wind - beside).normalize());
    let skew = BeamDynamics { stiff_axis: along * 0.5_f32.sqrt(), ..BEAM };
    let load = 2.0 * along + 3.0 * across;
    assert!(skew.effective_load(load).distance(along + 3.0 * across) < 1e-5);
    assert_eq!(BEAM.effective_load(load), load);
    let [even, skew] = [BEAM, skew].map(|beam| Vec3::from(posed(&[beam], 0.01)[0].tip_angle));
    let (by_axis, by_other) = (skew.dot(along) / even.dot(along), skew.dot(across) / even.dot(across));
    assert!((by_axis - 0.5).abs() < 1e-2 && (by_other - 1.0).abs() < 1e-2, "{by_axis} {by_other}");
}

#[test]
fn children_stay_attached_to_their_parents() {
    let beams = hierarchy();
    for pressure in [10.0, 300.0, 1e5] {
        let poses = posed(&beams, pressure);
        for child in 1..3 {
            let (root, _) = poses[child].carry(&beams[child], 0.0, beams[child].base);
            let parent = child - 1;
            let (attachment, turn) = poses[parent].carry(&beams[parent], beams[child].attach, beams[child].base);
            // Rounding of coordinates of some 6 m.
            assert!(root.distance(attachment) < 1e-5, "{root} is off {attachment}");
            assert!(poses[child].rotation.angle_between(turn) < 1e-3);
        }
    }
}

/// Where a point bound at `s` on beam `index` goes: the recursion of the module's documentation by numerical integration
/// of the exact mode, with true rotations, in f64.
fn slow_carry(beams: &[BeamDynamics], tip_angles: &[Vec3], index: usize, s: f32, point: DVec3) -> DVec3 {
    const STEPS: usize = 2000;
    let beam = &beams[index];
    let (direction, tip_angle) = (beam.direction.as_dvec3(), tip_angles[index].as_dvec3());
    let axis = direction.cross(tip_angle).try_normalize().unwrap_or(DVec3::X);
    let turned = |at: f64| bevy::math::DQuat::from_axis_angle(axis, exact_slope(at) * tip_angle.length());
    let (root, length, s) = (beam.base.as_dvec3(), f64::from(beam.length_m), f64::from(s));
    let step = s / STEPS as f64;
    let bent = root + (0..STEPS).map(|i| turned((i as f64 + 0.5) * step) * direction * (length * step)).sum::<DVec3>();
    let moved = turned(s) * (point - (root + length * s * direction)) + bent;
    match beams.get(beam.parent as usize) {
        Some(_) => slow_carry(beams, tip_angles, beam.parent as usize, beam.attach, moved),
        None => moved,
    }
}

#[test]
fn poses_match_the_slow_recursion() {
    let beams = hierarchy();
    for pressure in [5.0, 100.0, 1e6] {
        let poses = posed(&beams, pressure);
        let tip_angles: Vec<Vec3> = poses.iter().map(|pose| Vec3::from(pose.tip_angle)).collect();
        for (index, pose) in poses.iter().enumerate() {
            let s = 0.8;
            let point = axis_point(&beams[index], s) + Vec3::new(0.1, -0.2, 0.3);
            let (fast, _) = pose.carry(&beams[index], s, point);
            let slow = slow_carry(&beams, &tip_angles, index, s, point.as_dvec3());
            // The fits: 2e-4 rad and 5e-5 of the length for each of three beams, 10 m in all.
            assert!(fast.as_dvec3().distance(slow) < 3e-3, "beam {index}: {fast} is not {slow}");
        }
    }
}

#[test]
fn pose_turns_with_the_coordinates() {
    let turn = Quat::from_rotation_y(0.7);
    let turned = BeamDynamics { base: turn * BEAM.base, direction: turn * BEAM.direction, ..BEAM };
    let map = steady_map(60.0);
    let mut here = [BeamPose::REST];
    let mut there = [BeamPose::REST];
    let responses = vec![Vec4::new(3.0, -2.0, 5.0, 0.0); wind().grid.rows()];
    poser(&[turned], &map, Mat3::IDENTITY, 1.0).pose(&responses, Vec3::ZERO, &mut here);
    poser(&[BEAM], &map, Mat3::from_quat(turn), 1.0).pose(&responses, Vec3::ZERO, &mut there);
    let difference = here[0].tip_angle - Vec3A::from(turn * Vec3::from(there[0].tip_angle));
    assert!(difference.length() < 1e-6);
}

#[test]
fn larger_instances_use_slower_classes() {
    let grid = wind().grid;
    let mut poses = [BeamPose::REST];
    let poser = poser(&[BEAM], &steady_map(0.0), Mat3::IDENTITY, 1.22 * 1.22);
    // A tree 1.22^2 times as large sways two classes below its own.
    let is_slower = |row: &u32| *row as usize == grid.row(5, 0, 0);
    let response = |row: &u32| if is_slower(row) { Vec4::new(10.0, 0.0, 0.0, 0.0) } else { Vec4::ZERO };
    let responses: Vec<Vec4> = poser.rows().iter().map(response).collect();
    poser.pose(&responses, Vec3::ZERO, &mut poses);
    assert!(poses[0].tip_angle.length() > 0.01);
}

#[test]
fn poses_are_finite_for_any_input() {
    let mut beams = hierarchy();
    beams[0].parent = 2;
    beams[1].in_leaf.gain = f32::NAN;
    beams[2].in_leaf.gain = f32::MAX;
    beams[2].in_leaf.class = f32::NAN;
    for pose in posed(&beams, 1e30) {
        assert!(pose.tip_angle.is_finite() && pose.rotation.is_finite() && pose.translation.is_finite());
        assert!(pose.tip_angle.length() <= TIP_ANGLE_LIMIT * 1.001);
    }
    let poser = poser(&beams, &steady_map(1.0), Mat3::IDENTITY, f32::NAN);
    poser.pose(&[], Vec3::ZERO, &mut [BeamPose::REST; 1]);
    assert_eq!((poser.len(), TreePoser::default().is_empty()), (3, true));
}

#[test]
fn bare_trees_sway_in_their_own_way() {
    let map = steady_map(1.0);
    let tip = |leaf_share| {
        let tree = TreeInWind { map: &map, wind: wind(), to_wind: Mat3::IDENTITY, scale: 1.0, leaf_share };
        let mut poses = [BeamPose::REST];
        TreePoser::new(&[BEAM], &tree).pose(&[], Vec3::ZERO, &mut poses);
        poses[0].tip_angle.length()
    };
    assert!((tip(0.0) / tip(1.0) - 1.5).abs() < 1e-3);
    assert!((tip(0.5) / tip(1.0) - 1.25).abs() < 1e-3);
}
