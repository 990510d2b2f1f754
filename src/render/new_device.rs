//! A graphics device that is lost takes with it all that lay on it alone: meshes, textures and tables. Once the renderer has another
//! (`RenderErrorPolicy::Recover` of Bevy), all of that is made again, by systems that run in the frame after. What shaders can do is not
//! asked again: the other device is taken for one like the first.

use bevy::{prelude::*, render::renderer::RenderDevice};

/// Whether the renderer has another device than in the last frame. The first is not another.
pub(crate) fn device_is_new(device: Option<Res<RenderDevice>>, mut has_had_one: Local<bool>) -> bool {
    device.is_some_and(|device| std::mem::replace(&mut *has_had_one, true) && device.is_changed())
}

/// Removes a mesh that lay on the lost device alone. To free its handle would be too late: the renderer asks for all vertices again in
/// this frame.
pub(crate) fn remove_lost_mesh(mesh: impl Into<AssetId<Mesh>>, meshes: &mut Assets<Mesh>) {
    meshes.remove(mesh);
}
