//! The law that describes a real pattern: each law is fitted by maximum likelihood, and all are ranked by Akaike's criterion.

use super::{
    dispersion::{GoodnessOfFit, goodness_of_fit},
    frequencies::Frequencies,
    law::{CountKind, CountLaw, CountModel},
    likelihood::{by_likelihood, log_likelihood},
};
use crate::setting::SettingError;

/// A law with estimated parameters, and how well it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The law with its parameters.
    pub law: CountLaw,
    /// Natural logarithm of the probability of the pattern.
    pub log_likelihood: f64,
    /// Akaike's criterion, 2 (parameters - log-likelihood): the smaller the better.
    pub aic: f64,
    /// The test by chi-square, where the pattern has enough classes for it.
    pub goodness: Option<GoodnessOfFit>,
}

impl Fit {
    fn new(law: CountLaw, table: &Frequencies) -> Self {
        let parameters = law.model().kind().parameters();
        let log_likelihood = log_likelihood(&law, table);
        Self {
            law,
            log_likelihood,
            aic: 2.0 * (f64::from(parameters) - log_likelihood),
            goodness: goodness_of_fit(&law, table, parameters),
        }
    }
}

/// The laws that a pattern may follow, estimated by maximum likelihood, the best first. Laws that cannot describe it
/// (clustered ones for a regular pattern, and the reverse) are left out.
///
/// # Errors
/// [`SettingError`] where the quadrats hold more than 500 plants on average: choose smaller ones.
pub fn characterise(table: &Frequencies) -> Result<Vec<Fit>, SettingError> {
    CountModel::Poisson.with_mean(table.mean())?;
    let mut fits: Vec<Fit> = CountKind::ALL
        .into_iter()
        .filter_map(|kind| by_likelihood(kind, table))
        .map(|law| Fit::new(law, table))
        .filter(|fit| fit.aic.is_finite())
        .collect();
    fits.sort_by(|a, b| a.aic.total_cmp(&b.aic));
    Ok(fits)
}

#[cfg(test)]
mod tests {
    use super::super::real_patterns;
    use super::*;

    #[test]
    fn real_patterns_have_the_expected_law() {
        for (table, kind) in [
            (&real_patterns::PINES[..], CountKind::Poisson),
            (&real_patterns::SPRUCES, CountKind::Binomial),
            (&real_patterns::REDWOODS, CountKind::NegativeBinomial),
            (&real_patterns::LANSING, CountKind::Poisson),
        ] {
            let fits = characterise(&real_patterns::table(table)).unwrap();
            assert_eq!(fits[0].law.model().kind(), kind, "{fits:#?}");
            assert!(fits.is_sorted_by(|a, b| a.aic <= b.aic));
        }
    }

    #[test]
    fn quadrats_that_hold_hundreds_each_are_refused() {
        let table = Frequencies::of_counts(&[600, 601, 590]).unwrap();
        assert!(characterise(&table).unwrap_err().to_string().contains("must be 0.000001 to 500"));
    }
}
