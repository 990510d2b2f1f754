//! The outline of an impressionist crown: a partial ellipsoid, drawn out to a tip.
//!
//! With the radius `R` at the widest height, `t` the distance from there as a share of the semi-axis (above: up to the
//! top; below: the same semi-axis or the distance to the base, whichever is longer, so that the ellipsoid is cut), the
//! curve `p` and the tip point `q`,
//!
//! ```text
//! r(t) / R = (1 - q) (1 - |t|^p)^(1/p) + q (1 - t)   above,     (1 - |t|^p)^(1/p)   below
//! ```
//!
//! `p = 2`, `q = 0` is the paper's ellipsoid, `q = 1` a cone. For `p >= 1` the solid is convex, so that moving towards
//! its axis never leaves it.

use bevy::math::Vec3;

/// A convex solid of revolution about the y axis; heights in m above the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Profile {
    pub base_m: f32,
    pub top_m: f32,
    pub radius_m: f32,
    /// Height of the greatest radius, as a share of the crown's.
    pub widest_at: f32,
    pub tip_point: f32,
    pub curve: f32,
}

impl Profile {
    pub(super) fn height_m(&self) -> f32 {
        self.top_m - self.base_m
    }

    /// Height of the greatest radius, m.
    pub(super) fn widest_m(&self) -> f32 {
        self.base_m + self.widest_at * self.height_m()
    }

    /// Semi-axis of the ellipsoid above, and below.
    fn semi_axis_m(&self, above: bool) -> f32 {
        let (up, down) = (self.top_m - self.widest_m(), self.widest_m() - self.base_m);
        if above { up } else { up.max(down) }
    }

    /// Horizontal radius at a height, m: 0 above the top and below the base.
    pub(super) fn girth_m(&self, height_m: f32) -> f32 {
        if !(self.base_m..=self.top_m).contains(&height_m) {
            return 0.0;
        }
        let from_widest_m = height_m - self.widest_m();
        let above = from_widest_m > 0.0;
        let share = (from_widest_m.abs() / self.semi_axis_m(above).max(1e-6)).min(1.0);
        let round = (1.0 - share.powf(self.curve)).max(0.0).powf(1.0 / self.curve);
        let pointed = if above { self.tip_point } else { 0.0 };
        self.radius_m * (round + (1.0 - share - round) * pointed)
    }

    /// Whether a point lies in the solid, to within a thousandth of its size.
    pub(super) fn holds(&self, point: Vec3) -> bool {
        let slack_m = 1e-3 * self.height_m().max(self.radius_m);
        let nearest_m = point.y.clamp(self.base_m, self.top_m);
        (point.y - nearest_m).abs() <= slack_m && point.x.hypot(point.z) <= self.girth_m(nearest_m) + slack_m
    }

    /// The point of the surface at a polar angle (as a share, 0 at the tip to 1 at the base) and an azimuth. Equal
    /// shares are equal angles: points crowd at the tip, as the paper's do.
    pub(super) fn surface(&self, polar_share: f32, azimuth_rad: f32) -> Vec3 {
        let below_m = self.semi_axis_m(false);
        let last_rad =
            std::f32::consts::FRAC_PI_2 + ((self.widest_m() - self.base_m) / below_m.max(1e-6)).min(1.0).asin();
        let cos = (polar_share * last_rad).cos();
        let height_m = self.widest_m() + cos * self.semi_axis_m(cos > 0.0);
        let height_m = height_m.clamp(self.base_m, self.top_m);
        let radius_m = self.girth_m(height_m);
        Vec3::new(radius_m * azimuth_rad.cos(), height_m, radius_m * azimuth_rad.sin())
    }

    /// The point of the axis towards which the surface is displaced, always inside: half-way between the point's own
    /// height and the widest in a round crown, level with the point in a pointed one.
    pub(super) fn core(&self, point: Vec3) -> Vec3 {
        let own_m = point.y.clamp(self.base_m, self.top_m);
        let height_m = own_m + 0.5 * (1.0 - self.tip_point) * (self.widest_m() - own_m);
        let margin_m = 0.05 * self.height_m();
        Vec3::Y * height_m.clamp(self.base_m + margin_m, self.top_m - margin_m)
    }

    /// How far down from the top to the widest height, 0 to 1 there and below.
    pub(super) fn breadth_share(&self, height_m: f32) -> f32 {
        ((self.top_m - height_m) / (self.top_m - self.widest_m()).max(1e-6)).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ELLIPSOID: Profile =
        Profile { base_m: 2.0, top_m: 12.0, radius_m: 4.0, widest_at: 0.5, tip_point: 0.0, curve: 2.0 };

    #[test]
    fn curve_two_is_an_ellipsoid_and_tip_one_a_cone() {
        let cone = Profile { tip_point: 1.0, widest_at: 0.0, ..ELLIPSOID };
        for step in 0..=20 {
            let height_m = 2.0 + 0.5 * step as f32;
            let ellipse = 4.0 * (1.0 - ((height_m - 7.0) / 5.0).powi(2)).max(0.0).sqrt();
            assert!((ELLIPSOID.girth_m(height_m) - ellipse).abs() < 2e-3);
            assert!((cone.girth_m(height_m) - 4.0 * (12.0 - height_m) / 10.0).abs() < 1e-4);
        }
        assert_eq!(ELLIPSOID.girth_m(12.1), 0.0);
        assert_eq!(ELLIPSOID.girth_m(1.9), 0.0);
    }

    #[test]
    fn a_low_widest_point_cuts_the_ellipsoid() {
        let cut = Profile { widest_at: 0.3, ..ELLIPSOID };
        // Semi-axis 7 m above and below, of which 3 m are left.
        assert!((cut.girth_m(2.0) - 4.0 * (1.0 - 9.0_f32 / 49.0).sqrt()).abs() < 1e-4);
        assert!((cut.surface(1.0, 0.0).y - 2.0).abs() < 1e-4);
        assert!((cut.surface(0.0, 1.0) - Vec3::Y * 12.0).length() < 1e-4);
    }

    #[test]
    fn the_solid_is_convex_and_its_core_inside() {
        for (tip_point, curve, widest_at) in [(0.0, 1.0, 0.9), (1.0, 6.0, 0.0), (0.4, 2.0, 0.4), (0.7, 3.0, 0.7)] {
            let profile = Profile { tip_point, curve, widest_at, ..ELLIPSOID };
            for step in 0..=40 {
                let point = profile.surface(step as f32 / 40.0, 0.7);
                let core = profile.core(point);
                assert!(profile.holds(point) && profile.holds(core));
                assert!((1..20).all(|k| profile.holds(point.lerp(core, k as f32 / 20.0))), "{profile:?} {point}");
            }
        }
    }
}
