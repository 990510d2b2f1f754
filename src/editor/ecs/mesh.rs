//! Diagrams as entities: each is a child of the tree that it is of, which is hidden meanwhile.

use super::{turntable::StageTree, workbench::Workbench};
use crate::{
    background::{Work, spawn_work},
    editor::diagram::{Diagram, View, diagram},
    render::{LevelOfDetail, TreeMeshes},
    tree::{Grown, Season, Tree, TreeModel},
};
use bevy::{
    asset::RenderAssetUsages,
    light::{NotShadowCaster, NotShadowReceiver},
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
    tasks::{block_on, poll_once},
};

/// The diagram of a tree.
#[derive(Component)]
pub(super) struct DiagramOf(Entity);

/// A diagram that is made.
#[derive(Component)]
pub(super) struct MakingDiagram {
    key: (AssetId<TreeModel>, View),
    task: Work<Option<Diagram>>,
}

/// What the diagram of a tree was made of.
#[derive(Component, PartialEq, Eq)]
pub(super) struct MadeDiagram(AssetId<TreeModel>, View);

/// Begins diagrams of trees whose view or model is another.
pub(super) fn begin_diagrams(
    mut commands: Commands,
    workbench: Res<Workbench>,
    levels: Res<LevelOfDetail>,
    season: Res<Season>,
    models: Res<Assets<TreeModel>>,
    trees: Query<(Entity, &Tree, &Grown, Option<&MadeDiagram>, Option<&MakingDiagram>), With<StageTree>>,
) {
    let view = workbench.stage.view;
    for (entity, tree, grown, made, making) in &trees {
        let key = (grown.model.id(), view);
        let is_known =
            made.is_some_and(|made| (made.0, made.1) == key) || making.is_some_and(|making| making.key == key);
        let Some(model) = models.get(&grown.model).filter(|_| !is_known) else { continue };
        let (model, decimations) = (model.clone(), levels.bake.decimations.clone());
        let leaf_share = model.leaf_season.share(season.wrapped() + tree.season_shift());
        let task = spawn_work(move || diagram(&model, view, &decimations, leaf_share));
        commands.entity(entity).insert(MakingDiagram { key, task });
    }
}

/// Shows diagrams that are made, in place of those before them.
pub(super) fn show_diagrams(
    mut commands: Commands,
    mut workbench: ResMut<Workbench>,
    mut making: Query<(Entity, &mut MakingDiagram)>,
    shown: Query<(Entity, &DiagramOf)>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for (tree, mut making) in &mut making {
        let Some(made) = block_on(poll_once(&mut making.task)) else { continue };
        shown.iter().filter(|(_, of)| of.0 == tree).for_each(|(old, _)| commands.entity(old).despawn());
        commands.entity(tree).remove::<MakingDiagram>().insert(MadeDiagram(making.key.0, making.key.1));
        let made = made.unwrap_or_else(|panic| {
            workbench.tell_panic(&panic, "the lit tree is shown");
            None
        });
        let Some(diagram) = made else {
            workbench.legend.clear();
            continue;
        };
        workbench.legend.clone_from(&diagram.legend);
        let material = StandardMaterial { unlit: true, cull_mode: None, ..default() };
        let bundle = (
            DiagramOf(tree),
            Mesh3d(meshes.add(mesh_of(diagram))),
            MeshMaterial3d(materials.add(material)),
            Visibility::Visible,
            NotShadowCaster,
            NotShadowReceiver,
        );
        let entity = commands.spawn(bundle).id();
        commands.entity(tree).add_child(entity);
    }
}

/// Hides what is drawn of trees while a diagram is in its place.
pub(super) fn hide_trees(
    trees: Query<(Option<&MadeDiagram>, &TreeMeshes), With<StageTree>>,
    mut visibilities: Query<&mut Visibility>,
) {
    for (made, meshes) in &trees {
        let is_lit = made.is_none_or(|made| made.1 == View::Lit);
        let wanted = if is_lit { Visibility::Inherited } else { Visibility::Hidden };
        for mesh in meshes.iter() {
            if let Ok(mut visibility) = visibilities.get_mut(mesh) {
                visibility.set_if_neq(wanted);
            }
        }
    }
}

fn mesh_of(diagram: Diagram) -> Mesh {
    let topology = if diagram.is_lines { PrimitiveTopology::LineList } else { PrimitiveTopology::TriangleList };
    Mesh::new(topology, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 1.0, 0.0]; diagram.positions.len()])
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, diagram.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, diagram.colours)
        .with_inserted_indices(Indices::U32(diagram.indices))
}
