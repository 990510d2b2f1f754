//! The method of moments: the parameters with which a law has the sample's own moments.
//!
//! With the factorial cumulants m, k2 = s² - m and k3 = m3 - 3 s² + 2 m:
//!
//! - binomial: p = -k2/m, n = m/p to the nearest whole.
//! - negative binomial: k = m²/k2.
//! - Poisson-Poisson: λ₂ = k2/m.
//! - Poisson-binomial: (n-1) p = k2/m and (n-2) p = k3/k2, so p = k2/m - k3/k2; n to the nearest whole, then p anew.
//! - Poisson-negative binomial: (k+1) p = k2/m and (k+2) p = k3/k2, so p = k3/k2 - k2/m.

use super::{
    frequencies::Frequencies,
    law::{CountKind, CountLaw, CountModel},
};

/// The law of a kind with the moments of a real pattern. `None` where there is no such law: a regular pattern has no
/// clustered law, and the third moment, which the last two kinds need, is often beyond them.
pub fn by_moments(kind: CountKind, table: &Frequencies) -> Option<CountLaw> {
    let (mean, variance) = (table.mean(), table.variance());
    let k2 = variance - mean;
    let ratio = k2 / mean;
    // (k+2) p of the clumps, or (n-2) p.
    let skew = (table.third_moment() - 3.0 * variance + 2.0 * mean) / k2;
    let fits = match kind {
        CountKind::Poisson => true,
        CountKind::Binomial => k2 < 0.0,
        _ => k2 > 0.0,
    };
    if !fits {
        return None;
    }
    let model = match kind {
        CountKind::Poisson => CountModel::Poisson,
        CountKind::Binomial => CountModel::Binomial { n: (mean / -ratio).round().max(mean.ceil()) as u32 },
        CountKind::NegativeBinomial => CountModel::NegativeBinomial { k: mean / ratio },
        CountKind::PoissonPoisson => CountModel::PoissonPoisson { clump: ratio },
        CountKind::PoissonBinomial => {
            let n = (1.0 + ratio / (ratio - skew)).round();
            let in_reach = skew < ratio && n >= 2.0;
            in_reach.then_some(CountModel::PoissonBinomial { n: n as u32, p: ratio / (n - 1.0) })?
        }
        CountKind::PoissonNegativeBinomial => {
            let p = skew - ratio;
            CountModel::PoissonNegativeBinomial { k: ratio / p - 1.0, p }
        }
    };
    model.with_mean(mean).ok()
}

#[cfg(test)]
mod tests {
    use super::super::{probability::Probabilities, real_patterns};
    use super::*;
    use approx::assert_relative_eq;

    /// A sample so large that its moments are the law's.
    fn ideal_sample(law: &CountLaw) -> Frequencies {
        let probabilities = Probabilities::new(law);
        let quadrats = probabilities.as_slice().iter().map(|p| (p * 1e12).round() as u64).collect();
        Frequencies::new(quadrats).unwrap()
    }

    #[test]
    fn laws_are_recovered_from_their_moments() {
        for model in [
            CountModel::Poisson,
            CountModel::Binomial { n: 7 },
            CountModel::NegativeBinomial { k: 0.8 },
            CountModel::PoissonPoisson { clump: 2.5 },
            CountModel::PoissonBinomial { n: 5, p: 0.4 },
            CountModel::PoissonNegativeBinomial { k: 2.0, p: 0.7 },
        ] {
            let law = model.with_mean(1.3).unwrap();
            let found = by_moments(model.kind(), &ideal_sample(&law)).unwrap();
            assert_relative_eq!(found.mean(), law.mean(), max_relative = 1e-6);
            assert_relative_eq!(found.variance(), law.variance(), max_relative = 1e-5);
            match (found.model(), model) {
                (
                    CountModel::PoissonNegativeBinomial { k, p },
                    CountModel::PoissonNegativeBinomial { k: k0, p: p0 },
                ) => {
                    assert_relative_eq!(k, k0, max_relative = 1e-3);
                    assert_relative_eq!(p, p0, max_relative = 1e-3);
                }
                (CountModel::PoissonBinomial { n, .. }, _) => assert_eq!(n, 5),
                (CountModel::Binomial { n }, _) => assert_eq!(n, 7),
                _ => {}
            }
        }
    }

    #[test]
    fn a_regular_pattern_has_no_clustered_law_and_the_reverse() {
        let (regular, clustered) =
            (real_patterns::table(&real_patterns::SPRUCES), real_patterns::table(&real_patterns::REDWOODS));
        assert!(by_moments(CountKind::Binomial, &clustered).is_none());
        for kind in &CountKind::ALL[2..] {
            assert!(by_moments(*kind, &regular).is_none(), "{kind:?}");
        }
        assert!(by_moments(CountKind::Binomial, &regular).is_some());
        assert!(by_moments(CountKind::NegativeBinomial, &clustered).is_some());
    }
}
