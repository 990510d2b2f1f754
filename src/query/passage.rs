//! A ray on its way through trees: in the coordinates of each, and how much of it all their crowns stop.

use crate::tree::body::BodyRay;
use bevy::math::{Affine3A, Vec3};
use std::f32::consts::LN_2;

/// A ray in a tree's own coordinates.
pub struct LocalRay {
    /// As far as it is in the tree's box.
    pub ray: BodyRay,
    /// Length in the world of a metre of it.
    pub scale: f32,
    /// Where it begins on the ray in the world, m.
    pub begins_m: f32,
    /// The place of the tree.
    pub world_from_local: Affine3A,
}

impl LocalRay {
    /// A ray up to a length, m, as far as it is in a tree's box, whose least and greatest corners are tree-local; `None` where it misses
    /// that.
    pub fn new(
        world_from_local: Affine3A,
        origin: Vec3,
        direction: Vec3,
        end_m: f32,
        bounds: [Vec3; 2],
    ) -> Option<Self> {
        let local_from_world = world_from_local.inverse();
        let way = local_from_world.transform_vector3(direction);
        let scale = 1.0 / way.length();
        if !(scale.is_finite() && way.is_finite() && scale > 0.0) {
            return None;
        }
        let (from, way) = (local_from_world.transform_point3(origin), way * scale);
        let [mut enters_m, mut leaves_m] = [0.0, end_m / scale];
        for axis in 0..3 {
            let [one, other] = bounds.map(|bound| (bound[axis] - from[axis]) / way[axis]);
            // On an axis across the ray both are infinite, or no numbers on the very border.
            enters_m = one.min(other).max(enters_m);
            leaves_m = one.max(other).min(leaves_m);
        }
        (enters_m <= leaves_m).then(|| {
            let ray = BodyRay { origin: from + enters_m * way, direction: way, part_m: [0.0, leaves_m - enters_m] };
            Self { ray, scale, begins_m: enters_m * scale, world_from_local }
        })
    }
}

/// A part of the way through a crown: from, to, m, its optical depth, and whose it is.
pub type Passed<K> = (f32, f32, f32, K);

/// The optical depth of a way up to its end, m, and where it is ln 2, m, and in whose crown.
pub fn depth_until<K: Copy + Ord>(mut passed: Vec<Passed<K>>, end_m: f32) -> (f32, Option<(f32, K)>) {
    passed.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.3.cmp(&b.3)));
    let (mut depth, mut half) = (0.0, None);
    for (from_m, to_m, whole, tree) in passed {
        let share = ((end_m - from_m) / (to_m - from_m)).clamp(0.0, 1.0);
        let more = if share > 0.0 { share * whole } else { 0.0 };
        if half.is_none() && depth + more >= LN_2 {
            let place = (LN_2 - depth) / whole;
            half = Some((from_m + place * (to_m - from_m), tree));
        }
        depth += more;
    }
    (depth, half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Quat;

    #[test]
    fn half_of_a_ray_is_stopped_where_its_depth_is_ln_2() {
        // Two crowns that overlap, in any order.
        let passed = vec![(10.0, 14.0, LN_2, 'b'), (4.0, 6.0, 0.5 * LN_2, 'a')];
        let (depth, place) = depth_until(passed.clone(), 100.0);
        assert!((depth - 1.5 * LN_2).abs() < 1e-6);
        assert!(place.is_some_and(|(at_m, tree)| (at_m - 12.0).abs() < 1e-5 && tree == 'b'));
        let (depth, place) = depth_until(passed.clone(), 11.0);
        assert!((depth - 0.75 * LN_2).abs() < 1e-6 && place.is_none());
        assert_eq!(depth_until(passed, 3.0), (0.0, None));
        assert_eq!(depth_until(Vec::<Passed<char>>::new(), 3.0), (0.0, None));
    }

    /// Places on a ray that a turned, mirrored and scaled tree knows are those of the world.
    #[test]
    fn a_local_ray_is_the_ray_in_the_world() {
        let at = |scale| {
            Affine3A::from_scale_rotation_translation(scale, Quat::from_rotation_y(1.1), Vec3::new(300.0, -4.0, 120.0))
        };
        let tree = at(Vec3::new(-1.5, 1.5, 1.5));
        let (origin, target) = (Vec3::new(280.0, 9.0, 100.0), Vec3::new(300.5, 5.0, 120.5));
        let direction = (target - origin).normalize();
        let bounds = [Vec3::new(-4.0, 0.0, -4.0), Vec3::new(4.0, 12.0, 4.0)];
        let local = LocalRay::new(tree, origin, direction, 100.0, bounds).unwrap();
        for step in 0..=10 {
            let part_m = 0.1 * step as f32 * local.ray.part_m[1];
            let there = tree.transform_point3(local.ray.origin + part_m * local.ray.direction);
            let here = origin + (local.begins_m + local.scale * part_m) * direction;
            assert!(there.distance(here) < 1e-3, "{there} for {here}");
        }
        assert!(LocalRay::new(tree, origin, -direction, 100.0, bounds).is_none());
        assert!(LocalRay::new(tree, origin, direction, 5.0, bounds).is_none(), "too short");
        assert!(LocalRay::new(at(Vec3::ZERO), origin, direction, 100.0, bounds).is_none());
    }
}
