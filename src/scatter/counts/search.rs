//! The greatest value of a function of one parameter.

/// Places that are tried before the best of them is refined.
const STEPS: usize = 32;
/// The golden section shrinks the bracket by 0.618 each time: 2e-9 of it remains.
const REFINEMENTS: usize = 42;

/// Where `of` is greatest between `lowest` and `highest`, both above 0: a scan in equal ratios finds the peak, the golden
/// section its top. Values that are no number count as lowest.
pub(super) fn maximise(lowest: f64, highest: f64, of: impl Fn(f64) -> f64) -> f64 {
    let of = |place: f64| {
        let value = of(place.exp());
        if value.is_nan() { f64::NEG_INFINITY } else { value }
    };
    let (low, high) = (lowest.ln(), highest.ln());
    let step = (high - low) / STEPS as f64;
    let (mut best, mut top) = (low, f64::NEG_INFINITY);
    for index in 0..=STEPS {
        let place = low + step * index as f64;
        let value = of(place);
        if value > top {
            (best, top) = (place, value);
        }
    }
    golden_section((best - step).max(low), (best + step).min(high), of).exp().clamp(lowest, highest)
}

/// The top of a single hill.
fn golden_section(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (of(left), of(right));
    for _ in 0..REFINEMENTS {
        if at_left >= at_right {
            high = right;
            (right, at_right) = (left, at_left);
            left = high - golden * (high - low);
            at_left = of(left);
        } else {
            low = left;
            (left, at_left) = (right, at_right);
            right = low + golden * (high - low);
            at_right = of(right);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_higher_of_two_maxima_is_found_also_at_an_end() {
        let hills = |x: f64| (-(x.ln() - 1.0).powi(2)).exp() + 1.5 * (-(x.ln() + 2.0).powi(2)).exp();
        assert_relative_eq!(maximise(1e-3, 1e3, hills), (-2.0_f64).exp(), max_relative = 1e-3);
        assert_relative_eq!(maximise(0.5, 20.0, |x| x), 20.0, max_relative = 1e-6);
        assert_relative_eq!(maximise(0.5, 20.0, |x| -(x.ln() - 0.7).powi(2)), 0.7_f64.exp(), max_relative = 1e-6);
    }
}
