//! Chi-square tests: whether a pattern is random, and whether a law describes it.
//!
//! The chi-square distribution is the incomplete gamma function of `puruspe`, which depends on nothing; `statrs` has the
//! same and far more beside it. Below the mean it is summed here, because `puruspe` 0.4.4 gives NaN there from 200 degrees
//! of freedom up.

use super::{frequencies::Frequencies, law::CountLaw, probability::Probabilities};

/// Fewer expected quadrats than this in a class, and it is pooled with the next (Cochran's rule).
const LEAST_EXPECTED: f64 = 5.0;

/// How far the quadrats are from evenly random.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dispersion {
    /// Variance over mean: 1 for a random pattern, less for a regular, more for a clustered one.
    pub index: f64,
    /// (Q - 1) times the index: chi-square with Q - 1 degrees of freedom if the pattern is random.
    pub chi_square: f64,
    /// Q - 1.
    pub degrees_of_freedom: f64,
    /// Probability that a random pattern looks as clustered as this or more.
    pub p_clustered: f64,
    /// Probability that a random pattern looks as regular as this or more.
    pub p_regular: f64,
}

/// The index of dispersion of a pattern.
pub fn dispersion(table: &Frequencies) -> Dispersion {
    let index = table.variance() / table.mean();
    let degrees_of_freedom = table.quadrats() - 1.0;
    let chi_square = degrees_of_freedom * index;
    let p_clustered = chi_square_above(chi_square, degrees_of_freedom);
    Dispersion { index, chi_square, degrees_of_freedom, p_clustered, p_regular: 1.0 - p_clustered }
}

impl Dispersion {
    /// The indices between which the share `confidence` of all random patterns with as many quadrats lies, the same share
    /// being beyond either end.
    pub fn range_if_random(&self, confidence: f64) -> [f64; 2] {
        let tail = 0.5 * (1.0 - confidence);
        [1.0 - tail, tail].map(|above| chi_square_quantile(above, self.degrees_of_freedom) / self.degrees_of_freedom)
    }
}

/// How well a law describes a pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoodnessOfFit {
    /// Sum over the classes of (observed - expected)² / expected.
    pub chi_square: f64,
    /// Classes less one, less the parameters that were estimated.
    pub degrees_of_freedom: f64,
    /// Probability that a pattern of this law differs from it as much as this one or more.
    pub p: f64,
}

/// Compares a pattern with a law of which `estimated` parameters were taken from the same pattern. Classes with fewer
/// than 5 expected quadrats are pooled with their neighbours. `None` where too few classes remain.
pub fn goodness_of_fit(law: &CountLaw, table: &Frequencies, estimated: u32) -> Option<GoodnessOfFit> {
    let classes = pooled_classes(law, table);
    let degrees_of_freedom = classes.len() as f64 - 1.0 - f64::from(estimated);
    if degrees_of_freedom < 1.0 {
        return None;
    }
    let chi_square = classes.iter().map(|(observed, expected)| (observed - expected).powi(2) / expected).sum();
    Some(GoodnessOfFit { chi_square, degrees_of_freedom, p: chi_square_above(chi_square, degrees_of_freedom) })
}

/// (Observed, expected) quadrats of each class; the last holds the tail.
fn pooled_classes(law: &CountLaw, table: &Frequencies) -> Vec<(f64, f64)> {
    let probabilities = Probabilities::new(law);
    let quadrats = table.quadrats();
    let observed = |count: usize| table.quadrats_with().get(count).map_or(0.0, |&quadrats| quadrats as f64);
    let mut classes = Vec::new();
    let (mut left_observed, mut left_expected) = (quadrats, quadrats);
    let (mut pool_observed, mut pool_expected) = (0.0, 0.0);
    for (count, probability) in probabilities.as_slice().iter().enumerate() {
        pool_observed += observed(count);
        pool_expected += quadrats * probability;
        if left_expected - pool_expected < LEAST_EXPECTED {
            break;
        }
        if pool_expected >= LEAST_EXPECTED {
            classes.push((pool_observed, pool_expected));
            left_observed -= pool_observed;
            left_expected -= pool_expected;
            (pool_observed, pool_expected) = (0.0, 0.0);
        }
    }
    classes.push((left_observed, left_expected));
    classes
}

/// Probability that a chi-square variable is above `value`.
fn chi_square_above(value: f64, degrees_of_freedom: f64) -> f64 {
    let (shape, place) = (0.5 * degrees_of_freedom, 0.5 * value.max(0.0));
    let above = if place < shape + 1.0 { 1.0 - gamma_below(shape, place) } else { puruspe::gammq(shape, place) };
    above.clamp(0.0, 1.0)
}

/// Probability that a gamma variable is below `place`, which is less than `shape` + 1: e^-x x^a / Gamma(a) times the sum
/// of x^n / (a (a+1) ... (a+n)).
fn gamma_below(shape: f64, place: f64) -> f64 {
    if place <= 0.0 {
        return 0.0;
    }
    let (mut term, mut sum) = (shape.recip(), shape.recip());
    // Some multiples of the root of the shape are enough; 2^24 quadrats take 30,000.
    for step in 1..1_000_000 {
        term *= place / (shape + f64::from(step));
        sum += term;
        if term < sum * f64::EPSILON {
            break;
        }
    }
    (shape * place.ln() - place - puruspe::ln_gamma(shape)).exp() * sum
}

