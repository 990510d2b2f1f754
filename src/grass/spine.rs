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
//!
//! A body that pushes blades aside turns those that would stand in it. Where it is nearest to an upright blade, that has to make way by
//! `w`, horizontally and away from the body's middle: at once. Such a blade turns by `w` over the 3/4 of its length by which a tip moves for
//! each radian, up to the limit of all leaning. How it swings back is in `swing`.

use super::blades::Blade;
use bevy::math::{Vec2, Vec3, Vec3Swizzles};

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

/// The vector by which a body, a ball of `radius_m` that is moved along the line between two ends, turns the tip of an upright blade, rad.
/// A blade right under its middle leans along `fallback`.
pub fn push_bend(root: Vec3, length_m: f32, ends: [Vec3; 2], radius_m: f32, fallback: Vec2) -> Vec2 {
    let middle = root + Vec3::Y * (0.5 * length_m);
    let line = ends[1] - ends[0];
    let share = ((middle - ends[0]).dot(line) / line.length_squared().max(LEAST_M)).clamp(0.0, 1.0);
    let centre = ends[0] + line * share;
    let rise = centre.y - root.y;
    // How far the centre is above the tip or below the root.
    let off_m = rise - rise.max(0.0).min(length_m);
    let away = root.xz() - centre.xz();
    let way_m = (radius_m * radius_m - off_m * off_m).max(0.0).sqrt() - away.length();
    if way_m.is_nan() || way_m <= 0.0 {
        return Vec2::ZERO;
    }
    let direction = if away.length_squared() > LEAST_M { away.normalize() } else { fallback };
    direction * (way_m / (TIP_WAY * length_m)).min(ANGLE_LIMIT_RAD)
}

/// Lengths by which a tip moves for each radian that it turns.
const TIP_WAY: f32 = 0.75;
/// Shorter than this, m (or m^2), is nothing.
pub(super) const LEAST_M: f32 = 1e-6;

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
            under_trees: 0.0,
        };
        // A uniform load that turns the tip by theta moves it by 3/4 theta l (q l^4 / 8 E I over q l^3 / 6 E I).
        let tip = blade.spine(Vec2::X * 0.01)[LINKS];
        // Three links sum the slope by the midpoint rule, whose error is h^2/24 times the change of h', 3: 0.014.
        assert!((tip.x / 0.01 - 0.75).abs() < 0.015, "{tip}");
    }

    #[test]
    fn upright_blades_make_way_for_a_body() {
        let ends = [Vec3::new(0.0, 0.3, 0.0), Vec3::new(0.0, 1.5, 0.0)];
        let bend = |x: f32, y: f32| push_bend(Vec3::new(x, y, 0.0), 0.5, ends, 0.3, Vec2::Y);
        // Half a radius in, a tip of 0.375 m a radian has to go 0.15 m.
        assert!(
            (bend(0.15, 0.0) - Vec2::X * 0.4).length() < 1e-5 && (bend(-0.15, 0.0) + Vec2::X * 0.4).length() < 1e-5
        );
        assert_eq!(bend(0.31, 0.0), Vec2::ZERO);
        assert_eq!(bend(0.1, -1.2), Vec2::ZERO, "a body far above bends nothing");
        assert!(bend(0.0, 0.0).y > 0.7 && bend(0.0, 0.0).length() <= ANGLE_LIMIT_RAD);
        // The nearer to the middle, the further; no step at the rim.
        let bends: Vec<f32> = (0..=300).map(|step| bend(step as f32 * 1e-3 + 1e-2, 0.0).length()).collect();
        assert!(bends.windows(2).all(|pair| pair[1] <= pair[0] && pair[0] - pair[1] < 0.01));
        let odd = [f32::NAN, f32::INFINITY, 0.0];
        assert!(odd.iter().all(|x| !push_bend(Vec3::splat(*x), *x, [Vec3::ZERO; 2], 0.3, Vec2::X).is_nan()));
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
