//! The GPU buffers that the shaders of trees, grass and fires read.

use bevy::{asset::RenderAssetUsages, prelude::*, render::storage::ShaderBuffer};

/// Size of a buffer before its first upload, bytes.
const FIRST_BYTES: u64 = 256;
/// Size of the values of a frame, bytes.
pub(crate) const FRAME_BYTES: u64 = 11_008;

/// The tables of all trees that sway and of the wind, for shaders of your own.
///
/// To draw what moves with trees, import `bevy_windwood::render::shaders::instances` and `frame` for the layouts and `beam` for `carry`, and
/// find a tree's row in the low 16 bits of its mesh tag. To read the wind, import `bevy_windwood::render::shaders::wind`, which has
/// `velocity_at`, and bind `frame` at 103 and `winds` at 105 and 106 of the material's group.
///
/// The handles stay the same. Buffers grow, and Bevy binds materials anew by itself when they do.
#[derive(Resource, Clone)]
pub struct SwayBuffers {
    /// `array<BeamPose>`: a half for this frame and one for the last frame, which change places each frame. That of the last frame is there
    /// once a camera has had a `MotionVectorPrepass`.
    pub poses: Handle<ShaderBuffer>,
    /// `array<BeamRow>`.
    pub beams: Handle<ShaderBuffer>,
    /// `array<TreeRow>`.
    pub trees: Handle<ShaderBuffer>,
    /// One `Frame`.
    pub frame: Handle<ShaderBuffer>,
    /// `array<vec4<u32>>`: the winds of slot A and B, between which `frame` says how to fade.
    pub winds: [Handle<ShaderBuffer>; 2],
}

impl FromWorld for SwayBuffers {
    fn from_world(world: &mut World) -> Self {
        let mut buffers = world.resource_mut::<Assets<ShaderBuffer>>();
        let frame = buffers.add(ShaderBuffer::with_size(FRAME_BYTES, RenderAssetUsages::RENDER_WORLD));
        let mut empty = || empty_buffer(&mut buffers);
        Self { poses: empty(), beams: empty(), trees: empty(), frame, winds: [empty(), empty()] }
    }
}

/// A buffer without values. It has to be there to be bound; nothing reads it.
pub(crate) fn empty_buffer(buffers: &mut Assets<ShaderBuffer>) -> Handle<ShaderBuffer> {
    buffers.add(ShaderBuffer::with_size(FIRST_BYTES, RenderAssetUsages::RENDER_WORLD))
}
