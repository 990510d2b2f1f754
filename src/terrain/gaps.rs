//! Fills the gaps of a map, for drawing: as a membrane does that is held at their edges.
//!
//! The fill solves Laplace's equation, each cell being the mean of its four neighbours (at the border of the map, of those that there are),
//! so that it goes smoothly from edge to edge and never beyond the heights about the gap. It is found from coarse to fine (a cascadic
//! multigrid; Bornemann and Deuflhard 1996): the map is halved by means of what is known until nothing is missing, and on the way back each
//! gap starts from the coarser map and is relaxed by sweeps of Gauss and Seidel.

/// Sweeps at each level. Chosen so that a gap in a plane is filled to 1% of its rise (`a_gap_in_a_plane_is_filled_by_the_plane`).
const SWEEPS: usize = 40;

/// Fills what is NaN in rows of `columns` samples. Where all are NaN, all stay.
pub(super) fn fill(columns: usize, heights_m: &mut [f32]) {
    let gaps: Vec<usize> = (0..heights_m.len()).filter(|&index| heights_m[index].is_nan()).collect();
    if gaps.is_empty() || gaps.len() == heights_m.len() {
        return;
    }
    let rows = heights_m.len() / columns;
    let (coarse_columns, mut coarse) = halved(columns, rows, heights_m);
    fill(coarse_columns, &mut coarse);
    let coarse_rows = coarse.len() / coarse_columns;
    for &index in &gaps {
        heights_m[index] = between(coarse_columns, coarse_rows, &coarse, index % columns, index / columns);
    }
    for _ in 0..SWEEPS {
        for &index in &gaps {
            heights_m[index] = mean_of_neighbours(columns, rows, heights_m, index);
        }
    }
}

/// The means of what is known in squares of 2 x 2, and the columns of them.
fn halved(columns: usize, rows: usize, heights_m: &[f32]) -> (usize, Vec<f32>) {
    let (coarse_columns, coarse_rows) = (columns.div_ceil(2), rows.div_ceil(2));
    let mean = |index: usize| {
        let (column, row) = (index % coarse_columns * 2, index / coarse_columns * 2);
        let (mut sum, mut known) = (0.0, 0);
        for row in row..(row + 2).min(rows) {
            for height_m in &heights_m[row * columns..][column..(column + 2).min(columns)] {
                if !height_m.is_nan() {
                    sum += f64::from(*height_m);
                    known += 1;
                }
            }
        }
        // Nothing known: 0/0 is NaN, a gap again.
        (sum / f64::from(known)) as f32
    };
    (coarse_columns, (0..coarse_columns * coarse_rows).map(mean).collect())
}

/// A sample of the finer map, bilinear between the coarser samples, which lie in the middle of 2 x 2 finer ones.
fn between(columns: usize, rows: usize, coarse: &[f32], column: usize, row: usize) -> f32 {
    let neighbours = |fine: usize, count: usize| {
        let nearest = fine / 2;
        let other = if fine.is_multiple_of(2) { nearest.saturating_sub(1) } else { (nearest + 1).min(count - 1) };
        [(nearest, 0.75), (other, 0.25)]
    };
    let mut sum = 0.0;
    for (row, along_z) in neighbours(row, rows) {
        for (column, along_x) in neighbours(column, columns) {
            sum += along_x * along_z * coarse[row * columns + column];
        }
    }
    sum
}

fn mean_of_neighbours(columns: usize, rows: usize, heights_m: &[f32], index: usize) -> f32 {
    let (column, row) = (index % columns, index / columns);
    let (mut sum, mut count) = (0.0, 0.0);
    let mut add = |is_there: bool, neighbour: usize| {
        if is_there {
            sum += heights_m[neighbour];
            count += 1.0;
        }
    };
    add(column > 0, index.wrapping_sub(1));
    add(column + 1 < columns, index + 1);
    add(row > 0, index.wrapping_sub(columns));
    add(row + 1 < rows, index + columns);
    sum / count
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: usize = 70;
    const ROWS: usize = 50;

    fn map(height_m: impl Fn(f32, f32) -> f32, is_gap: impl Fn(f32, f32) -> bool) -> (Vec<f32>, Vec<f32>) {
        let places = (0..COLUMNS * ROWS).map(|index| ((index % COLUMNS) as f32, (index / COLUMNS) as f32));
        let whole: Vec<f32> = places.clone().map(|(x, z)| height_m(x, z)).collect();
        let with_gaps = places.zip(&whole).map(|((x, z), &height)| if is_gap(x, z) { f32::NAN } else { height });
        (whole.clone(), with_gaps.collect())
    }

    #[test]
    fn a_gap_in_a_plane_is_filled_by_the_plane() {
        let is_gap = |x: f32, z: f32| (x - 30.0).hypot(z - 26.0) < 15.0;
        let (whole, mut filled) = map(|x, z| 500.0 + 3.0 * x - 2.0 * z, is_gap);
        fill(COLUMNS, &mut filled);
        // The plane rises by 108 m across the gap.
        let worst = whole.iter().zip(&filled).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 1.08, "{worst} m");
    }

    #[test]
    fn what_is_known_stays_and_no_fill_goes_beyond_it() {
        let is_gap = |x: f32, z: f32| x < 20.0 || z > 40.0 || (x as u32 * 31 + z as u32 * 17).is_multiple_of(5);
        let (_, given) = map(|x, z| 100.0 * (x * 0.3).sin() * (z * 0.2).cos(), is_gap);
        let mut filled = given.clone();
        fill(COLUMNS, &mut filled);
        let known = || given.iter().copied().filter(|height| !height.is_nan());
        let (low, high) = (known().fold(f32::MAX, f32::min), known().fold(f32::MIN, f32::max));
        for (given, filled) in given.iter().zip(&filled) {
            assert!(given.is_nan() || given == filled);
            // The mean of three rounds.
            assert!((low - 1e-4..=high + 1e-4).contains(filled), "{filled} beyond {low} to {high}");
        }
    }

    #[test]
    fn one_known_cell_fills_all_and_none_fills_nothing() {
        let mut heights = vec![f32::NAN; COLUMNS * ROWS];
        fill(COLUMNS, &mut heights);
        assert!(heights.iter().all(|height| height.is_nan()));
        heights[1234] = 7.0;
        fill(COLUMNS, &mut heights);
        assert!(heights.iter().all(|&height| (height - 7.0).abs() < 1e-4));
    }
}
