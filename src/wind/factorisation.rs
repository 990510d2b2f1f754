//! A factor L of a symmetric matrix C = L L^T, where C may be slightly indefinite.
//!
//! A symmetric matrix is stored as its lower triangle, packed column after column: column j begins with its diagonal
//! element. Nearly all matrices of a field are positive definite and take the Cholesky factorisation as they are.
//! A negative pivot cannot simply be dropped: coherence errors reach 0.3 in the slowest bins. Such a matrix is first replaced
//! by the nearest positive semidefinite one, by setting its negative eigenvalues to zero (errors up to 0.015 there).

use nalgebra::{DMatrix, SymmetricEigen};
use std::ops::Range;

/// A pivot below this counts as zero. The matrices' elements are at most 1.
const LEAST_PIVOT: f64 = 1e-9;

/// Below a pivot that counts as zero, a semidefinite matrix has nothing larger than the pivot's root.
const LARGEST_REMAINDER: f64 = 3.2e-5;

/// Number of stored elements of a symmetric matrix.
pub(super) const fn packed_len(size: usize) -> usize {
    size * (size + 1) / 2
}

/// The columns of a packed lower triangle, with the range of their elements from the diagonal down.
pub(super) fn packed_columns(size: usize) -> impl Iterator<Item = (usize, Range<usize>)> {
    let mut start = 0;
    (0..size).map(move |column| {
        let range = start..start + size - column;
        start = range.end;
        (column, range)
    })
}

/// Writes to `factor` a factor of the packed symmetric `matrix`, or of the semidefinite matrix nearest to it.
pub(super) fn factorise(matrix: &[f64], size: usize, factor: &mut [f64]) {
    factor.copy_from_slice(matrix);
    if !cholesky(factor, size) {
        nearest_semidefinite(matrix, size, factor);
        // What rounding leaves of negative pivots is dropped.
        cholesky_of_semidefinite(factor, size);
    }
}

/// Replaces a matrix by its Cholesky factor, or returns false where it proves to be indefinite.
fn cholesky(matrix: &mut [f64], size: usize) -> bool {
    packed_columns(size).all(|(_, range)| {
        let (column, later) = split_column(matrix, &range);
        if column[0] <= LEAST_PIVOT && column.iter().any(|value| value.abs() > LARGEST_REMAINDER) {
            return false;
        }
        eliminate(column, later);
        true
    })
}

fn cholesky_of_semidefinite(matrix: &mut [f64], size: usize) {
    for (_, range) in packed_columns(size) {
        let (column, later) = split_column(matrix, &range);
        eliminate(column, later);
    }
}

fn split_column<'a>(matrix: &'a mut [f64], range: &Range<usize>) -> (&'a mut [f64], &'a mut [f64]) {
    matrix[range.start..].split_at_mut(range.len())
}

/// Turns a column into the factor's and subtracts its part from the later columns.
fn eliminate(column: &mut [f64], mut later: &mut [f64]) {
    if column[0] <= LEAST_PIVOT {
        column.fill(0.0);
        return;
    }
    let scale = column[0].sqrt().recip();
    column.iter_mut().for_each(|value| *value *= scale);
    for row in 1..column.len() {
        let (reduced, rest) = later.split_at_mut(column.len() - row);
        add_scaled(reduced, -column[row], &column[row..]);
        later = rest;
    }
}

/// sums += factor * values
pub(super) fn add_scaled(sums: &mut [f64], factor: f64, values: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += factor * value;
    }
}

/// Writes to `nearest` the matrix without the part that belongs to negative eigenvalues.
fn nearest_semidefinite(matrix: &[f64], size: usize, nearest: &mut [f64]) {
    let mut full = DMatrix::zeros(size, size);
    for (column, range) in packed_columns(size) {
        for (row, &value) in (column..).zip(&matrix[range]) {
            full[(row, column)] = value;
            full[(column, row)] = value;
        }
    }
    let eigen = SymmetricEigen::new(full);
    nearest.copy_from_slice(matrix);
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value < 0.0 {
            for (column, range) in packed_columns(size) {
                add_scaled(&mut nearest[range], -value * vector[column], &vector.as_slice()[column..]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn packed(full: &DMatrix<f64>) -> Vec<f64> {
        let size = full.nrows();
        (0..size).flat_map(|column| (column..size).map(move |row| full[(row, column)])).collect()
    }

    fn product(factor: &[f64], size: usize) -> DMatrix<f64> {
        let mut lower = DMatrix::zeros(size, size);
        for (column, range) in packed_columns(size) {
            for (row, &value) in (column..).zip(&factor[range]) {
                lower[(row, column)] = value;
            }
        }
        &lower * lower.transpose()
    }

    fn factor_of(full: &DMatrix<f64>) -> DMatrix<f64> {
        let mut factor = vec![0.0; packed_len(full.nrows())];
        factorise(&packed(full), full.nrows(), &mut factor);
        product(&factor, full.nrows())
    }

    #[test]
    fn factor_of_a_definite_matrix_multiplies_back() {
        let matrix = DMatrix::from_fn(7, 7, |row, column| (-0.2 * (row as f64 - column as f64).abs()).exp());
        assert_relative_eq!(factor_of(&matrix), matrix, epsilon = 1e-14);
    }

    #[test]
    fn factor_of_full_coherence_is_one_column() {
        let matrix = DMatrix::from_element(5, 5, 1.0);
        assert_relative_eq!(factor_of(&matrix), matrix, epsilon = 1e-14);
    }

    #[test]
    fn factor_of_an_indefinite_matrix_is_of_the_nearest_semidefinite_one() {
        // Correlations of 0.9, 0.9 and 0.1 contradict each other.
        let matrix = DMatrix::from_row_slice(3, 3, &[1.0, 0.9, 0.1, 0.9, 1.0, 0.9, 0.1, 0.9, 1.0]);
        let mut eigen = SymmetricEigen::new(matrix.clone());
        assert!(eigen.eigenvalues.min() < -0.1);
        eigen.eigenvalues.apply(|value: &mut f64| *value = value.max(0.0));
        // The pivots counted as zero leave at most LARGEST_REMAINDER.
        assert_relative_eq!(factor_of(&matrix), eigen.recompose(), epsilon = 1e-4);
    }
}
