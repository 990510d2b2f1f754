//! How the top of a tree moves in a wind: one period of it, and its spectrum beside the tree's own frequencies.

use bevy::math::{Mat3, Vec3, Vec4};

use super::spectrum::{Band, Transform, spectrum};
use crate::{
    dynamics::{
        BeamDynamics, FrequencyClasses, NO_PARENT,
        beam_pose::BeamPose,
        pose::{TreeInWind, TreePoser},
    },
    sway::WindResponse,
    tree::TreeModel,
    wind::Canopy,
};

/// Samples in a second: trunks and limbs are slower than half of it.
const SAMPLES_PER_S: f64 = 16.0;
/// Orders of branches whose own frequencies are told.
const ORDERS: [&str; 3] = ["trunk", "limbs", "boughs"];

/// The motion of a tree's top.
#[derive(Clone, Debug)]
pub struct TipMotion {
    /// Height of the tree, m.
    pub height_m: f32,
    /// Time, s, and how far the top is from where it rests, along the wind, m.
    pub along: Vec<[f64; 2]>,
    /// The same across it.
    pub across: Vec<[f64; 2]>,
    /// Power spectral density of the motion along the wind, m²/Hz.
    pub spectrum: Vec<Band>,
    /// The slowest natural frequency of each order of branches, Hz.
    pub own: Vec<(&'static str, f64)>,
}

/// How a tree stands in the wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandsInWind {
    /// Its foot, m.
    pub place: Vec3,
    /// Its size over that of its model.
    pub scale: f32,
    /// Its rotation.
    pub world_from_local: Mat3,
    /// The stand about it.
    pub canopy: Canopy,
    /// Share of its leaves that it has.
    pub leaf_share: f32,
}

impl TipMotion {
    /// Of a tree. None of one without wood. It takes some milliseconds: meant for the background.
    pub fn of(model: &TreeModel, response: &WindResponse, stands: &StandsInWind) -> Option<Self> {
        let StandsInWind { place, scale, world_from_local, canopy, leaf_share } = *stands;
        let (beams, rest) = stem_to_top(model)?;
        let (frame, period_s) = (response.field.frame(), response.field.period_s());
        let wind = response.beam_wind_in(&canopy);
        let to_wind = frame.wind_from_world() * world_from_local;
        let tree = TreeInWind { map: response.basis.map(), wind, to_wind, scale, leaf_share };
        let poser = TreePoser::new(&beams, &tree);
        let mut poses = vec![BeamPose::REST; beams.len()];
        let mut responses: Vec<Vec4> = Vec::new();
        let mut off_rest = |time_s: f64| {
            let place = response.place(place, time_s);
            response.table.responses(&place, poser.rows(), &mut responses);
            let blowing = response.wind_at(&wind.stand, &place, model.height_m() * scale);
            poser.pose(&responses, world_from_local.transpose() * blowing, &mut poses);
            let top = poses.last().zip(beams.last()).map_or(rest, |(pose, beam)| pose.carry(beam, 1.0, rest).0);
            to_wind * (scale * (top - rest))
        };
        let count = (period_s * SAMPLES_PER_S).round().max(1.0) as usize;
        let times_s = (0..count).map(|sample| sample as f64 * period_s / count as f64);
        let (along, across): (Vec<_>, Vec<_>) = times_s
            .map(|time_s| {
                let off = off_rest(time_s);
                ([time_s, f64::from(off.x)], [time_s, f64::from(off.z)])
            })
            .unzip();
        let spectrum = spectrum(&[Transform::new(along.iter().map(|[_, off]| *off), period_s)]);
        Some(Self {
            height_m: model.height_m() * scale,
            along,
            across,
            spectrum,
            own: own_frequencies(model, scale, leaf_share),
        })
    }
}

/// The beams from the ground to the highest end of the trunk, and that end at rest.
fn stem_to_top(model: &TreeModel) -> Option<(Vec<BeamDynamics>, Vec3)> {
    let skeleton = &model.skeleton.beams;
    let trunk = (0..skeleton.len()).filter(|index| skeleton[*index].order == 0);
    let top = trunk.max_by(|a, b| skeleton[*a].path(1.0).y.total_cmp(&skeleton[*b].path(1.0).y))?;
    let mut chain = vec![top];
    while let Some(parent) = skeleton[chain[chain.len() - 1]].parent {
        chain.push(parent as usize);
    }
    chain.reverse();
    let linked = |(place, index): (usize, &usize)| {
        let mut beam = model.beams[*index];
        beam.parent = if place == 0 { NO_PARENT } else { place as u32 - 1 };
        beam
    };
    Some((chain.iter().enumerate().map(linked).collect(), skeleton[top].path(1.0)))
}