/// The value above which a share of all chi-square variables lies, by bisection.
fn chi_square_quantile(above: f64, degrees_of_freedom: f64) -> f64 {
    let farthest = degrees_of_freedom + 20.0 * (2.0 * degrees_of_freedom).sqrt() + 100.0;
    let (mut low, mut high) = (0.0, farthest);
    for _ in 0..52 {
        let middle = 0.5 * (low + high);
        if chi_square_above(middle, degrees_of_freedom) > above { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::super::{law::CountModel, real_patterns};
    use super::*;
    use approx::assert_relative_eq;
    use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};

    #[test]
    fn chi_square_matches_tables_and_the_closed_form_of_even_degrees() {
        // The 5% point of 1 degree and the 1% point of 3, from any table.
        assert_relative_eq!(chi_square_above(3.841_458_8, 1.0), 0.05, epsilon = 1e-8);
        assert_relative_eq!(chi_square_above(11.344_866_7, 3.0), 0.01, epsilon = 1e-8);
        // Even degrees: e^-y sum of y^i/i!, i below half of them.
        for (value, degrees) in [(7.0, 10), (500.0, 460), (1000.0, 1000), (380.0, 460), (900.0, 1000), (700.0, 1000)] {
            let y: f64 = 0.5 * value;
            let terms = (1..degrees / 2).scan((-y).exp(), |term, i| {
                *term *= y / f64::from(i);
                Some(*term)
            });
            let expected = (-y).exp() + terms.sum::<f64>();
            assert_relative_eq!(chi_square_above(value, f64::from(degrees)), expected, max_relative = 1e-6);
        }
        // A million degrees: nearly normal, so half is above the mean, and 84 of 100 above that less a deviation.
        assert_relative_eq!(chi_square_above(1e6, 1e6), 0.5, epsilon = 1e-3);
        assert_relative_eq!(chi_square_above(1e6 - 2e6_f64.sqrt(), 1e6), 0.841_345, epsilon = 1e-3);
    }

    #[test]
    fn every_index_has_a_probability() {
        for degrees_of_freedom in [1.0, 99.0, 199.0, 200.0, 2499.0, 1e6] {
            let above = |index: u32| chi_square_above(f64::from(index) / 50.0 * degrees_of_freedom, degrees_of_freedom);
            let all: Vec<f64> = (0..200).map(above).collect();
            assert!(all.is_sorted_by(|a, b| *b <= a + 1e-7), "{degrees_of_freedom}: {all:?}");
            assert!(all[0] == 1.0 && all[199] < 0.05, "{degrees_of_freedom}: {all:?}");
        }
    }

    #[test]
    fn range_of_random_patterns_matches_tables_and_the_normal_law() {
        let range = |degrees_of_freedom: f64| {
            let dispersion =
                Dispersion { degrees_of_freedom, ..dispersion(&real_patterns::table(&real_patterns::PINES)) };
            dispersion.range_if_random(0.95)
        };
        let [low, high] = range(10.0);
        assert_relative_eq!(low, 0.324_697, epsilon = 1e-6);
        assert_relative_eq!(high, 2.048_318, epsilon = 1e-6);
        for degrees_of_freedom in [1e4, 1e6, 1.6e7_f64] {
            let half = 1.959_964 * (2.0 / degrees_of_freedom).sqrt();
            let [low, high] = range(degrees_of_freedom);
            assert_relative_eq!(1.0 - low, half, max_relative = 0.03);
            assert_relative_eq!(high - 1.0, half, max_relative = 0.03);
        }
    }

    #[test]
    fn spruces_are_regular_redwoods_clustered_and_pines_random() {
        let spruces = dispersion(&real_patterns::table(&real_patterns::SPRUCES));
        assert!(spruces.index < 0.7 && spruces.p_regular < 1e-3, "{spruces:?}");
        let redwoods = dispersion(&real_patterns::table(&real_patterns::REDWOODS));
        assert!(redwoods.index > 1.8 && redwoods.p_clustered < 1e-6, "{redwoods:?}");
        let pines = dispersion(&real_patterns::table(&real_patterns::PINES));
        assert!(pines.p_regular > 0.05 && pines.p_clustered > 0.05, "{pines:?}");
    }

    #[test]
    fn pooled_classes_hold_every_quadrat_and_expect_at_least_five() {
        let law = CountModel::NegativeBinomial { k: 0.9 }.with_mean(1.0).unwrap();
        let classes = pooled_classes(&law, &real_patterns::table(&real_patterns::REDWOODS));
        assert_relative_eq!(classes.iter().map(|class| class.0).sum::<f64>(), 196.0);
        assert_relative_eq!(classes.iter().map(|class| class.1).sum::<f64>(), 196.0, max_relative = 1e-9);
        assert!(classes.iter().all(|class| class.1 >= LEAST_EXPECTED), "{classes:?}");
    }

    /// Of patterns drawn from a law one in a hundred differs from it at the level of 1%; from another law nearly all do.
    #[test]
    fn the_right_law_is_rarely_rejected_and_a_wrong_one_always() {
        const PATTERNS: u32 = 400;
        let law = CountModel::NegativeBinomial { k: 1.0 }.with_mean(1.0).unwrap();
        let wrong = CountModel::Poisson.with_mean(1.0).unwrap();
        let probabilities = Probabilities::new(&law);
        let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
        let (mut rejected, mut wrong_rejected) = (0, 0);
        for _ in 0..PATTERNS {
            let counts: Vec<u32> = (0..1000).map(|_| probabilities.draw(&mut random) as u32).collect();
            let table = Frequencies::of_counts(&counts).unwrap();
            rejected += u32::from(goodness_of_fit(&law, &table, 0).unwrap().p < 0.01);
            wrong_rejected += u32::from(goodness_of_fit(&wrong, &table, 0).unwrap().p < 0.01);
        }
        // 4 expected; more than 12 has a probability of 3e-4.
        assert!(rejected <= 12, "{rejected}");
        assert_eq!(wrong_rejected, PATTERNS);
    }
}
