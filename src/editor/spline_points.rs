//! The control points of a spline ground, as things that are dragged up and down.

use bevy::math::Vec3;

use crate::terrain::{SplineGroundSettings, SplinePatch};

/// Heights are kept to so many parts of a metre.
const PARTS_OF_A_METRE: f32 = 10.0;
/// Sides of a new patch, in points.
const NEW_SIDE: u32 = 4;

/// A control point, by its patch and its number there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ControlPoint {
    pub patch: usize,
    pub number: usize,
}

/// All points with their places, m. Of two at one place of the lattice that of the later patch holds, and only that one is told.
pub fn control_points(settings: &SplineGroundSettings) -> Vec<(ControlPoint, Vec3)> {
    let mut points = Vec::new();
    for (patch_number, patch) in settings.patches.iter().enumerate() {
        for (number, height_m) in patch.heights_m.iter().enumerate() {
            let Some((column, row)) = place_in_lattice(patch, number) else { continue };
            let is_covered = settings.patches[patch_number + 1..].iter().any(|later| covers(later, column, row));
            if is_covered {
                continue;
            }
            let x = settings.west_m + settings.cell_x_m * column as f64;
            let z = settings.north_m + settings.cell_z_m * row as f64;
            let point = ControlPoint { patch: patch_number, number };
            points.push((point, Vec3::new(x as f32, *height_m, z as f32)));
        }
    }
    points
}

/// The height of a point, m.
pub fn height_m(settings: &SplineGroundSettings, point: ControlPoint) -> Option<f32> {
    settings.patches.get(point.patch)?.heights_m.get(point.number).copied()
}

/// The ground with a point at another height, m.
pub fn with_height(
    settings: &SplineGroundSettings,
    point: ControlPoint,
    height_m: f32,
) -> Option<SplineGroundSettings> {
    let mut settings = settings.clone();
    let own = settings.patches.get_mut(point.patch)?.heights_m.get_mut(point.number)?;
    *own = (height_m * PARTS_OF_A_METRE).round() / PARTS_OF_A_METRE;
    Some(settings)
}

/// The ground with one more patch, level and to the east of all others.
pub fn with_patch(settings: &SplineGroundSettings) -> SplineGroundSettings {
    let mut settings = settings.clone();
    let end = |patch: &SplinePatch| patch.first_column.saturating_add(patch.columns as i32);
    let first_column = settings.patches.iter().map(end).max().unwrap_or(0);
    let first_row = settings.patches.last().map_or(0, |patch| patch.first_row);
    let heights_m = vec![settings.base_m; (NEW_SIDE * NEW_SIDE) as usize];
    settings.patches.push(SplinePatch { first_column, first_row, columns: NEW_SIDE, rows: NEW_SIDE, heights_m });
    settings
}

/// Column and row of a point in the lattice.
fn place_in_lattice(patch: &SplinePatch, number: usize) -> Option<(i64, i64)> {
    let (column, row) = (number.checked_rem(patch.columns as usize)?, number / patch.columns as usize);
    Some((i64::from(patch.first_column) + column as i64, i64::from(patch.first_row) + row as i64))
}

fn covers(patch: &SplinePatch, column: i64, row: i64) -> bool {
    let within =
        |first: i32, count: u32, at: i64| (i64::from(first)..i64::from(first) + i64::from(count)).contains(&at);
    within(patch.first_column, patch.columns, column) && within(patch.first_row, patch.rows, row)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn five() -> SplineGroundSettings {
        SplineGroundSettings::from_ron(include_str!("../../assets/terrain/five_patches.ground.ron")).unwrap()
    }

    #[test]
    fn fifty_points_stand_at_their_places() {
        let ground = five();
        let points = control_points(&ground);
        assert_eq!(points.len(), 50);
        let (point, place) = points[3];
        assert_eq!((point, place), (ControlPoint { patch: 0, number: 3 }, Vec3::new(-210.0, 24.0, -60.0)));
        let raised = with_height(&ground, point, 30.04).unwrap();
        assert_eq!((height_m(&raised, point), control_points(&raised)[3].1.y), (Some(30.0), 30.0));
        assert_eq!(with_height(&ground, ControlPoint { patch: 9, number: 0 }, 1.0), None);
    }

    #[test]
    fn a_patch_is_added_where_no_other_is_and_covers_what_lies_under_it() {
        let ground = five();
        let more = with_patch(&ground);
        more.validate().unwrap();
        assert_eq!(control_points(&more).len(), 66);
        let mut over = more;
        over.patches[5].first_column = 0;
        over.patches[5].first_row = 0;
        over.validate().unwrap();
        assert_eq!(control_points(&over).len(), 50, "sixteen lie under the new patch");
        assert_eq!(control_points(&with_patch(&SplineGroundSettings::default())).len(), 16);
    }

    #[test]
    fn a_patch_without_columns_has_no_points() {
        let patch = SplinePatch { heights_m: vec![1.0], ..SplinePatch::default() };
        assert!(control_points(&SplineGroundSettings { patches: vec![patch], ..Default::default() }).is_empty());
    }
}
