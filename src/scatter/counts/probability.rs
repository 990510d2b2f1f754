//! The probabilities of a law, by recursion, and counts drawn from them.
//!
//! Simple laws, from P(r-1) to P(r) (equations 6 to 8 of Setas et al.):
//!
//! - Poisson: P(0) = e^-v, then v/r.
//! - binomial: P(0) = (1-p)^n, then (n-r+1) p / (r (1-p)); for p > 1/2 the empty places are counted instead.
//! - negative binomial: P(0) = (1+p)^-k, then (k+r-1)/r p/(1+p).
//!
//! A Poisson number λ of clumps, each with generating function g: the whole has G = exp(λ (g - 1)), so G' = λ g' G, and
//! with g' = sum of h(t) s^t
//!
//! P(0) = exp(λ (g(0) - 1)), P(r+1) = λ/(r+1) sum over t <= r of h(t) P(r-t).
//!
//! - Poisson clumps (Neyman A): g(0) = e^-l, h(t) = l e^-l l^t/t!.
//! - binomial clumps: g(0) = q^n, h(t) = n p C(n-1,t) p^t q^(n-1-t).
//! - negative binomial clumps: g(0) = (1+p)^-k, h(t) = k p (1+p)^(-k-1) C(k+t,t) (p/(1+p))^t.
//!
//! In each case h is the clump's mean times a law of the same kind: Poisson, binomial of n-1 places, negative binomial of
//! k+1. So one set of recursions serves all six.

use rand::{Rng, RngExt};

use super::law::{CountLaw, CountModel};

/// What a table of probabilities may leave out.
const TAIL: f64 = 1e-12;
/// More entries than any law within the limits of [`CountModel`] needs.
const MOST_ENTRIES: usize = 1 << 14;

/// P(r) for r = 0, 1, 2, ..., and how to draw from it.
#[derive(Clone, Debug)]
pub struct Probabilities {
    of: Vec<f64>,
    cumulative: Vec<f64>,
}

impl Probabilities {
    /// The table of a law, until all but 1e-12 is accounted for.
    pub fn new(law: &CountLaw) -> Self {
        let deviation = law.variance().sqrt();
        // Past this no law within the limits has 1e-12 left: e^-30 for a tail that falls with the scale of the clumps.
        let ratio = law.variance() / law.mean();
        let enough = law.mean() + 9.0 * deviation + 40.0 * (1.0 + ratio);
        let mut of = Self::first(law, (enough as usize).clamp(2, MOST_ENTRIES));
        let mut cumulative: Vec<f64> = of
            .iter()
            .scan(0.0, |sum, probability| {
                *sum += probability;
                Some(*sum)
            })
            .collect();
        let entries = cumulative.partition_point(|&sum| sum < 1.0 - TAIL) + 1;
        of.truncate(entries);
        cumulative.truncate(entries);
        Self { of, cumulative }
    }

    /// P(0) to P(`entries` - 1).
    pub(super) fn first(law: &CountLaw, entries: usize) -> Vec<f64> {
        let mean = law.mean();
        match law.model() {
            CountModel::Poisson => poisson(mean, entries),
            CountModel::Binomial { n } => binomial(n, mean / f64::from(n), entries),
            CountModel::NegativeBinomial { k } => negative_binomial(k, mean / k, entries),
            CountModel::PoissonPoisson { clump } => compound(mean, clump, libm::exp(-clump), &poisson(clump, entries)),
            CountModel::PoissonBinomial { n, p } => {
                let empty = libm::pow(1.0 - p, f64::from(n));
                compound(mean, f64::from(n) * p, empty, &binomial(n - 1, p, entries))
            }
            CountModel::PoissonNegativeBinomial { k, p } => {
                let empty = libm::exp(-k * libm::log1p(p));
                compound(mean, k * p, empty, &negative_binomial(k + 1.0, p, entries))
            }
        }
    }

    /// P(r); 0 past the end of the table.
    pub fn of(&self, count: usize) -> f64 {
        self.of.get(count).copied().unwrap_or(0.0)
    }

