//! The grid of a field of grass: which patches are about a viewer, and the seed of each.

use crate::mixing::{finalised, packed};
use bevy::math::{IVec2, Vec2};

/// A patch of the grid, counted from the field's origin along x and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct GridPatch {
    x: i32,
    z: i32,
}

impl GridPatch {
    /// Its middle in the field's (x, z), m, where patches have these sides.
    pub fn middle_m(self, side_m: Vec2) -> Vec2 {
        (Vec2::new(self.x as f32, self.z as f32) + 0.5) * side_m
    }

    /// Distance from a place to its nearest point, m: 0 within.
    pub fn distance_m(self, side_m: Vec2, place_m: Vec2) -> f32 {
        let beyond_m = (place_m - self.middle_m(side_m)).abs() - 0.5 * side_m;
        beyond_m.max(Vec2::ZERO).length()
    }

    /// The seed of its blades in a field with that seed.
    pub fn seed(self, field_seed: u64) -> u64 {
        finalised(finalised(packed(IVec2::new(self.x, self.z))) ^ field_seed)
    }
}

/// The patches that reach nearer to a place than that.
pub(crate) fn patches_within(side_m: Vec2, place_m: Vec2, reach_m: f32) -> impl Iterator<Item = GridPatch> {
    let [low, high] = [-reach_m, reach_m].map(|away_m| ((place_m + away_m) / side_m).floor().as_ivec2());
    let square = (low.x..=high.x).flat_map(move |x| (low.y..=high.y).map(move |z| GridPatch { x, z }));
    square.filter(move |patch| patch.distance_m(side_m, place_m) < reach_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    const SIDE_M: Vec2 = Vec2::new(16.0, 12.0);

    proptest! {
        /// Every place that is near enough lies in a patch that is there.
        #[test]
        fn patches_cover_the_disc_about_a_viewer(
            x in -5000.0..5000.0_f32, z in -5000.0..5000.0_f32, turn_rad in 0.0..6.2_f32, share in 0.0..0.999_f32,
        ) {
            let (viewer_m, reach_m) = (Vec2::new(x, z), 40.0);
            let seen_m = viewer_m + Vec2::from_angle(turn_rad) * (share * reach_m);
            let mut patches = patches_within(SIDE_M, viewer_m, reach_m);
            prop_assert!(patches.any(|patch| patch.distance_m(SIDE_M, seen_m) < 1e-3));
        }
    }

    #[test]
    fn patches_are_no_more_than_the_disc_needs() {
        let count = patches_within(SIDE_M, Vec2::new(3.0, -700.0), 40.0).count() as f32;
        // A disc and a rectangle that meet it: Steiner's formula for the area of all the places of the middle.
        let area_m2 = std::f32::consts::PI * 40.0 * 40.0 + 40.0 * 2.0 * (SIDE_M.x + SIDE_M.y) + SIDE_M.x * SIDE_M.y;
        assert!((count / (area_m2 / (SIDE_M.x * SIDE_M.y)) - 1.0).abs() < 0.1, "{count}");
    }

    #[test]
    fn seeds_differ_from_patch_to_patch_and_from_field_to_field() {
        let patches: Vec<GridPatch> = (-20..20).flat_map(|x| (-20..20).map(move |z| GridPatch { x, z })).collect();
        let seeds: BTreeSet<u64> =
            patches.iter().flat_map(|patch| [1, 2, u64::MAX].map(|field| patch.seed(field))).collect();
        assert_eq!(seeds.len(), 3 * patches.len());
    }

    #[test]
    fn a_viewer_beyond_the_grid_is_no_error() {
        for far_m in [1e12, f32::MAX, -f32::MAX] {
            assert!(patches_within(SIDE_M, Vec2::splat(far_m), 40.0).count() < 100);
        }
    }
}