/// The frequency of a beam, Hz.
pub fn frequency_hz(beam: &BeamDynamics, leaf_share: f32) -> f32 {
    FrequencyClasses::default().frequency_at_hz(beam.sway(leaf_share).class)
}

/// Of a tree of that size over its model's: a larger one sways more slowly.
fn own_frequencies(model: &TreeModel, scale: f32, leaf_share: f32) -> Vec<(&'static str, f64)> {
    let beams = || model.skeleton.beams.iter().zip(&model.beams);
    let slowest = |(order, name): (usize, &&'static str)| {
        let of_order = beams().filter(|(beam, _)| usize::from(beam.order) == order);
        let hz = of_order.map(|(_, beam)| frequency_hz(beam, leaf_share)).reduce(f32::min)?;
        Some((*name, f64::from(hz / scale)))
    };
    ORDERS.iter().enumerate().filter_map(slowest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        sway::SwaySettings,
        tree::{Species, mechanics::tree_sway},
        wind::{FieldSettings, WindField},
    };
    use bevy::math::{Dir2, Vec2};
    use std::sync::Arc;

    fn alone() -> StandsInWind {
        StandsInWind {
            place: Vec3::ZERO,
            scale: 1.0,
            world_from_local: Mat3::IDENTITY,
            canopy: Canopy::default(),
            leaf_share: 1.0,
        }
    }

    fn motion(speed: f32) -> (TipMotion, TreeModel) {
        motion_of(FieldSettings { speed, ..FieldSettings::default() }, &alone())
    }

    fn motion_of(wind: FieldSettings, stands: &StandsInWind) -> (TipMotion, TreeModel) {
        let field = WindField::synthesise(&wind).unwrap();
        let response = WindResponse::new(Arc::new(field), &SwaySettings::default());
        let model = TreeModel::bake(&Species::default(), 40.0, 1);
        (TipMotion::of(&model, &response, stands).unwrap(), model)
    }

    #[test]
    fn the_top_leans_with_the_wind_and_sways_with_the_trunks_frequency() {
        let (motion, model) = motion(10.0);
        let mean = motion.along.iter().map(|[_, off]| off).sum::<f64>() / motion.along.len() as f64;
        let across = motion.across.iter().map(|[_, off]| off).sum::<f64>() / motion.across.len() as f64;
        assert!(mean > 1e-3 && across.abs() < 0.5 * mean, "{mean} along, {across} across");
        let trunk = f64::from(tree_sway(&Species::default(), &model.skeleton).frequency_hz);
        assert!((motion.own[0].1 / trunk - 1.0).abs() < 0.05, "{:?}, {trunk}", motion.own);
        // In its own band the top moves more than an octave above it.
        let at = |hz: f64| {
            let distance = |band: &&Band| (band.frequency_hz / hz).ln().abs();
            motion.spectrum.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap().value
        };
        assert!(at(trunk) > 4.0 * at(2.0 * trunk));
    }

    #[test]
    fn a_tree_that_is_turned_with_the_wind_moves_as_before_and_a_larger_one_more_slowly() {
        let (own, _) = motion(10.0);
        let angle_rad = 2.0_f32;
        let direction = Dir2::new(Vec2::new(angle_rad.cos(), -angle_rad.sin())).unwrap();
        let wind = FieldSettings { speed: 10.0, direction, ..FieldSettings::default() };
        let world_from_local = Mat3::from_rotation_y(angle_rad);
        let (turned, _) = motion_of(wind.clone(), &StandsInWind { world_from_local, ..alone() });
        let reach = own.along.iter().map(|[_, off]| off.abs()).fold(0.0, f64::max);
        let difference = |(a, b): (&[f64; 2], &[f64; 2])| (a[1] - b[1]).abs();
        let worst = own.along.iter().zip(&turned.along).map(difference).fold(0.0, f64::max);
        assert!(worst < 1e-3 * reach, "{worst} of {reach}");
        let (large, _) = motion_of(wind, &StandsInWind { scale: 1.5, world_from_local, ..alone() });
        assert!((large.own[0].1 * 1.5 / own.own[0].1 - 1.0).abs() < 1e-5, "{:?} {:?}", large.own, own.own);
    }

    #[test]
    fn in_a_calm_it_rests() {
        let (motion, _) = motion(0.0);
        assert!(motion.along.iter().all(|[_, off]| off.abs() < 1e-6));
    }
}
