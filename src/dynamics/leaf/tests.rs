use super::*;

const STILL: LeafResponse = LeafResponse {
    turn: 1.0,
    onset_speed_m_s: 2.0,
    full_speed_m_s: 10.0,
    flutter_angle_rad: 0.0,
    flutter_frequency_hz: 3.0,
};
const DEGREE: f32 = PI / 180.0;
const PERIOD_S: f32 = 64.0;

/// The rotation of a leaf with that axis on a branch at rest.
fn turn(response: &LeafResponse, axis: Vec3, wind: Vec3) -> Quat {
    response.rotation(&RestingLeaf { axis, phase: 0.3 }, Quat::IDENTITY, wind, 1.0, PERIOD_S)
}

/// The angle of the rotation that leads from one to the other, exact for small angles too.
fn angle_between(a: Quat, b: Quat) -> f32 {
    4.0 * (0.5 * (a - b).length().min((a + b).length())).min(1.0).asin()
}

/// Unit vectors all over the sphere, by a spiral.
fn directions(count: usize) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |k| {
        let y = 1.0 - (2.0 * k as f32 + 1.0) / count as f32;
        let (sin, cos) = (2.399_963 * k as f32).sin_cos();
        let radius = (1.0 - y * y).sqrt();
        Vec3::new(radius * cos, y, radius * sin)
    })
}

/// Unit vectors at and around one, out to a third of a radian.
fn around(axis: Vec3) -> impl Iterator<Item = Vec3> {
    [0.0, 1e-7, 1e-4, 0.003, 0.01, 0.03, 0.1, 0.3].into_iter().flat_map(move |off| tilts(off).map(move |q| q * axis))
}

/// Rotations by an angle about axes all over the sphere.
fn tilts(angle_rad: f32) -> impl Iterator<Item = Quat> {
    directions(14).map(move |axis| Quat::from_axis_angle(axis, angle_rad))
}

#[test]
fn leaves_turn_along_the_arc_to_the_wind_by_their_share() {
    for (speed, share) in [(1.9, 0.0), (6.0, 0.5), (10.0, 1.0), (80.0, 1.0)] {
        for direction in directions(200) {
            for axis in directions(50).filter(|axis| axis.angle_between(direction) < FULL_SHARE_ANGLE_RAD) {
                let expected = Quat::IDENTITY.slerp(Quat::from_rotation_arc(axis, direction), share);
                let error = angle_between(turn(&STILL, axis, speed * direction), expected);
                assert!(error < 1e-4, "{axis} in {direction} at {speed} m/s is off by {error}");
            }
        }
    }
}

#[test]
fn a_leaf_that_points_straight_upwind_does_not_turn() {
    for axis in directions(100).chain([Vec3::Y, Vec3::NEG_Y, Vec3::X, Vec3::NEG_Z]) {
        for near in around(axis).take_while(|near| near.distance(axis) < 1e-3) {
            assert!(angle_between(turn(&STILL, axis, -20.0 * near), Quat::IDENTITY) < 1e-4);
        }
    }
}

#[test]
fn a_wind_that_swings_turns_leaves_by_no_more_than_is_stated() {
    let mut worst = 0.0_f32;
    for axis in directions(60).chain([Vec3::Y, Vec3::NEG_Y]) {
        for direction in directions(400).chain(around(axis)).chain(around(-axis)) {
            let now = turn(&STILL, axis, 20.0 * direction);
            for swing in tilts(DEGREE) {
                worst = worst.max(angle_between(now, turn(&STILL, axis, 20.0 * (swing * direction))));
            }
        }
    }
    assert!(worst < 3.4 * DEGREE && worst > 3.3 * DEGREE, "{worst}");
}

#[test]
fn a_branch_that_moves_turns_its_leaves_by_no_more_than_is_stated() {
    let response = LeafResponse { flutter_angle_rad: 0.5, ..STILL };
    let mut worst = 0.0_f32;
    for axis in directions(40) {
        let leaf = RestingLeaf { axis, phase: 0.7 };
        for carried in directions(30).map(|about| Quat::from_axis_angle(about, 1.1)) {
            let at = |carried| response.rotation(&leaf, carried, Vec3::new(9.0, -2.0, 14.0), 7.7, PERIOD_S);
            worst = tilts(DEGREE).map(|tilt| angle_between(at(carried), at(tilt * carried))).fold(worst, f32::max);
        }
    }
    assert!(worst < 4.4 * DEGREE, "{worst}");
}

