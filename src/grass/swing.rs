//! How blades swing back that a body has pushed aside and left. `shaders/blade.wesl` has the same formulas.
//!
//! A body goes straight on for a while: a ball that is moved along a line (see [`spine`](super::spine)), while that line is moved to another
//! place. Where it came nearest to a blade, and when, follows from that stretch. There it let go of the blade, which is a free oscillator
//! from then on: of frequency `f` and damping ratio `D`, let go at rest, after a time `a`
//!
//! ```text
//! share(a) = exp(-D w a) (cos(v a) + D w / v sin(v a)),    w = 2 pi f,  v = w sqrt(1 - D^2)
//! ```
//!
//! of how far it was pushed. Of all stretches, that counts of which most is left. A body that is there now holds a blade at least as far as it
//! has to make way, but one that swings against it: that is stopped by twice as much, so that nothing jumps.

use super::spine::{LEAST_M, push_bend};
use crate::dynamics::SweptCapsule;
use bevy::math::{Vec2, Vec3};
use std::f32::consts::TAU;

/// After this time a blade has come to rest, s; from the first time on, that is hastened.
pub const REST_S: [f32; 2] = [1.5, 2.0];

/// How a blade swings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// Its natural frequency, Hz.
    pub frequency_hz: f32,
    /// Its damping by critical damping, less than 1.
    pub damping_ratio: f32,
}

impl Swing {
    /// How much of a push is left a time after the body has let go, s.
    pub fn share(&self, age_s: f32) -> f32 {
        let omega = TAU * self.frequency_hz;
        let damped = omega * (1.0 - self.damping_ratio * self.damping_ratio).sqrt();
        let (sine, cosine) = (damped * age_s).sin_cos();
        let oscillation = cosine + self.damping_ratio * omega / damped.max(LEAST_M) * sine;
        self.envelope(age_s) * oscillation
    }

