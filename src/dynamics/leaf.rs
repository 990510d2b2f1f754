//! Leaves: plates without mass that turn into the wind and flutter.
//!
//! The paper (eq. 26 of Setas et al.) moves the spherical angles of a leaf's main axis from rest towards the wind by a
//! share `k1(u)`, and adds a random part by a share `k2(u)` of a small angle. Angles wrap and the random part, drawn anew
//! in each frame, flickers. Here the axis goes along the great circle from rest to wind, and the random part is a sum of
//! sines, smooth in time and seamless over the wind's period:
//!
//! ```text
//! rotation = turn(k1(u) angle(rest, wind)) . flutter
//! flutter  = rotation by the vector k2(u) D (n_1 e_1 + n_2 e_2),   e_1, e_2 normal to the resting axis
//! n_i(t)   = mean of sin(2 pi (m_j t / period + phase_ij)), j < 3,  m_j whole
//! k1(u)    = turn smoothstep(onset, full, u),   k2(u) = smoothstep(onset/2, full/2, u)
//! ```

use crate::setting::SettingError;
use bevy::math::{FloatExt, Quat, Vec3};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};
use std::f32::consts::TAU;

/// Frequencies of the three sines of the flutter, relative to the leaf's: no simple ratio, so that it does not look
/// periodic.
const FLUTTER_RATIOS: [f32; 3] = [0.618, 1.0, 1.414];
/// What a leaf's phase is multiplied by for each sine, about the first and the second axis: leaves of different phases
/// share no pattern.
const FLUTTER_PHASES: [[f32; 3]; 2] = [[1.0, 7.0, 13.0], [3.0, 11.0, 17.0]];
/// Below this sine of the angle between rest and wind the axis to turn about is not well defined.
const PARALLEL: f32 = 1e-4;

/// How a species' leaves respond to the wind.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LeafResponse {
    /// Share of the angle to the wind's direction that a leaf turns through in full wind, 0 to 1.
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
}

/// The rotation of a leaf about its anchor.
///
/// `rest_axis` is the unit main axis at rest and `wind` the velocity in m/s, both in the same coordinates. The motion
/// repeats itself after `period_s`, within which `time_s` lies; `phase` (0 to 1) tells leaves apart.
pub(crate) fn turn(
    response: &LeafResponse,
    rest_axis: Vec3,
    wind: Vec3,
    time_s: f32,
    period_s: f32,
    phase: f32,
) -> Quat {
    let wind = if wind.is_finite() { wind } else { Vec3::ZERO };
    let speed = wind.length();
    let turned = response.turn * smooth_share(response.onset_speed_m_s, response.full_speed_m_s, speed);
    let fluttering = smooth_share(0.5 * response.onset_speed_m_s, 0.5 * response.full_speed_m_s, speed);
    let flutter = flutter_vector(response, rest_axis, time_s, period_s, phase) * fluttering;
    turn_towards(rest_axis, wind, turned) * Quat::from_scaled_axis(flutter)
}

/// Turns `rest_axis` through the share `turned` of its angle to the wind, along the shortest way.
fn turn_towards(rest_axis: Vec3, wind: Vec3, turned: f32) -> Quat {
    let Some(direction) = wind.try_normalize() else { return Quat::IDENTITY };
    let normal = rest_axis.cross(direction);
    let sine = normal.length();
    let axis = if sine > PARALLEL { normal / sine } else { any_normal(rest_axis) };
    let angle = sine.atan2(rest_axis.dot(direction));
    Quat::from_axis_angle(axis, turned * angle)
}

/// The flutter in full wind, as a rotation vector.
fn flutter_vector(response: &LeafResponse, rest_axis: Vec3, time_s: f32, period_s: f32, phase: f32) -> Vec3 {
    let period_s = if period_s > 0.0 && period_s.is_finite() { period_s } else { 1.0 };
    let periods = (time_s / period_s).fract();
    let first = any_normal(rest_axis);
    let second = rest_axis.cross(first);
    let [a, b] = FLUTTER_PHASES.map(|phases| {
        let sines = FLUTTER_RATIOS.iter().zip(phases).map(|(ratio, factor)| {
            let cycles = (ratio * response.flutter_frequency_hz * period_s).round();
            (TAU * (cycles * periods + factor * phase).fract()).sin()
        });
        sines.sum::<f32>() / FLUTTER_RATIOS.len() as f32
    });
    response.flutter_angle_rad * (a * first + b * second)
}