#[test]
fn flutter_is_fixed_to_the_leaf() {
    let response = LeafResponse { turn: 0.0, flutter_angle_rad: 0.5, ..STILL };
    for axis in directions(30).chain([Vec3::Y, Vec3::NEG_Z]) {
        let leaf = RestingLeaf { axis, phase: 0.2 };
        let at = |carried| response.rotation(&leaf, carried, 15.0 * Vec3::X, 3.3, PERIOD_S);
        let resting = at(Quat::IDENTITY);
        assert!(angle_between(resting, Quat::IDENTITY) > 0.01);
        for carried in tilts(0.8) {
            assert!(angle_between(at(carried), carried * resting) < 1e-5);
        }
    }
}

#[test]
fn flutter_is_bounded_smooth_and_periodic() {
    let response = LeafResponse { turn: 0.0, ..LeafResponse::default() };
    let leaf = RestingLeaf { axis: Vec3::Z, phase: 0.37 };
    let axis = |time_s| response.rotation(&leaf, Quat::IDENTITY, Vec3::X * 20.0, time_s, PERIOD_S) * Vec3::Z;
    let angles: Vec<f32> = (0..6400).map(|step| axis(step as f32 / 100.0).angle_between(Vec3::Z)).collect();
    let greatest = angles.iter().copied().fold(0.0, f32::max);
    assert!(greatest < 1.415 * response.flutter_angle_rad && greatest > 0.5 * response.flutter_angle_rad);
    // The fastest sine turns by 2 pi 1.414 f a second at most, about each of two axes.
    let rate = TAU * 1.414 * response.flutter_frequency_hz * response.flutter_angle_rad * 2f32.sqrt();
    for step in 0..6400 {
        let moved = axis(step as f32 / 100.0).distance(axis((step + 1) as f32 / 100.0));
        assert!(moved < rate / 100.0 * 1.01, "{moved} at step {step}");
    }
    assert!(axis(0.0).distance(axis(PERIOD_S)) < 1e-4);
}

#[test]
fn leaves_of_different_phases_differ() {
    let response = LeafResponse::default();
    let axis = |phase| {
        let leaf = RestingLeaf { axis: Vec3::Z, phase };
        response.rotation(&leaf, Quat::IDENTITY, Vec3::X * 20.0, 3.0, PERIOD_S) * Vec3::Z
    };
    assert!(axis(0.1).distance(axis(0.4)) > 0.01);
}

#[test]
fn settings_outside_their_domain_are_named() {
    assert_eq!(STILL.validate(), Ok(()));
    let error = LeafResponse { turn: 1.5, ..STILL }.validate().unwrap_err();
    assert_eq!(error.to_string(), "`turn` is 1.5, but must be 0 to 1");
    for bad in [LeafResponse { full_speed_m_s: 2.0, ..STILL }, LeafResponse { flutter_angle_rad: f32::NAN, ..STILL }] {
        assert!(bad.validate().is_err());
    }
}

#[test]
fn in_a_calm_leaves_rest_on_their_branches() {
    let carried = Quat::from_axis_angle(Vec3::X, 0.4);
    let leaf = RestingLeaf { axis: Vec3::Y, phase: 0.5 };
    assert_eq!(LeafResponse::default().rotation(&leaf, carried, Vec3::ZERO, 5.0, PERIOD_S), carried);
}

#[test]
fn any_input_gives_a_rotation() {
    let worst = [0.0, -0.0, 1e-30, 1e30, f32::MAX, f32::NAN, f32::INFINITY];
    for a in worst {
        for b in worst {
            let odd = Vec3::new(a, b, -a);
            for response in [LeafResponse::default(), LeafResponse { turn: a, flutter_frequency_hz: b, ..STILL }] {
                for leaf in [RestingLeaf { axis: Vec3::Y, phase: a }, RestingLeaf { axis: odd, phase: 0.5 }] {
                    for carried in [Quat::IDENTITY, Quat::from_xyzw(a, b, 0.0, 1.0)] {
                        assert!(response.rotation(&leaf, carried, odd, 5.0, PERIOD_S).is_finite());
                        assert!(response.rotation(&leaf, carried, 20.0 * Vec3::X, a, b).is_finite());
                    }
                }
            }
        }
    }
}
