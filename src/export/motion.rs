//! The sway of a tree as a loop: the free tip angles of all beams, key by key, and from them the poses.
//!
//! The wind is periodic, and so is what trees do in it. A loop as long as its period is that motion itself. A shorter one is a stretch of
//! it that is closed by [`looped`]; its loads are mixed before beams saturate, as those of two winds are.

use super::{
    joints::chosen_beams,
    looped::looped,
    settings::MotionSettings,
    skin::{Skin, tip},
};
use crate::{
    dynamics::{
        beam_pose::BeamPose,
        pose::{TreeInWind, TreePoser},
    },
    sway::WindResponse,
    tree::TreeModel,
};
use bevy::math::{Quat, Vec3, Vec3A};

/// How many moments the angles of beams are averaged over, to choose joints.
const MOMENTS: usize = 32;

/// The sway of a tree at the origin, in the open.
pub(super) struct SwayLoop<'a> {
    model: &'a TreeModel,
    poser: TreePoser,
    /// Where the mean wind blows to, in the tree's coordinates.
    downwind: Vec3,
    /// Free tip angles, one a beam, for each key but the last, which is the first again.
    angles: Vec<Vec<Vec3A>>,
    /// Times of the keys, the last the length of the loop, s.
    pub times_s: Vec<f32>,
}

/// The poses of a joint relative to its parent, key by key: unit quaternions, and places, m.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct JointMotion {
    pub rotations: Vec<[f32; 4]>,
    pub translations: Vec<[f32; 3]>,
}

impl<'a> SwayLoop<'a> {
    /// The loop of a model that stands in a wind and has its leaves of that time of the year.
    pub fn new(model: &'a TreeModel, wind: &WindResponse, year: f32, settings: &MotionSettings) -> Self {
        let period_s = wind.table.period_s();
        let is_whole = f64::from(settings.loop_s) >= period_s;
        let loop_s = if is_whole { period_s } else { f64::from(settings.loop_s) };
        let keys = (loop_s * f64::from(settings.rate_hz)).round().max(2.0) as usize;
        let step_s = loop_s / keys as f64;
        let before =
            if is_whole { 0 } else { ((f64::from(settings.fade_s) / step_s).round() as usize).clamp(1, keys / 2) };
        let tree = TreeInWind {
            map: wind.basis.map(),
            wind: wind.beam_wind(),
            to_wind: wind.field.frame().wind_from_world(),
            scale: 1.0,
            leaf_share: model.leaf_season.share(year),
        };
        let poser = TreePoser::new(&model.beams, &tree);
        let downwind = tree.to_wind.transpose() * Vec3::X;
        let mut responses = Vec::new();
        let angles_at = |key: usize| {
            let time_s = settings.start_s + (key as f64 - before as f64) * step_s;
            wind.table.responses(&wind.place(Vec3::ZERO, time_s), poser.rows(), &mut responses);
            let mut angles = vec![Vec3A::ZERO; model.beams.len()];
            poser.add_free_angles(&responses, 1.0, &mut angles);
            angles
        };
        let stretch: Vec<Vec<Vec3A>> = (0..keys + before).map(angles_at).collect();
        let times_s = (0..=keys).map(|key| (loop_s * key as f64 / keys as f64) as f32).collect();
        let angles = if is_whole { stretch } else { looped(&stretch, before) };
        Self { model, poser, downwind, angles, times_s }
    }

    /// The poses of all beams at a key.
    pub fn pose(&self, key: usize, poses: &mut Vec<BeamPose>) {
        poses.resize(self.model.beams.len(), BeamPose::REST);
        self.poser.pose_free(&self.angles[key % self.angles.len()], self.downwind, poses);
    }

    /// A skin of at most so many joints for this sway.
    pub fn skin(&self, joints: u32) -> Skin {
        let mut squares = vec![0.0_f32; self.model.beams.len()];
        let mut poses = Vec::new();
        for moment in 0..MOMENTS {
            self.pose(moment * self.angles.len() / MOMENTS, &mut poses);
            squares
                .iter_mut()
                .zip(&poses)
                .for_each(|(sum, pose)| *sum += pose.tip_angle.length_squared() / MOMENTS as f32);
        }
        Skin::new(self.model, &chosen_beams(self.model, &squares, joints as usize - 1))
    }

    /// The motion of each joint of a skin but the first, which rests.
    pub fn joint_motions(&self, skin: &Skin) -> Vec<JointMotion> {
        let mut motions = vec![JointMotion::default(); skin.joints.len() - 1];
        let (mut poses, mut places) = (Vec::new(), Vec::new());
        for key in 0..self.times_s.len() {
            self.pose(key, &mut poses);
            joint_places(self.model, skin, &poses, &mut places);
            for ((joint, place), motion) in skin.joints.iter().zip(&places).skip(1).zip(&mut motions) {
                let (parent_place, parent_rotation) = places[joint.parent.unwrap_or(0)];
                let (place, rotation) = *place;
                let upright = parent_rotation.conjugate();
                let turned = (upright * rotation).normalize();
                // Both signs are the same rotation; with this one, keys that are near to each other have numbers that are.
                let turned = if turned.w < 0.0 { -turned } else { turned };
                motion.rotations.push(turned.to_array());
                motion.translations.push((upright * (place - parent_place)).to_array());
            }
        }
        motions
    }
}

/// Where the joints of a skin are in a pose of all beams, tree-local, m, and how they are turned.
pub(super) fn joint_places(model: &TreeModel, skin: &Skin, poses: &[BeamPose], places: &mut Vec<(Vec3, Quat)>) {
    places.clear();
    places.extend(skin.joints.iter().map(|joint| match joint.beam {
        None => (Vec3::ZERO, Quat::IDENTITY),
        Some(beam) => {
            let rest = &model.beams[beam as usize];
            poses[beam as usize].carry(rest, 1.0, tip(rest))
        }
    }));
}
