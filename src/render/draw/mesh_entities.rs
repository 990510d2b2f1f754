//! Spawns and swaps the meshes of trees: one for the wood and one for the leaves of a level. All trees with a model and a level are drawn in
//! one batch.

use super::{
    components::{DrawnTree, TreeMeshOf, TreeMeshes, TreePart},
    growth::FormerShape,
    layers::insert_layers_and_culling,
    waiting::{DrawnLevels, WaitingTrees},
};
use crate::{
    render::{
        capabilities::RenderCapabilities,
        instances::{
            components::{HasImpostor, TreeInstance},
            tag::{Fading, pack_tag},
        },
        lod::thresholds::LodSelection,
        species::library::{PreparedLod, PreparedMesh, PreparedVariant, SpeciesLibrary},
    },
    tree::{Season, Tree},
};
use bevy::{camera::visibility::RenderLayers, light::NotShadowCaster, mesh::MeshTag, prelude::*};

/// What the meshes of a tree follow from.
type Drawn = (
    Entity,
    &'static Tree,
    Ref<'static, TreeInstance>,
    &'static LodSelection,
    &'static mut DrawnTree,
    Has<HasImpostor>,
    Has<FormerShape>,
    Option<&'static RenderLayers>,
    Option<&'static TreeMeshes>,
);

/// Draws the levels that were selected for trees, or others until these are there. The first that is seen of a tree is what was selected.
pub(crate) fn update_tree_meshes(
    mut commands: Commands,
    library: Res<SpeciesLibrary>,
    capabilities: Res<RenderCapabilities>,
    season: Res<Season>,
    mut waiting: ResMut<WaitingTrees>,
    mut trees: Query<Drawn, Or<(Changed<LodSelection>, Changed<TreeInstance>, Changed<DrawnTree>)>>,
    mut visibilities: Query<&mut Visibility, With<TreeMeshOf>>,
) {
    for (entity, tree, instance, selection, mut drawn, has_impostor, is_growing, layers, meshes) in &mut trees {
        let Some(variant) = library.variant(tree.species.id(), instance.model) else { continue };
        // With another instance everything is another.
        let before = drawn.selection.filter(|_| !instance.is_changed());
        if before == Some(*selection) {
            continue;
        }
        let is_new = meshes.is_none();
        let meshes = meshes.into_iter().flat_map(TreeMeshes::iter);
        let is_same = |before: &LodSelection| (before.lod, before.is_fading) == (selection.lod, selection.is_fading);
        if before.as_ref().is_some_and(is_same) {
            // Only an impostor comes or goes.
            let visibility = mesh_visibility(selection);
            let has_caster_changed = before.is_some_and(|it| it.is_shadow_impostor != selection.is_shadow_impostor);
            meshes.for_each(|mesh| {
                if let Ok(mut it) = visibilities.get_mut(mesh) {
                    it.set_if_neq(visibility);
                }
                if has_caster_changed {
                    set_caster(&mut commands.entity(mesh), !selection.is_shadow_impostor);
                }
            });
            drawn.bypass_change_detection().selection = Some(*selection);
            continue;
        }
        let is_bare = library.is_bare(tree.species.id(), season.wrapped() + tree.season_shift());
        let levels = DrawnLevels::of(variant, selection, is_bare);
        if !levels.is_complete {
            waiting.0.push(entity);
            if is_new {
                continue;
            }
        }
        meshes.for_each(|mesh| commands.entity(mesh).despawn());
        let spawner = MeshSpawner {
            tree: entity,
            instance: &instance,
            variant,
            selection,
            levels,
            has_impostor,
            is_growing,
            is_bare,
            layers,
            capabilities: *capabilities,
        };
        let mesh_count = spawner.spawn(&mut commands);
        *drawn.bypass_change_detection() = DrawnTree { selection: Some(*selection), is_bare, mesh_count };
    }
}

fn mesh_visibility(selection: &LodSelection) -> Visibility {
    if selection.is_impostor { Visibility::Hidden } else { Visibility::Inherited }
}

