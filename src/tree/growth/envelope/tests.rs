use proptest::prelude::*;

use super::*;
use crate::tree::tests::strategies::SHAPES;

/// The shapes' outlines as schoolbooks write them, apart from the table of quadrics.
fn written_girth_m(envelope: &Envelope, height_m: f32) -> f32 {
    let up = (height_m - envelope.base_m) / (envelope.top_m - envelope.base_m);
    envelope.radius_m
        * match envelope.shape {
            EnvelopeShape::Ellipsoid => (1.0 - (2.0 * up - 1.0).powi(2)).max(0.0).sqrt(),
            EnvelopeShape::Dome => (1.0 - up * up).max(0.0).sqrt(),
            EnvelopeShape::Cylinder => 1.0,
            EnvelopeShape::Cone => 1.0 - up,
            EnvelopeShape::Paraboloid => (1.0 - up).sqrt(),
            EnvelopeShape::InvertedCone => up,
        }
}

/// Slow oracle: walks along the ray and remembers the last place inside.
fn marched_exit_m(envelope: &Envelope, from: Vec3, direction: Vec3, step_m: f32) -> f32 {
    let inside = |point: Vec3| {
        (envelope.base_m..=envelope.top_m).contains(&point.y)
            && point.x.hypot(point.z) <= written_girth_m(envelope, point.y)
    };
    let farthest = (4.0 * envelope.top_m.max(envelope.radius_m) / step_m) as usize;
    let last = (0..farthest).rev().find(|&step| inside(from + direction * (step as f32 * step_m)));
    last.map_or(0.0, |step| step as f32 * step_m)
}

fn shapes() -> impl Strategy<Value = EnvelopeShape> {
    prop::sample::select(SHAPES.to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn exit_distances_agree_with_marching_along_the_ray(
        shape in shapes(),
        height in 0.0_f32..0.95,
        azimuth in 0.0_f32..std::f32::consts::TAU,
        elevation in -1.5_f32..1.5,
        aside in (-0.6_f32..0.6, -0.6_f32..0.6),
    ) {
        let envelope = Envelope { shape, base_m: 2.0, top_m: 14.0, radius_m: 5.0 };
        let off = Vec3::new(aside.0, 0.0, aside.1);
        let from = Vec3::Y * (height * envelope.top_m) + off * written_girth_m(&envelope, height * envelope.top_m);
        let (sin, cos) = elevation.sin_cos();
        let direction = Vec3::new(cos * azimuth.cos(), sin, cos * azimuth.sin());
        let step_m = 0.01;
        let exit_m = envelope.exit_distance_m(from, direction);
        let marched_m = marched_exit_m(&envelope, from, direction, step_m);
        // The walker is late by up to a step, and may miss a corner cut by less than a step.
        prop_assert!((exit_m - marched_m).abs() <= 3.0 * step_m, "{exit_m} against {marched_m}");
    }
}

#[test]
fn depth_runs_from_the_surface_to_the_middle() {
    let envelope = Envelope::default();
    let rim = envelope.centre() + Vec3::X * envelope.radius_m;
    assert!(envelope.depth(rim) < 1e-5);
    assert_eq!(envelope.depth(envelope.centre()), 1.0);
    assert_eq!(envelope.depth(rim * 3.0), 0.0);
    let cone = Envelope { shape: EnvelopeShape::Cone, ..envelope };
    assert_eq!(cone.depth(Vec3::Y * 5.0), 1.0);
    assert!(cone.depth(Vec3::new(cone.girth_m(5.0), 5.0, 0.0)) < 1e-5);
}

#[test]
fn outward_is_a_unit_vector_even_in_the_middle() {
    for shape in SHAPES {
        let envelope = Envelope { shape, ..Envelope::default() };
        for point in [envelope.centre(), Vec3::ZERO, Vec3::new(3.0, 7.0, -2.0)] {
            assert!((envelope.outward(point).length() - 1.0).abs() < 1e-5);
        }
    }
}

#[test]
fn the_surface_lies_at_no_depth_and_at_the_girth() {
    for shape in SHAPES {
        let envelope = Envelope { shape, ..Envelope::default() };
        for share in [0.03, 0.3, 0.5, 0.8, 0.97] {
            let height_m = envelope.base_m + share * (envelope.top_m - envelope.base_m);
            let girth_m = envelope.girth_m(height_m);
            assert!((girth_m - written_girth_m(&envelope, height_m)).abs() < 1e-3, "{shape:?}");
            let rim = Vec3::new(0.6 * girth_m, height_m, -0.8 * girth_m);
            assert!(envelope.depth(rim) < 1e-3, "{shape:?} {share}: {}", envelope.depth(rim));
            assert!(envelope.depth(rim * Vec3::new(0.5, 1.0, 0.5)) > 0.0);
        }
        assert_eq!([envelope.girth_m(0.0), envelope.girth_m(envelope.top_m + 0.1)], [0.0; 2]);
    }
}

#[test]
fn an_envelope_around_points_holds_them() {
    let points = [Vec3::new(1.0, 2.0, 0.0), Vec3::new(0.0, 9.0, 0.5), Vec3::new(-3.0, 4.0, 4.0)];
    let around = Envelope::around(EnvelopeShape::Cylinder, points);
    assert_eq!((around.base_m, around.top_m, around.radius_m), (2.0, 9.0, 5.0));
    assert!(Envelope::around(EnvelopeShape::Cone, []).validate().is_err(), "nothing has grown");
}
