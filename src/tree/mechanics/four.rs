//! Complex numbers, vectors and matrices at four frequencies at once.

use bevy::math::{Vec3, Vec4};
use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

/// A complex number for each of four frequencies.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Four {
    pub re: Vec4,
    pub im: Vec4,
}

/// A vector of such numbers.
pub(super) type Vector = [Four; 3];
/// A matrix of such numbers, by rows.
pub(super) type Matrix = [Vector; 3];

impl Four {
    pub const ZERO: Self = Self { re: Vec4::ZERO, im: Vec4::ZERO };

    #[inline]
    pub fn real(value: f32) -> Self {
        Self { re: Vec4::splat(value), im: Vec4::ZERO }
    }

    #[inline]
    pub fn recip(self) -> Self {
        // Squares of determinants would leave the range of f32.
        let scale = self.re.abs().max(self.im.abs()).recip();
        let (re, im) = (self.re * scale, self.im * scale);
        let norm = scale / (re * re + im * im);
        Self { re: re * norm, im: -im * norm }
    }
}

impl Add for Four {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl Sub for Four {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }
}

impl Mul for Four {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}

impl Mul<f32> for Four {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f32) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
}

impl AddAssign for Four {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Four {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

#[inline(always)]
pub(super) fn dot(a: &Vector, b: &Vector) -> Four {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a x b`.
#[inline(always)]
pub(super) fn cross(a: Vec3, b: &Vector) -> Vector {
    [b[2] * a.y - b[1] * a.z, b[0] * a.z - b[2] * a.x, b[1] * a.x - b[0] * a.y]
}

#[inline]
pub(super) fn transposed(matrix: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[column][row]))
}

#[inline(always)]
pub(super) fn times(matrix: &Matrix, vector: &Vector) -> Vector {
    std::array::from_fn(|row| dot(&matrix[row], vector))
}

/// `a b^T`.
#[inline]
pub(super) fn times_transposed(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| dot(&a[row], &b[column])))
}

/// `a b^T` where that is symmetric.
#[inline]
pub(super) fn symmetric_times_transposed(a: &Matrix, b: &Matrix) -> Matrix {
    let [xx, xy, xz] = std::array::from_fn(|column| dot(&a[0], &b[column]));
    let [yy, yz] = [1, 2].map(|column| dot(&a[1], &b[column]));
    let zz = dot(&a[2], &b[2]);
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
}

/// The inverse of a symmetric matrix.
#[inline]
pub(super) fn inverse(m: &Matrix) -> Matrix {
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = *m;
    let (a, b, c) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
    let (d, e, f) = (xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy);
    let scale = (xx * a + xy * b + xz * c).recip();
    let [a, b, c, d, e, f] = [a, b, c, d, e, f].map(|minor| minor * scale);
    [[a, b, c], [b, d, e], [c, e, f]]
}

#[inline]
pub(super) fn add<const N: usize>(a: &mut [Four; N], b: &[Four; N]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += *b);
}

#[inline]
pub(super) fn subtract<const N: usize>(a: &mut [Four; N], b: &[Four; N]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a -= *b);
}

#[inline]
pub(super) fn subtracted(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|n| a[n] - b[n])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Determinants of stems go beyond the root of the range of f32.
    #[test]
    fn inverses_are_inverses_for_twigs_and_for_stems() {
        for scale in [1e-6_f32, 1.0, 1e10] {
            let at = |re: f32, im: f32| Four { re: Vec4::splat(re * scale), im: Vec4::splat(im * scale) };
            let [xx, xy, xz] = [at(2.0, -0.3), at(0.4, 0.1), at(-0.2, 0.05)];
            let [yy, yz, zz] = [at(1.5, -0.2), at(0.3, -0.1), at(0.9, -0.1)];
            let matrix = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
            let unit = times_transposed(&matrix, &inverse(&matrix));
            for (row, column) in (0..9).map(|index| (index / 3, index % 3)) {
                let expected = if row == column { 1.0 } else { 0.0 };
                let Four { re, im } = unit[row][column];
                assert!(
                    (re - expected).abs().max_element() < 1e-5 && im.abs().max_element() < 1e-5,
                    "{scale}: {re} {im}"
                );
            }
        }
    }
}
