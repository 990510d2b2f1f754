//! What the product says of a tree.

use crate::frame::of_tree::{Place, vector};
use bevy::math::{Mat3, Vec3};
use bevy_windwood::{
    dynamics::{BeamPose, FrequencyClasses, LoadBasis, LoadBasisKind, SLOPE_TIP, TreePoser},
    tree::TreeModel,
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
        let greatest_gain = boughs.map(|(beam, _)| beam.gain).fold(f32::MIN_POSITIVE, f32::max);
        let pressure = SMALL_ANGLE / (SLOPE_TIP * greatest_gain);
        let poses = [Vec3::X, Vec3::Z].map(|wind| posed(model, pressure * wind));
        Self { model, pressure, poses }
    }

    pub fn frequency_hz(&self, beam: usize) -> f64 {
        let classes = FrequencyClasses::default();
        f64::from(classes.lowest_hz) * f64::from(classes.ratio).powf(f64::from(self.model.beams[beam].class))
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
    let poser = TreePoser::new(&model.beams, basis.map(), &FrequencyClasses::default(), Mat3::IDENTITY, 1.0);
    let mut poses = vec![BeamPose::REST; model.beams.len()];
    poser.pose(&[], &mut poses);
    poses
}
