//! The method of maximum likelihood: the parameters under which the observed table is most probable.
//!
//! For each law the estimate of the mean is the sample's mean: with the other parameters held, P(r) of each law is a
//! power series in one parameter, whose likelihood equation says just that. What remains is a search over
//!
//! - nothing (Poisson), or n (binomial);
//! - k of the negative binomial, the root of sum over r of A(r)/(k+r) = Q ln(1+m/k), where A(r) is the number of
//!   quadrats with more than r plants;
//! - λ₂ (Poisson-Poisson), n and p (Poisson-binomial), k and p (Poisson-negative binomial).

use super::{
    frequencies::Frequencies,
    law::{CountKind, CountLaw, CountModel},
    probability::Probabilities,
    search::maximise,
};

/// The most places that an estimated clump may have: with more, Neyman's law says the same with a parameter less.
const MOST_PLACES_IN_CLUMP: u32 = 20;
/// The most places that an estimated quadrat may have: with more, Poisson's law says the same with a parameter less.
const MOST_PLACES_IN_QUADRAT: u32 = 1000;
const CLUMP: (f64, f64) = (1e-3, 100.0);
const SHAPE: (f64, f64) = (1e-2, 100.0);
const RATIO: (f64, f64) = (1e-4, 99.0);

/// Natural logarithm of the probability of the observed table, without the multinomial factor that all laws share.
pub(super) fn log_likelihood(law: &CountLaw, table: &Frequencies) -> f64 {
    let probabilities = Probabilities::first(law, table.greatest() + 1);
    let of_class = |(&quadrats, probability): (&u64, &f64)| {
        if quadrats == 0 { 0.0 } else { quadrats as f64 * probability.ln() }
    };
    table.quadrats_with().iter().zip(&probabilities).map(of_class).sum()
}

/// The law of a kind under which a real pattern is most probable. `None` where the likelihood has no maximum: a regular
/// pattern has no best clustered law, nor a clustered one a best regular law.
///
/// The compound laws are searched with some thousands of tables, each of as many steps as the square of the greatest
/// count: choose quadrats with tens of plants at most.
pub fn by_likelihood(kind: CountKind, table: &Frequencies) -> Option<CountLaw> {
    let quadrats = table.quadrats();
    let (mean, variance) = (table.mean(), table.variance() * (quadrats - 1.0) / quadrats);
    let has_maximum = match kind {
        CountKind::Poisson => true,
        CountKind::Binomial => variance < mean,
        _ => variance > mean,
    };
    if !has_maximum {
        return None;
    }
    let likelihood =
        |model: CountModel| model.with_mean(mean).map_or(f64::NEG_INFINITY, |law| log_likelihood(&law, table));
    let model = match kind {
        CountKind::Poisson => CountModel::Poisson,
        CountKind::Binomial => {
            let fewest = (table.greatest() as u32).max(mean.ceil() as u32);
            best((fewest..=MOST_PLACES_IN_QUADRAT).map(|n| CountModel::Binomial { n }), likelihood)?
        }
        CountKind::NegativeBinomial => CountModel::NegativeBinomial { k: negative_binomial_shape(table) },
        CountKind::PoissonPoisson => {
            let clump = maximise(CLUMP.0, CLUMP.1, |clump| likelihood(CountModel::PoissonPoisson { clump }));
            CountModel::PoissonPoisson { clump }
        }
        CountKind::PoissonBinomial => {
            let with_places = |n| {
                let p = maximise(RATIO.0, 1.0, |p| likelihood(CountModel::PoissonBinomial { n, p }));
                CountModel::PoissonBinomial { n, p }
            };
            best((2..=MOST_PLACES_IN_CLUMP).map(with_places), likelihood)?
        }
        CountKind::PoissonNegativeBinomial => {
            let with_shape = |k| {
                let most = RATIO.1.min(CLUMP.1 / (k + 1.0));
                let p = maximise(RATIO.0, most, |p| likelihood(CountModel::PoissonNegativeBinomial { k, p }));
                CountModel::PoissonNegativeBinomial { k, p }
            };
            with_shape(maximise(SHAPE.0, SHAPE.1, |k| likelihood(with_shape(k))))
        }
    };
    model.with_mean(mean).ok()
}

/// The model with the greatest likelihood; of equals the first.
fn best(models: impl Iterator<Item = CountModel>, likelihood: impl Fn(CountModel) -> f64) -> Option<CountModel> {
    let mut top = None;
    for model in models {
        let value = likelihood(model);
        if top.is_none_or(|(_, highest)| value > highest) {
            top = Some((model, value));
        }
    }
    top.map(|(model, _)| model)
}

