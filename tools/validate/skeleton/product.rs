//! What the product says of a tree.

use super::elements::{REFERENCE_HEIGHT_M, ROUGHNESS_M};
use crate::frame::{
    modes::Mode,
    of_tree::{Place, vector},
};
use bevy::math::{Mat3, Vec3};
use bevy_windwood::{
    dynamics::{
        BeamDynamics, BeamPose, BeamSway, BeamWind, DRAG_SPEED_M_S, FrequencyClasses, LoadBasis, LoadBasisKind,
        MeanWind, OscillatorGrid, SLOPE_TIP, StandWind, TreeInWind, TreePoser,
    },
    tree::TreeModel,
    wind::LogProfile,
};
use nalgebra::Vector3;

/// Tip angle up to which trunk and main branches are bent, rad: small enough for their law to be linear, and great beside the rounding of f32.
const SMALL_ANGLE: f32 = 0.02;

/// A tree, posed in a small pressure along x and along z.
pub struct Product<'a> {
    model: &'a TreeModel,
    pressure: f32,
    poses: [Vec<BeamPose>; 2],
}

impl<'a> Product<'a> {
    pub fn new(model: &'a TreeModel) -> Self {
        let boughs = model.beams.iter().zip(&model.skeleton.beams).filter(|(_, beam)| beam.order <= 1);
        let greatest_gain = boughs.map(|(beam, _)| beam.in_leaf.gain).fold(f32::MIN_POSITIVE, f32::max);
        let pressure = SMALL_ANGLE / (SLOPE_TIP * greatest_gain);
        let poses = [Vec3::X, Vec3::Z].map(|wind| posed(model, pressure * wind));
        Self { model, pressure, poses }
    }

    /// The natural frequencies of a beam, one or two, Hz, and the share of each in its deflection.
    pub fn modes(&self, beam: usize) -> Vec<Mode> {
        let classes = FrequencyClasses::default();
        let BeamSway { class, second, .. } = self.model.beams[beam].in_leaf;
        let mode = |class: f32, share: f32| Mode {
            frequency_hz: f64::from(classes.frequency_at_hz(class)),
            share: f64::from(share),
        };
        let both = [mode(class, 1.0 - second.share), mode(class + second.class_offset, second.share)];
        both[..if second.share > 0.0 { 2 } else { 1 }].to_vec()
    }

    /// The frequency by which gusts move it furthest, Hz.
    pub fn frequency_hz(&self, beam: usize) -> f64 {
        self.modes(beam)[0].frequency_hz
    }

    /// The frequency at which it begins to resonate, Hz.
    pub fn onset_hz(&self, beam: usize) -> f64 {
        self.modes(beam).iter().map(|mode| mode.share / mode.frequency_hz.powi(2)).sum::<f64>().sqrt().recip()
    }

    /// Where a level wind moves a place, m by m^2/s^2.
    pub fn deflection(&self, place: Place, wind: Vector3<f64>) -> Vector3<f64> {
        self.combined(wind, |poses| self.moved(poses, place) - self.at_rest(place))
    }

    /// The same as seen from the root of the chain that begins with the beam `first`.
    pub fn bend(&self, first: usize, place: Place, wind: Vector3<f64>) -> Vector3<f64> {
        self.combined(wind, |poses| {
            let root = &poses[first];
            let carried = root.rotation.inverse() * (self.moved(poses, place) - Vec3::from(root.translation));
            carried - self.at_rest(place)
        })
    }

    fn combined(&self, wind: Vector3<f64>, of: impl Fn(&[BeamPose]) -> Vec3) -> Vector3<f64> {
        let [x, z] = self.poses.each_ref().map(|poses| vector(of(poses)) / f64::from(self.pressure));
        x * wind.x + z * wind.z
    }

    fn moved(&self, poses: &[BeamPose], place: Place) -> Vec3 {
        poses[place.beam].carry(&self.model.beams[place.beam], place.s as f32, self.at_rest(place)).0
    }

    fn at_rest(&self, place: Place) -> Vec3 {
        let beam = &self.model.beams[place.beam];
        beam.base + beam.direction * (beam.length_m * place.s as f32)
    }
}

/// The tree in a uniform, steady load: its part across each beam bends it.
fn posed(model: &TreeModel, pressure: Vec3) -> Vec<BeamPose> {
    let basis = LoadBasis::new(LoadBasisKind::Principal, &[pressure], move |_, _| pressure);
    // The profile of the finite elements' load, and a drag that grows with the square of the speed.
    let mean =
        MeanWind::new(&LogProfile::from_reference(DRAG_SPEED_M_S, ROUGHNESS_M as f32, 0.0), REFERENCE_HEIGHT_M as f32);
    let quadratic = |beam: &BeamDynamics| {
        let in_leaf = BeamSway { drag_exponent: 0.0, ..beam.in_leaf };
        BeamDynamics { in_leaf, bare: in_leaf, ..*beam }
    };
    let beams: Vec<BeamDynamics> = model.beams.iter().map(quadratic).collect();
    let grid = OscillatorGrid::new(FrequencyClasses::default(), 0.05, DRAG_SPEED_M_S, 10.0);
    let wind = BeamWind { stand: StandWind::open(mean), grid };
    let tree = TreeInWind { map: basis.map(), wind, to_wind: Mat3::IDENTITY, scale: 1.0, leaf_share: 1.0 };
    let poser = TreePoser::new(&beams, &tree);
    let mut poses = vec![BeamPose::REST; model.beams.len()];
    poser.pose(&[], Vec3::ZERO, &mut poses);
    poses
}
