//! The six laws of the number of plants in a quadrat, by their parameters.
//!
//! A [`CountModel`] says how plants cluster or keep apart. With a mean it is a [`CountLaw`], whose parameters are those of
//! the literature. The paper prints the mean as Q/N with "Q the number of quadrats and N the number of points"
//! (equations 6 to 8); it is N/Q.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use crate::setting::{SettingError, require};

/// The greatest mean number of plants in a quadrat: beyond it e^-mean, from which the recursions start, loses digits.
pub(in crate::scatter) const GREATEST_MEAN: f64 = 500.0;
/// The least mean: one plant in a million quadrats.
const LEAST_MEAN: f64 = 1e-6;
/// Limits of clump sizes and ratios, so that a table of probabilities stays within some thousands of entries.
const GREATEST_RATIO: f64 = 100.0;
const GREATEST_TRIALS: u32 = 1000;
const LEAST_SHAPE: f64 = 1e-3;
const GREATEST_SHAPE: f64 = 1e6;

/// How plants cluster or keep apart, at any density.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect, Serialize, Deserialize)]
pub enum CountModel {
    /// Random: each plant falls anywhere, without regard to the others.
    #[default]
    Poisson,
    /// Regular: a quadrat has `n` places and no more.
    Binomial {
        /// Places in a quadrat, at least the mean. domain: \[1, 1000\].
        n: u32,
    },
    /// Clustered: the smaller `k`, the more uneven are the quadrats.
    NegativeBinomial {
        /// domain: \[0.001, 1000000\], with a variance of at most 101 times the mean.
        k: f64,
    },
    /// Clustered: clumps, Poisson in number, each of a Poisson number of plants (Neyman's type A).
    PoissonPoisson {
        /// λ₂, the mean number of plants in a clump. domain: \[0.001, 100\].
        clump: f64,
    },
    /// Clustered: clumps, Poisson in number, each of `n` places that are taken with probability `p`.
    PoissonBinomial {
        /// Places in a clump. domain: \[1, 1000\].
        n: u32,
        /// domain: above 0 to 1; n p is at most 100.
        p: f64,
    },
    /// Clustered: clumps, Poisson in number, each of a negative binomial number of plants.
    PoissonNegativeBinomial {
        /// domain: \[0.001, 1000000\].
        k: f64,
        /// domain: above 0; (k + 1) p is at most 100.
        p: f64,
    },
}

/// Which of the six laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the laws are explained at CountModel")]
pub enum CountKind {
    Poisson,
    Binomial,
    NegativeBinomial,
    PoissonPoisson,
    PoissonBinomial,
    PoissonNegativeBinomial,
}

impl CountKind {
    /// All six, in the paper's order.
    pub const ALL: [Self; 6] = [
        Self::Poisson,
        Self::Binomial,
        Self::NegativeBinomial,
        Self::PoissonPoisson,
        Self::PoissonBinomial,
        Self::PoissonNegativeBinomial,
    ];

    /// What the law is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Poisson => "Poisson",
            Self::Binomial => "binomial",
            Self::NegativeBinomial => "negative binomial",
            Self::PoissonPoisson => "Poisson-Poisson",
            Self::PoissonBinomial => "Poisson-binomial",
            Self::PoissonNegativeBinomial => "Poisson-negative binomial",
        }
    }

    /// Number of parameters that an estimate has to find.
    pub(super) fn parameters(self) -> u32 {
        match self {
            Self::Poisson => 1,
            Self::Binomial | Self::NegativeBinomial | Self::PoissonPoisson => 2,
            Self::PoissonBinomial | Self::PoissonNegativeBinomial => 3,
        }
    }
}

/// A model with its mean: the law of the number of plants in a quadrat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountLaw {
    model: CountModel,
    mean: f64,
}

impl CountModel {
    /// The law of this model with `mean` plants in a quadrat.
    ///
    /// # Errors
    /// [`SettingError`] where a parameter is outside its domain, or a binomial's quadrat has fewer places
    /// than plants.
    pub fn with_mean(self, mean: f64) -> Result<CountLaw, SettingError> {
        require("mean_per_quadrat", mean, LEAST_MEAN..=GREATEST_MEAN)?;
        self.validate()?;
        match self {
            Self::Binomial { n } if mean > f64::from(n) => {
                Err(SettingError::new("n", n, format!("at least the mean per quadrat, {mean}")))
            }
            Self::NegativeBinomial { k } if mean / k > GREATEST_RATIO => {
                let least = mean / GREATEST_RATIO;
                Err(SettingError::new("k", k, format!("at least {least} with {mean} plants in a quadrat")))
            }
            _ => Ok(CountLaw { model: self, mean }),
        }
    }

