//! The pose of one beam, and where that moves what is bound to it: see `pose.rs`.

use super::{beam::BeamDynamics, bend::AxisPoint, lanes::Vector};
use bevy::math::{Quat, Vec3, Vec3A};

/// How a beam is bent, and what its ancestors do to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamPose {
    /// Angle of the tip in radians, as a vector in the sense of the deflection, in the tree's rest coordinates.
    pub tip_angle: Vec3A,
    /// Rotation that the ancestors give to the beam's rest frame.
    pub rotation: Quat,
    /// Translation that the ancestors give to the beam's rest frame, in metres, after the rotation.
    pub translation: Vec3A,
}

impl Default for BeamPose {
    fn default() -> Self {
        Self::REST
    }
}

impl BeamPose {
    /// The pose in a calm.
    pub const REST: Self = Self { tip_angle: Vec3A::ZERO, rotation: Quat::IDENTITY, translation: Vec3A::ZERO };

    /// Where `rest_point`, bound at `s` (0 to 1) of this pose's beam, is now, in metres in the tree's coordinates, and
    /// the rotation there.
    pub fn carry(&self, beam: &BeamDynamics, s: f32, rest_point: Vec3) -> (Vec3, Quat) {
        let point = AxisPoint::new(beam, s);
        let bend = point.bend(&Vector(self.tip_angle.to_array()));
        let vector = |v: Vector<f32>| Vec3A::from_array(v.0);
        let arm = Vec3A::from(rest_point) - vector(point.rest);
        // Adding what moved, rather than subtracting and adding the axis, keeps the rest pose exact.
        let moved = vector(bend.rotation.displacement(&Vector(arm.to_array())) + bend.displacement);
        let turn = Quat::from_vec4(Vec3A::from_array(bend.rotation.vector.0).extend(bend.rotation.scalar));
        (Vec3::from(self.rotation * (Vec3A::from(rest_point) + moved) + self.translation), self.rotation * turn)
    }

    /// Where the point of the axis at `s` (0 to 1) of this pose's beam is now, in metres in the tree's coordinates.
    pub(crate) fn carry_axis(&self, beam: &BeamDynamics, s: f32) -> Vec3 {
        let point = AxisPoint::new(beam, s);
        let bent = point.rest + point.bend(&Vector(self.tip_angle.to_array())).displacement;
        Vec3::from(self.rotation * Vec3A::from_array(bent.0) + self.translation)
    }
}
