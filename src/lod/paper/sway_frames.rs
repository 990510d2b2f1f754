//! The poses of a tree in the frames of an envelope's animation: its sway about its stem in a fresh breeze, which repeats
//! itself.
//!
//! The stem stays, for the envelope itself moves with it. Each other branch swings by a sine of one turn in the whole
//! animation, with a phase and a heading of its own, because the frames serve winds from all sides. The amplitude is that
//! of a fresh breeze's gusts: to the first order in the turbulence intensity `I = rms(u) / U` the load `|u| u` has the rms
//! `2 I U^2`, and a sine's amplitude is sqrt(2) of its rms. As in all winds, `gain` makes an angle of that; branches follow
//! without resonance. The mean wind's bend is left out: it would lean all frames towards one side.

use bevy::math::{Vec2, Vec3, Vec3A};
use std::f32::consts::{SQRT_2, TAU};

use super::main_stem::MainStem;
use crate::{
    dynamics::{beam::BeamDynamics, beam_pose::BeamPose, bend::SLOPE_TIP, pose::TreePoser},
    lod::reference_wind::{MEAN_SPEED_M_S, TURBULENCE_INTENSITY},
    sequence::r2,
    tree::{TreeModel, skeleton::Skeleton},
};

/// Amplitude of the load `|u| u`, m^2/s^2.
const GUST_M2_S2: f32 = SQRT_2 * 2.0 * TURBULENCE_INTENSITY * MEAN_SPEED_M_S * MEAN_SPEED_M_S;

/// The poses of all beams in one of `frames` frames. A single frame is of the tree at rest.
pub(in crate::lod) fn poses(model: &TreeModel, frame: u32, frames: u32) -> Vec<BeamPose> {
    let mut poses = vec![BeamPose::REST; model.beams.len()];
    if frames > 1 {
        let angles = free_tip_angles(model, (frame % frames) as f32 / frames as f32);
        TreePoser::bent(&model.beams, |_| Vec3::ZERO).pose_free(&angles, Vec3::ZERO, &mut poses);
    }
    poses
}

/// The free tip angles of all beams, rad, at a share of the animation.
fn free_tip_angles(model: &TreeModel, moment: f32) -> Vec<Vec3A> {
    let angle = |(beam, branch): (&BeamDynamics, usize)| swing(beam, branch, moment);
    let mut angles: Vec<Vec3A> = model.beams.iter().zip(first_beams(&model.skeleton)).map(angle).collect();
    MainStem::of(&model.skeleton).chain().iter().for_each(|&beam| angles[beam] = Vec3A::ZERO);
    angles
}

/// The free tip angle of a beam of a branch, rad.
fn swing(beam: &BeamDynamics, branch: usize, moment: f32) -> Vec3A {
    // Evenly spread over the square of phases and headings.
    let [phase_turns, heading_turns] = r2([0.0; 2], branch);
    let heading = Vec2::from_angle(TAU * heading_turns);
    let across = Vec3::new(heading.x, 0.0, heading.y).reject_from_normalized(beam.direction);
    let load_m2_s2 = GUST_M2_S2 * (TAU * (moment + phase_turns)).sin();
    Vec3A::from(across * (SLOPE_TIP * beam.in_leaf.open_country_gain() * load_m2_s2))
}

/// For each beam the first one of its branch: a branch sways as a whole.
fn first_beams(skeleton: &Skeleton) -> Vec<usize> {
    let mut first: Vec<usize> = (0..skeleton.beams.len()).collect();
    for (beam, next) in skeleton.continuations().into_iter().enumerate() {
        if let Some(next) = next {
            first[next as usize] = first[beam];
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::Species;

    const FRAMES: u32 = 5;

    fn oak() -> TreeModel {
        let species = Species::from_ron(include_str!("../../../assets/species/oak.species.ron")).unwrap();
        TreeModel::bake(&species, species.age.mature_years, 1)
    }

    /// The free tip angles of all beams in all frames, as shares of their amplitudes; none for beams that stay.
    fn swings(model: &TreeModel) -> Vec<Vec<f32>> {
        let amplitude = |beam: usize| {
            // The second step of Roberts' R2 sequence.
            let turns = first_beams(&model.skeleton)[beam] as f64 * 0.569_840_290_998_053_3;
            let heading_rad = TAU * turns.fract() as f32;
            let heading = Vec3::new(heading_rad.cos(), 0.0, heading_rad.sin());
            let row = &model.beams[beam];
            // The load of the rms that the breeze has, as a sine, on what faces it.
            SLOPE_TIP * row.in_leaf.open_country_gain() * 50.0 * (heading - row.direction * heading.dot(row.direction))
        };
        let amplitudes: Vec<Vec3> = (0..model.beams.len()).map(amplitude).collect();
        let swings = |frame: u32| {
            let angles = free_tip_angles(model, frame as f32 / FRAMES as f32);
            let share =
                |(angle, amplitude): (&Vec3A, &Vec3)| Vec3::from(*angle).dot(*amplitude) / amplitude.length_squared();
            let moving =
                angles.iter().zip(&amplitudes).filter(|(angle, full)| **angle != Vec3A::ZERO && full.length() > 1e-6);
            moving.map(share).collect()
        };
        (0..FRAMES).map(swings).collect()
    }

    #[test]
    fn branches_swing_by_a_sine_of_the_breeze_and_the_stem_stays() {
        let model = oak();
        for beam in (0..FRAMES).flat_map(|frame| poses(&model, frame, FRAMES).into_iter().enumerate()) {
            let is_of_stem = MainStem::of(&model.skeleton).chain().contains(&beam.0);
            let rests = beam.1.tip_angle == Vec3A::ZERO;
            assert!(rests || !is_of_stem);
            assert!(!rests || is_of_stem || model.beams[beam.0].in_leaf.gain == 0.0, "{}", beam.0);
        }
        let swings = swings(&model);
        assert!(swings[0].len() > 100);
        for branch in 0..swings[0].len() {
            // Even samples of a sine have half its squared amplitude.
            let squares: f32 = swings.iter().map(|frame| frame[branch].powi(2)).sum();
            assert!((squares / (0.5 * FRAMES as f32) - 1.0).abs() < 0.02, "{squares}");
        }
    }

    #[test]
    fn the_animation_repeats_without_a_jump() {
        let model = oak();
        let swings = swings(&model);
        let expected = 1.0 - (TAU / FRAMES as f32).cos();
        for frame in 0..FRAMES as usize {
            let next = &swings[(frame + 1) % FRAMES as usize];
            let steps = swings[frame].iter().zip(next).map(|(one, other)| (other - one).powi(2));
            let mean = steps.sum::<f32>() / next.len() as f32;
            assert!((mean / expected - 1.0).abs() < 0.1, "{frame}: {mean} for {expected}");
            assert_eq!(poses(&model, frame as u32 + FRAMES, FRAMES), poses(&model, frame as u32, FRAMES));
        }
    }

    #[test]
    fn all_beams_of_a_branch_have_one_first_beam() {
        let model = oak();
        let first = first_beams(&model.skeleton);
        for (index, beam) in model.skeleton.beams.iter().enumerate() {
            let parent = beam.parent.map(|parent| parent as usize);
            let continued = parent.filter(|&parent| model.skeleton.continuations()[parent] == Some(index as u32));
            assert_eq!(first[index], continued.map_or(index, |parent| first[parent]));
        }
    }
}