/// Has a mesh cast shadows, or not.
fn set_caster(mesh: &mut EntityCommands, casts_shadow: bool) {
    if casts_shadow {
        mesh.remove::<NotShadowCaster>();
    } else {
        mesh.insert(NotShadowCaster);
    }
}

/// Spawns the meshes of a tree.
struct MeshSpawner<'a> {
    tree: Entity,
    instance: &'a TreeInstance,
    variant: &'a PreparedVariant,
    selection: &'a LodSelection,
    levels: DrawnLevels,
    has_impostor: bool,
    is_growing: bool,
    is_bare: bool,
    layers: Option<&'a RenderLayers>,
    capabilities: RenderCapabilities,
}

impl MeshSpawner<'_> {
    /// Spawns a level, and the one that it fades into. Returns the number of meshes.
    fn spawn(&self, commands: &mut Commands) -> u8 {
        let lod = self.levels.first;
        let Some(level) = self.variant.lods.get(usize::from(lod)) else { return 0 };
        let next = self.levels.next.and_then(|next| self.variant.lods.get(usize::from(next)));
        let wood_of = |level| PreparedLod::wood(level, self.is_bare);
        let next_wood = next.filter(|next| !next.is_wood_nested).map(wood_of);
        let next_leaves = next.and_then(|next| next.leaves.as_ref());
        let fading = if next.is_some() { Fading::OUT } else { self.end_of(lod) };
        let next_fading = Fading::IN.and(self.end_of(lod + 1));
        let meshes = [
            (TreePart::Wood, Some(wood_of(level)), lod, fading),
            (TreePart::Leaves, level.leaves.as_ref(), lod, fading),
            (TreePart::Wood, next_wood, lod + 1, next_fading),
            (TreePart::Leaves, next_leaves, lod + 1, next_fading),
        ];
        let mut count = 0;
        for (part, mesh, lod, fading) in meshes {
            let Some((mesh, handle)) = mesh.and_then(|mesh| Some((mesh, mesh.mesh.as_ref()?))) else { continue };
            self.spawn_mesh(part, mesh, handle, lod, fading, commands);
            count += 1;
        }
        count
    }

    /// How a level ends that fades into no other.
    fn end_of(&self, lod: u8) -> Fading {
        if self.has_impostor && lod + 1 == self.instance.lod_count { Fading::TO_IMPOSTOR } else { Fading::NONE }
    }

    /// Spawns a mesh with all that it needs at once, since each insertion moves an entity in memory.
    fn spawn_mesh(
        &self,
        part: TreePart,
        mesh: &PreparedMesh,
        handle: &Handle<Mesh>,
        lod: u8,
        fading: Fading,
        commands: &mut Commands,
    ) {
        let row = self.instance.row;
        let fading = if mesh.can_fade && row.is_some() { fading } else { Fading::NONE };
        let tag = pack_tag(row.unwrap_or(0), lod, fading, self.instance.tint);
        // The box holds all poses in the winds that blow; the mesh's own would cull a tree that leans into the view.
        let entity = (
            (TreeMeshOf(self.tree), ChildOf(self.tree), part, mesh_visibility(self.selection)),
            (Mesh3d(handle.clone()), MeshTag::new(tag), self.variant.bounds),
        );
        let materials = mesh.materials(self.is_bare);
        let fading_bark =
            || self.variant.fading_bark(self.is_bare).filter(|_| self.is_growing && part == TreePart::Wood);
        let swaying = materials.swaying.as_ref().map(|own| fading_bark().unwrap_or(own));
        let mut spawned = match swaying {
            Some(swaying) if row.is_some() => commands.spawn((entity, MeshMaterial3d(swaying.clone()))),
            _ => commands.spawn((entity, MeshMaterial3d(materials.still.clone()))),
        };
        if self.selection.is_shadow_impostor {
            spawned.insert(NotShadowCaster);
        }
        insert_layers_and_culling(&mut spawned, self.layers, self.capabilities);
    }
}
