//! How a tree falls that is hinged at its cut: a rigid body about an axis on the ground, with its weight and the drag of its crown.
//!
//! ```text
//! I angle'' = g S sin angle - D |angle'| angle'
//! S = sum m s,   I = sum m s^2,   D = sum c s^3
//! ```
//!
//! over the pieces of the tree, of mass m and drag c |u| u, each s above the cut. The angle is that from upright.

use crate::tree::Piece;

/// Standard gravity, m/s^2.
const GRAVITY_M_S2: f64 = 9.80665;
/// Longest step, s. The greatest error of a fall is of its fourth power.
const LONGEST_STEP_S: f64 = 1.0 / 240.0;
/// No longer time is looked at in one go, s: longer than any fall.
const LONGEST_S: f64 = 60.0;

/// What the fall of a tree follows from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::forest) struct FallingBody {
    /// First moment of its mass, S. units: kg m.
    pub moment_kg_m: f64,
    /// Moment of inertia, I. units: kg m^2.
    pub inertia_kg_m2: f64,
    /// Torque of the drag at 1 rad/s, D. units: N m s^2.
    pub drag_n_m_s2: f64,
}

impl FallingBody {
    /// Of the pieces of a tree that is cut so high, m; what is below the cut does not fall. Of the leaves there is only a share.
    pub fn of(pieces: impl Iterator<Item = Piece>, cut_m: f64, leaf_share: f64) -> Self {
        let mut body = Self { moment_kg_m: 0.0, inertia_kg_m2: 0.0, drag_n_m_s2: 0.0 };
        for piece in pieces {
            let share = if piece.is_leaf { leaf_share } else { 1.0 };
            let arm_m = (f64::from(piece.at.y) - cut_m).max(0.0);
            body.moment_kg_m += share * piece.mass_kg * arm_m;
            body.inertia_kg_m2 += share * piece.mass_kg * arm_m.powi(2);
            body.drag_n_m_s2 += share * piece.drag_kg_m * arm_m.powi(3);
        }
        body
    }

    /// The same body, larger by a factor. Masses grow with its third power, areas with its second.
    pub fn scaled(self, scale: f64) -> Self {
        Self {
            moment_kg_m: self.moment_kg_m * scale.powi(4),
            inertia_kg_m2: self.inertia_kg_m2 * scale.powi(5),
            drag_n_m_s2: self.drag_n_m_s2 * scale.powi(5),
        }
    }

    /// Angular acceleration, rad/s^2; 0 of what has no mass.
    fn acceleration(&self, Fall { angle_rad, speed_rad_s }: Fall) -> f64 {
        let torque =
            GRAVITY_M_S2 * self.moment_kg_m * angle_rad.sin() - self.drag_n_m_s2 * speed_rad_s.abs() * speed_rad_s;
        let acceleration = torque / self.inertia_kg_m2;
        if acceleration.is_finite() { acceleration } else { 0.0 }
    }
}

/// How far a tree has fallen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::forest) struct Fall {
    /// From upright. units: rad.
    pub angle_rad: f64,
    /// units: rad/s.
    pub speed_rad_s: f64,
}

impl Fall {
    /// Lets a body fall on for a time, s: fourth-order Runge-Kutta steps, so that it hardly matters in how many pieces the time comes.
    pub fn advance(&mut self, body: &FallingBody, time_s: f64) {
        let time_s = if time_s > 0.0 { time_s.min(LONGEST_S) } else { 0.0 };
        let steps = (time_s / LONGEST_STEP_S).ceil();
        for _ in 0..steps as u32 {
            self.step(body, time_s / steps);
        }
    }

    fn step(&mut self, body: &FallingBody, step_s: f64) {
        let rate = |state: Self| Self { angle_rad: state.speed_rad_s, speed_rad_s: body.acceleration(state) };
        let first = rate(*self);
        let second = rate(self.plus(first, 0.5 * step_s));
        let third = rate(self.plus(second, 0.5 * step_s));
        let fourth = rate(self.plus(third, step_s));
        let ends = self.plus(first, step_s / 6.0).plus(fourth, step_s / 6.0);
        *self = ends.plus(second, step_s / 3.0).plus(third, step_s / 3.0);
    }

