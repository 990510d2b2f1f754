//! Lower levels of detail of a baked tree. Pure code, run once for each model and off the frame.
//!
//! Setas, Gomes & Rebordão ("Dynamic simulation of natural environments in virtual reality", section 4.1.2) draw a tree in
//! three resolutions. The high one is the grown tree itself. This room makes what stands for it farther away:
//!
//! | module | what |
//! |---|---|
//! | `decimate` | The tree's own meshes without thin branches, and with fewer but larger sprays of leaves. |
//! | `coarse_sway` | Which beams move the coarsest of them, and what these carry. |
//! | `thinned` | The levels made of such meshes, by what each species bears to lose. |
//! | `impostor` | An atlas of views from all over the upper hemisphere, and how far such pictures lean in the wind. |
//! | `paper` | The paper's medium level (a cone for the trunk, a textured envelope of leaves) and its low one (four polygons). |
//! | `bake` | What `impostor` and `paper` share: a tree that rays can hit, rasterised into textures with mips. |
//! | `screen_size` | At which size on screen one level follows another. |
//! | `settings` | What can be chosen about all of these. |

mod bake;
#[cfg(feature = "render")]
mod coarse_sway;
mod decimate;
mod impostor;
mod paper;
mod reference_wind;
mod screen_size;
mod settings;
mod thinned;

#[cfg(test)]
mod tests;

pub use bake::scene::Scene;
#[cfg(feature = "render")]
pub(crate) use coarse_sway::{bind_to_swaying, swaying_beams};
pub use decimate::{DecimatedMeshes, decimate, prunable_radius_m};
pub use impostor::{
    atlas::{ImpostorAtlas, ImpostorView},
    frame::ImpostorFrame,
    sway::ImpostorSway,
};
pub use paper::{
    envelope::{EnvelopeLevel, EnvelopeVertices},
    polygons::{CrossedPolygons, crossed_polygons},
};
pub use screen_size::{Lens, LodScreenSizes};
#[cfg(all(test, feature = "render"))]
pub(crate) use settings::LEAST_LEAF_SHARE;
pub use settings::{Decimation, EnvelopeSettings, ImpostorSettings, LodBakeSettings, MOST_LEVELS};
#[cfg(feature = "render")]
pub(crate) use thinned::thinned;
pub use thinned::{ThinnedMeshes, thinned_meshes};
