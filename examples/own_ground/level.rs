//! What stands for a game's level: a function, a mesh, and physics.

use bevy::{
    math::{DVec2, DVec3},
    mesh::VertexAttributeValues,
    prelude::*,
};
use bevy_windwood::Ground;

/// Half the side of the level, m.
pub const HALF_M: f32 = 160.0;
/// Cells of its mesh along a side.
const CELLS: u32 = 80;
/// Steps of a ray, m: what it misses between two is lost in a picture.
const RAY_STEP_M: f64 = 0.1;

/// The height of the level at a place, m.
pub fn height_m(at: DVec2) -> f64 {
    let hills = 7.0 * (at.x / 43.0).sin() * (at.y / 37.0).cos() + 2.0 * (at.x / 17.0 + at.y / 23.0).sin();
    // A flat valley runs through.
    hills.max(-3.0)
}

/// The mesh of the level.
pub fn mesh() -> Mesh {
    let mut mesh = Mesh::from(Plane3d::default().mesh().size(2.0 * HALF_M, 2.0 * HALF_M).subdivisions(CELLS - 1));
    if let Some(VertexAttributeValues::Float32x3(positions)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        for [x, y, z] in positions {
            *y = height_m(DVec2::new(f64::from(*x), f64::from(*z))) as f32;
        }
    }
    mesh.compute_smooth_normals();
    mesh
}

/// A stand-in for a physics engine, which knows the level and casts rays at it.
#[derive(Clone)]
pub struct Physics;

impl Physics {
    /// The distance to the level straight below a point, m, if it is within reach.
    pub fn distance_down_m(&self, from: DVec3, reach_m: f64) -> Option<f64> {
        let surface_m = height_m.height_m(DVec2::new(from.x, from.z));
        let steps = (reach_m / RAY_STEP_M) as u32;
        (0..steps).map(|step| f64::from(step) * RAY_STEP_M).find(|distance_m| from.y - distance_m <= surface_m)
    }
}
