//! What a tree has among the tables: components that our systems put on it.

use crate::tree::TreeModel;
use bevy::prelude::*;

/// A tree that can be drawn: its model is prepared. It is our own; a clone of the tree gets one of its own.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[component(immutable, clone_behavior = Ignore)]
pub(crate) struct TreeInstance {
    /// The model that it was assigned for.
    pub model: AssetId<TreeModel>,
    /// Its row in the tables; none where trees stand still. Taking the component away frees the row.
    pub row: Option<u32>,
    /// How many LOD levels it has.
    pub lod_count: u8,
    /// Beams that have to be posed where its coarsest level alone is drawn: the first ones.
    pub coarse_beams: u32,
    /// Its height while its scale is 1, m.
    pub height_m: f32,
    pub tint: u8,
}

/// A tree has become older or younger, and is about to get another instance.
#[derive(EntityEvent, Clone, Copy)]
pub(crate) struct TreeGrows {
    pub entity: Entity,
}

/// A tree for which an impostor stands beyond some distance. It is written by what draws impostors. No impostor stands for its clones.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[component(clone_behavior = Ignore)]
pub(crate) struct HasImpostor {
    /// The impostor does not stand nearer than this, m; none until it is drawn.
    pub from_m: Option<f32>,
    /// Its height while the tree's scale is 1, m. Models are grown for ages in steps, impostors for any age: it may differ from the tree's.
    pub height_m: f32,
}
