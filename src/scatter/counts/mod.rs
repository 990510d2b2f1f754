//! The number of plants in a quadrat: the laws of the quadrat method, and which of them a real pattern follows.
//!
//! After Setas et al., *Dynamic Simulation of Natural Environments in Virtual Reality* (section 2.2.1), who take the laws from Rogers,
//! *Statistical analysis of spatial dispersion: the quadrat method* (Pion, 1974):
//!
//! | law | pattern | variance / mean |
//! |---|---|---|
//! | Poisson | random | 1 |
//! | binomial | regular | 1 - p |
//! | negative binomial | clustered | 1 + p |
//! | Poisson-Poisson (Neyman A) | clumps, random in number, of random size | 1 + λ₂ |
//! | Poisson-binomial | clumps of limited size | 1 + (n - 1) p |
//! | Poisson-negative binomial | clumps of very uneven size | 1 + (k + 1) p |
//!
//! 1. A [`CountModel`] with a mean is a [`CountLaw`]; its [`Probabilities`] come from recursions.
//! 2. A real pattern, counted, is a table of [`Frequencies`]. [`dispersion()`] tests whether it is random;
//!    [`by_moments`] and [`by_likelihood`] estimate a law's parameters; [`characterise`] ranks the laws by Akaike's
//!    criterion.

pub(super) mod dispersion;
mod fit;
pub(super) mod frequencies;
pub(super) mod law;
mod likelihood;
mod moments;
pub(super) mod probability;
#[cfg(test)]
mod real_patterns;
mod search;

pub use dispersion::{Dispersion, GoodnessOfFit, dispersion, goodness_of_fit};
pub use fit::{Fit, characterise};
pub use frequencies::Frequencies;
pub use law::{CountKind, CountLaw, CountModel};
pub use likelihood::by_likelihood;
pub use moments::by_moments;
pub use probability::Probabilities;
