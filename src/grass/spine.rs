//! The bend of a blade: a chain of stiff links, so its length is kept in any wind. `shaders/blade.wesl` has the same formulas.
//!
//! The wind turns the tip of a blade by an angle that grows with the square of the speed, as drag does, and saturates in
//! the way of `dynamics::pose` (`U` the horizontal wind, `U_h` the half-bend speed, `L` the limit):
//!
//! ```text
//! free = L (|U| / U_h)^2,   tip = U/|U| free / sqrt(1 + (free / L)^2)
//! ```
//!
//! A blade leans, droops and bends by vectors in the ground plane: their direction is where it leans, their length the
//! angle from the vertical. At the share `s` of its length that angle is
//!
//! ```text
//! a(s) = lean + h(s) (droop + tip),    h(s) = 1 - (1 - s)^3
//! ```
//!
//! with `h` the slope of a uniform cantilever under a uniform load: E I w'' = q (l - x)^2 / 2. Link `k` of `n` points
//! along a(s) at its middle, so the joints are the sums of unit vectors times l / n.

use super::blades::Blade;
use bevy::math::{Vec2, Vec3};

/// Links of a blade: the least number that looks bent.
pub const LINKS: usize = 3;
/// Angle that the wind alone turns a tip by in an ever stronger storm, rad (69 degrees).
pub const TIP_ANGLE_LIMIT_RAD: f32 = 1.2;
/// No part of a blade leans farther from the vertical than this, rad (86 degrees): grass lies down, but not into the ground.
pub const ANGLE_LIMIT_RAD: f32 = 1.5;

/// The vector by which a horizontal wind of `velocity` m/s, as (x, z), turns a tip, rad.
pub fn tip_bend(velocity: Vec2, half_bend_speed_m_s: f32) -> Vec2 {
    let share = velocity / half_bend_speed_m_s;
    // (|U| / U_h)^2 times the direction.
    let load = share * share.length();
    load * (TIP_ANGLE_LIMIT_RAD / (1.0 + load.length_squared()).sqrt())
}

impl Blade {
    /// The angle vector at the share `s` of its length, rad, with the tip bent by `tip`.
    pub(super) fn angle_at(&self, s: f32, tip: Vec2) -> Vec2 {
        let out = Vec2::from_angle(self.azimuth_rad);
        let rest = 1.0 - s;
        let slope = 1.0 - rest * rest * rest;
        let angle = out * self.lean_rad + (out * self.droop_rad + tip) * slope;
        angle * (ANGLE_LIMIT_RAD / angle.length().max(ANGLE_LIMIT_RAD))
    }

    /// The joints from root to tip.
    pub fn spine(&self, tip: Vec2) -> [Vec3; LINKS + 1] {
        let mut joints = [self.root; LINKS + 1];
        for link in 0..LINKS {
            let middle = (link as f32 + 0.5) / LINKS as f32;
            joints[link + 1] = joints[link] + axis(self.angle_at(middle, tip)) * (self.length_m / LINKS as f32);
        }
        joints
    }
}

/// The unit vector that leans from the vertical by an angle vector.
pub(super) fn axis(angle: Vec2) -> Vec3 {
    let size = angle.length();
    let sinc = if size > 1e-6 { size.sin() / size } else { 1.0 };
    Vec3::new(angle.x * sinc, size.cos(), angle.y * sinc)
}

#[cfg(test)]
mod tests {
    use super::{
        super::{blades::layout_blades, settings::Sward},
        *,
    };
    use crate::ground::LevelGround;

    fn meadow() -> Vec<Blade> {
        layout_blades(&Sward { width_m: 3.0, depth_m: 3.0, ..Sward::default() }, &LevelGround(0.0))
    }

    fn winds() -> impl Iterator<Item = Vec2> {
        (0..48).map(|k| Vec2::from_angle(k as f32 * 0.7) * (k as f32 * 1.5))
    }

    #[test]
    fn length_is_kept_in_any_wind() {
        for blade in meadow() {
            for wind in winds() {
                let joints = blade.spine(tip_bend(wind, 10.0));
                let length: f32 = joints.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
                assert!((length / blade.length_m - 1.0).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn blades_stay_above_the_ground_and_below_their_length() {
        for blade in meadow() {
            for wind in winds() {
                let joints = blade.spine(tip_bend(wind, 10.0));
                assert!(joints.windows(2).all(|pair| pair[1].y > pair[0].y));
                assert!(joints[LINKS].y - blade.root.y <= blade.length_m * (1.0 + 1e-6));
            }
        }
    }

    #[test]
    fn bend_grows_with_the_square_of_the_speed_up_to_the_limit() {
        let bend = |speed: f32| tip_bend(Vec2::X * speed, 10.0).x;
        assert!((bend(1.0) / bend(0.5) - 4.0).abs() < 1e-3);
        assert!((bend(10.0) - TIP_ANGLE_LIMIT_RAD / 2.0_f32.sqrt()).abs() < 1e-6);
        assert!(bend(1000.0) <= TIP_ANGLE_LIMIT_RAD && bend(1000.0) > 0.999 * TIP_ANGLE_LIMIT_RAD);
        assert_eq!(tip_bend(Vec2::ZERO, 10.0), Vec2::ZERO);
    }

    #[test]
    fn small_bends_match_beam_theory() {
        let blade = Blade {
            root: Vec3::ZERO,
            length_m: 1.0,
            width_m: 0.01,
            azimuth_rad: 0.0,
            lean_rad: 0.0,
            droop_rad: 0.0,
            dryness: 0.0,
            rank: 0.0,
        };
        // A uniform load that turns the tip by theta moves it by 3/4 theta l (q l^4 / 8 E I over q l^3 / 6 E I).
        let tip = blade.spine(Vec2::X * 0.01)[LINKS];
        // Three links sum the slope by the midpoint rule, whose error is h^2/24 times the change of h', 3: 0.014.
        assert!((tip.x / 0.01 - 0.75).abs() < 0.015, "{tip}");
    }

    #[test]
    fn blades_stay_in_their_plane_in_still_air() {
        for blade in meadow() {
            let out = Vec2::from_angle(blade.azimuth_rad);
            for joint in blade.spine(Vec2::ZERO) {
                let off = joint - blade.root;
                assert!(out.perp_dot(Vec2::new(off.x, off.z)).abs() < 1e-5);
            }
        }
    }
}
