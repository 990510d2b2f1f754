//! How trees are drawn.
//!
//! Each stage is a folder, and knows only those before it:
//!
//! | stage | what it does |
//! |---|---|
//! | `species` | prepares the meshes, textures and materials of a species, off the frame |
//! | `instances` | gives each tree a row in the tables that all trees share, and poses those that are visible |
//! | `lod` | selects the levels of detail of each tree by its size on the pictures of the cameras |
//! | `draw` | spawns, swaps and removes the mesh entities of trees |
//! | `gpu` | uploads what changed, and runs the pose pass |
//! | `impostors` | the mesh and the material of far trees, which a [`Forest`](crate::forest::Forest) plants |
//!
//! Beside them: `settings`, `capabilities` and `new_device`, which all may know; `buffers`, `pipeline` and `texture_image`, which rooms with materials of
//! their own share; and `shaders`. `shaders/pose_pass.wesl` poses all beams once a frame, and `shaders/tree_vertex.wesl` moves every vertex
//! with its beam: there is no work per tree and frame on the CPU.
//!
//! Shaders of your own import `bevy_windwood::render::shaders::wind` and bind the tables of [`SwayBuffers`].

pub(crate) mod buffers;
pub(crate) mod capabilities;
pub(crate) mod draw;
mod gpu;
pub(crate) mod impostors;
pub(crate) mod instances;
pub(crate) mod lighting;
pub(crate) mod lod;
pub(crate) mod new_device;
pub(crate) mod pipeline;
mod plugin;
pub(crate) mod settings;
mod shader_files;
mod sky_share;
pub(crate) mod species;
pub(crate) mod texture_image;
pub(crate) mod wind_exposure;

pub use {
    buffers::sway_buffers::SwayBuffers,
    capabilities::RenderCapabilities,
    draw::components::{TreeMeshOf, TreeMeshes, TreePart},
    gpu::pose_pass::POSES_SPAN,
    lighting::TreeLighting,
    plugin::TreeRenderPlugin,
    settings::{LevelOfDetail, LevelStyle},
    texture_image::repeating_image,
};
