//! Trees that grow: the shape of a tree's former model fades while that of its new one comes, each in those pixels that the dither of the
//! levels of detail leaves to it.

use super::components::{DrawnTree, TreeMeshOf, TreeMeshes, TreePart};
use crate::{
    render::{
        instances::{
            components::{TreeGrows, TreeInstance},
            tables::InstanceTables,
        },
        lod::thresholds::LodSelection,
        species::library::{SpeciesLibrary, VariantRemoved},
    },
    tree::{Tree, TreeModel},
};
use bevy::prelude::*;

/// How long a fade takes, s. By eye: within it a step of age is seen to grow, and not to change.
const FADE_S: f32 = 1.5;

/// The shape that a tree had before it grew. It keeps its row in the tables: taking the component away frees that.
#[derive(Component, Debug)]
#[component(clone_behavior = Ignore)]
pub(crate) struct FormerShape {
    model: AssetId<TreeModel>,
    row: u32,
    height_m: f32,
    /// How much of it has faded, 0 to 1.
    faded: f32,
}

/// A mesh of the former shape of a tree.
#[derive(Component)]
#[relationship(relationship_target = FormerMeshes)]
pub(crate) struct FormerMeshOf(Entity);

#[derive(Component, Default)]
#[relationship_target(relationship = FormerMeshOf, linked_spawn)]
pub(crate) struct FormerMeshes(Vec<Entity>);

/// Keeps what is drawn of a tree that grows, as the shape from which it fades. Of one that grows faster than it fades the last is kept.
pub(crate) fn keep_former_shape(
    grows: On<TreeGrows>,
    mut commands: Commands,
    library: Res<SpeciesLibrary>,
    mut tables: ResMut<InstanceTables>,
    trees: Query<(&Tree, &TreeInstance, &LodSelection, &DrawnTree, &TreeMeshes)>,
    parts: Query<&TreePart>,
) {
    let tree = grows.entity;
    commands.entity(tree).despawn_related::<FormerMeshes>().remove::<FormerShape>();
    let Ok((Tree { species, .. }, instance, selection, drawn, meshes)) = trees.get(tree) else { return };
    let Some(row) = instance.row.filter(|_| !selection.is_impostor) else { return };
    tables.keep_row(row);
    let (model, height_m) = (instance.model, instance.height_m);
    commands.entity(tree).insert(FormerShape { model, row, height_m, faded: 0.0 });
    let bark = library.variant(species.id(), model).and_then(|variant| variant.fading_bark(drawn.is_bare));
    for mesh in meshes.iter() {
        let mut former = commands.entity(mesh);
        former.remove::<TreeMeshOf>().insert(FormerMeshOf(tree));
        if let Some(bark) = bark.filter(|_| parts.get(mesh) == Ok(&TreePart::Wood)) {
            former.insert(MeshMaterial3d(bark.clone()));
        }
    }
}

/// Fades former shapes, and the shapes that the trees have now in their place.
pub(crate) fn fade_former_shapes(
    mut commands: Commands,
    time: Res<Time>,
    mut tables: ResMut<InstanceTables>,
    mut removed: MessageReader<VariantRemoved>,
    mut trees: Query<(
        Entity,
        &mut FormerShape,
        &Tree,
        &TreeInstance,
        &GlobalTransform,
        &LodSelection,
        &mut DrawnTree,
        Has<TreeMeshes>,
    )>,
) {
    let removed: Vec<AssetId<TreeModel>> = removed.read().map(|VariantRemoved(model)| *model).collect();
    for (entity, mut former, tree, instance, at, selection, mut drawn, is_drawn) in &mut trees {
        if is_drawn {
            former.faded += time.delta_secs() / FADE_S;
        }
        if former.faded >= 1.0 || selection.is_impostor || removed.contains(&former.model) {
            commands.entity(entity).despawn_related::<FormerMeshes>().remove::<FormerShape>();
            // Its wood needs no mask any more.
            drawn.selection = None;
            continue;
        }
        tables.write_growth_fade(former.row, former.faded);
        tables.write_transform(former.row, at, tree.season_shift(), former.height_m);
        if let Some(row) = instance.row {
            tables.write_growth_fade(row, former.faded - 1.0);
        }
    }
}

/// Frees the row of a former shape that goes. What the tree is now is seen whole.
pub(crate) fn free_former_row(
    discarded: On<Discard<FormerShape>>,
    trees: Query<(&FormerShape, Option<&TreeInstance>)>,
    mut tables: ResMut<InstanceTables>,
) {
    let Ok((former, instance)) = trees.get(discarded.entity) else { return };
    tables.free_row(former.row);
    if let Some(row) = instance.and_then(|instance| instance.row) {
        tables.write_growth_fade(row, 0.0);
    }
}
