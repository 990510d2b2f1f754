//! What becomes of the trees of forests.

use super::stem_id::StemId;
use crate::tree::Species;
use bevy::prelude::*;

/// A tree of a forest stands as an entity now.
#[derive(Message, Clone, Debug, PartialEq)]
pub struct TreeEntered {
    /// The forest.
    pub forest: Entity,
    /// The tree.
    pub tree: Entity,
    /// Which stem it is.
    pub id: StemId,
    /// Where it leaves the ground, m.
    pub place: Vec3,
    /// Its species.
    pub species: AssetId<Species>,
}

/// A tree of a forest stands as an entity no more: nobody is near any longer, or the plan or a change has made it one of another
/// species, which enters as an entity of its own. One that is felled does not leave.
#[derive(Message, Clone, Debug, PartialEq)]
pub struct TreeLeft {
    /// The forest.
    pub forest: Entity,
    /// The entity, which is despawned.
    pub tree: Entity,
    /// Which stem it is.
    pub id: StemId,
    /// Where it stood, m.
    pub place: Vec3,
    /// Its species.
    pub species: AssetId<Species>,
}

/// A stem of a forest was felled by [`ForestChanges::fell`](super::ForestChanges::fell). Of stems that are felled in changes that were loaded
/// nothing is told, nor of stems too far to be known.
#[derive(Message, Clone, Debug, PartialEq)]
pub struct TreeFelled {
    /// The forest.
    pub forest: Entity,
    /// The tree, if it stood as an entity.
    pub tree: Option<Entity>,
    /// Which stem it is.
    pub id: StemId,
    /// Where it stood, m.
    pub place: Vec3,
    /// Its species.
    pub species: AssetId<Species>,
}
