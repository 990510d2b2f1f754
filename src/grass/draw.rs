//! Draws meadows: a mesh and a material for each patch, made once.

use super::{
    grow::{GrassPatch, Meadow},
    material::{GrassMaterial, base_material, grass_material},
    mesh::{bounds, still_mesh, swaying_mesh},
};
use crate::{
    schedule::WindwoodSystems,
    sway::{DrawPath, StandTables},
};
use bevy::{
    asset::embedded_asset,
    camera::{primitives::Aabb, visibility::NoAutoAabb},
    pbr::MaterialPlugin,
    prelude::*,
    render::RenderApp,
    shader::load_shader_library,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use std::sync::Arc;

/// Draws [`GrassPatch`]es, bent in the vertex shader. Needs [`SwayDrawPlugin`](crate::sway::SwayDrawPlugin), which has the
/// wind tables. Without a renderer it does nothing.
pub struct GrassDrawPlugin;

impl Plugin for GrassDrawPlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            return;
        }
        load_shader_library!(app, "shaders/blade.wesl");
        embedded_asset!(app, "shaders/grass.wesl");
        let can_draw = resource_exists::<DrawPath>.and_then(resource_exists::<StandTables>);
        app.add_plugins(MaterialPlugin::<GrassMaterial>::default())
            .add_observer(undress_patch)
            .add_systems(
                Update,
                (start_mowing, dress_patches).chain().after(super::grow::receive_meadows).run_if(can_draw),
            )
            .add_systems(
                PostUpdate,
                bind_anew.after(WindwoodSystems::Upload).run_if(resource_exists_and_changed::<StandTables>),
            );
    }
}

/// The blades that a patch shows, to tell whether they are still its meadow's.
#[derive(Component)]
struct Shown(Arc<Vec<super::blades::Blade>>);

/// A mesh that is being made.
#[derive(Component)]
struct Mowing {
    task: Task<(Mesh, Aabb)>,
    meadow: Meadow,
}

/// Starts making the mesh of each meadow that is new. One of which only the look has changed keeps its mesh, if the mesh
/// holds no colours.
fn start_mowing(
    mut commands: Commands,
    path: Res<DrawPath>,
    tables: Res<StandTables>,
    mut materials: ResMut<Assets<GrassMaterial>>,
    meadows: Query<(Entity, &Meadow, Option<&Shown>, Option<&MeshMaterial3d<GrassMaterial>>), Changed<Meadow>>,
) {
    for (entity, meadow, shown, material) in &meadows {
        let is_shown = shown.is_some_and(|shown| Arc::ptr_eq(&shown.0, &meadow.blades));
        if let Some(mut material) = material.filter(|_| is_shown).and_then(|handle| materials.get_mut(handle)) {
            *material = grass_material(&meadow.patch, &tables);
            continue;
        }
        let (sways, sown) = (path.sways, meadow.clone());
        let task = AsyncComputeTaskPool::get().spawn(async move {
            let look = &sown.patch.look;
            let mesh = if sways { swaying_mesh(&sown.blades) } else { still_mesh(&sown.blades, look) };
            (mesh, bounds(&sown))
        });
        commands.entity(entity).insert(Mowing { task, meadow: meadow.clone() });
    }
}

/// Puts meshes that are made, and their materials, on their patches.
fn dress_patches(
    mut commands: Commands,
    path: Res<DrawPath>,
    tables: Res<StandTables>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut swaying: ResMut<Assets<GrassMaterial>>,
    mut still: ResMut<Assets<StandardMaterial>>,
    mut mowing: Query<(Entity, &mut Mowing)>,
) {
    for (entity, mut mowing) in &mut mowing {
        let Some((mesh, bounds)) = block_on(poll_once(&mut mowing.task)) else { continue };
        let patch = &mowing.meadow.patch;
        let mut entity = commands.entity(entity);
        // The box holds every pose; the mesh's own would be that of the roots.
        entity.remove::<Mowing>().insert((
            Mesh3d(meshes.add(mesh)),
            bounds,
            NoAutoAabb,
            Shown(mowing.meadow.blades.clone()),
        ));
        if path.sways {
            entity.insert(MeshMaterial3d(swaying.add(grass_material(patch, &tables))));
        } else {
            entity.insert(MeshMaterial3d(still.add(base_material(&patch.look))));
        }
    }
}

/// Binds materials to wind tables that were replaced.
fn bind_anew(mut materials: ResMut<Assets<GrassMaterial>>) {
    // Iterating mutably marks every material as changed.
    materials.iter_mut().for_each(drop);
}

fn undress_patch(removed: On<Remove<GrassPatch>>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<(Mowing, Shown, Mesh3d, MeshMaterial3d<GrassMaterial>, MeshMaterial3d<StandardMaterial>)>();
    }
}