/// The root of the likelihood equation of k, by bisection of its logarithm.
fn negative_binomial_shape(table: &Frequencies) -> f64 {
    let (quadrats, mean) = (table.quadrats(), table.mean());
    let mut more = quadrats;
    let with_more_than: Vec<f64> = table
        .quadrats_with()
        .iter()
        .map(|&quadrats| {
            more -= quadrats as f64;
            more
        })
        .collect();
    let excess = |k: f64| {
        let sum: f64 = with_more_than.iter().enumerate().map(|(count, more)| more / (k + count as f64)).sum();
        sum - quadrats * (mean / k).ln_1p()
    };
    let (mut low, mut high) = (1e-3_f64.ln(), 1e6_f64.ln());
    for _ in 0..64 {
        let middle = 0.5 * (low + high);
        if excess(middle.exp()) > 0.0 { low = middle } else { high = middle }
    }
    (0.5 * (low + high)).exp()
}

#[cfg(test)]
mod tests {
    use super::super::real_patterns;
    use super::*;
    use approx::assert_relative_eq;
    use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};

    #[test]
    fn redwoods_have_the_published_negative_binomial() {
        let law = by_likelihood(CountKind::NegativeBinomial, &real_patterns::table(&real_patterns::REDWOODS)).unwrap();
        let CountModel::NegativeBinomial { k } = law.model() else { panic!("asked for a negative binomial") };
        assert_relative_eq!(k, 0.907, epsilon = 5e-4);
        assert_relative_eq!(law.mean() / k, 1.097, epsilon = 5e-4);
    }

    /// Every parameter pushed to either side, the mean among them, makes the table less probable.
    #[test]
    fn estimates_maximise_the_likelihood() {
        let table = real_patterns::table(&real_patterns::REDWOODS);
        for kind in CountKind::ALL {
            let Some(law) = by_likelihood(kind, &table) else { continue };
            let top = log_likelihood(&law, &table);
            let below = |model: CountModel, mean: f64| {
                let pushed = log_likelihood(&model.with_mean(mean).unwrap(), &table);
                assert!(pushed <= top + 1e-7, "{model:?} with {mean}: {pushed} above {top} of {law:?}");
            };
            for factor in [0.98, 1.02] {
                match law.model() {
                    CountModel::Poisson | CountModel::Binomial { .. } => {}
                    CountModel::NegativeBinomial { k } => {
                        below(CountModel::NegativeBinomial { k: k * factor }, law.mean());
                    }
                    CountModel::PoissonPoisson { clump } => {
                        below(CountModel::PoissonPoisson { clump: clump * factor }, law.mean());
                    }
                    CountModel::PoissonBinomial { n, p } => {
                        below(CountModel::PoissonBinomial { n, p: p * factor }, law.mean());
                    }
                    CountModel::PoissonNegativeBinomial { k, p } => {
                        below(CountModel::PoissonNegativeBinomial { k: k * factor, p }, law.mean());
                        below(CountModel::PoissonNegativeBinomial { k, p: p * factor }, law.mean());
                    }
                }
                below(law.model(), law.mean() * factor);
            }
        }
    }

    #[test]
    fn parameters_of_drawn_samples_are_recovered() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
        let mut sample = |model: CountModel| {
            let probabilities = Probabilities::new(&model.with_mean(1.5).unwrap());
            let counts: Vec<u32> = (0..40_000).map(|_| probabilities.draw(&mut random) as u32).collect();
            by_likelihood(model.kind(), &Frequencies::of_counts(&counts).unwrap()).unwrap()
        };
        // Standard errors of these samples are some 2% (and more for the last, whose parameters trade off).
        let law = sample(CountModel::Binomial { n: 6 });
        assert_eq!(law.model(), CountModel::Binomial { n: 6 });
        assert_relative_eq!(law.mean(), 1.5, max_relative = 0.02);
        let CountModel::NegativeBinomial { k } = sample(CountModel::NegativeBinomial { k: 0.7 }).model() else {
            panic!()
        };
        assert_relative_eq!(k, 0.7, max_relative = 0.05);
        let CountModel::PoissonPoisson { clump } = sample(CountModel::PoissonPoisson { clump: 2.0 }).model() else {
            panic!()
        };
        assert_relative_eq!(clump, 2.0, max_relative = 0.05);
        let law = sample(CountModel::PoissonBinomial { n: 4, p: 0.7 });
        assert_relative_eq!(law.variance(), 1.5 * 3.1, max_relative = 0.05);
        let law = sample(CountModel::PoissonNegativeBinomial { k: 1.0, p: 1.0 });
        assert_relative_eq!(law.variance(), 1.5 * 3.0, max_relative = 0.05);
    }
}
