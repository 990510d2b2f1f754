//! Arithmetic that is written once for one number and for eight side by side, as many as two or four registers of a processor hold.

use std::ops::{Add, Div, Mul, Sub};
use wide::f32x8;

/// How many beams are posed at once.
pub(super) const LANES: usize = 8;

/// A number for each of [`LANES`] beams.
pub(super) type Lanes = f32x8;

/// One number, or one for each lane.
pub(super) trait Number:
    Copy + From<f32> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    fn sqrt(self) -> Self;
    /// The smaller of the two; `bound` for what is not a number.
    fn at_most(self, bound: f32) -> Self;
    /// The greater of the two; `bound` for what is not a number.
    fn at_least(self, bound: f32) -> Self;
}

impl Number for f32 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn at_most(self, bound: f32) -> Self {
        self.min(bound)
    }

    #[inline(always)]
    fn at_least(self, bound: f32) -> Self {
        self.max(bound)
    }
}

impl Number for Lanes {
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn at_most(self, bound: f32) -> Self {
        self.min(Self::splat(bound))
    }

    #[inline(always)]
    fn at_least(self, bound: f32) -> Self {
        self.max(Self::splat(bound))
    }
}

/// A vector of such numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vector<T>(pub [T; 3]);

impl<T: Number> Vector<T> {
    #[inline(always)]
    pub fn dot(&self, other: &Self) -> T {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        a * x + b * y + c * z
    }

    #[inline(always)]
    pub fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    #[inline(always)]
    pub fn length_squared(&self) -> T {
        self.dot(self)
    }
}

impl<T: Number> Add for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a + x, b + y, c + z])
    }
}

impl<T: Number> Sub for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a - x, b - y, c - z])
    }
}

impl<T: Number> Mul<T> for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self(self.0.map(|component| component * factor))
    }
}

/// A unit quaternion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rotation<T> {
    pub vector: Vector<T>,
    pub scalar: T,
}

impl<T: Number> Rotation<T> {
    /// By how much this turns a vector away from where it is. At rest that is exactly nothing.
    #[inline(always)]
    pub fn displacement(&self, of: &Vector<T>) -> Vector<T> {
        let twice = self.vector.cross(of) * T::from(2.0);
        twice * self.scalar + self.vector.cross(&twice)
    }

    #[inline(always)]
    pub fn rotate(&self, vector: Vector<T>) -> Vector<T> {
        vector + self.displacement(&vector)
    }

    /// First `inner`, then this one.
    #[inline(always)]
    pub fn after(&self, inner: &Self) -> Self {
        Self {
            vector: inner.vector * self.scalar + self.vector * inner.scalar + self.vector.cross(&inner.vector),
            scalar: self.scalar * inner.scalar - self.vector.dot(&inner.vector),
        }
    }
}

/// The lanes of as many numbers.
#[inline(always)]
pub(super) fn lanes<const N: usize>(of_lane: impl Fn(usize) -> [f32; N]) -> [Lanes; N] {
    let by_lane: [[f32; N]; LANES] = std::array::from_fn(of_lane);
    std::array::from_fn(|component| Lanes::from(std::array::from_fn::<f32, LANES, _>(|lane| by_lane[lane][component])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::{Quat, Vec3};

    fn vector(v: Vec3) -> Vector<f32> {
        Vector(v.to_array())
    }

    fn rotation(q: Quat) -> Rotation<f32> {
        Rotation { vector: Vector([q.x, q.y, q.z]), scalar: q.w }
    }

    #[test]
    fn rotations_are_those_of_quaternions() {
        let (a, b) = (Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 1.3), Quat::from_rotation_y(-0.7));
        let v = Vec3::new(3.0, -2.0, 5.0);
        let both = rotation(a).after(&rotation(b));
        let turned = Vec3::from_array(rotation(a).rotate(vector(v)).0);
        assert!(turned.distance(a * v) < 1e-5, "{turned}");
        let turned = Vec3::from_array(both.rotate(vector(v)).0);
        assert!(turned.distance(a * b * v) < 1e-5, "{turned}");
        assert_eq!(rotation(Quat::IDENTITY).displacement(&vector(v)).0, [0.0; 3]);
    }

    #[test]
    fn lanes_are_kept_apart() {
        let of_lane = |lane: usize| [lane as f32, 10.0 - lane as f32, 0.5];
        let [a, b, c] = lanes(of_lane);
        let product = Vector([a, b, c]).dot(&Vector([b, a, c])).to_array();
        for (lane, product) in product.into_iter().enumerate() {
            let [a, b, c] = of_lane(lane);
            assert_eq!(product, a * b + b * a + c * c);
        }
        assert_eq!(Number::at_most(Lanes::from(f32::NAN), 2.0).to_array(), [2.0; LANES]);
        assert_eq!(Number::at_least(f32::NAN, 2.0), 2.0);
    }
}
