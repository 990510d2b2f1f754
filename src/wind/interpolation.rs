//! Interpolation between the samples of a regular axis: in time, and across the wind and in height.
//!
//! In time the samples are close. A Catmull-Rom spline passes through them with a continuous slope. Across the wind and in
//! height they are far apart for the faster gusts, and such a spline would lose power there: [`unit_weights`] keeps it.

use crate::interpolation::catmull_rom;

/// Where the unit-power weights begin, rad: tan = sqrt(2).
const HALF_ANGLE_RAD: f32 = 0.955_316_6;
/// The share of linear interpolation in height: it loses some power of fast gusts, and takes away from the 5% too much that
/// [`unit_weights`] have of gusts that neighbours share in part. Chosen so that a place has the power of every frequency to 5%.
const LINEAR_SHARE_IN_HEIGHT: f32 = 0.04;
/// The same across the wind, where it is less than none, and a skew makes up for it.
const LINEAR_SHARE_ACROSS: f32 = -0.12;
/// What is added to the weight of the farther sample on the left, as a polynomial in `2 t - 1` of the second degree, and to that of the nearer
/// one beyond what keeps the sum at 1. Fitted, with the number above and the lags of [`lateral`](super::lateral), to the coherence of pairs of
/// places. `render/shaders/wind.wesl` has the same.
const EVEN_SKEW: f32 = 0.05;
const ODD_SKEW: f32 = 0.87;
const CURVED_SKEW: f32 = 0.4;
const NEAR_SKEW: f32 = -0.22;

/// Weights of the samples at -1, 0, 1 and 2 for the place t in \[0, 1\], which keep the power of what is sampled.
///
/// The power of a blend is `sum_ij w_i w_j rho_ij`, with the correlations `rho` of the samples. Where they are 1 it takes
/// `sum w = 1`; where neighbours are independent, `sum w^2 = 1`. Two samples allow both only on themselves. Four do: such weights
/// lie on a sphere, and these on its arc from the sample 0 to the sample 1,
///
/// ```text
/// w = 1/4 + sqrt(3)/4 (-cos, cos, cos, -cos) + sqrt(3/8) (0, sin, -sin, 0)
/// ```
///
/// at angles from `atan(sqrt 2)` to its negative. In the middle they are the coefficients of Daubechies' D4 wavelet. A share of
/// linear interpolation is mixed in. For correlations `exp(-x)` of neighbours the power is then within 4% of right for all x, in
/// the mean over t. The slope is nothing on the samples, and so continuous.
fn unit_weights(eased: f32, linear_share: f32) -> [f32; 4] {
    let (sin, cos) = (HALF_ANGLE_RAD * (1.0 - 2.0 * eased)).sin_cos();
    let unit = 1.0 - linear_share;
    let (even, odd) = (0.25 * 3f32.sqrt() * cos, 0.375f32.sqrt() * sin);
    let outer = unit * (0.25 - even);
    let inner = unit * (0.25 + even);
    [outer, inner + unit * odd + linear_share * (1.0 - eased), inner - unit * odd + linear_share * eased, outer]
}

/// Weights in height.
fn weights_in_height(t: f32) -> [f32; 4] {
    unit_weights(ease(t), LINEAR_SHARE_IN_HEIGHT)
}

/// Weights across the wind. A place near a sample takes more from the side on which it is not: so two places a few metres apart have
/// less in common, and two that are one to two samples apart more, than by [`unit_weights`] alone. Power and sum are as there: 2% in the
/// mean over t, and 9% at any one t.
fn weights_across(t: f32) -> [f32; 4] {
    let eased = ease(t);
    let hump = 4.0 * eased * (1.0 - eased);
    let far = |side: f32| hump * (EVEN_SKEW + side * (ODD_SKEW + side * CURVED_SKEW));
    let near = |side: f32| hump * (side * (NEAR_SKEW - side * CURVED_SKEW) - EVEN_SKEW);
    let side = 2.0 * eased - 1.0;
    let [a, b, c, d] = unit_weights(eased, LINEAR_SHARE_ACROSS);
    [a + far(side), b + near(side), c + near(-side), d + far(-side)]
}

fn ease(t: f32) -> f32 {
    t * t * (3.0 - 2.0 * t)
}

/// Four samples around a place on an axis of time, and their weights in a Catmull-Rom spline.
pub(super) struct SplineTaps {
    pub indices: [usize; 4],
    pub weights: [f32; 4],
}

impl SplineTaps {
    /// On an axis of `count` samples that begins again after the last. `coordinate` counts samples; 0 where it is not
    /// finite.
    pub fn periodic(coordinate: f64, count: usize) -> Self {
        let (indices, within) = periodic(coordinate, count);
        Self { indices, weights: catmull_rom(within) }
    }
}

/// Four samples around a place on an axis in space, and their weights, which keep the power.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlendTaps {
    pub indices: [usize; 4],
    pub weights: [f32; 4],
}

impl BlendTaps {
    /// Across the wind, where `count` columns begin again after the last. `coordinate` counts them; 0 where it is not finite.
    pub(super) fn across(coordinate: f64, count: usize) -> Self {
        let (indices, within) = periodic(coordinate, count);
        Self { indices, weights: weights_across(within) }
    }