    /// Checks the parameters that do not depend on the mean.
    ///
    /// # Errors
    /// [`SettingError`] for the first that is outside its domain.
    pub fn validate(self) -> Result<(), SettingError> {
        let probability = f64::MIN_POSITIVE..=1.0;
        match self {
            Self::Poisson => Ok(()),
            Self::Binomial { n } => require("n", n, 1..=GREATEST_TRIALS),
            Self::NegativeBinomial { k } => require("k", k, LEAST_SHAPE..=GREATEST_SHAPE),
            Self::PoissonPoisson { clump } => require("clump", clump, 1e-3..=GREATEST_RATIO),
            Self::PoissonBinomial { n, p } => {
                require("n", n, 1..=GREATEST_TRIALS)?;
                require("p", p, probability)?;
                require("n p", f64::from(n) * p, 1e-3..=GREATEST_RATIO)
            }
            Self::PoissonNegativeBinomial { k, p } => {
                require("k", k, LEAST_SHAPE..=GREATEST_SHAPE)?;
                require("p", p, f64::MIN_POSITIVE..=GREATEST_RATIO)?;
                require("(k + 1) p", (k + 1.0) * p, 0.0..=GREATEST_RATIO)?;
                require("k p", k * p, 1e-6..=GREATEST_RATIO)
            }
        }
    }

    /// Which of the six.
    pub fn kind(self) -> CountKind {
        match self {
            Self::Poisson => CountKind::Poisson,
            Self::Binomial { .. } => CountKind::Binomial,
            Self::NegativeBinomial { .. } => CountKind::NegativeBinomial,
            Self::PoissonPoisson { .. } => CountKind::PoissonPoisson,
            Self::PoissonBinomial { .. } => CountKind::PoissonBinomial,
            Self::PoissonNegativeBinomial { .. } => CountKind::PoissonNegativeBinomial,
        }
    }
}

impl CountLaw {
    /// How the plants cluster or keep apart.
    pub fn model(&self) -> CountModel {
        self.model
    }

    /// Mean number of plants in a quadrat.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Variance of the number of plants in a quadrat.
    pub fn variance(&self) -> f64 {
        let ratio = match self.model {
            CountModel::Poisson => 1.0,
            CountModel::Binomial { n } => 1.0 - self.mean / f64::from(n),
            CountModel::NegativeBinomial { k } => 1.0 + self.mean / k,
            CountModel::PoissonPoisson { clump } => 1.0 + clump,
            CountModel::PoissonBinomial { n, p } => 1.0 + (f64::from(n) - 1.0) * p,
            CountModel::PoissonNegativeBinomial { k, p } => 1.0 + (k + 1.0) * p,
        };
        self.mean * ratio
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_outside_their_domain_are_named() {
        let message = |model: CountModel, mean| model.with_mean(mean).unwrap_err().to_string();
        assert_eq!(message(CountModel::Poisson, f64::NAN), "`mean_per_quadrat` is NaN, but must be 0.000001 to 500");
        assert_eq!(
            message(CountModel::Binomial { n: 2 }, 2.5),
            "`n` is 2, but must be at least the mean per quadrat, 2.5"
        );
        assert!(message(CountModel::NegativeBinomial { k: -1.0 }, 1.0).starts_with("`k` is -1"));
        assert!(message(CountModel::NegativeBinomial { k: 0.001 }, 500.0).contains("at least 5"));
        assert!(message(CountModel::PoissonPoisson { clump: 1e9 }, 1.0).starts_with("`clump` is 1000000000"));
        assert!(message(CountModel::PoissonBinomial { n: 4, p: 1.5 }, 1.0).starts_with("`p` is 1.5"));
        assert!(message(CountModel::PoissonNegativeBinomial { k: 1e6, p: 1.0 }, 1.0).starts_with("`(k + 1) p`"));
    }

    #[test]
    fn a_binomial_that_is_full_has_no_variance() {
        assert_eq!(CountModel::Binomial { n: 3 }.with_mean(3.0).unwrap().variance(), 0.0);
    }
}
