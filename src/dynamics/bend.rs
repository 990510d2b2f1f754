//! How a beam bends along its first mode, and keeps its length.
//!
//! The axis at `s` is turned by `h(s) Theta`, with `h = phi_1' / phi_1'(1)` the slope of the mode (18). Its place
//! follows by integrating the turned direction along the beam, which keeps every length. With
//! `H_k(s) = int_0^s h^k` and `T = |Theta|^2`, the Taylor series of cosine and sine give
//!
//! ```text
//! bent(s) = b + L (d X + Theta Y)
//! X = s - T H_2/2 + T^2 H_4/24 - T^3 H_6/720         = int cos(h |Theta|)
//! Y = H_1 - T H_3/6 + T^2 H_5/120                    = int sin(h |Theta|) / |Theta|
//! ```
//!
//! for a beam with its base at `b`, of direction `d` and length `L`, whose tip is turned by `Theta`: see `pose.rs`. It needs no
//! trigonometry: quaternions come from polynomials in the half angle.

use super::{
    beam::BeamDynamics,
    lanes::{Lanes, Number, Rotation, Vector, lanes},
};

/// `phi_1'(1)`, the slope at the tip of the first mode with a tip of 1: the tip's angle for a deflection of one length.
pub const SLOPE_TIP: f32 = 1.376_505_4;

/// `h(s) = s B_0(s)` and `H_k(s) = s^(k+1) B_k(s)`, k = 1..6, with `B = B[0] + B[1] s + B[2] s^2 + B[3] s^3`: minimax
/// fits to eq. 18, to 2.1e-4 for h, and to less than 5e-5 of the length for all that `H_k` is multiplied by.
pub const MODE_SHAPE: [[f32; 4]; 7] = [
    [2.546_882, -1.678_134_6, -0.275_886_7, 0.406_925_2],
    [1.274_264_9, -0.563_412, -0.062_747_29, 0.078_356_65],
    [2.195_082_1, -2.357_947, 0.806_842_25, -0.030_695_12],
    [4.209_066, -7.150_318, 4.499_929_4, -1.011_924_7],
    [8.117_791, -17.585_144, 13.848_035, -3.879_497_8],
    [15.020_49, -37.190_565, 32.597_094, -9.959_87],
    [26.275_35, -70.269_42, 65.276_05, -20.841_745],
];

/// A point of a beam's axis with all that does not change from frame to frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisPoint<T = f32> {
    /// `b + L s d`.
    pub rest: Vector<T>,
    direction: Vector<T>,
    /// `h / 2`.
    half_turn: T,
    /// Coefficients of T, T^2, T^3 in `L (X - s)`.
    along: [T; 3],
    /// Coefficients of 1, T, T^2 in `L Y`.
    across: [T; 3],
}

/// What bending does at a point of the axis.
pub(super) struct Bend<T> {
    pub rotation: Rotation<T>,
    pub displacement: Vector<T>,
}

impl AxisPoint {
    /// The foot of a beam of no length.
    pub const ORIGIN: Self = Self {
        rest: Vector([0.0; 3]),
        direction: Vector([0.0, 1.0, 0.0]),
        half_turn: 0.0,
        along: [0.0; 3],
        across: [0.0; 3],
    };

    pub fn new(beam: &BeamDynamics, s: f32) -> Self {
        let s = s.clamp(0.0, 1.0);
        let [h, h1, h2, h3, h4, h5, h6] = mode_shape(s);
        let length = beam.length_m;
        Self {
            rest: Vector((beam.base + length * s * beam.direction).to_array()),
            direction: Vector(beam.direction.to_array()),
            half_turn: 0.5 * h,
            along: [-length * h2 / 2.0, length * h4 / 24.0, -length * h6 / 720.0],
            across: [length * h1, -length * h3 / 6.0, length * h5 / 120.0],
        }
    }
}

impl AxisPoint<Lanes> {
    /// Points of as many beams, side by side.
    pub fn side_by_side(point: impl Fn(usize) -> AxisPoint) -> Self {
        let [half_turn] = lanes(|lane| [point(lane).half_turn]);
        Self {
            rest: Vector(lanes(|lane| point(lane).rest.0)),
            direction: Vector(lanes(|lane| point(lane).direction.0)),
            half_turn,
            along: lanes(|lane| point(lane).along),
            across: lanes(|lane| point(lane).across),
        }
    }
}

impl<T: Number> AxisPoint<T> {
    /// For the angle by which the tip is turned, rad, as a vector in the sense of the deflection.
    #[inline(always)]
    pub fn bend(&self, tip_angle: &Vector<T>) -> Bend<T> {
        let t = tip_angle.length_squared();
        let along = t * (self.along[0] + t * (self.along[1] + t * self.along[2]));
        let across = self.across[0] + t * (self.across[1] + t * self.across[2]);
        Bend {
            rotation: rotation_by_twice(self.direction.cross(tip_angle) * self.half_turn),
            displacement: self.direction * along + *tip_angle * across,
        }
    }
}

/// `h(s)` and `H_1(s)` to `H_6(s)`, see [`MODE_SHAPE`].
pub(crate) fn mode_shape(s: f32) -> [f32; 7] {
    let mut power = 1.0;
    MODE_SHAPE.map(|[a, b, c, d]| {
        power *= s;
        power * (a + s * (b + s * (c + s * d)))
    })
}

/// A rotation by twice the vector `half`, for up to some 1.2 rad in all.
///
/// The series are of the 4th and 6th degree; what they leave of the quaternion's length, below 1e-5, one step of
/// Newton's method for the inverse root removes.
#[inline(always)]
fn rotation_by_twice<T: Number>(half: Vector<T>) -> Rotation<T> {
    let number = T::from;
    let x2 = half.length_squared();
    let sine = number(1.0) + x2 * (number(-1.0 / 6.0) + x2 * number(1.0 / 120.0));
    let cosine = number(1.0) + x2 * (number(-1.0 / 2.0) + x2 * (number(1.0 / 24.0) + x2 * number(-1.0 / 720.0)));
    let inverse_norm = number(1.5) - number(0.5) * (cosine * cosine + sine * sine * x2);
    Rotation { vector: half * (sine * inverse_norm), scalar: cosine * inverse_norm }
}
