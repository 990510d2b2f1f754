//! Shows trees to views that came after them.
//!
//! Bevy 0.19.1 tells a view of a mesh with `NoCpuCulling` once, when the mesh comes: a camera or a sun that comes later, or
//! is switched on, never hears of it (`collect_gpu_culled_meshes` goes by what was added in the frame). So when a view
//! comes, our meshes are out of sight for one frame, and come anew in the next. To have the processor cull them for a frame
//! instead would show them all the time, but then some of them are lost to the new view (`tests/late_views.rs`).

use bevy::{camera::visibility::NoCpuCulling, light::DirectionalLight, prelude::*};

/// A mesh of ours that the graphics processor culls.
#[derive(Component, Clone, Copy, Default)]
#[require(NoCpuCulling)]
pub(crate) struct CulledOnGpu;

/// Meshes that are out of sight in this frame.
#[derive(Resource, Default)]
pub(super) struct Roused(Vec<Entity>);

/// Has the visibility of meshes that were hidden in the last frame found out anew. Before it is propagated.
pub(super) fn recall_meshes(mut roused: ResMut<Roused>, mut meshes: Query<&mut Visibility>) {
    for mesh in roused.bypass_change_detection().0.drain(..) {
        if let Ok(mut visibility) = meshes.get_mut(mesh) {
            visibility.set_changed();
        }
    }
}

/// Hides every mesh when a camera or a sun with shadows has come or was switched on. After visibility is propagated.
pub(super) fn rouse_meshes(
    mut roused: ResMut<Roused>,
    mut looking: Local<Vec<Entity>>,
    mut now: Local<Vec<Entity>>,
    cameras: Query<(Entity, &Camera)>,
    suns: Query<(Entity, &DirectionalLight)>,
    mut meshes: Query<(Entity, &mut InheritedVisibility), With<CulledOnGpu>>,
) {
    now.clear();
    now.extend(cameras.iter().filter(|(_, camera)| camera.is_active).map(|(entity, _)| entity));
    now.extend(suns.iter().filter(|(_, sun)| sun.shadow_maps_enabled).map(|(entity, _)| entity));
    now.sort_unstable();
    if now.iter().any(|view| looking.binary_search(view).is_err()) {
        let visible = meshes.iter_mut().filter(|(_, visibility)| visibility.get());
        roused.bypass_change_detection().0.extend(visible.map(|(mesh, mut visibility)| {
            *visibility = InheritedVisibility::HIDDEN;
            mesh
        }));
    }
    looking.clone_from(&now);
}
