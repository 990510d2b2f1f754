//! Draws meadows: a mesh and a material for each patch, made once.

use super::{
    components::{GrassPatch, Meadow},
    ecs::GrassField,
    material::{GrassMaterial, base_material, grass_material},
    mesh::{bounds, still_mesh, swaying_mesh},
};
use crate::{
    background::{Work, spawn_work},
    plugin_checks::{has_renderer, require_renderer_before},
    render::{
        RenderCapabilities, SwayBuffers,
        new_device::{device_is_new, remove_lost_mesh},
    },
};
use bevy::{
    asset::embedded_asset,
    camera::{primitives::Aabb, visibility::NoAutoAabb},
    light::NotShadowCaster,
    pbr::MaterialPlugin,
    prelude::*,
    shader::load_shader_library,
    tasks::{block_on, poll_once},
};
use std::sync::Arc;

/// Draws [`GrassPatch`]es, bent in the vertex shader. Needs [`TreeRenderPlugin`](crate::render::TreeRenderPlugin), which has the
/// wind tables. Without a renderer it does nothing.
pub struct GrassDrawPlugin;

impl Plugin for GrassDrawPlugin {
    fn build(&self, app: &mut App) {
        if !has_renderer(app) {
            return;
        }
        load_shader_library!(app, "shaders/blade.wesl");
        embedded_asset!(app, "shaders/grass.wesl");
        embedded_asset!(app, "shaders/grass_colour.wesl");
        let can_draw = resource_exists::<RenderCapabilities>;
        app.add_plugins(MaterialPlugin::<GrassMaterial>::default()).add_observer(remove_patch_meshes).add_systems(
            Update,
            (remake_lost_meshes.run_if(device_is_new), start_making_meshes, show_patches)
                .chain()
                .after(super::components::finish_meadow_layouts)
                .run_if(can_draw),
        );
    }

    fn finish(&self, app: &mut App) {
        require_renderer_before::<Self>(app, app.is_plugin_added::<MaterialPlugin<GrassMaterial>>());
    }
}

/// The blades that a patch shows, to tell whether they are still its meadow's.
#[derive(Component)]
struct Shown(Arc<Vec<super::blades::Blade>>);

/// A mesh that is being made.
#[derive(Component)]
struct MeshTask {
    task: Work<(Mesh, Aabb)>,
    meadow: Meadow,
}

/// Has all meshes made again, when they lay on a graphics device that was lost.
fn remake_lost_meshes(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    shown: Query<(Entity, &Meadow, &Mesh3d), With<Shown>>,
) {
    for (entity, meadow, mesh) in &shown {
        remove_lost_mesh(mesh, &mut meshes);
        commands.entity(entity).remove::<Shown>().insert(meadow.clone());
    }
}

/// Starts making the mesh of each meadow that is new. One of which only the look has changed keeps its mesh, if the mesh
/// holds no colours.
fn start_making_meshes(
    mut commands: Commands,
    capabilities: Res<RenderCapabilities>,
    buffers: Res<SwayBuffers>,
    mut materials: ResMut<Assets<GrassMaterial>>,
    meadows: Query<(Entity, &Meadow, Option<&Shown>, Option<&MeshMaterial3d<GrassMaterial>>), Changed<Meadow>>,
) {
    for (entity, meadow, shown, material) in &meadows {
        let is_shown = shown.is_some_and(|shown| Arc::ptr_eq(&shown.0, &meadow.blades));
        if let Some(mut material) = material.filter(|_| is_shown).and_then(|handle| materials.get_mut(handle)) {
            *material = grass_material(&meadow.patch, &buffers);
            continue;
        }
        let (sways, meadow_of_task) = (capabilities.sways, meadow.clone());
        let task = spawn_work(move || {
            let look = &meadow_of_task.patch.look;
            let mesh =
                if sways { swaying_mesh(&meadow_of_task.blades) } else { still_mesh(&meadow_of_task.blades, look) };
            (mesh, bounds(&meadow_of_task))
        });
        commands.entity(entity).insert(MeshTask { task, meadow: meadow.clone() });
    }
}

/// Puts meshes that are made, and their materials, on their patches.
fn show_patches(
    mut commands: Commands,
    capabilities: Res<RenderCapabilities>,
    buffers: Res<SwayBuffers>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut swaying: ResMut<Assets<GrassMaterial>>,
    mut still: ResMut<Assets<StandardMaterial>>,
    mut tasks: Query<(Entity, &mut MeshTask, Option<&ChildOf>)>,
    fields_without_shadow: Query<(), (With<GrassField>, With<NotShadowCaster>)>,
) {
    for (entity, mut making, parent) in &mut tasks {
        let Some(made) = block_on(poll_once(&mut making.task)) else { continue };
        let mut entity = commands.entity(entity);
        entity.remove::<MeshTask>();
        let (mesh, bounds) = match made {
            Ok(made) => made,
            Err(panic) => {
                error!("grass patch {}: {panic}; the last good mesh stays", entity.id());
                continue;
            }
        };
        let patch = &making.meadow.patch;
        // Where nothing grows there is no mesh: Bevy warns of those without vertices.
        let mesh = if making.meadow.blades.is_empty() { Handle::default() } else { meshes.add(mesh) };
        // The box holds every pose; the mesh's own would be that of the roots.
        entity.insert((Mesh3d(mesh), bounds, NoAutoAabb, Shown(making.meadow.blades.clone())));
        if parent.is_some_and(|parent| fields_without_shadow.contains(parent.parent())) {
            entity.insert(NotShadowCaster);
        }
        if capabilities.sways {
            entity.insert(MeshMaterial3d(swaying.add(grass_material(patch, &buffers))));
        } else {
            entity.insert(MeshMaterial3d(still.add(base_material(&patch.look))));
        }
    }
}

fn remove_patch_meshes(removed: On<Remove<GrassPatch>>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity
            .try_remove::<(MeshTask, Shown, Mesh3d, MeshMaterial3d<GrassMaterial>, MeshMaterial3d<StandardMaterial>)>();
    }
}
