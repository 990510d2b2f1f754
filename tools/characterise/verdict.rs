//! Whether a pattern is regular, random or clustered, by its index of dispersion.

use bevy_windwood::scatter::counts::Dispersion;

/// Share of random patterns that the test calls random.
pub const CONFIDENCE: f64 = 0.95;
/// Share of them beyond either end.
const TAIL: f64 = 0.5 * (1.0 - CONFIDENCE);

/// The result of the test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Regular,
    Random,
    Clustered,
}

impl Verdict {
    /// By the chi-square test of both tails, at 5% in all.
    pub fn of(dispersion: &Dispersion) -> Self {
        if dispersion.p_clustered < TAIL {
            Self::Clustered
        } else if dispersion.p_regular < TAIL {
            Self::Regular
        } else {
            Self::Random
        }
    }

    /// As a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Regular => "regular",
            Self::Random => "random",
            Self::Clustered => "clustered",
        }
    }
}
