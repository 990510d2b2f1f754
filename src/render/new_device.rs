//! A graphics device that is lost takes with it all that lay on it alone: meshes, textures and tables. Once the renderer has another
//! (`RenderErrorPolicy::Recover` of Bevy), all of that is made again, by systems that run in the frame after. What shaders can do is not
//! asked again: the other device is taken for one like the first.

use bevy::{prelude::*, render::renderer::RenderDevice};

/// Whether the renderer has another device than in the last frame. So it has in the first one, too, in which nothing is there to be made
/// again.
pub(crate) fn device_is_new(device: Option<Res<RenderDevice>>) -> bool {
    device.is_some_and(|device| device.is_changed())
}
