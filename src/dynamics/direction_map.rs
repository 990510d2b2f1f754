//! The coefficients of the load basis for every direction of a beam, in a small square of texels.
//!
//! A beam and its reverse are loaded alike, so half the sphere suffices: the upper one, in the hemi-octahedral map.
//! For a unit direction `d` in wind coordinates (along, up, across):
//!
//! ```text
//! if d.y < 0 { d = -d }
//! p = (d.x, d.z) / (|d.x| + |d.y| + |d.z|)              the octahedron seen from above: |p.x| + |p.y| <= 1
//! u = p.x + p.y,   v = p.x - p.y                        turned by 45 degrees into the square [-1, 1]^2
//! column = floor((u/2 + 1/2) (size - 1) + 1/2)          the nearest texel
//! row    = floor((v/2 + 1/2) (size - 1) + 1/2)
//! index  = row size + column
//! ```
//!
//! The size is odd, so that a vertical trunk lies on a texel's centre, as do both senses of the mean wind's direction
//! (two corners). There is no filtering: a texel is 64 bytes, one line of cache, and the nearest of 129 x 129
//! texels is at most 1.6 degrees off.

use bevy::math::{Vec2, Vec3, Vec4};

/// Number of floats in a texel: four vec4, see [`LoadCoefficients::to_texel`].
pub(crate) const TEXEL_FLOATS: usize = 16;

/// How the load of a beam is put together from the basis signals: `mean + sum of moving[k] * signal[k]`, in m^2/s^2,
/// in wind coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadCoefficients {
    /// Mean load, m^2/s^2: what bends the beam even in a steady wind.
    pub mean: Vec3,
    /// Load per unit of each signal, m^2/s^2.
    pub moving: [Vec3; 4],
}

impl LoadCoefficients {
    /// The four vec4 of a texel: `(moving[k].x, moving[k].y, moving[k].z, w_k)` for k = 0..4, where
    /// `(w_0, w_1, w_2)` is the mean and `w_3` is 0.
    pub(crate) fn to_texel(self) -> [f32; TEXEL_FLOATS] {
        let w = [self.mean.x, self.mean.y, self.mean.z, 0.0];
        let mut texel = [0.0; TEXEL_FLOATS];
        for (k, (row, moving)) in texel.chunks_exact_mut(4).zip(self.moving).enumerate() {
            row.copy_from_slice(&[moving.x, moving.y, moving.z, w[k]]);
        }
        texel
    }

    /// The inverse of [`to_texel`](Self::to_texel).
    pub(crate) fn from_texel(texel: &[f32; TEXEL_FLOATS]) -> Self {
        Self {
            mean: Vec3::new(texel[3], texel[7], texel[11]),
            moving: std::array::from_fn(|k| Vec3::from_slice(&texel[4 * k..])),
        }
    }

    /// Without the parts along the unit vector `direction`: a load along a beam does not bend it, and the nearest
    /// texel's load is perpendicular to the texel's direction, not quite to the beam's.
    pub(crate) fn perpendicular_to(&self, direction: Vec3) -> Self {
        let reject = |load: Vec3| load - load.dot(direction) * direction;
        Self { mean: reject(self.mean), moving: self.moving.map(reject) }
    }

    /// The load for the given values of the signals, m^2/s^2.
    pub fn load(&self, signals: Vec4) -> Vec3 {
        let [a, b, c, d] = self.moving;
        self.mean + a * signals.x + b * signals.y + c * signals.z + d * signals.w
    }
}

/// [`LoadCoefficients`] over the directions, ready for the GPU.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectionMap {
    size: usize,
    texels: Vec<[f32; TEXEL_FLOATS]>,
}

impl DirectionMap {
    /// Evaluates `coefficients` at the centres of a square of `size` x `size` texels. An even size is made odd and a
    /// size below 3 is made 3.
    pub(crate) fn new(size: usize, mut coefficients: impl FnMut(Vec3) -> LoadCoefficients) -> Self {
        let size = size.max(3) | 1;
        let texels =
            (0..size * size).map(|index| coefficients(texel_direction(index, size)).to_texel()).collect::<Vec<_>>();
        Self { size, texels }
    }

    /// The same map with `2 size - 1` texels a side; those between the given ones are means of their neighbours.
    pub(crate) fn refined(&self) -> Self {
        let size = 2 * self.size - 1;
        let coarse = |row: usize, column: usize| &self.texels[row * self.size + column];
        let texels = (0..size * size).map(|index| {
            let (row, column) = (index / size, index % size);
            let (top, left) = (row / 2, column / 2);
            let (bottom, right) = (row.div_ceil(2), column.div_ceil(2));
            let corners = [coarse(top, left), coarse(top, right), coarse(bottom, left), coarse(bottom, right)];
            std::array::from_fn(|i| corners.iter().map(|texel| texel[i]).sum::<f32>() / 4.0)
        });
        Self { size, texels: texels.collect() }
    }

    /// The coefficients of the nearest texel, made perpendicular to `direction`, a unit vector in wind coordinates.
    pub(crate) fn coefficients(&self, direction: Vec3) -> LoadCoefficients {
        LoadCoefficients::from_texel(&self.texels[self.texel_index(direction)]).perpendicular_to(direction)
    }