    /// The most of it that there may be then.
    fn envelope(&self, age_s: f32) -> f32 {
        let [from_s, to_s] = REST_S;
        let t = ((age_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
        (-self.damping_ratio * TAU * self.frequency_hz * age_s).exp() * (1.0 - t * t * (3.0 - 2.0 * t))
    }

    /// The vector by which bodies turn the tip of a blade, rad: those that are there now, `held`, and those that have been there.
    pub fn tip(&self, held: Vec2, root: Vec3, length_m: f32, stretches: &[SweptCapsule], fallback: Vec2) -> Vec2 {
        let (mut most, mut left) = (0.0, Vec2::ZERO);
        for stretch in stretches {
            let (push, age_s) = push_by(stretch, root, length_m, fallback);
            let strength = push.length() * self.envelope(age_s);
            if strength > most {
                (most, left) = (strength, push * self.share(age_s));
            }
        }
        hold(left, held)
    }
}

/// A blade that swings, and is held by a body: at least as far as that.
fn hold(swinging: Vec2, held: Vec2) -> Vec2 {
    let least = held.length();
    if least < LEAST_M {
        return swinging;
    }
    let direction = held / least;
    // One that comes back onto the body is stopped by it, the less the less it is in the way, so that nothing jumps.
    swinging + direction * (least - swinging.dot(direction).max(-least)).max(0.0)
}

/// How far a body turned the tip of a blade when it was nearest to it, rad, and how long ago that was, s.
fn push_by(stretch: &SweptCapsule, root: Vec3, length_m: f32, fallback: Vec2) -> (Vec2, f32) {
    let middle = root + Vec3::Y * (0.5 * length_m);
    let [[from_a, from_b], [to_a, to_b]] = stretch.ends;
    let u = share_along(middle, from_a, from_b);
    let (from, to) = (from_a.lerp(from_b, u), to_a.lerp(to_b, u));
    let v = share_along(middle, from, to);
    let push = push_bend(root, length_m, [from_a.lerp(to_a, v), from_b.lerp(to_b, v)], stretch.radius_m, fallback);
    (push, stretch.ages_s[0] + (stretch.ages_s[1] - stretch.ages_s[0]) * v)
}

/// Where on a line, from 0 to 1, it is nearest to a place.
fn share_along(place: Vec3, from: Vec3, to: Vec3) -> f32 {
    let line = to - from;
    ((place - from).dot(line) / line.length_squared().max(LEAST_M)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SWING: Swing = Swing { frequency_hz: 2.0, damping_ratio: 0.2 };
    const LENGTH_M: f32 = 0.5;

    /// A ball of half a metre that goes along x at 2 m/s and is at a place now.
    fn passed(now_m: f32) -> SweptCapsule {
        let ends = [Vec3::new(now_m - 4.0, 0.3, 0.0); 2];
        SweptCapsule { ends: [ends, ends.map(|end| end + Vec3::X * 4.0)], radius_m: 0.5, ages_s: [2.0, 0.0] }
    }

    /// Against the equation of motion, step by step.
    #[test]
    fn a_blade_that_is_let_go_is_a_free_oscillator() {
        let omega = TAU * SWING.frequency_hz;
        let (mut place, mut speed) = (1.0_f64, 0.0_f64);
        let step_s = 1e-5;
        for step in 0..150_000 {
            if step % 1000 == 0 {
                let share = f64::from(SWING.share((step as f64 * step_s) as f32));
                assert!((share - place).abs() < 1e-3, "{share} against {place} after {step} steps");
            }
            let omega = f64::from(omega);
            speed -= step_s * (omega * omega * place + 2.0 * f64::from(SWING.damping_ratio) * omega * speed);
            place += step_s * speed;
        }
        assert_eq!(SWING.share(REST_S[1]), 0.0);
    }

    /// It is held while the body is there, swings to the other side afterwards, and comes to rest.
    #[test]
    fn a_blade_swings_back_over_its_place_once_a_body_has_passed() {
        let root = Vec3::new(0.0, 0.0, 0.3);
        let tips: Vec<Vec2> = (0..800)
            .map(|step| {
                let now_m = -2.0 + 0.01 * step as f32;
                let stretch = passed(now_m);
                let held = push_bend(root, LENGTH_M, stretch.ends[1], stretch.radius_m, Vec2::X);
                let tip = SWING.tip(held, root, LENGTH_M, &[stretch], Vec2::X);
                // One that swings against the body more than it has to make way is stopped by twice that.
                let (free, least) = (SWING.tip(Vec2::ZERO, root, LENGTH_M, &[stretch], Vec2::X), held.length());
                let along = |tip: Vec2| tip.dot(held.normalize_or_zero());
                assert!(along(tip) >= least.min(along(free) + 2.0 * least) - 1e-4, "{tip} though {held}, free {free}");
                tip
            })
            .collect();
        assert!(tips.windows(2).all(|pair| pair[0].distance(pair[1]) < 0.08), "nothing jumps");
        assert!(tips[..140].iter().all(|tip| *tip == Vec2::ZERO), "it has not come yet");
        let side: Vec<f32> = tips.iter().map(|tip| tip.y).collect();
        assert!(side.iter().copied().fold(0.0, f32::max) > 0.3);
        assert!(side[240..].iter().copied().fold(0.0, f32::min) < -0.1, "over its place");
        assert!(tips[640..].iter().all(|tip| tip.length() < 0.02), "and rests");
    }

    #[test]
    fn of_several_stretches_that_counts_of_which_most_is_left() {
        let root = Vec3::new(0.0, 0.0, 0.2);
        let old = SweptCapsule { ages_s: [1.2, 1.1], ..passed(2.0) };
        let new = SweptCapsule { ages_s: [0.3, 0.1], ..passed(2.0) };
        let tip = |stretches: &[SweptCapsule]| SWING.tip(Vec2::ZERO, root, LENGTH_M, stretches, Vec2::X);
        assert_eq!(tip(&[old, new]), tip(&[new]));
        assert_eq!(tip(&[new, old]), tip(&[new]));
        assert_eq!(tip(&[]), Vec2::ZERO);
    }
}
