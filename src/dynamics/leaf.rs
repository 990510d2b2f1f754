//! Leaves: plates without mass that turn into the wind and flutter.
//!
//! The paper (eq. 26 of Setas et al.) moves the spherical angles of a leaf's main axis from rest towards the wind by a
//! share `k1(u)`, and adds a random part by a share `k2(u)` of a small angle. Angles wrap and the random part, drawn anew
//! in each frame, flickers. Here the axis goes along the great circle from rest to wind, and the random part is a sum of
//! sines, smooth in time and seamless over the wind's period. With `a` the axis as the branch carries it, at the angle
//! `theta` to the wind:
//!
//! ```text
//! rotation = turn . carried . flutter
//! turn     = rotation by k1(u) theta s(theta) about a x wind
//! flutter  = rotation by the vector k2(u) D (n_1 e_1 + n_2 e_2),   e_1, e_2 normal to the resting axis
//! n_i(t)   = mean of sin(2 pi (m_j t / period + phase_ij)), j < 3,  m_j whole
//! k1(u)    = turn smoothstep(onset, full, u),   k2(u) = smoothstep(onset/2, full/2, u)
//! s(theta) = 1 - smoothstep(120 deg, 180 deg, theta)
//! ```
//!
//! `s` keeps the turn continuous. To a leaf that points straight upwind no way round is the shorter one, and no continuous
//! map turns leaves fully into winds from everywhere: it would give the sphere a field of tangents without a zero. So the
//! turn vanishes there, as does the torque of drag on a plate, which grows with sin(theta). The angle at which `s` begins
//! is chosen by eye. With it the leaf turns by at most 3.4 times the angle that the wind or its own axis turns by:
//! `max(|f'|, 2 sin(f/2) / sin(theta))` for `f = theta s(theta)`.

use crate::setting::SettingError;
use bevy::math::{FloatExt, Quat, Vec3};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};
use std::f32::consts::{PI, TAU};

/// Frequencies of the three sines of the flutter, relative to the leaf's: no simple ratio, so that it does not look
/// periodic.
const FLUTTER_RATIOS: [f32; 3] = [0.618, 1.0, 1.414];
/// What a leaf's phase is multiplied by for each sine, about the first and the second axis: leaves of different phases
/// share no pattern.
const FLUTTER_PHASES: [[f32; 3]; 2] = [[1.0, 7.0, 13.0], [3.0, 11.0, 17.0]];
/// Angle to the wind up to which a leaf turns through its full share, in radians. Chosen by eye.
const FULL_SHARE_ANGLE_RAD: f32 = TAU / 3.0;
/// Keeps quotients of lengths finite where both are zero.
const LEAST_LENGTH: f32 = 1e-12;

/// How a species' leaves respond to the wind.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LeafResponse {
    /// Share of the angle to the wind's direction that a leaf turns through in full wind, 0 to 1. The share falls where
    /// that angle is above 120 degrees: a leaf that points straight upwind does not turn.
    pub turn: f32,
    /// Speed at which leaves begin to turn, in m/s; they begin to flutter at half of it.
    pub onset_speed_m_s: f32,
    /// Speed at which they have turned as far as they do, in m/s; they flutter in full at half of it.
    pub full_speed_m_s: f32,
    /// Greatest angle of the flutter about each of its two axes, in radians.
    pub flutter_angle_rad: f32,
    /// Typical frequency of the flutter, in Hz.
    pub flutter_frequency_hz: f32,
}

impl Default for LeafResponse {
    /// Leaves rustle from 1.6 m/s (Beaufort 2) and are in constant motion from some 4 m/s (Beaufort 3); the angles and
    /// the frequency are chosen by eye.
    fn default() -> Self {
        Self {
            turn: 0.6,
            onset_speed_m_s: 3.2,
            full_speed_m_s: 12.0,
            flutter_angle_rad: 0.35,
            flutter_frequency_hz: 3.0,
        }
    }
}

/// A leaf at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestingLeaf {
    /// Unit main axis, from the anchor to the tip, in the tree's coordinates.
    pub axis: Vec3,
    /// Phase of its flutter, 0 to 1: tells leaves apart.
    pub phase: f32,
}

