//! The places of plants in their quadrat.

use bevy::math::DVec2;
use rand::{Rng, RngExt};

use super::grid::QuadratGrid;
use crate::setting::{SettingError, require};

/// Darts thrown for a plant before it is left out: nearly all find room in a quadrat that is nine tenths full.
const DARTS: u32 = 24;
/// 160 MB of points.
const MOST_POINTS: u64 = 10_000_000;

/// Puts as many points into each quadrat as `counts` says, uniformly; with `least_distance_m` above 0 no two of the same
/// quadrat nearer than that to each other, and none nearer than half of it to the quadrat's edge, so that none of
/// different quadrats are either. A point that finds no room is left out.
///
/// # Errors
/// [`SettingError`] where `counts` are not as many as the quadrats, the points are more than ten million, or
/// the distance does not fit into a quadrat.
pub fn place_points(
    grid: &QuadratGrid,
    counts: &[u32],
    least_distance_m: f64,
    random: &mut impl Rng,
) -> Result<Vec<DVec2>, SettingError> {
    require("counts", counts.len(), grid.quadrats()..=grid.quadrats())?;
    let total: u64 = counts.iter().map(|&count| u64::from(count)).sum();
    require("points", total, 0..=MOST_POINTS)?;
    require("least_distance_m", least_distance_m, 0.0..=0.5 * grid.quadrat_m().min_element())?;
    let margin = DVec2::splat(0.5 * least_distance_m);
    let mut points = Vec::with_capacity(total as usize);
    for (quadrat, &count) in counts.iter().enumerate() {
        let corner = grid.corner_m(quadrat) + margin;
        throw_darts(corner, grid.quadrat_m() - 2.0 * margin, count as usize, least_distance_m, random, &mut points);
    }
    Ok(points)
}

/// Adds up to `count` points between `corner` and `corner + size`, none nearer than `least_distance_m` to another of
/// them.
pub(in crate::scatter) fn throw_darts(
    corner: DVec2,
    size: DVec2,
    count: usize,
    least_distance_m: f64,
    random: &mut impl Rng,
    points: &mut Vec<DVec2>,
) {
    let first = points.len();
    let darts = if least_distance_m > 0.0 { DARTS } else { 1 };
    for _ in 0..count {
        for _ in 0..darts {
            let dart = corner + size * DVec2::new(random.random(), random.random());
            let crowded = |other: &DVec2| other.distance_squared(dart) < least_distance_m * least_distance_m;
            if least_distance_m == 0.0 || !points[first..].iter().any(crowded) {
                points.push(dart);
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};

    fn grid() -> QuadratGrid {
        QuadratGrid::new(DVec2::ZERO, DVec2::splat(100.0), 10, 10).unwrap()
    }

    #[test]
    fn quadrats_hold_their_counts() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let counts: Vec<u32> = (0..100).map(|quadrat| quadrat % 7).collect();
        let points = place_points(&grid(), &counts, 0.0, &mut random).unwrap();
        assert_eq!(grid().counts(&points).unwrap(), counts);
        let spaced = place_points(&grid(), &counts, 1.0, &mut random).unwrap();
        assert_eq!(grid().counts(&spaced).unwrap(), counts, "six stems a metre apart have room in 81 square metres");
    }

    #[test]
    fn points_keep_the_least_distance_even_where_there_is_no_room() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let points = place_points(&grid(), &[60; 100], 2.0, &mut random).unwrap();
        assert!(points.len() < 6000);
        for (index, a) in points.iter().enumerate() {
            assert!(points[..index].iter().all(|b| a.distance(*b) >= 2.0));
        }
    }

    #[test]
    fn too_many_points_and_bad_distances_are_refused() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut error =
            |counts: &[u32], distance| place_points(&grid(), counts, distance, &mut random).unwrap_err().to_string();
        assert_eq!(error(&[u32::MAX; 100], 0.0), "`points` is 429496729500, but must be 0 to 10000000");
        assert_eq!(error(&[1; 100], f64::NAN), "`least_distance_m` is NaN, but must be 0 to 5");
        assert_eq!(error(&[1; 3], 0.0), "`counts` is 3, but must be 100 to 100");
    }
}