/// A unit vector normal to a unit vector.
fn any_normal(axis: Vec3) -> Vec3 {
    let helper = if axis.y.abs() < 0.9 { Vec3::Y } else { Vec3::X };
    axis.cross(helper).normalize_or(Vec3::Z)
}

/// From 0 at `start` smoothly to 1 at `end`, which may be the same.
fn smooth_share(start: f32, end: f32, value: f32) -> f32 {
    ((value - start) / (end - start).max(f32::EPSILON)).smoothstep(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: LeafResponse = LeafResponse {
        turn: 1.0,
        onset_speed_m_s: 2.0,
        full_speed_m_s: 10.0,
        flutter_angle_rad: 0.0,
        flutter_frequency_hz: 3.0,
    };

    #[test]
    fn leaves_point_along_a_full_wind() {
        let wind = Vec3::new(8.0, -3.0, 9.0);
        for rest in [Vec3::X, Vec3::NEG_Y, wind.normalize(), -wind.normalize()] {
            let axis = turn(&STILL, rest, wind, 1.0, 128.0, 0.3) * rest;
            // Rounding; PARALLEL is the most that the axis of the turn may be off.
            assert!(axis.distance(wind.normalize()) < 2e-4, "{rest} turned to {axis}");
        }
    }

    #[test]
    fn turn_grows_with_the_wind() {
        let angle = |speed: f32| {
            let axis = turn(&STILL, Vec3::Y, Vec3::X * speed, 0.0, 128.0, 0.0) * Vec3::Y;
            axis.angle_between(Vec3::Y)
        };
        assert!(angle(1.9) < 1e-3);
        // Halfway between onset and full speed the smooth step is at one half.
        assert!((angle(6.0) - std::f32::consts::FRAC_PI_4).abs() < 1e-5);
        assert!((2..12).all(|speed| angle(speed as f32 + 1.0) >= angle(speed as f32) - 1e-5));
    }

    #[test]
    fn flutter_is_bounded_smooth_and_periodic() {
        let response = LeafResponse { turn: 0.0, ..LeafResponse::default() };
        let axis = |time_s: f32| turn(&response, Vec3::Z, Vec3::X * 20.0, time_s, 64.0, 0.37) * Vec3::Z;
        let angles: Vec<f32> = (0..6400).map(|step| axis(step as f32 / 100.0).angle_between(Vec3::Z)).collect();
        let greatest = angles.iter().copied().fold(0.0, f32::max);
        assert!(greatest < 1.415 * response.flutter_angle_rad && greatest > 0.5 * response.flutter_angle_rad);
        // The fastest sine turns by 2 pi 1.414 f a second at most, about each of two axes.
        let rate = TAU * 1.414 * response.flutter_frequency_hz * response.flutter_angle_rad * 2f32.sqrt();
        for step in 0..6400 {
            let moved = axis(step as f32 / 100.0).distance(axis((step + 1) as f32 / 100.0));
            assert!(moved < rate / 100.0 * 1.01, "{moved} at step {step}");
        }
        assert!(axis(0.0).distance(axis(64.0)) < 1e-4);
    }

    #[test]
    fn leaves_of_different_phases_differ() {
        let response = LeafResponse::default();
        let axis = |phase| turn(&response, Vec3::Z, Vec3::X * 20.0, 3.0, 64.0, phase) * Vec3::Z;
        assert!(axis(0.1).distance(axis(0.4)) > 0.01);
    }

    #[test]
    fn settings_outside_their_domain_are_named() {
        assert_eq!(STILL.validate(), Ok(()));
        let error = LeafResponse { turn: 1.5, ..STILL }.validate().unwrap_err();
        assert_eq!(error.to_string(), "`turn` is 1.5, but must be 0 to 1");
        for bad in
            [LeafResponse { full_speed_m_s: 2.0, ..STILL }, LeafResponse { flutter_angle_rad: f32::NAN, ..STILL }]
        {
            assert!(bad.validate().is_err());
        }
    }

    #[test]
    fn calm_is_the_rest_pose_and_any_wind_is_finite() {
        let response = LeafResponse::default();
        let rested = turn(&response, Vec3::Y, Vec3::ZERO, 5.0, 64.0, 0.5);
        assert_eq!(rested, Quat::IDENTITY);
        for wind in [Vec3::NAN, Vec3::INFINITY, Vec3::NEG_Y * 1e30, Vec3::splat(1e-30)] {
            for period_s in [64.0, 0.0, f32::NAN] {
                assert!(turn(&response, Vec3::Y, wind, 5.0, period_s, 0.5).is_finite());
            }
        }
    }
}
