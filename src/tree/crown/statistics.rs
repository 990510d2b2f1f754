//! Statistics of an impressionist crown, measured on its vertices.

use bevy::math::Vec3;
use serde::{Deserialize, Serialize};

use super::impressionist::ImpressionistCrown;
use crate::tree::vertices::LeafVertices;

/// How the polygons of a crown lie. All is measured on the corners that are drawn, not taken from the settings; zeros
/// for a crown without polygons.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CrownStatistics {
    /// Polygons.
    pub polygons: usize,
    /// Mean angle between polygons and the level, degrees.
    pub inclination_mean_deg: f32,
    /// Half the range of a uniform distribution with the measured variance: sqrt(3) standard deviations, degrees.
    pub inclination_spread_deg: f32,
    /// Greatest angle between a polygon's normal and the way out, both seen from above, degrees. A plane has no
    /// front: 0 to 90.
    pub azimuth_greatest_deg: f32,
    /// Share of the corners that lie outside the crown's outline (by more than a thousandth of its size), 0 to 1.
    pub outside_envelope_share: f32,
}

impl CrownStatistics {
    /// Measures `leaves` of the individual of `crown` that was grown at `scale`.
    #[must_use]
    pub fn of(crown: &ImpressionistCrown, scale: f32, leaves: &LeafVertices) -> Self {
        let profile = crown.scaled(scale).profile();
        let corner = |index: u32| leaves.positions.get(index as usize).copied().map_or(Vec3::ZERO, Vec3::from);
        let polygons: Vec<[Vec3; 3]> =
            leaves.indices.chunks_exact(3).map(|t| [corner(t[0]), corner(t[1]), corner(t[2])]).collect();
        if polygons.is_empty() {
            return Self::default();
        }
        let count = polygons.len() as f64;
        let inclinations: Vec<f64> = polygons.iter().map(|corners| f64::from(inclination_deg(corners))).collect();
        let mean = inclinations.iter().sum::<f64>() / count;
        let variance = inclinations.iter().map(|angle| (angle - mean).powi(2)).sum::<f64>() / count;
        let outside = polygons.iter().flatten().filter(|&&corner| !profile.holds(corner)).count();
        Self {
            polygons: polygons.len(),
            inclination_mean_deg: mean as f32,
            inclination_spread_deg: (3.0 * variance).sqrt() as f32,
            azimuth_greatest_deg: polygons.iter().filter_map(azimuth_deg).fold(0.0, f32::max),
            outside_envelope_share: outside as f32 / (3.0 * count as f32),
        }
    }
}

fn normal([a, b, c]: &[Vec3; 3]) -> Vec3 {
    (*b - *a).cross(*c - *a).normalize_or(Vec3::Y)
}

fn inclination_deg(corners: &[Vec3; 3]) -> f32 {
    normal(corners).y.abs().min(1.0).acos().to_degrees()
}

/// `None` where the polygon is level or its anchor on the axis, for then there is no such angle.
fn azimuth_deg(corners: &[Vec3; 3]) -> Option<f32> {
    let level = |vector: Vec3| Vec3::new(vector.x, 0.0, vector.z);
    let (faces, out) = (level(normal(corners)), level(corners[0]));
    if faces.length() < 1e-3 || out.length() < 1e-3 {
        return None;
    }
    Some((faces.dot(out).abs() / (faces.length() * out.length())).min(1.0).acos().to_degrees())
}
