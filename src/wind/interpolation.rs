//! Catmull-Rom interpolation between the samples of a regular axis: passes through them, with a continuous slope.

use crate::interpolation::catmull_rom;

/// The four samples around a place on an axis, and their weights.
pub(super) struct Taps {
    pub indices: [usize; 4],
    pub weights: [f32; 4],
}

impl Taps {
    /// On an axis of `count` samples that begins again after the last. `coordinate` counts samples; 0 where it is not
    /// finite.
    pub fn periodic(coordinate: f64, count: usize) -> Self {
        let coordinate = if coordinate.is_finite() { coordinate } else { 0.0 };
        let cell = coordinate.floor();
        // The remainder is whole and below `count`, however far away the cell is.
        let first = cell.rem_euclid(count as f64) as usize + count - 1;
        Self {
            indices: [0, 1, 2, 3].map(|tap| (first + tap) % count),
            weights: catmull_rom((coordinate - cell) as f32),
        }
    }

    /// On an axis of `count` samples beyond whose ends the first and the last sample hold. NaN counts as 0.
    ///
    /// The slope fades to nothing within one sample beyond the end, so that it stays continuous there.
    pub fn held(coordinate: f32, count: usize) -> Self {
        let last = count as i32 - 1;
        let coordinate = coordinate.max(-2.0).min(last as f32 + 2.0);
        let coordinate = if coordinate.is_nan() { 0.0 } else { coordinate };
        let cell = coordinate.floor();
        Self {
            indices: [-1, 0, 1, 2].map(|tap| (cell as i32 + tap).clamp(0, last) as usize),
            weights: catmull_rom(coordinate - cell),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLES: [f32; 5] = [3.0, -1.0, 4.0, 1.0, -5.0];

    fn blend(taps: &Taps) -> f32 {
        (0..4).map(|tap| taps.weights[tap] * SAMPLES[taps.indices[tap]]).sum()
    }

    #[test]
    fn passes_through_the_samples_in_every_period() {
        for index in -20..20 {
            let sample = SAMPLES[i32::rem_euclid(index, 5) as usize];
            assert_eq!(blend(&Taps::periodic(f64::from(index), 5)), sample);
        }
    }

    #[test]
    fn value_and_slope_are_continuous_everywhere_on_both_axes() {
        let step = 1e-3;
        let on_both = |place: f32| [blend(&Taps::periodic(f64::from(place), 5)), blend(&Taps::held(place, 5))];
        for knot in -3..9 {
            let at = |offset: f32| on_both(knot as f32 + offset);
            let (before, here, after) = (at(-step), at(0.0), at(step));
            for axis in 0..2 {
                let slopes = [(here[axis] - before[axis]) / step, (after[axis] - here[axis]) / step];
                // The samples' second differences reach 30, and so the slope changes by 0.03 in a step; a kink would
                // be of the order of the slopes, 1 to 10.
                assert!((slopes[0] - slopes[1]).abs() < 0.1, "kink at {knot} of axis {axis}: {slopes:?}");
            }
        }
    }

    #[test]
    fn ends_are_held_and_the_result_is_finite_for_any_coordinate() {
        assert_eq!(blend(&Taps::held(-2.0, 5)), 3.0);
        assert_eq!(blend(&Taps::held(f32::NEG_INFINITY, 5)), 3.0);
        assert_eq!(blend(&Taps::held(f32::INFINITY, 5)), -5.0);
        assert!(blend(&Taps::held(f32::NAN, 5)).is_finite());
    }
}
