//! Means around each texel.

/// Means over squares of `2 reach + 1` texels of a picture with this side, which wrap around; by running sums along rows and
/// then along columns. `reach` is less than the side.
pub(crate) fn blurred(values: &[f32], size: usize, reach: usize) -> Vec<f32> {
    let mut rows = vec![0.0; size * size];
    let share = 1.0 / (2 * reach + 1) as f32;
    for (row, out) in values.chunks_exact(size).zip(rows.chunks_exact_mut(size)) {
        let mut sum: f32 = (0..=2 * reach).map(|k| row[(k + size - reach) % size]).sum();
        for x in 0..size {
            out[x] = sum * share;
            sum += row[(x + reach + 1) % size] - row[(x + size - reach) % size];
        }
    }
    let mut out = vec![0.0; size * size];
    let line = |y: usize| &rows[(y % size) * size..(y % size + 1) * size];
    let mut sums = vec![0.0_f32; size];
    for k in 0..=2 * reach {
        sums.iter_mut().zip(line(k + size - reach)).for_each(|(sum, value)| *sum += value);
    }
    for y in 0..size {
        for x in 0..size {
            out[y * size + x] = sums[x] * share;
        }
        let (entering, leaving) = (line(y + reach + 1), line(y + size - reach));
        for (sum, (enters, leaves)) in sums.iter_mut().zip(entering.iter().zip(leaving)) {
            *sum += enters - leaves;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blur_that_wraps_keeps_the_mean_and_a_level() {
        const SIZE: usize = 64;
        const REACH: usize = 9;
        let mut values = vec![0.0; SIZE * SIZE];
        values[3] = 1.0;
        let blurred = blurred(&values, SIZE, REACH);
        let side = (2 * REACH + 1) as f32;
        assert!((blurred.iter().sum::<f32>() - 1.0).abs() < 1e-3);
        // The square around the texel reaches over both edges of the tile.
        assert!((blurred[SIZE - 1] - 1.0 / (side * side)).abs() < 1e-5);
        assert!((blurred[SIZE * (SIZE - 1)] - 1.0 / (side * side)).abs() < 1e-5);
        assert!(blurred[SIZE / 2 * SIZE + SIZE / 2].abs() < 1e-5);
    }
}
