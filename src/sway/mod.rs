//! Trees in the wind: the tables that join wind, dynamics and trees, and the systems that pose every tree from them.
//!
//! - `response` turns a wind field into tables, once per wind, off the frame.
//! - `active` fades from the tables of one wind to those of the next.
//! - `articulated` poses the trees that ask for it on the processor.
//! - With the feature `render`, `looks` has the meshes (`cut`), images (`painted`) and materials (`outfits`) of species made in
//!   the background, `dress` puts them on trees, as many levels of detail as `detail` says, and `stand` gives trees rows in
//!   shared tables; each frame `upload` sends the clock and the rows that changed (`table`, `writes`), `compute` poses all
//!   beams on the graphics processor (`shaders/pose.wgsl`), and `shaders/sway.wgsl` carries every vertex: no work per tree and
//!   frame on the processor.

mod active;
mod articulated;
mod plugin;
mod response;

#[cfg(feature = "render")]
mod chunks;
#[cfg(feature = "render")]
mod compute;
#[cfg(feature = "render")]
mod cut;
#[cfg(feature = "render")]
mod detail;
#[cfg(feature = "render")]
mod draw;
#[cfg(feature = "render")]
mod draw_plugin;
#[cfg(feature = "render")]
mod dress;
#[cfg(feature = "render")]
mod exposure;
#[cfg(feature = "render")]
mod lighting;
#[cfg(feature = "render")]
mod looks;
#[cfg(feature = "render")]
mod material;
#[cfg(feature = "render")]
mod mend;
#[cfg(feature = "render")]
mod outfits;
#[cfg(feature = "render")]
mod painted;
#[cfg(feature = "render")]
mod ranges;
#[cfg(feature = "render")]
mod rouse;
#[cfg(feature = "render")]
mod rows;
#[cfg(feature = "render")]
mod stand;
#[cfg(feature = "render")]
mod table;
#[cfg(feature = "render")]
mod upload;
#[cfg(feature = "render")]
mod writes;

pub use active::{ActiveSway, FLUTTER_PERIOD_S, WeightedResponse};
pub use articulated::TreePose;
pub use plugin::SwayPlugin;
pub use response::{SwaySettings, WindResponse};

#[cfg(feature = "render")]
pub use {
    compute::POSES_SPAN,
    detail::{LevelOfDetail, LevelStyle},
    draw::{DrawPath, Foliage},
    draw_plugin::SwayDrawPlugin,
    lighting::TreeLighting,
    upload::StandTables,
};
#[cfg(feature = "render")]
pub(crate) use {
    detail::CardRange,
    draw::{CardBehind, TreesByLevel},
    exposure::Exposure,
    lighting::{LitAsTrees, TreeLights, relight},
    material::SeasonUniform,
    rouse::CulledOnGpu,
};
