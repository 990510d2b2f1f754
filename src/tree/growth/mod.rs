//! Growing skeletons: age, the envelope that bounds a crown, the generators, what breaks, and the pipes that give wood
//! its thickness.

use bevy::reflect::Reflect;
use rand::Rng;
use serde::{Deserialize, Serialize};

use self::{age::Stage, grower::Wood, reeves::Trunk};
use super::{
    crown::{
        gardner::{self, GardnerCrown},
        impressionist::{self, ImpressionistCrown},
    },
    skeleton::Skeleton,
    species::SpeciesError,
};

pub mod age;
pub mod aono_kunii;
pub mod damage;
pub mod envelope;
pub(super) mod grower;
pub mod phyllotaxis;
pub(super) mod pipes;
pub mod reeves;
pub mod zaharia;

pub use phyllotaxis::Phyllotaxis;

/// How a skeleton grows.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
pub enum Growth {
    /// Stochastic branching inside an envelope.
    ReevesBlau(reeves::ReevesBlau),
    /// Zaharia's oak: branches placed at random, shorter towards their parents' tips.
    Oak(zaharia::Oak),
    /// Zaharia's fir: branches in floors.
    Fir(zaharia::Fir),
    /// Aono & Kunii's structural tree: the same branching again and again.
    AonoKunii(aono_kunii::AonoKunii),
    /// Starling & Ashdown's impression of a crown: polygons, not leaves.
    Impressionist(ImpressionistCrown),
    /// Gardner's: textured ellipsoids.
    Gardner(GardnerCrown),
}

impl Growth {
    pub(super) fn validate(&self) -> Result<(), SpeciesError> {
        match self {
            Self::ReevesBlau(growth) => growth.validate(),
            Self::Oak(growth) => growth.validate(),
            Self::Fir(growth) => growth.validate(),
            Self::AonoKunii(growth) => growth.validate(),
            Self::Impressionist(crown) => crown.validate(),
            Self::Gardner(crown) => crown.validate(),
        }
    }

    /// The trunk of the mature tree.
    #[must_use]
    pub fn trunk(&self) -> Trunk {
        match self {
            Self::ReevesBlau(growth) => growth.trunk,
            Self::Oak(growth) => growth.trunk,
            Self::Fir(growth) => growth.trunk,
            Self::AonoKunii(growth) => growth.trunk,
            Self::Impressionist(crown) => crown.trunk(),
            Self::Gardner(crown) => crown.trunk(),
        }
    }

    /// Exponent of the pipe model that gives the beams their radii; none where growth gives them itself.
    pub(super) fn pipe_exponent(&self) -> Option<f32> {
        match self {
            Self::ReevesBlau(growth) => Some(growth.pipe_exponent),
            Self::Oak(growth) => Some(growth.pipe_exponent),
            Self::Fir(growth) => Some(growth.pipe_exponent),
            Self::AonoKunii(_) | Self::Impressionist(_) | Self::Gardner(_) => None,
        }
    }

    pub(super) fn grow(&self, stage: &Stage, random: &mut impl Rng) -> Individual {
        match self {
            Self::ReevesBlau(growth) => Individual::Branches(reeves::grow(growth, stage, random)),
            Self::Oak(growth) => Individual::Branches(growth.grow(stage, random)),
            Self::Fir(growth) => Individual::Branches(growth.grow(stage, random)),
            Self::AonoKunii(growth) => Individual::Branches(growth.grow(stage, random)),
            Self::Impressionist(crown) => Individual::Painted(impressionist::grow(crown, stage.height, random)),
            Self::Gardner(crown) => Individual::Painted(gardner::grow(crown, stage.height, random)),
        }
    }
}

/// What a seed grows into.
pub(super) enum Individual {
    /// Branches, on which leaves are still to be hung.
    Branches(Wood),
    /// A crown as painters see it, with its leaves.
    Painted(Skeleton),
}
