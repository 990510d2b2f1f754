//! The motion in a GLB against the poses of the crate.

use super::{OAK, WIND, glb_reader::Reader};
use crate::{
    dynamics::{
        beam_pose::BeamPose,
        pose::{TreeInWind, TreePoser},
    },
    export::{ExportSettings, MotionSettings, tree_glb},
};
use bevy::math::{Mat4, Vec3};

/// The poses that the crate gives a tree at the origin at a time.
fn poses(time_s: f64) -> Vec<BeamPose> {
    let model = &OAK.model;
    let tree = TreeInWind {
        map: WIND.basis.map(),
        wind: WIND.beam_wind(),
        to_wind: WIND.field.frame().wind_from_world(),
        scale: 1.0,
        leaf_share: model.leaf_season.share(ExportSettings::default().year),
    };
    let poser = TreePoser::new(&model.beams, &tree);
    let (mut responses, mut poses) = (Vec::new(), vec![BeamPose::REST; model.beams.len()]);
    WIND.table.responses(&WIND.place(Vec3::ZERO, time_s), poser.rows(), &mut responses);
    poser.pose(&responses, tree.to_wind.transpose() * Vec3::X, &mut poses);
    poses
}

fn reader(motion: MotionSettings) -> Reader {
    let settings = ExportSettings { motion, ..ExportSettings::default() };
    Reader::new(&tree_glb(&OAK.tree(), &settings, Some(&WIND)).unwrap())
}

/// Where the crate has the tip of the beam of each joint but the first.
fn tips(reader: &Reader, poses: &[BeamPose]) -> Vec<Vec3> {
    let beam = |name: &str| name.strip_prefix("beam ").unwrap().parse::<usize>().unwrap();
    let joints = reader.joints();
    let beams = joints[1..].iter().map(|(joint, _)| beam(joint.name().unwrap()));
    let tip = |beam: usize| {
        let rest = &OAK.model.beams[beam];
        poses[beam].carry(rest, 1.0, rest.base + rest.length_m * rest.direction).0
    };
    beams.map(tip).collect()
}

fn places(matrices: &[Mat4]) -> Vec<Vec3> {
    matrices[1..].iter().map(|matrix| matrix.w_axis.truncate()).collect()
}

fn greatest_distance(a: &[Vec3], b: &[Vec3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
}

#[test]
fn joints_follow_the_tips_of_their_beams() {
    let motion = MotionSettings { loop_s: 8.0, fade_s: 2.0, start_s: 31.0, ..MotionSettings::default() };
    let reader = reader(motion);
    let keys = reader.keys();
    let (mut at_keys, mut between, mut moved) = (0.0_f32, 0.0_f32, 0.0_f32);
    let rest = tips(&reader, &vec![BeamPose::REST; OAK.model.beams.len()]);
    for step in 0..60 {
        for (half, worst) in [(0.0, &mut at_keys), (0.5, &mut between)] {
            let time_s = (f64::from(step) * 3.0 + half) / f64::from(motion.rate_hz);
            let expected = tips(&reader, &poses(motion.start_s + time_s));
            let found = places(&reader.joint_matrices(&keys, time_s as f32));
            *worst = worst.max(greatest_distance(&found, &expected));
            moved = moved.max(greatest_distance(&expected, &rest));
        }
    }
    println!("tips of {} joints move up to {moved} m; at keys {at_keys} m, between {between} m", keys.len());
    assert!(moved > 0.1);
    assert!(at_keys < 1e-4, "{at_keys} m");
    assert!(between < 0.01 * moved, "{between} m of {moved} m");
}

/// A loop of the wind's own period is the motion itself, at its end too.
#[test]
fn a_whole_period_needs_no_fade() {
    let period_s = WIND.table.period_s();
    let reader = reader(MotionSettings { joints: 8, loop_s: 3000.0, rate_hz: 4.0, ..MotionSettings::default() });
    let keys = reader.keys();
    assert_eq!(f64::from(*keys[1].times_s.last().unwrap()), period_s);
    for time_s in [0.0, period_s - 0.25, period_s] {
        let found = places(&reader.joint_matrices(&keys, time_s as f32));
        let apart_m = greatest_distance(&found, &tips(&reader, &poses(time_s)));
        assert!(apart_m < 1e-3, "{apart_m} m at {time_s} s");
    }
}

/// Vertices bound to few joints against each vertex carried by its own beam.
#[test]
fn a_skin_moves_vertices_nearly_as_all_beams_do() {
    let shares = [8, 32, 64, 128].map(|joints| {
        let motion = MotionSettings { joints, ..MotionSettings::default() };
        let reader = reader(motion);
        let keys = reader.keys();
        let wood = reader.primitive("oak", "bark").unwrap();
        let (positions, influences) = (reader.positions(&wood), reader.influences(&wood));
        let inverse = reader.inverse_binds();
        let (mut error, mut motion_m2, mut worst) = (0.0_f64, 0.0_f64, 0.0_f32);
        for time_s in [1.0, 3.0, 5.0, 7.0, 9.0, 11.0_f32] {
            let matrices: Vec<Mat4> = reader
                .joint_matrices(&keys, time_s)
                .iter()
                .zip(&inverse)
                .map(|(joint, inverse)| *joint * *inverse)
                .collect();
            let poses = poses(f64::from(time_s));
            for ((rest, influences), sway) in positions.iter().zip(&influences).zip(&OAK.model.wood.sway) {
                let rest = Vec3::from_array(*rest);
                let skinned: Vec3 =
                    influences.iter().map(|(joint, weight)| *weight * matrices[*joint].transform_point3(rest)).sum();
                let beam = sway[0] as usize;
                let exact = poses[beam].carry(&OAK.model.beams[beam], sway[1], rest).0;
                error += f64::from(skinned.distance_squared(exact));
                motion_m2 += f64::from(rest.distance_squared(exact));
                worst = worst.max(skinned.distance(exact));
            }
        }
        let share = (error / motion_m2).sqrt();
        println!("{joints} joints: {:.1}% of the motion, at most {worst} m", 100.0 * share);
        share
    });
    assert!(shares.is_sorted_by(|fewer, more| fewer >= more), "{shares:?}");
    assert!(shares[2] < 0.15, "{shares:?}");
}
