//! Shows trees to views that came after them.
//!
//! Bevy 0.19.1 tells a view of a mesh with `NoCpuCulling` once, when the mesh comes: a camera or a sun that comes later, or
//! is switched on, never hears of it (`collect_gpu_culled_meshes` goes by what was added in the frame). So when a view
//! comes, our meshes are culled by the processor for one frame, and come anew in the next.

use bevy::{camera::visibility::NoCpuCulling, light::DirectionalLight, prelude::*};

/// A mesh of ours that the graphics processor culls.
#[derive(Component, Clone, Copy, Default)]
#[require(NoCpuCulling)]
pub(crate) struct CulledOnGpu;

/// Takes the mark of Bevy's own off every mesh when a camera or a sun with shadows has come or was switched on.
pub(super) fn rouse_meshes(
    mut commands: Commands,
    mut looking: Local<Vec<Entity>>,
    mut now: Local<Vec<Entity>>,
    cameras: Query<(Entity, &Camera)>,
    suns: Query<(Entity, &DirectionalLight)>,
    meshes: Query<Entity, (With<CulledOnGpu>, With<NoCpuCulling>)>,
) {
    now.clear();
    now.extend(cameras.iter().filter(|(_, camera)| camera.is_active).map(|(entity, _)| entity));
    now.extend(suns.iter().filter(|(_, sun)| sun.shadow_maps_enabled).map(|(entity, _)| entity));
    now.sort_unstable();
    if now.iter().any(|view| looking.binary_search(view).is_err()) {
        meshes.iter().for_each(|mesh| {
            commands.entity(mesh).remove::<NoCpuCulling>();
        });
    }
    looking.clone_from(&now);
}

/// Puts it on again in the frame after.
pub(super) fn calm_meshes(mut commands: Commands, meshes: Query<Entity, (With<CulledOnGpu>, Without<NoCpuCulling>)>) {
    meshes.iter().for_each(|mesh| {
        commands.entity(mesh).insert(NoCpuCulling);
    });
}
