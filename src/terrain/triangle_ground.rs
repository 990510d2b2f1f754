//! Ground of triangles: the mesh of a game's level, and whatever else is made of triangles.

use super::error::TerrainError;
use crate::{
    ground::Ground,
    setting::{SettingError, require},
};
use bevy::math::{DVec2, DVec3, Vec3};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2_from_tris},
    triangle::Triangle,
};
use std::time::Duration;

/// 600 MiB of corners and boxes.
const MOST_TRIANGLES: usize = 1 << 22;
/// Corners beyond this have no millimetres left in single precision, and more than metres are off long before.
const FARTHEST_M: f32 = 1e7;
/// How far a place may lie outside a triangle, as a share of it: no ray falls through the edge between two.
const EDGE: f64 = 1e-9;

/// Ground of triangles, in the world's frame. The highest one above a place is the ground there, whichever way it faces; where there is
/// none, there is no ground, and nothing grows. A place is found in the logarithm of the number of triangles.
pub struct TriangleGround {
    triangles: Vec<[Vec3; 3]>,
    boxes: Bvh2,
}

impl TriangleGround {
    /// Ground of the triangles whose corners, m, are three indices each.
    ///
    /// # Errors
    /// [`TerrainError::Setting`] for corners that are no numbers or farther than 10^7 m away, indices of no corner, no triangle, more than
    /// 2^22, or a number of indices that is no multiple of three.
    pub fn new(corners: &[Vec3], indices: &[u32]) -> Result<Self, TerrainError> {
        if !indices.len().is_multiple_of(3) {
            return Err(SettingError::new("indices", indices.len(), "three for each triangle").into());
        }
        require("triangles", indices.len() / 3, 1..=MOST_TRIANGLES)?;
        for (index, corner) in corners.iter().enumerate() {
            // NaN is not within reach either.
            if !corner.abs().cmple(Vec3::splat(FARTHEST_M)).all() {
                let allowed = format!("within {FARTHEST_M} m of the origin");
                return Err(SettingError::new(format!("corners[{index}]"), corner, allowed).into());
            }
        }
        let corner = |place: usize| {
            let allowed = || format!("the number of a corner, below {}", corners.len());
            let found = corners.get(indices[place] as usize).copied();
            found.ok_or_else(|| SettingError::new(format!("indices[{place}]"), indices[place], allowed()))
        };
        let triangle = |first: usize| Ok([corner(first)?, corner(first + 1)?, corner(first + 2)?]);
        let triangles = (0..indices.len()).step_by(3).map(triangle).collect::<Result<Vec<_>, SettingError>>()?;
        let solids: Vec<Triangle> = triangles
            .iter()
            .map(|corners| corners.map(|corner| corner.to_array().into()))
            .map(|[v0, v1, v2]| Triangle { v0, v1, v2 })
            .collect();
        let boxes = build_bvh2_from_tris(&solids, BvhBuildParams::fast_build(), &mut Duration::default());
        Ok(Self { triangles, boxes })
    }

    /// The height of the highest triangle above a place, and its gradient.
    fn highest(&self, place: DVec2) -> Option<(f64, DVec2)> {
        let mut highest: Option<(f64, DVec2)> = None;
        self.boxes.aabb_traverse(column_about(place), |boxes, node| {
            let node = &boxes.nodes[node as usize];
            let first = node.first_index as usize;
            for &triangle in &boxes.primitive_indices[first..first + node.prim_count as usize] {
                if let Some(hit) = height_and_gradient(self.triangles[triangle as usize], place)
                    && highest.is_none_or(|(height_m, _)| hit.0 > height_m)
                {
                    highest = Some(hit);
                }
            }
            true
        });
        highest
    }
}

impl Ground for TriangleGround {
    fn height_m(&self, place: DVec2) -> f64 {
        self.highest(place).map_or(f64::NAN, |(height_m, _)| height_m)
    }

    /// That of the triangle at the place.
    fn gradient(&self, place: DVec2) -> DVec2 {
        self.highest(place).map_or(DVec2::ZERO, |(_, gradient)| gradient)
    }
}

/// The box of all heights about a place, as narrow as single precision has it.
fn column_about(place: DVec2) -> Aabb {
    let [x, z] = place.as_vec2().to_array();
    Aabb { min: [x.next_down(), f32::MIN, z.next_down()].into(), max: [x.next_up(), f32::MAX, z.next_up()].into() }
}