    /// In height, where the first and the last of `count` levels hold beyond them. NaN counts as 0.
    pub(super) fn in_height(coordinate: f32, count: usize) -> Self {
        let last = count as i32 - 1;
        let coordinate = coordinate.max(0.0).min(last as f32);
        let cell = (coordinate.floor() as i32).min((last - 1).max(0));
        // Beyond an end another sample takes the part of the one that is missing: to count one twice would change the power.
        let inside = |index: i32, instead: i32| if (0..=last).contains(&index) { index } else { instead };
        let outer = [inside(cell - 1, cell + 3), inside(cell + 2, cell - 2)];
        let indices = [outer[0], cell, cell + 1, outer[1]].map(|index| index.clamp(0, last) as usize);
        Self { indices, weights: weights_in_height(coordinate - cell as f32) }
    }
}

fn periodic(coordinate: f64, count: usize) -> ([usize; 4], f32) {
    let coordinate = if coordinate.is_finite() { coordinate } else { 0.0 };
    let cell = coordinate.floor();
    // The remainder is whole and below `count`, however far away the cell is.
    let first = cell.rem_euclid(count as f64) as usize + count - 1;
    ([0, 1, 2, 3].map(|tap| (first + tap) % count), (coordinate - cell) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLES: [f32; 5] = [3.0, -1.0, 4.0, 1.0, -5.0];

    fn sum(indices: [usize; 4], weights: [f32; 4]) -> f32 {
        (0..4).map(|tap| weights[tap] * SAMPLES[indices[tap]]).sum()
    }

    fn in_time(place: f32) -> f32 {
        let SplineTaps { indices, weights } = SplineTaps::periodic(f64::from(place), 5);
        sum(indices, weights)
    }

    fn across(place: f32) -> f32 {
        let BlendTaps { indices, weights } = BlendTaps::across(f64::from(place), 5);
        sum(indices, weights)
    }

    fn held(place: f32) -> f32 {
        let BlendTaps { indices, weights } = BlendTaps::in_height(place, 5);
        sum(indices, weights)
    }

    #[test]
    fn passes_through_the_samples_in_every_period() {
        for index in -20..20 {
            let sample = SAMPLES[i32::rem_euclid(index, 5) as usize];
            assert_eq!(in_time(index as f32), sample);
            // Sines and cosines round.
            assert!((across(index as f32) - sample).abs() < 2e-6);
            assert!((held(index as f32) - SAMPLES[index.clamp(0, 4) as usize]).abs() < 2e-6);
        }
    }

    #[test]
    fn value_and_slope_are_continuous_everywhere_on_all_axes() {
        let step = 1e-3;
        for (axis, value) in [in_time, across, held].into_iter().enumerate() {
            for knot in -3..9 {
                let at = |offset: f32| value(knot as f32 + offset);
                let (before, here, after) = (at(-step), at(0.0), at(step));
                let slopes = [(here - before) / step, (after - here) / step];
                // The second differences reach 50, and so the slope changes by 0.05 in a step; a kink would
                // be of the order of the slopes, 1 to 10.
                assert!((slopes[0] - slopes[1]).abs() < 0.15, "kink at {knot} of axis {axis}: {slopes:?}");
            }
        }
    }

    #[test]
    fn a_blend_keeps_what_samples_share_and_the_power_of_what_they_do_not() {
        for step in 0..=100 {
            let weights = unit_weights(step as f32 / 100.0, 0.0);
            assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
            assert!((weights.iter().map(|weight| weight * weight).sum::<f32>() - 1.0).abs() < 1e-6);
            let sum: f32 = weights_across(step as f32 / 100.0).iter().sum();
            assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        }
        // Power in the mean over a cell, for samples of correlation exp(-x) a step.
        for decay in [0.0, 0.1, 0.3, 0.6, 1.0, 2.0, 5.0, 50.0_f32] {
            for (weights_at, most) in [(weights_across as fn(f32) -> [f32; 4], 0.022), (weights_in_height, 0.042)] {
                let power = |step: i32| -> f32 {
                    let weights = weights_at((step as f32 + 0.5) / 100.0);
                    let pair = |i: usize, j: usize| weights[i] * weights[j] * (-decay * i.abs_diff(j) as f32).exp();
                    (0..16).map(|pairs| pair(pairs / 4, pairs % 4)).sum()
                };
                let mean = (0..100).map(power).sum::<f32>() / 100.0;
                assert!((mean - 1.0).abs() < most, "{mean} at {decay}");
                assert!((0..100).all(|step| (power(step) - 1.0).abs() < 0.1), "at {decay}");
            }
        }
    }

    #[test]
    fn ends_are_held_and_the_result_is_finite_for_any_coordinate() {
        for (place, end) in [(-2.0, 3.0), (f32::NEG_INFINITY, 3.0), (f32::INFINITY, -5.0)] {
            assert!((held(place) - end).abs() < 2e-6);
        }
        assert!(held(f32::NAN).is_finite());
        for count in 1..4 {
            let taps = BlendTaps::in_height(0.6, count);
            assert!(taps.indices.iter().all(|&index| index < count));
        }
    }

    #[test]
    fn no_sample_counts_twice_where_an_axis_has_four() {
        for step in 0..40 {
            let mut indices = BlendTaps::in_height(step as f32 / 10.0, 5).indices;
            indices.sort_unstable();
            assert!(indices.windows(2).all(|pair| pair[0] < pair[1]), "{indices:?}");
        }
    }
}
