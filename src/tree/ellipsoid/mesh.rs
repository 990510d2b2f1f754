//! The vertices of ellipsoids.

use bevy::math::{Mat3, Quat, Vec2, Vec3};

use super::chart::unfolded;
use crate::tree::{skeleton::LeafCluster, vertices::LeafVertices};

/// An ellipsoid that carries the texture of [`texture`](super::texture::texture).
pub(in crate::tree) struct Ellipsoid {
    pub centre: Vec3,
    /// Directions of its axes: the columns of an orthogonal matrix.
    pub axes: Mat3,
    /// Semi-axes along these, m: above 0.
    pub semi_axes_m: Vec3,
    /// How the texture, and with it the vertices, are turned on it.
    pub turn: Quat,
    /// Facets along a quarter of its girth: at least 1.
    pub facets: u32,
}

impl Ellipsoid {
    /// Adds its vertices, which belong to `cluster`. `light` is the ambient light at a point with a normal, 0 to 1.
    pub fn write(&self, cluster: &LeafCluster, light: impl Fn(Vec3, Vec3) -> f32, out: &mut LeafVertices) {
        let first = out.positions.len() as u32;
        let steps = 2 * self.facets;
        for row in 0..=steps {
            for column in 0..=steps {
                let uv = Vec2::new(column as f32, row as f32) / steps as f32;
                let sphere = self.turn * unfolded(uv);
                let position = self.centre + self.axes * (sphere * self.semi_axes_m);
                // Scaled by the thinnest axis, so that no quotient leaves the range of numbers.
                let thinness = self.semi_axes_m.min_element() / self.semi_axes_m;
                let normal = (self.axes * (sphere * thinness)).try_normalize().unwrap_or(Vec3::Y);
                out.push(cluster, position, normal, uv.to_array(), light(position, normal));
            }
        }
        for row in 0..steps {
            for column in 0..steps {
                out.indices.extend(cell(row, column, steps).map(|index| first + index));
            }
        }
    }
}

/// The two triangles of a cell of the chart, split along the octahedron's edges, counter-clockwise from outside.
fn cell(row: u32, column: u32, steps: u32) -> [u32; 6] {
    let low = row * (steps + 1) + column;
    let (right, below, across) = (low + 1, low + steps + 1, low + steps + 2);
    let half = steps / 2;
    if (row < half) == (column < half) {
        [low, below, right, right, below, across]
    } else {
        [low, below, across, low, across, right]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::EulerRot;

    fn cluster() -> LeafCluster {
        LeafCluster {
            beam: 3,
            at: 0.4,
            anchor: Vec3::ZERO,
            axis: Vec3::X,
            normal: Vec3::Y,
            size_m: 1.0,
            phase: 0.7,
            depth: 0.2,
            tint: 0.5,
        }
    }

    fn written(ellipsoid: &Ellipsoid) -> LeafVertices {
        let mut out = LeafVertices::default();
        ellipsoid.write(&cluster(), |_, _| 0.6, &mut out);
        out
    }

    fn leaf(facets: u32) -> Ellipsoid {
        Ellipsoid {
            centre: Vec3::new(4.0, -2.0, 1.0),
            axes: Mat3::from_euler(EulerRot::XYZ, 0.4, 1.1, -0.7),
            semi_axes_m: Vec3::new(0.3, 0.03, 0.1),
            turn: Quat::from_rotation_x(0.8),
            facets,
        }
    }

    /// Against the implicit equation of an ellipsoid and its gradient.
    #[test]
    fn vertices_lie_on_the_ellipsoid_and_normals_are_those_of_its_quadric() {
        for facets in [1, 2, 5] {
            let ellipsoid = leaf(facets);
            let out = written(&ellipsoid);
            assert_eq!(out.positions.len() as u32, (2 * facets + 1).pow(2));
            assert_eq!(out.indices.len() as u32, 3 * 8 * facets.pow(2));
            for (position, normal) in out.positions.iter().zip(&out.normals) {
                let own = ellipsoid.axes.transpose() * (Vec3::from(*position) - ellipsoid.centre);
                let scaled = own / ellipsoid.semi_axes_m;
                assert!((scaled.length_squared() - 1.0).abs() < 1e-4, "{scaled}");
                let gradient = ellipsoid.axes * (scaled / ellipsoid.semi_axes_m);
                assert!(gradient.normalize().dot(Vec3::from(*normal)) > 0.9999);
            }
        }
    }

    /// Triangles face outwards, and with finer facets their area and volume become those of the ellipsoid.
    #[test]
    fn triangles_enclose_the_volume_of_the_ellipsoid() {
        let volume = |facets: u32| {
            let ellipsoid = leaf(facets);
            let out = written(&ellipsoid);
            let corner = |index: u32| Vec3::from(out.positions[index as usize]) - ellipsoid.centre;
            let of_triangle = |triple: &[u32]| {
                let [a, b, c] = [triple[0], triple[1], triple[2]].map(corner);
                a.dot(b.cross(c)) / 6.0
            };
            let parts: Vec<f32> = out.indices.chunks_exact(3).map(of_triangle).collect();
            assert!(parts.iter().all(|part| *part > 0.0));
            parts.iter().sum::<f32>() / (4.0 / 3.0 * std::f32::consts::PI * ellipsoid.semi_axes_m.element_product())
        };
        // An octahedron in a sphere fills 1 / pi of it.
        assert!((volume(1) - std::f32::consts::FRAC_1_PI).abs() < 1e-4);
        assert!(volume(16) > 0.98 && volume(16) < 1.0);
    }
}