    /// Index of the texel nearest to `direction`, a unit vector in wind coordinates; see the [module](self).
    /// A direction that is not finite counts as vertical.
    fn texel_index(&self, direction: Vec3) -> usize {
        let square = square_from_direction(direction);
        let place = (square * 0.5 + 0.5) * (self.size - 1) as f32 + 0.5;
        let (column, row) = (place.x as usize, place.y as usize);
        row.min(self.size - 1) * self.size + column.min(self.size - 1)
    }

    /// Texels a side; odd.
    pub(crate) fn size(&self) -> usize {
        self.size
    }

    /// The texels row by row, see [`LoadCoefficients::to_texel`].
    pub(crate) fn texels(&self) -> &[[f32; TEXEL_FLOATS]] {
        &self.texels
    }
}

/// The point (u, v) of the square [-1, 1]^2 for a unit direction.
fn square_from_direction(direction: Vec3) -> Vec2 {
    let upward = if direction.y < 0.0 { -direction } else { direction };
    let manhattan = upward.abs().element_sum();
    let point = Vec2::new(upward.x, upward.z) / manhattan;
    let square = Vec2::new(point.x + point.y, point.x - point.y);
    if square.is_finite() { square } else { Vec2::ZERO }
}

/// The unit direction for a point (u, v) of the square [-1, 1]^2.
fn direction_from_square(square: Vec2) -> Vec3 {
    let point = Vec2::new(square.x + square.y, square.x - square.y) * 0.5;
    let height = (1.0 - point.x.abs() - point.y.abs()).max(0.0);
    Vec3::new(point.x, height, point.y).normalize()
}

/// Direction of a texel's centre, a unit vector in wind coordinates with y >= 0.
fn texel_direction(index: usize, size: usize) -> Vec3 {
    let place = Vec2::new((index % size) as f32, (index / size) as f32);
    direction_from_square(place * (2.0 / (size - 1) as f32) - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions() -> impl Iterator<Item = Vec3> {
        (0..500).map(|i| {
            let height = (i as f32 + 0.5) / 250.0 - 1.0;
            let azimuth = 2.4 * i as f32;
            let radius = (1.0 - height * height).sqrt();
            Vec3::new(radius * azimuth.cos(), height, radius * azimuth.sin())
        })
    }

    fn any_coefficients(direction: Vec3) -> LoadCoefficients {
        LoadCoefficients { mean: direction, moving: [Vec3::X, 2.0 * direction, Vec3::Y, Vec3::Z] }
    }

    #[test]
    fn nearest_texel_is_within_its_size_of_a_direction_and_its_reverse() {
        let map = DirectionMap::new(129, |_| LoadCoefficients::default());
        for direction in directions() {
            let texel = texel_direction(map.texel_index(direction), map.size());
            // Half a texel is 1/128 of the square in u and in v; the map stretches by less than 2.5.
            assert!(texel.cross(direction).length() < 2.5 * 2f32.sqrt() / 128.0, "{direction} found {texel}");
            assert!(map.texel_index(direction) == map.texel_index(-direction) || direction.y == 0.0);
        }
    }

    #[test]
    fn texel_of_a_texels_direction_is_that_texel() {
        let map = DirectionMap::new(9, |_| LoadCoefficients::default());
        let upward = (0..81).filter(|&index| texel_direction(index, map.size()).y > 1e-6);
        assert_eq!(upward.clone().count(), 81 - 32);
        for index in upward {
            assert_eq!(map.texel_index(texel_direction(index, map.size())), index);
        }
    }

    #[test]
    fn axes_lie_on_texel_centres() {
        let map = DirectionMap::new(65, |_| LoadCoefficients::default());
        for axis in [Vec3::Y, Vec3::NEG_Y, Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z] {
            let texel = texel_direction(map.texel_index(axis), map.size());
            assert!(texel.cross(axis).length() < 1e-6, "{axis} found {texel}");
        }
    }

    #[test]
    fn texel_and_coefficients_round_trip() {
        let coefficients = any_coefficients(Vec3::new(0.6, 0.0, 0.8));
        let texel = coefficients.to_texel();
        assert_eq!([texel[3], texel[7], texel[11], texel[15]], [0.6, 0.0, 0.8, 0.0]);
        assert_eq!(texel[4..7], [1.2, 0.0, 1.6]);
        assert_eq!(LoadCoefficients::from_texel(&texel), coefficients);
    }

    #[test]
    fn refined_map_keeps_texels_and_has_means_between_them() {
        let coarse = DirectionMap::new(5, any_coefficients);
        let fine = coarse.refined();
        assert_eq!(fine.size(), 9);
        assert_eq!(fine.texels()[2 * 9 + 4], coarse.texels()[5 + 2]);
        let between = (coarse.texels()[5 + 2][3] + coarse.texels()[5 + 3][3]) / 2.0;
        assert!((fine.texels()[2 * 9 + 5][3] - between).abs() < 1e-7);
    }

    #[test]
    fn loads_are_perpendicular_to_the_beam() {
        let map = DirectionMap::new(9, any_coefficients);
        for direction in directions() {
            let coefficients = map.coefficients(direction);
            for load in coefficients.moving.into_iter().chain([coefficients.mean]) {
                assert!(load.dot(direction).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn any_direction_has_a_texel() {
        let map = DirectionMap::new(0, |_| LoadCoefficients::default());
        assert_eq!(map.size(), 3);
        for direction in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::new(1e30, -2e30, 0.0)] {
            assert!(map.texel_index(direction) < 9);
        }
    }
}
