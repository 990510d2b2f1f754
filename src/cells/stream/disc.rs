//! The cells of a disc on the map, row by row.

use bevy::math::{DVec2, IVec2};

/// The ground within a radius of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Disc {
    /// (x, z), m.
    pub centre: DVec2,
    pub radius_m: f64,
}

/// The least and the greatest column of a run of cells.
type Run = [i32; 2];

impl Disc {
    /// The cells of a row of which any part is within the disc.
    fn run(&self, row: i32, cell_m: f64) -> Option<Run> {
        let nearest_edge_m = self.centre.y.clamp(f64::from(row) * cell_m, (f64::from(row) + 1.0) * cell_m);
        let half_m = (self.radius_m.powi(2) - (nearest_edge_m - self.centre.y).powi(2)).sqrt();
        let column = |x_m: f64| (x_m / cell_m).floor() as i32;
        (half_m >= 0.0).then(|| [column(self.centre.x - half_m), column(self.centre.x + half_m)])
    }

    /// Whether any part of a cell is within the disc.
    fn contains(&self, cell: IVec2, cell_m: f64) -> bool {
        self.run(cell.y, cell_m).is_some_and(|[first, last]| (first..=last).contains(&cell.x))
    }

    /// The rows that it reaches, and one more on either side: rows that are only touched belong to it.
    fn rows(&self, cell_m: f64) -> Run {
        let row = |z_m: f64| (z_m / cell_m).floor() as i32;
        [row(self.centre.y - self.radius_m).saturating_sub(1), row(self.centre.y + self.radius_m).saturating_add(1)]
    }
}

/// Whether any part of a cell is within any of the discs.
pub(super) fn any_contains(discs: &[Disc], cell: IVec2, cell_m: f64) -> bool {
    discs.iter().any(|disc| disc.contains(cell, cell_m))
}

/// Visits each cell within `bounds` that is in any of `these` discs and in none of `those`, in runs (row, first column, last
/// column). What it costs follows from the rows and the runs, not from the cells that are in both.
pub(super) fn visit_difference(
    these: &[Disc],
    those: &[Disc],
    cell_m: f64,
    bounds: [IVec2; 2],
    mut visit: impl FnMut(i32, i32, i32),
) {
    let [min, max] = bounds;
    let rows =
        these.iter().map(|disc| disc.rows(cell_m)).reduce(|one, other| [one[0].min(other[0]), one[1].max(other[1])]);
    let Some([first_row, last_row]) = rows else { return };
    let mut taken: Vec<Run> = Vec::new();
    for row in first_row.max(min.y)..=last_row.min(max.y) {
        taken.clear();
        taken.extend(those.iter().filter_map(|disc| disc.run(row, cell_m)));
        for disc in these {
            let Some([first, last]) = disc.run(row, cell_m) else { continue };
            let run = [first.max(min.x), last.min(max.x)];
            visit_rest(run, &mut taken, |first, last| visit(row, first, last));
            taken.push(run);
        }
    }
}

/// Visits what is left of a run without those that are taken.
fn visit_rest([first, last]: Run, taken: &mut [Run], mut visit: impl FnMut(i32, i32)) {
    taken.sort_unstable();
    let mut next = first;
    for &[from, to] in &*taken {
        if from > next && next <= last {
            visit(next, last.min(from - 1));
        }
        next = next.max(to.saturating_add(1));
    }
    if next <= last {
        visit(next, last);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    fn discs() -> impl Strategy<Value = Vec<Disc>> {
        let disc = (-300.0..300.0, -300.0..300.0, 0.0..250.0)
            .prop_map(|(x, z, radius_m)| Disc { centre: DVec2::new(x, z), radius_m });
        prop::collection::vec(disc, 0..4)
    }

    /// Whether the nearest point of the cell is within the radius.
    fn is_within(cell: IVec2, disc: &Disc) -> bool {
        let corner = cell.as_dvec2() * 16.0;
        disc.centre.clamp(corner, corner + 16.0).distance(disc.centre) <= disc.radius_m
    }

    proptest! {
        #[test]
        fn the_difference_equals_that_of_single_cells(these in discs(), those in discs()) {
            let bounds = [IVec2::splat(-20), IVec2::new(12, 20)];
            let mut visited = Vec::new();
            visit_difference(&these, &those, 16.0, bounds, |row, first, last| {
                visited.extend((first..=last).map(|column| (row, column)));
            });
            let mut slow = BTreeSet::new();
            for row in -20..=20 {
                for column in -20..=12 {
                    let cell = IVec2::new(column, row);
                    let any = |discs: &[Disc]| discs.iter().any(|disc| is_within(cell, disc));
                    if any(&these) && !any(&those) {
                        slow.insert((row, column));
                    }
                    prop_assert!(these.iter().all(|disc| disc.contains(cell, 16.0) == is_within(cell, disc)));
                }
            }
            prop_assert_eq!(visited.len(), slow.len(), "no cell twice");
            prop_assert_eq!(visited.into_iter().collect::<BTreeSet<_>>(), slow);
        }
    }

    #[test]
    fn discs_beyond_all_cells_are_empty() {
        let bounds = [IVec2::splat(-5), IVec2::splat(5)];
        for centre in [DVec2::splat(1e30), DVec2::new(0.0, -1e300), DVec2::new(-1e300, 0.0)] {
            let mut cells = 0;
            let disc = Disc { centre, radius_m: 100.0 };
            visit_difference(&[disc], &[], 16.0, bounds, |_, first, last| cells += last - first + 1);
            assert_eq!(cells, 0);
        }
    }
}