    fn plus(self, rate: Self, time_s: f64) -> Self {
        Self {
            angle_rad: self.angle_rad + rate.angle_rad * time_s,
            speed_rad_s: self.speed_rad_s + rate.speed_rad_s * time_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// A rod of 1 t and 20 m.
    const ROD: FallingBody =
        FallingBody { moment_kg_m: 10_000.0, inertia_kg_m2: 1000.0 * 400.0 / 3.0, drag_n_m_s2: 0.0 };
    const LEAN: Fall = Fall { angle_rad: 0.05, speed_rad_s: 0.0 };

    /// Time until an angle is reached, in steps of so many seconds; within a step as if its speed were constant.
    fn time_to(angle_rad: f64, body: &FallingBody, step_s: f64) -> (f64, Fall) {
        let (mut fall, mut time_s) = (LEAN, 0.0);
        while fall.angle_rad < angle_rad {
            fall.advance(body, step_s);
            time_s += step_s;
        }
        (time_s - (fall.angle_rad - angle_rad) / fall.speed_rad_s, fall)
    }

    /// Gauss's arithmetic-geometric mean.
    fn agm(mut a: f64, mut b: f64) -> f64 {
        for _ in 0..40 {
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
        }
        a
    }

    /// A pendulum from rest to its lowest place takes a quarter of its period: `sqrt(I / g S) K(k)`, `k = sin(amplitude / 2)`, and
    /// `K = pi / (2 agm(1, sqrt(1 - k^2)))`.
    #[test]
    fn without_drag_it_takes_a_quarter_of_a_pendulums_period_to_hang() {
        let k = (0.5 * (PI - LEAN.angle_rad)).sin();
        let quarter = PI / (2.0 * agm(1.0, (1.0 - k * k).sqrt()));
        let expected_s = (ROD.inertia_kg_m2 / (GRAVITY_M_S2 * ROD.moment_kg_m)).sqrt() * quarter;
        assert_relative_eq!(time_to(PI, &ROD, 1e-3).0, expected_s, max_relative = 1e-6);
    }

    #[test]
    fn without_drag_energy_is_kept() {
        let mut fall = LEAN;
        let energy = |fall: Fall| {
            0.5 * ROD.inertia_kg_m2 * fall.speed_rad_s.powi(2) + GRAVITY_M_S2 * ROD.moment_kg_m * fall.angle_rad.cos()
        };
        let before = energy(fall);
        for _ in 0..500 {
            fall.advance(&ROD, 0.01);
            assert_relative_eq!(energy(fall), before, max_relative = 1e-8);
        }
    }

    /// `u = speed^2` is linear in the angle: `u' + a u = b sin angle` with `a = 2 D / I`, `b = 2 g S / I`, which is solved by
    /// `b (a sin - cos) / (1 + a^2) + C e^(-a angle)`.
    #[test]
    fn with_drag_its_speed_is_that_of_the_closed_form() {
        for drag_n_m_s2 in [1e4, 1e5, 1e6] {
            let body = FallingBody { drag_n_m_s2, ..ROD };
            let (a, b) =
                (2.0 * drag_n_m_s2 / body.inertia_kg_m2, 2.0 * GRAVITY_M_S2 * body.moment_kg_m / body.inertia_kg_m2);
            let forced = |angle: f64| b * (a * angle.sin() - angle.cos()) / (1.0 + a * a);
            let mut fall = LEAN;
            while fall.angle_rad < FRAC_PI_2 {
                fall.advance(&body, 0.02);
                let free = -forced(LEAN.angle_rad) * (-a * (fall.angle_rad - LEAN.angle_rad)).exp();
                assert_relative_eq!(fall.speed_rad_s.powi(2), forced(fall.angle_rad) + free, max_relative = 1e-6);
            }
        }
    }

    #[test]
    fn a_fall_does_not_depend_on_frames() {
        let body = FallingBody { drag_n_m_s2: 2e4, ..ROD };
        let of = |frames: u32| {
            let mut fall = LEAN;
            (0..frames).for_each(|_| fall.advance(&body, 5.0 / f64::from(frames)));
            fall.angle_rad
        };
        assert!(of(60) > 1.0);
        for frames in [7, 40, 240, 1000] {
            assert_relative_eq!(of(frames), of(60), max_relative = 1e-8);
        }
    }

    #[test]
    fn what_has_no_mass_and_times_that_are_none_move_nothing() {
        let mut fall = LEAN;
        fall.advance(&FallingBody { moment_kg_m: 0.0, inertia_kg_m2: 0.0, drag_n_m_s2: 1.0 }, 1.0);
        fall.advance(&ROD, f64::NAN);
        fall.advance(&ROD, -1.0);
        assert_eq!(fall, LEAN);
    }

    #[test]
    fn a_rod_is_the_sum_of_its_pieces() {
        let piece = |number: u16, is_leaf| Piece {
            at: bevy::math::Vec3::new(1.0, 1.0 + 0.01 + 0.02 * f32::from(number), 0.0),
            mass_kg: 1.0,
            drag_kg_m: 0.5,
            is_leaf,
        };
        let body = FallingBody::of((0..1000).map(|number| piece(number, false)), 1.0, 1.0);
        assert_relative_eq!(body.moment_kg_m, ROD.moment_kg_m, max_relative = 1e-5);
        assert_relative_eq!(body.inertia_kg_m2, ROD.inertia_kg_m2, max_relative = 1e-5);
        // 500 kg/m over 20 m.
        assert_relative_eq!(body.drag_n_m_s2, 500.0 / 20.0 * 20_f64.powi(4) / 4.0, max_relative = 1e-5);
        let bare = FallingBody::of((0..1000).map(|number| piece(number, true)), 1.0, 0.0);
        assert_eq!(bare.inertia_kg_m2, 0.0);
    }

    #[test]
    fn larger_bodies_fall_more_slowly() {
        let twice = ROD.scaled(2.0);
        assert_relative_eq!(
            time_to(1.5, &twice, 1e-3).0,
            time_to(1.5, &ROD, 1e-3).0 * 2.0_f64.sqrt(),
            max_relative = 1e-4
        );
    }
}
