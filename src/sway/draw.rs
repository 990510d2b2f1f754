//! Draws trees: one draw for the wood and one for the leaves of a tree, all trees of a model in one batch.
//!
//! Nothing here runs per tree and frame. A tree is dressed once, when it gets its model; after that the frame's clock is
//! the only thing that changes.

use super::{
    looks::{Outfit, SpeciesLooks, VariantLook},
    material::TAG_TREE_BITS,
    stand::{Stand, Standing},
};
use crate::tree::{Grown, Species, Tree};
use bevy::{
    camera::visibility::{NoAutoAabb, NoCpuCulling},
    mesh::MeshTag,
    platform::collections::HashMap,
    prelude::*,
};

/// How this machine can draw trees; found out once at start.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawPath {
    /// Whether the vertex shader can read the wind tables. If not, trees stand still in a standard material.
    pub sways: bool,
    /// Whether the graphics processor culls by itself, so that the processor need not.
    pub culls_on_gpu: bool,
    /// Beams that can be posed at once, over all trees; trees beyond that stand still.
    pub pose_limit: u32,
    /// Largest table that a shader can read, bytes.
    pub table_limit_bytes: u64,
}

/// The leaves of a tree: a child entity with a draw of its own.
#[derive(Component, Clone, Copy, Debug)]
#[require(Visibility)]
pub struct Foliage;

/// What the species look like, as far as they have been prepared.
#[derive(Resource, Default)]
pub(super) struct Wardrobe {
    pub looks: HashMap<AssetId<Species>, SpeciesLooks>,
}

/// Message: the looks of a species are there.
#[derive(Message, Clone, Copy)]
pub(super) struct SpeciesDressed(pub AssetId<Species>);

/// Puts the meshes and materials of its model on every tree that has got a new one.
pub(super) fn dress_trees(
    mut commands: Commands,
    wardrobe: Res<Wardrobe>,
    path: Res<DrawPath>,
    mut stand: ResMut<Stand>,
    mut warned: Local<bool>,
    mut dressed: MessageReader<SpeciesDressed>,
    trees: Query<(Entity, &Tree, &Grown, Option<&Children>)>,
    regrown: Query<Entity, Changed<Grown>>,
    foliage: Query<Entity, With<Foliage>>,
) {
    let renewed: Vec<AssetId<Species>> = dressed.read().map(|message| message.0).collect();
    let mut dress = |(entity, tree, grown, children): (Entity, &Tree, &Grown, Option<&Children>)| {
        let Some(looks) = wardrobe.looks.get(&tree.species.id()) else { return };
        let Some(variant) = looks.variants.get(&grown.model.id()) else { return };
        for old in children.into_iter().flatten().filter(|child| foliage.contains(**child)) {
            commands.entity(*old).despawn();
        }
        let standing = if path.sways { stand.admit(grown.model.id(), path.pose_limit) } else { None };
        if path.sways && standing.is_none() && !*warned {
            warn!("windwood: this device can pose {} beams at once; trees beyond that stand still", path.pose_limit);
            *warned = true;
        }
        let tint = tree.tint_byte(grown.seed);
        let tag = MeshTag(standing.map_or(0, |standing| standing.row) | tint << TAG_TREE_BITS);
        // The old row, if there is one, is given back when the component goes.
        let mut tree = commands.entity(entity);
        tree.remove::<Standing>();
        if let Some(standing) = standing {
            tree.insert(standing);
        }
        let wood =
            Draw { mesh: &variant.wood, outfit: &looks.bark, sways: standing.is_some(), tag: tag.clone(), variant };
        wood.put_on(commands.entity(entity), *path);
        if let Some(leaves) = &variant.leaves {
            let leaves = Draw { mesh: leaves, outfit: &looks.foliage, sways: standing.is_some(), tag, variant };
            leaves.put_on(commands.spawn((Foliage, ChildOf(entity), Transform::default())), *path);
        }
    };
    if renewed.is_empty() {
        regrown.iter().filter_map(|entity| trees.get(entity).ok()).for_each(&mut dress);
    } else {
        let due = |tree: &Tree, entity| renewed.contains(&tree.species.id()) || regrown.contains(entity);
        trees.iter().filter(|(entity, tree, ..)| due(tree, *entity)).for_each(&mut dress);
    }
}

/// One draw of a tree.
struct Draw<'a> {
    mesh: &'a Handle<Mesh>,
    outfit: &'a Outfit,
    sways: bool,
    tag: MeshTag,
    variant: &'a VariantLook,
}

impl Draw<'_> {
    fn put_on(self, mut entity: EntityCommands, path: DrawPath) {
        // The box holds every pose; the mesh's own would cull a tree that leans into the view.
        entity.insert((Mesh3d(self.mesh.clone()), self.tag, self.variant.bounds, NoAutoAabb));
        match &self.outfit.swaying {
            Some(swaying) if self.sways => entity.insert(MeshMaterial3d(swaying.clone())),
            _ => entity.insert(MeshMaterial3d(self.outfit.still.clone())),
        };
        if path.culls_on_gpu {
            entity.insert(NoCpuCulling);
        }
    }
}