/// The plane of a triangle above a place within it. A vertical triangle is above none.
fn height_and_gradient(corners: [Vec3; 3], place: DVec2) -> Option<(f64, DVec2)> {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let flat = |edge: DVec3| DVec2::new(edge.x, edge.z);
    let (ab, ac, at) = (b - a, c - a, place - flat(a));
    let area = flat(ab).perp_dot(flat(ac));
    let (to_b, to_c) = (at.perp_dot(flat(ac)) / area, flat(ab).perp_dot(at) / area);
    // Of a vertical triangle both are infinite or no numbers, and so never inside.
    if !(to_b >= -EDGE && to_c >= -EDGE && to_b + to_c <= 1.0 + EDGE) {
        return None;
    }
    let gradient = DVec2::new(ab.y * ac.z - ac.y * ab.z, ac.y * ab.x - ab.y * ac.x) / area;
    Some((a.y + to_b * ab.y + to_c * ac.y, gradient))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    /// A grid of 20 x 20 cells of 5 m, bent by a function.
    fn hills(height_m: impl Fn(f32, f32) -> f32) -> TriangleGround {
        let places = (0..21 * 21).map(|index| (5.0 * (index % 21) as f32, 5.0 * (index / 21) as f32));
        let corners: Vec<Vec3> = places.map(|(x, z)| Vec3::new(x, height_m(x, z), z)).collect();
        let cell = |index: u32| {
            let first = index / 20 * 21 + index % 20;
            [first, first + 21, first + 1, first + 1, first + 21, first + 22]
        };
        TriangleGround::new(&corners, &(0..400).flat_map(cell).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn a_plane_of_triangles_is_that_plane_everywhere_also_on_edges() {
        let ground = hills(|x, z| 100.0 + 0.5 * x - 0.25 * z);
        for step in 0..=400_u32 {
            let at = DVec2::new(f64::from(step % 20) * 5.0, f64::from(step) * 0.25);
            assert_relative_eq!(ground.height_m(at), 100.0 + 0.5 * at.x - 0.25 * at.y, epsilon = 1e-4);
            assert_relative_eq!(ground.gradient(at).x, 0.5, epsilon = 1e-5);
            assert_relative_eq!(ground.gradient(at).y, -0.25, epsilon = 1e-5);
        }
        for outside in [DVec2::new(-0.01, 5.0), DVec2::new(5.0, 100.01), DVec2::splat(f64::NAN), DVec2::splat(1e30)] {
            assert!(ground.height_m(outside).is_nan(), "{outside}");
            assert_eq!(ground.gradient(outside), DVec2::ZERO);
        }
    }

    #[test]
    fn the_highest_of_all_triangles_above_a_place_is_found() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
        let corners: Vec<Vec3> =
            (0..900).map(|_| Vec3::from_array(std::array::from_fn(|_| random.random_range(-50.0..50.0_f32)))).collect();
        let ground = TriangleGround::new(&corners, &(0..900).collect::<Vec<_>>()).unwrap();
        for _ in 0..500 {
            let at = DVec2::new(random.random_range(-50.0..50.0), random.random_range(-50.0..50.0));
            let all = ground.triangles.iter().filter_map(|corners| height_and_gradient(*corners, at));
            let expected = all.map(|(height_m, _)| height_m).fold(f64::NAN, f64::max);
            let found = ground.height_m(at);
            assert!(found == expected || found.is_nan() && expected.is_nan(), "{found} for {expected}");
        }
    }

    #[test]
    fn walls_are_above_no_place() {
        let wall = [Vec3::ZERO, Vec3::new(10.0, 0.0, 0.0), Vec3::new(10.0, 20.0, 0.0)];
        let ground = TriangleGround::new(&wall, &[0, 1, 2]).unwrap();
        assert!(ground.height_m(DVec2::new(5.0, 0.0)).is_nan());
    }

    #[test]
    fn what_is_no_ground_is_refused_by_name() {
        let error = |corners: &[Vec3], indices: &[u32]| match TriangleGround::new(corners, indices) {
            Ok(_) => panic!("it should have been refused"),
            Err(error) => error.to_string(),
        };
        assert_eq!(error(&[], &[]), "`triangles` is 0, but must be 1 to 4194304");
        assert_eq!(error(&[Vec3::ZERO], &[0, 0]), "`indices` is 2, but must be three for each triangle");
        assert_eq!(error(&[Vec3::ZERO], &[0, 1, 0]), "`indices[1]` is 1, but must be the number of a corner, below 1");
        assert!(error(&[Vec3::NAN], &[0, 0, 0]).starts_with("`corners[0]` is [NaN, NaN, NaN]"));
    }
}