impl LeafResponse {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain: a share from 0 to 1, and speeds, angle and frequency from 0, the full speed above
    /// the onset.
    pub(crate) fn validate(&self) -> Result<(), SettingError> {
        let onset = self.onset_speed_m_s;
        let checks = [
            ("turn", self.turn, 0.0..=1.0, "0 to 1"),
            ("onset_speed_m_s", onset, 0.0..=f32::MAX, "at least 0 and finite"),
            ("full_speed_m_s", self.full_speed_m_s, onset.next_up()..=f32::MAX, "above onset_speed_m_s and finite"),
            ("flutter_angle_rad", self.flutter_angle_rad, 0.0..=f32::MAX, "at least 0 and finite"),
            ("flutter_frequency_hz", self.flutter_frequency_hz, 0.0..=f32::MAX, "at least 0 and finite"),
        ];
        match checks.into_iter().find(|(_, value, allowed, _)| !allowed.contains(value)) {
            Some((field, value, _, allowed)) => Err(SettingError::new(field, value, allowed)),
            None => Ok(()),
        }
    }

    /// The rotation of a leaf about its anchor, from rest to now, in the tree's coordinates.
    ///
    /// `carried` is the rotation of its branch where it hangs, and `wind` the velocity in m/s. The motion repeats itself
    /// after `period_s`, within which `time_s` lies. In a calm the leaf rests on its branch, and also where something is
    /// not finite. The leaf turns by at most 3.4 times the angle that the wind turns by, and by 4.4 times that of its
    /// branch.
    pub fn rotation(&self, leaf: &RestingLeaf, carried: Quat, wind: Vec3, time_s: f32, period_s: f32) -> Quat {
        let carried = if carried.is_finite() { carried } else { Quat::IDENTITY };
        let speed = wind.length();
        let turned = self.turn * smooth_share(self.onset_speed_m_s, self.full_speed_m_s, speed);
        let turn = turn_towards(carried * leaf.axis, wind / speed.max(LEAST_LENGTH), turned);
        let fluttering = smooth_share(0.5 * self.onset_speed_m_s, 0.5 * self.full_speed_m_s, speed);
        let flutter = fluttering * flutter_vector(self, leaf, time_s, period_s);
        let rotation = turn * carried * Quat::from_scaled_axis(flutter);
        if rotation.is_finite() { rotation } else { carried }
    }
}

/// Turns `axis` towards the wind by `turned` of the angle between them, less where that is above
/// [`FULL_SHARE_ANGLE_RAD`]. `direction` is the wind's, or zero.
fn turn_towards(axis: Vec3, direction: Vec3, turned: f32) -> Quat {
    let normal = axis.cross(direction);
    // In a calm both are zero, of which shaders know no arc tangent.
    let sine = normal.length().max(LEAST_LENGTH);
    let angle = sine.atan2(axis.dot(direction));
    let share = turned * (1.0 - smooth_share(FULL_SHARE_ANGLE_RAD, PI, angle));
    Quat::from_scaled_axis(normal / sine * (share * angle))
}

/// The flutter in full wind, as a rotation vector. It depends on the axis at rest alone: it is fixed to the leaf, and
/// the branch carries it along.
fn flutter_vector(response: &LeafResponse, leaf: &RestingLeaf, time_s: f32, period_s: f32) -> Vec3 {
    let periods = (time_s / period_s).fract();
    let (first, second) = leaf.axis.any_orthonormal_pair();
    let [a, b] = FLUTTER_PHASES.map(|phases| {
        let sines = FLUTTER_RATIOS.iter().zip(phases).map(|(ratio, factor)| {
            let cycles = (ratio * response.flutter_frequency_hz * period_s).round();
            (TAU * (cycles * periods + factor * leaf.phase).fract()).sin()
        });
        sines.sum::<f32>() / FLUTTER_RATIOS.len() as f32
    });
    response.flutter_angle_rad * (a * first + b * second)
}

/// From 0 at `start` smoothly to 1 at `end`, which may be the same.
fn smooth_share(start: f32, end: f32, value: f32) -> f32 {
    ((value - start) / (end - start).max(f32::EPSILON)).smoothstep(0.0, 1.0)
}

#[cfg(test)]
mod tests;
