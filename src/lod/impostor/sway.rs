//! How an impostor sways: as a picture it can lean, but not bend.
//!
//! Its foot stays, and each place moves downwind by a share of its height: the sine of its lean. That sine saturates as the
//! tip angle of a beam does ([`pose`](crate::dynamics::pose)). The gain is chosen so that the leaning picture is nearest to
//! where all vertices of the tree are in the pressure of a fresh breeze's mean wind (least squares).

use bevy::math::Vec3;

use crate::{
    dynamics::{
        beam::{BeamDynamics, BeamSway},
        beam_pose::BeamPose,
        bend::SLOPE_TIP,
        pose::{TIP_ANGLE_LIMIT, TreePoser},
    },
    lod::{bake::scene::Scene, reference_wind::MEAN_SPEED_M_S},
    tree::{LeafSeason, TreeModel},
};

/// Pressure under which vertices are compared, m^2/s^2.
const PRESSURE_M2_S2: f32 = MEAN_SPEED_M_S * MEAN_SPEED_M_S;

/// How a tree leans as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImpostorSway {
    /// The sway of the stem's lowest beam in leaf, but for the gain: that is of the sine of the lean, before it saturates.
    pub in_leaf: BeamSway,
    /// The same while it is bare.
    pub bare: BeamSway,
    /// When it has leaves.
    pub leaf_season: LeafSeason,
}

impl ImpostorSway {
    /// Of a model, the `scene` being that model at rest.
    #[must_use]
    pub fn of(scene: &Scene, model: &TreeModel) -> Self {
        let Some(root) = model.beams.first() else { return Self::default() };
        let sine = 0.5 * [Vec3::X, Vec3::Z].map(|heading| nearest_sine(scene, model, heading)).iter().sum::<f32>();
        let limit = TIP_ANGLE_LIMIT.sin();
        let sine = sine.clamp(0.0, 0.95 * limit);
        let unsaturated = sine / (1.0 - (sine / limit).powi(2)).sqrt();
        // As many times the gain of the beam itself, in leaf and bare.
        let share = unsaturated / (root.in_leaf.open_country_gain() * PRESSURE_M2_S2);
        let share = if share.is_finite() { share } else { 0.0 };
        let [in_leaf, bare] = [root.in_leaf, root.bare].map(|sway| BeamSway { gain: share * sway.gain, ..sway });
        Self { in_leaf, bare, leaf_season: model.leaf_season }
    }
}

/// Sine of the lean that comes nearest to a tree under a pressure along `heading`.
fn nearest_sine(scene: &Scene, model: &TreeModel, heading: Vec3) -> f32 {
    let bent = bent(scene, model, heading);
    let pairs = || scene.vertices.iter().zip(&bent.vertices).map(|(rest, bent)| (rest.position, bent.position));
    let moved: f32 = pairs().map(|(rest, bent)| (bent - rest).dot(heading) * rest.y).sum();
    let heights: f32 = pairs().map(|(rest, _)| rest.y * rest.y).sum();
    moved / heights.max(1e-6)
}

/// The tree as it bends under the pressure along `heading`.
pub(in crate::lod) fn bent(scene: &Scene, model: &TreeModel, heading: Vec3) -> Scene {
    let tip_angle = |beam: &BeamDynamics| {
        let load = beam.effective_load(heading.reject_from_normalized(beam.direction) * PRESSURE_M2_S2);
        load * (SLOPE_TIP * beam.in_leaf.open_country_gain())
    };
    let mut poses = vec![BeamPose::REST; model.beams.len()];
    TreePoser::bent(&model.beams, tip_angle).pose(&[], Vec3::ZERO, &mut poses);
    scene.posed(model, &poses)
}
