use super::*;
use crate::dynamics::{
    LiveBeam, LiveSteps, LiveTree, TreePoser,
    beam::{BeamSway, BeamWind},
    live::BeamLoad,
    test_beams,
};

fn wind() -> BeamWind {
    test_beams::wind(5.0)
}

fn beam(base: Vec3, direction: Vec3, length_m: f32, compliance_rad_n_m: f32, class: f32) -> BeamDynamics {
    let sway = BeamSway { gain: 1e-4, class, load_height_m: 1.0, ..BeamSway::default() };
    BeamDynamics { base, direction, attach: 0.5, compliance_rad_n_m, ..test_beams::upright(sway, length_m) }
}

/// A stiff trunk of 4 m with a branch of 2 m along x halfway up, and a twig at the end of that.
fn tree() -> Vec<BeamDynamics> {
    let trunk = beam(Vec3::ZERO, Vec3::Y, 4.0, 1e-5, 15.0);
    let branch = BeamDynamics { parent: 0, ..beam(Vec3::Y * 2.0, Vec3::X, 2.0, 5e-3, 18.0) };
    let twig = BeamDynamics { parent: 1, attach: 1.0, ..beam(Vec3::new(2.0, 2.0, 0.0), Vec3::X, 0.5, 0.3, 24.0) };
    vec![trunk, branch, twig]
}

/// A tree that is touched, and what it is posed with.
struct Touched {
    beams: Vec<BeamDynamics>,
    prepared: Vec<LiveBeam>,
    poser: TreePoser,
    live: LiveTree,
}

impl Touched {
    fn new(beams: Vec<BeamDynamics>) -> Self {
        let wind = wind();
        let prepared: Vec<LiveBeam> = beams.iter().map(|beam| LiveBeam::new(beam, &wind, 1.0, 1.0)).collect();
        let (poser, live) = (TreePoser::bent(&beams, |_| Vec3::ZERO), LiveTree::new(&prepared, &wind.grid));
        Self { beams, prepared, poser, live }
    }

    fn poses(&self) -> Vec<BeamPose> {
        let mut poses = vec![BeamPose::REST; self.beams.len()];
        self.poser.pose_free(&self.live.angles().collect::<Vec<_>>(), Vec3::ZERO, &mut poses);
        poses
    }

    fn frame(&mut self, frame_s: f64, body: Option<(Capsule, f32)>) {
        let steps = LiveSteps::new(&wind().grid, frame_s).expect("time passes");
        self.live.step(&self.prepared, &steps, |_, _| BeamLoad::NONE);
        if let Some((body, most_n)) = body {
            let poses = self.poses();
            Contacts { beams: &self.beams, poses: &poses, scale: 1.0 }.push(&mut self.live, &body, most_n);
        }
    }

    fn tip(&self, beam: usize) -> Vec3 {
        let rest = &self.beams[beam];
        self.poses()[beam].carry(rest, 1.0, rest.base + rest.direction * rest.length_m).0
    }
}

fn ball(at: Vec3, radius_m: f32) -> Capsule {
    Capsule { ends: [at, at], radius_m }
}

/// A force on a cantilever of even stiffness turns the place where it acts by F x^2 / 2 EI.
#[test]
fn a_force_turns_a_beam_as_beam_theory_says() {
    let beams = tree();
    for s in [0.3, 1.0] {
        let mut shares = Vec::new();
        Struck::new(&beams, 1, s).shares(&beams, Vec3A::Z, 1.0, |share| shares.push(share));
        let x = 2.0 * s;
        let ei = 2.0 / 5e-3;
        assert!((shares[0].angle - Vec3A::Z * (x * x / (2.0 * ei))).length() < 1e-7);
        // The trunk is bent up to 2 m by a force that is at that height, and twists out of its way.
        let trunk = shares[1].angle;
        assert!((trunk - Vec3A::Z * (2.0 * 2.0 / (2.0 * (4.0 / 1e-5)))).length() < 1e-9, "{trunk}");
    }
}

#[test]
fn a_blow_strikes_the_nearest_beam_and_those_that_bear_it() {
    let mut touched = Touched::new(tree());
    strike(&mut touched.live, &touched.beams, 1.0, Vec3::new(1.9, 2.1, 0.1), Vec3::Z * 0.5);
    touched.frame(0.02, None);
    let angles: Vec<Vec3A> = touched.live.angles().collect();
    assert!(angles[1].z > 100.0 * angles[0].z.abs() && angles[0].z > 0.0 && angles[2] == Vec3A::ZERO, "{angles:?}");
    for odd in [Vec3::NAN, Vec3::ZERO, Vec3::INFINITY] {
        let before: Vec<Vec3A> = touched.live.angles().collect();
        strike(&mut touched.live, &touched.beams, 1.0, Vec3::X, odd);
        strike(&mut touched.live, &touched.beams, f32::NAN, odd, Vec3::X);
        assert_eq!(before, touched.live.angles().collect::<Vec<_>>());
    }
}