    /// P(0), P(1), ...
    pub fn as_slice(&self) -> &[f64] {
        &self.of
    }

    /// Draws a count.
    pub fn draw(&self, random: &mut impl Rng) -> usize {
        let at: f64 = random.random();
        // Most quadrats hold few plants, so that a walk from 0 is the shortest way.
        let last = self.cumulative.len() - 1;
        self.cumulative.iter().position(|&sum| at < sum).unwrap_or(last)
    }
}

/// `first`, then each time the last value times `factor(r)`.
fn recursion(first: f64, entries: usize, factor: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut value = first;
    let rest = (1..entries).map(|count| {
        value *= factor(count as f64);
        value
    });
    std::iter::once(first).chain(rest).collect()
}

fn poisson(mean: f64, entries: usize) -> Vec<f64> {
    recursion(libm::exp(-mean), entries, |count| mean / count)
}

fn binomial(n: u32, p: f64, entries: usize) -> Vec<f64> {
    let places = f64::from(n);
    let upward = |p: f64, entries| {
        let odds = p / (1.0 - p);
        recursion(libm::pow(1.0 - p, f64::from(n)), entries, |count| (places - count + 1.0).max(0.0) / count * odds)
    };
    if p <= 0.5 {
        return upward(p, entries);
    }
    let mut taken = upward((1.0 - p).max(0.0), n as usize + 1);
    taken.reverse();
    taken.resize(entries, 0.0);
    taken
}

fn negative_binomial(k: f64, p: f64, entries: usize) -> Vec<f64> {
    let share = p / (1.0 + p);
    recursion(libm::exp(-k * libm::log1p(p)), entries, |count| (k + count - 1.0) / count * share)
}

/// The law of a Poisson number of clumps; `one_more` is h over the mean of a clump, and as long as the result.
fn compound(mean: f64, clump: f64, empty_clump: f64, one_more: &[f64]) -> Vec<f64> {
    let clumps = mean / clump;
    let mut of = Vec::with_capacity(one_more.len());
    of.push(libm::exp(clumps * (empty_clump - 1.0)));
    while of.len() < one_more.len() {
        let sum: f64 = one_more.iter().zip(of.iter().rev()).map(|(weight, probability)| weight * probability).sum();
        of.push(mean / of.len() as f64 * sum);
    }
    of
}

#[cfg(test)]
mod tests {
    use super::super::law::GREATEST_MEAN;
    use super::*;
    use approx::assert_relative_eq;
    use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
    use rustfft::{FftPlanner, num_complex::Complex};
    use std::f64::consts::TAU;

    const MODELS: [(CountModel, f64); 13] = [
        (CountModel::Poisson, 1.0),
        (CountModel::Poisson, 500.0),
        (CountModel::Binomial { n: 3 }, 1.0),
        (CountModel::Binomial { n: 5 }, 4.9),
        (CountModel::Binomial { n: 1000 }, 499.0),
        (CountModel::NegativeBinomial { k: 0.9 }, 1.0),
        (CountModel::NegativeBinomial { k: 0.05 }, 2.5),
        (CountModel::PoissonPoisson { clump: 2.0 }, 1.0),
        (CountModel::PoissonPoisson { clump: 50.0 }, 200.0),
        (CountModel::PoissonBinomial { n: 4, p: 0.6 }, 1.0),
        (CountModel::PoissonBinomial { n: 1, p: 1.0 }, 3.0),
        (CountModel::PoissonNegativeBinomial { k: 0.8, p: 1.5 }, 1.0),
        (CountModel::PoissonNegativeBinomial { k: 20.0, p: 0.5 }, 60.0),
    ];

    fn table(model: CountModel, mean: f64) -> (CountLaw, Probabilities) {
        let law = model.with_mean(mean).unwrap();
        let probabilities = Probabilities::new(&law);
        (law, probabilities)
    }

