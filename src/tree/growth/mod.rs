//! Growing skeletons: the envelope that bounds a crown, the generators, the pipes that give wood its thickness.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use super::species::SpeciesError;

pub mod envelope;
pub(super) mod pipes;
pub mod reeves;

/// How a skeleton grows.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
pub enum Growth {
    /// Stochastic branching inside an envelope.
    ReevesBlau(reeves::ReevesBlau),
}

impl Growth {
    pub(super) fn validate(&self) -> Result<(), SpeciesError> {
        let Self::ReevesBlau(growth) = self;
        growth.validate()
    }
}