#[test]
fn a_ball_moves_a_branch_out_of_its_way_at_any_frame_rate() {
    for frame_s in [1.0 / 240.0, 1.0 / 60.0, 0.2] {
        let mut touched = Touched::new(tree());
        let mut deepest_m = 0.0_f32;
        for frame in 0..(4.0 / frame_s) as u32 {
            // It comes from the side, and stays 0.2 m past where the branch was.
            let z = (-0.8 + 0.5 * frame as f32 * frame_s as f32).min(0.0);
            let body = ball(Vec3::new(1.7, 2.0, z), 0.2);
            touched.frame(frame_s, Some((body, 300.0)));
            if frame as f32 * frame_s as f32 > 2.5 {
                let contacts = Contacts { beams: &touched.beams, poses: &touched.poses(), scale: 1.0 };
                let depth = (0..3).filter_map(|beam| contacts.axis(beam)).map(|axis| {
                    let nearest = nearest_points(axis, body.ends);
                    0.2 - nearest.on_first.distance(nearest.on_second)
                });
                deepest_m = depth.fold(deepest_m, f32::max);
            }
        }
        assert!(deepest_m < 0.02, "{frame_s}: {deepest_m} m deep");
        let aside_m = touched.tip(1).distance(Vec3::new(2.0, 2.0, 0.0));
        assert!(aside_m > 0.15 && touched.tip(0).distance(Vec3::Y * 4.0) < 0.02, "{aside_m}");
        // It springs back once the ball has gone.
        for _ in 0..(30.0 / frame_s) as u32 {
            touched.frame(frame_s, None);
        }
        assert!(touched.live.is_still(1e-3) && touched.tip(1).distance(Vec3::new(2.0, 2.0, 0.0)) < 2e-3);
    }
}

#[test]
fn a_body_bends_nothing_further_than_its_force_does() {
    let mut touched = Touched::new(tree());
    for _ in 0..200 {
        touched.frame(1.0 / 60.0, Some((ball(Vec3::new(0.0, 3.8, 0.05), 0.4), 200.0)));
    }
    let most = 1e-5 * 0.95 * 0.5 * 3.8 * 200.0;
    let trunk = touched.live.angle(0).length();
    assert!(trunk > 0.2 * most && trunk <= most * 1.001, "{trunk} against {most}");
}

#[test]
fn bodies_that_are_no_bodies_push_nothing() {
    let mut touched = Touched::new(tree());
    for odd in [f32::NAN, f32::INFINITY, -1.0, 1e30] {
        for body in [ball(Vec3::splat(odd), 0.3), ball(Vec3::new(1.0, 2.0, 0.0), odd)] {
            touched.frame(1.0 / 60.0, Some((body, 100.0)));
            touched.frame(1.0 / 60.0, Some((body, odd)));
            assert!(touched.live.angles().all(Vec3A::is_finite), "{odd}");
        }
    }
    let centred = ball(Vec3::new(1.0, 2.0, 0.0), 0.3);
    touched.frame(1.0 / 60.0, Some((centred, 100.0)));
    assert!(touched.live.angles().all(Vec3A::is_finite));
}

/// By search over both segments.
#[test]
fn nearest_points_of_segments_are_found() {
    let at = |[a, b]: [Vec3; 2], t: f32| a.lerp(b, t);
    let steps = || (0..=100).map(|step| step as f32 * 0.01);
    for k in 0..40 {
        let k = k as f32;
        let point = |n: f32| Vec3::new((k * 1.7 + n).sin(), (k * 0.9 + 2.0 * n).cos(), (k * 0.3 + 3.0 * n).sin());
        let (first, second) = ([point(0.0), point(1.0)], [point(2.0), if k < 5.0 { point(2.0) } else { point(3.0) }]);
        let found = nearest_points(first, second);
        let found_m = found.on_first.distance(found.on_second);
        let least_m = steps()
            .flat_map(|t| steps().map(move |u| at(first, t).distance(at(second, u))))
            .fold(f32::INFINITY, f32::min);
        assert!(found_m <= least_m + 1e-6 && found_m > least_m - 0.02, "{found_m} against {least_m}");
        assert!(at(first, found.first).distance(found.on_first) < 1e-5);
    }
}
