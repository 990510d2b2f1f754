//! Gardner's ellipsoids as they are drawn; see [`gardner`](super::gardner).

use bevy::math::{Mat3, Quat, Vec3};

use super::gardner_settings::GardnerCrown;
use crate::tree::{
    ellipsoid::Ellipsoid,
    skeleton::{LeafCluster, Skeleton},
    vertices::LeafVertices,
};

/// Ambient light at the middle of the crown, and on the lower side of an ellipsoid, against that on top.
const DEEP_LIGHT: f32 = 0.3;
const UNDERSIDE_LIGHT: f32 = 0.45;

pub(super) fn leaves(crown: &GardnerCrown, skeleton: &Skeleton) -> LeafVertices {
    let mut out = LeafVertices::default();
    for cluster in &skeleton.clusters {
        ellipsoid(crown, cluster).write(cluster, |point, normal| light(skeleton, point, normal), &mut out);
    }
    out
}

fn ellipsoid(crown: &GardnerCrown, cluster: &LeafCluster) -> Ellipsoid {
    Ellipsoid {
        centre: cluster.anchor + cluster.axis * (0.5 * cluster.size_m),
        axes: Mat3::IDENTITY,
        semi_axes_m: Vec3::new(1.0, crown.slenderness(), 1.0) * (0.5 * cluster.size_m),
        // Each is turned otherwise, so that they do not show the same leaves on the same side.
        turn: Quat::from_rotation_y(std::f32::consts::TAU * cluster.phase),
        facets: crown.facets,
    }
}

/// Light that reaches a point: less towards the crown's middle and from below.
fn light(skeleton: &Skeleton, point: Vec3, normal: Vec3) -> f32 {
    let outer = 1.0 - skeleton.envelope.depth(point);
    let open = DEEP_LIGHT + (1.0 - DEEP_LIGHT) * outer * outer;
    open * (UNDERSIDE_LIGHT + (1.0 - UNDERSIDE_LIGHT) * (0.5 + 0.5 * normal.y))
}
