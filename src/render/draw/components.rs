//! The mesh entities of trees.

use crate::render::lod::thresholds::LodSelection;
use bevy::{camera::visibility::NoAutoAabb, prelude::*};

/// A mesh of a tree, of its wood or of its leaves at one LOD level: a child entity of the tree with a draw of its own. It is ours: it comes,
/// changes and goes with the tree's [`Tree`](crate::tree::Tree), and has the tree's `RenderLayers`.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[require(Transform, Visibility, NoAutoAabb)]
#[relationship(relationship_target = TreeMeshes)]
pub struct TreeMeshOf(pub Entity);

/// The meshes of a tree: it is drawn.
#[derive(Component, Debug, Default)]
#[relationship_target(relationship = TreeMeshOf, linked_spawn)]
pub struct TreeMeshes(Vec<Entity>);

/// What a [`TreeMeshOf`] is of.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub enum TreePart {
    /// Trunk and branches.
    Wood,
    /// The leaves.
    Leaves,
}

/// What was last drawn of a tree.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
#[component(clone_behavior = Ignore)]
pub(crate) struct DrawnTree {
    /// None before its first meshes, and when they have to be made anew.
    pub selection: Option<LodSelection>,
    /// Whether it was drawn without leaves.
    pub is_bare: bool,
    /// How many meshes it has.
    pub mesh_count: u8,
}
