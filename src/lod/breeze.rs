//! A tree's sway about its stem in a breeze that repeats itself: what the images of an envelope are of.
//!
//! The stem stays, for the envelope itself moves with it. Each other branch swings by a sine of one turn in the whole
//! sequence, with a phase and a heading of its own, because the image serves winds from all sides. The amplitude is that of
//! a fresh breeze's gusts: to the first order in the turbulence intensity `I = rms(u) / U` the load `|u| u` has the rms
//! `2 I U^2`, and a sine's amplitude is sqrt(2) of its rms. As in all winds, `gain` makes an angle of that; branches follow
//! without resonance. The mean wind's bend is left out: it would lean all images towards one side.

use bevy::math::{Vec2, Vec3, Vec3A};
use std::f32::consts::{SQRT_2, TAU};

use super::stem::Stem;
use crate::{
    dynamics::pose::{BeamDynamics, BeamPose, SLOPE_TIP, TreePoser},
    tree::{TreeModel, skeleton::Skeleton},
};

/// Mean speed at 10 m, m/s: the middle of a fresh breeze (Beaufort 5, 8.0 to 10.7 m/s).
pub(super) const FRESH_BREEZE_M_S: f32 = 9.4;
/// The intensity for which the basis of the loads was found ([`load_basis`](crate::dynamics::load_basis)).
const TURBULENCE_INTENSITY: f32 = 0.2;
/// Amplitude of the load `|u| u`, m^2/s^2.
const GUST_M2_S2: f32 = SQRT_2 * 2.0 * TURBULENCE_INTENSITY * FRESH_BREEZE_M_S * FRESH_BREEZE_M_S;
/// From a branch's phase and heading to the next one's, turns: 1/p and 1/p^2 of the plastic ratio p, p^3 = p + 1. As the
/// golden ratio does on a line, they fill the square of phases and headings evenly (Roberts 2018).
const STEP_TURNS: Vec2 = Vec2::new(0.754_877_7, 0.569_840_3);

/// The poses of all beams at the moment of one of `images` images. A single image is of the tree at rest.
pub(super) fn poses(model: &TreeModel, image: u32, images: u32) -> Vec<BeamPose> {
    let mut poses = vec![BeamPose::REST; model.beams.len()];
    if images > 1 {
        let angles = free_tip_angles(model, (image % images) as f32 / images as f32);
        TreePoser::bent(&model.beams, |_| Vec3::ZERO).pose_free(&angles, &mut poses);
    }
    poses
}

/// The free tip angles of all beams, rad, at a share of the sequence.
fn free_tip_angles(model: &TreeModel, moment: f32) -> Vec<Vec3A> {
    let angle = |(beam, branch): (&BeamDynamics, usize)| swing(beam, branch, moment);
    let mut angles: Vec<Vec3A> = model.beams.iter().zip(first_beams(&model.skeleton)).map(angle).collect();
    Stem::of(&model.skeleton).chain().iter().for_each(|&beam| angles[beam] = Vec3A::ZERO);
    angles
}

/// The free tip angle of a beam of a branch, rad.
fn swing(beam: &BeamDynamics, branch: usize, moment: f32) -> Vec3A {
    let turns = (branch as f32 * STEP_TURNS).fract();
    let heading = Vec2::from_angle(TAU * turns.y);
    let across = Vec3::new(heading.x, 0.0, heading.y).reject_from_normalized(beam.direction);
    let load_m2_s2 = GUST_M2_S2 * (TAU * (moment + turns.x)).sin();
    Vec3A::from(across * (SLOPE_TIP * beam.gain * load_m2_s2))
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

    const IMAGES: u32 = 5;

    fn oak() -> TreeModel {
        let species = Species::from_ron(include_str!("../../assets/species/oak.species.ron")).unwrap();
        TreeModel::bake(&species, species.age.mature_years, 1)
    }

    /// The free tip angles of all beams at all moments, as shares of their amplitudes; none for beams that stay.
    fn swings(model: &TreeModel) -> Vec<Vec<f32>> {
        let amplitude = |beam: usize| {
            let turns = first_beams(&model.skeleton)[beam] as f32 * STEP_TURNS.y;
            let heading = Vec3::new((TAU * turns).cos(), 0.0, (TAU * turns).sin());
            let row = &model.beams[beam];
            // The load of the rms that the breeze has, as a sine, on what faces it.
            SLOPE_TIP * row.gain * 50.0 * (heading - row.direction * heading.dot(row.direction))
        };
        let amplitudes: Vec<Vec3> = (0..model.beams.len()).map(amplitude).collect();
        let swings = |image: u32| {
            let angles = free_tip_angles(model, image as f32 / IMAGES as f32);
            let share =
                |(angle, amplitude): (&Vec3A, &Vec3)| Vec3::from(*angle).dot(*amplitude) / amplitude.length_squared();
            let moving =
                angles.iter().zip(&amplitudes).filter(|(angle, full)| **angle != Vec3A::ZERO && full.length() > 1e-6);
            moving.map(share).collect()
        };
        (0..IMAGES).map(swings).collect()
    }

    #[test]
    fn branches_swing_by_a_sine_of_the_breeze_and_the_stem_stays() {
        let model = oak();
        for beam in (0..IMAGES).flat_map(|image| poses(&model, image, IMAGES).into_iter().enumerate()) {
            let is_of_stem = Stem::of(&model.skeleton).chain().contains(&beam.0);
            let rests = beam.1.tip_angle == Vec3A::ZERO;
            assert!(rests || !is_of_stem);
            assert!(!rests || is_of_stem || model.beams[beam.0].gain == 0.0, "{}", beam.0);
        }
        let swings = swings(&model);
        assert!(swings[0].len() > 100);
        for branch in 0..swings[0].len() {
            // Even samples of a sine have half its squared amplitude.
            let squares: f32 = swings.iter().map(|image| image[branch].powi(2)).sum();
            assert!((squares / (0.5 * IMAGES as f32) - 1.0).abs() < 0.02, "{squares}");
        }
    }

    #[test]
    fn the_last_image_leads_to_the_first_as_any_to_the_next() {
        let model = oak();
        let swings = swings(&model);
        let expected = 1.0 - (TAU / IMAGES as f32).cos();
        for image in 0..IMAGES as usize {
            let next = &swings[(image + 1) % IMAGES as usize];
            let steps = swings[image].iter().zip(next).map(|(one, other)| (other - one).powi(2));
            let mean = steps.sum::<f32>() / next.len() as f32;
            assert!((mean / expected - 1.0).abs() < 0.1, "{image}: {mean} for {expected}");
            assert_eq!(poses(&model, image as u32 + IMAGES, IMAGES), poses(&model, image as u32, IMAGES));
        }
    }

    #[test]
    fn a_branch_swings_as_a_whole() {
        let model = oak();
        let first = first_beams(&model.skeleton);
        for (index, beam) in model.skeleton.beams.iter().enumerate() {
            let parent = beam.parent.map(|parent| parent as usize);
            let continued = parent.filter(|&parent| model.skeleton.continuations()[parent] == Some(index as u32));
            assert_eq!(first[index], continued.map_or(index, |parent| first[parent]));
        }
    }
}
