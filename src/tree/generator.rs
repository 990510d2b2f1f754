//! The generators of skeletons: which one a species uses, with its settings.

use bevy::reflect::Reflect;
use rand::Rng;
use serde::{Deserialize, Serialize};

use super::{
    crown::{
        gardner::{self, GardnerCrown},
        impressionist::{self, ImpressionistCrown},
    },
    growth::{
        age::Stage,
        aono_kunii::AonoKunii,
        grower::GrownBranches,
        reeves_blau::{self, ReevesBlau},
        trunk::Trunk,
        zaharia::{Fir, Oak},
    },
    skeleton::Skeleton,
};
use crate::setting::SettingError;

/// How a skeleton grows.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
pub enum Growth {
    /// Stochastic branching inside an envelope.
    ReevesBlau(ReevesBlau),
    /// Zaharia's oak: branches placed at random, shorter towards their parents' tips.
    Oak(Oak),
    /// Zaharia's fir: branches in floors.
    Fir(Fir),
    /// Aono & Kunii's structural tree: the same branching again and again.
    AonoKunii(AonoKunii),
    /// Starling & Ashdown's impression of a crown: polygons, not leaves.
    Impressionist(ImpressionistCrown),
    /// Gardner's: textured ellipsoids.
    Gardner(GardnerCrown),
}

impl Growth {
    pub(super) fn validate(&self) -> Result<(), SettingError> {
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

    pub(super) fn grow(&self, stage: &Stage, random: &mut impl Rng) -> Grown {
        match self {
            Self::ReevesBlau(growth) => Grown::Branches(reeves_blau::grow(growth, stage, random)),
            Self::Oak(growth) => Grown::Branches(growth.grow(stage, random)),
            Self::Fir(growth) => Grown::Branches(growth.grow(stage, random)),
            Self::AonoKunii(growth) => Grown::Branches(growth.grow(stage, random)),
            Self::Impressionist(crown) => Grown::WholeTree(impressionist::grow(crown, stage.height, random)),
            Self::Gardner(crown) => Grown::WholeTree(gardner::grow(crown, stage.height, random)),
        }
    }
}

/// What a generator grows.
pub(super) enum Grown {
    /// Branches that get their foliage and radii next.
    Branches(GrownBranches),
    /// A tree with its foliage.
    WholeTree(Skeleton),
}
