//! Leaves: how they are shaped, veined, coloured and set on their twig, and the textures of a spray of them.
//!
//! `outline` draws the margin of one leaf, `venation` its veins, `blade` turns both into a field that can be
//! drawn at any size, `spray` sets leaves on a twig, and [`texture`] draws them. `ellipsoids` is the other kind of leaves, which
//! have none of these.

mod blade;
mod ellipsoids;
mod outline;
mod settings;
mod spray;
pub mod texture;
mod venation;

pub use ellipsoids::{LeafEllipsoids, LeafKind};
pub use settings::{Leaf, LeafArrangement, LeafMargin, LeafShape};
pub use texture::{LeafTextures, bare_spray_texture, leaf_textures};
