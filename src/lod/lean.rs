//! How far a tree leans as a whole, for pictures of it, which can lean but not bend.
//!
//! A picture keeps its foot and has each place moved downwind by a share of its height, the sine of its lean. That sine
//! saturates as the tip angle of a beam does ([`pose`](crate::dynamics::pose)). Its gain makes the lean of the picture, in
//! the pressure of a fresh breeze's mean wind, the one nearest to where all corners of the tree are then (least squares).

use bevy::math::Vec3;

use super::{breeze::FRESH_BREEZE_M_S, scene::Scene};
use crate::{
    dynamics::pose::{BeamDynamics, BeamPose, SLOPE_TIP, TIP_ANGLE_LIMIT, TreePoser},
    tree::TreeModel,
};

/// Pressure that corners are compared under, m^2/s^2.
const PRESSURE_M2_S2: f32 = FRESH_BREEZE_M_S * FRESH_BREEZE_M_S;

/// How a tree leans.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lean {
    /// Sine of the lean for a unit of the pressure across the stem, before it saturates, s^2/m^2.
    pub gain: f32,
    /// Frequency class of the stem's lowest beam, as that of a [beam](BeamDynamics).
    pub class: f32,
}

impl Lean {
    /// Of a model, the `scene` being that model at rest.
    #[must_use]
    pub fn of(scene: &Scene, model: &TreeModel) -> Self {
        let Some(root) = model.beams.first() else { return Self::default() };
        let sine = 0.5 * [Vec3::X, Vec3::Z].map(|heading| sine(scene, model, heading)).iter().sum::<f32>();
        let limit = TIP_ANGLE_LIMIT.sin();
        let sine = sine.clamp(0.0, 0.95 * limit);
        // The sine before it saturates.
        let free = sine / (1.0 - (sine / limit).powi(2)).sqrt();
        Self { gain: free / PRESSURE_M2_S2, class: root.class }
    }
}

/// The lean that comes nearest to a tree under a pressure along `heading`.
fn sine(scene: &Scene, model: &TreeModel, heading: Vec3) -> f32 {
    let bent = bent(scene, model, heading);
    let pairs = || scene.corners.iter().zip(&bent.corners).map(|(rest, bent)| (rest.position, bent.position));
    let moved: f32 = pairs().map(|(rest, bent)| (bent - rest).dot(heading) * rest.y).sum();
    let heights: f32 = pairs().map(|(rest, _)| rest.y * rest.y).sum();
    moved / heights.max(1e-6)
}

pub(super) fn bent(scene: &Scene, model: &TreeModel, heading: Vec3) -> Scene {
    let free =
        |beam: &BeamDynamics| heading.reject_from_normalized(beam.direction) * (SLOPE_TIP * beam.gain * PRESSURE_M2_S2);
    let mut poses = vec![BeamPose::REST; model.beams.len()];
    TreePoser::bent(&model.beams, free).pose(&[], &mut poses);
    scene.posed(model, &poses)
}