    /// The generating function E[s^count], written down from the definition of each law.
    fn generating_function(law: &CountLaw, s: Complex<f64>) -> Complex<f64> {
        let mean = law.mean();
        let one = Complex::new(1.0, 0.0);
        match law.model() {
            CountModel::Poisson => ((s - 1.0) * mean).exp(),
            CountModel::Binomial { n } => (one + (s - 1.0) * (mean / f64::from(n))).powi(n as i32),
            CountModel::NegativeBinomial { k } => (one - (s - 1.0) * (mean / k)).powf(-k),
            CountModel::PoissonPoisson { clump } => ((((s - 1.0) * clump).exp() - 1.0) * (mean / clump)).exp(),
            CountModel::PoissonBinomial { n, p } => {
                (((one + (s - 1.0) * p).powi(n as i32) - 1.0) * (mean / (f64::from(n) * p))).exp()
            }
            CountModel::PoissonNegativeBinomial { k, p } => {
                (((one - (s - 1.0) * p).powf(-k) - 1.0) * (mean / (k * p))).exp()
            }
        }
    }

    #[test]
    fn recursions_match_the_fourier_inverse_of_the_generating_function() {
        for (model, mean) in MODELS {
            let (law, probabilities) = table(model, mean);
            let size = (2 * probabilities.as_slice().len()).next_power_of_two();
            let at = |index: usize| Complex::from_polar(1.0, TAU * index as f64 / size as f64);
            let mut series: Vec<_> = (0..size).map(|index| generating_function(&law, at(index))).collect();
            FftPlanner::new().plan_fft_forward(size).process(&mut series);
            for (count, value) in series.iter().enumerate() {
                let error = (value.re / size as f64 - probabilities.of(count)).abs();
                assert!(error < 2e-12, "{model:?} at {count}: {error}");
            }
        }
    }

    #[test]
    fn tables_have_the_moments_of_their_law() {
        for (model, mean) in MODELS {
            let (law, probabilities) = table(model, mean);
            let moment = |of: &dyn Fn(f64) -> f64| {
                probabilities.as_slice().iter().enumerate().map(|(r, p)| p * of(r as f64)).sum::<f64>()
            };
            assert_relative_eq!(moment(&|_| 1.0), 1.0, epsilon = 1e-11);
            assert_relative_eq!(moment(&|r| r), law.mean(), max_relative = 1e-9);
            assert_relative_eq!(moment(&|r| (r - mean).powi(2)), law.variance(), max_relative = 1e-7);
        }
    }

    #[test]
    fn tables_of_the_most_uneven_laws_are_complete() {
        for model in [
            CountModel::NegativeBinomial { k: 5.0 },
            CountModel::PoissonPoisson { clump: 100.0 },
            CountModel::PoissonBinomial { n: 1000, p: 0.1 },
            CountModel::PoissonNegativeBinomial { k: 0.001, p: 99.0 },
            CountModel::PoissonNegativeBinomial { k: 9.0, p: 10.0 },
        ] {
            let (_, probabilities) = table(model, GREATEST_MEAN);
            let sum: f64 = probabilities.as_slice().iter().sum();
            assert_relative_eq!(sum, 1.0, epsilon = 1e-9);
            assert!(probabilities.as_slice().len() < MOST_ENTRIES, "{model:?}");
        }
    }

    #[test]
    fn drawn_counts_have_the_probabilities_of_the_table() {
        let (_, probabilities) = table(CountModel::NegativeBinomial { k: 0.9 }, 1.0);
        let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
        const DRAWS: usize = 200_000;
        let mut found = vec![0_usize; probabilities.as_slice().len()];
        for _ in 0..DRAWS {
            found[probabilities.draw(&mut random)] += 1;
        }
        for (count, found) in found.into_iter().enumerate() {
            let expected = DRAWS as f64 * probabilities.of(count);
            // Five standard deviations of a binomial count.
            assert!((found as f64 - expected).abs() < 5.0 * expected.sqrt() + 3.0, "{count}: {found} for {expected}");
        }
    }
}
