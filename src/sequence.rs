//! Low-discrepancy sequences: places that spread evenly, however many there are.

/// Steps of Roberts' R2 sequence (2018): 1/p and 1/p^2 of the plastic ratio p, with p^3 = p + 1. As multiples of the golden
/// ratio do on a line, multiples of these fill a square evenly, and are in step with no wave, as a grid would be.
const R2_STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3];

/// Place `index` of the R2 sequence from `start`, in the unit square.
pub(crate) fn r2(start: [f64; 2], index: usize) -> [f32; 2] {
    [0, 1].map(|axis: usize| (start[axis] + R2_STEPS[axis] * index as f64).fract() as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_powers_of_the_plastic_ratio() {
        let ratio = 1.0 / R2_STEPS[0];
        assert!((ratio.powi(3) - ratio - 1.0).abs() < 1e-14);
        assert!((R2_STEPS[0] * R2_STEPS[0] - R2_STEPS[1]).abs() < 1e-15);
    }

    #[test]
    fn every_cell_of_a_grid_has_about_as_many_places() {
        let mut counts = [0; 64];
        for index in 0..6400 {
            let [x, y] = r2([0.5; 2], index).map(|place| (place * 8.0) as usize);
            counts[8 * y + x] += 1;
        }
        assert!(counts.iter().all(|count| (95..=105).contains(count)), "{counts:?}");
    }
}
