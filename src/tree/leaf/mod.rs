//! Leaves: how they are shaped, veined, coloured and set on their twig, and the textures of a spray of them.
//!
//! `outline` draws the margin of one leaf, `venation` its veins, `blade` turns both into a field that can be
//! drawn at any size, `spray` sets leaves on a twig, [`texture`] draws them, and `cover` tells how much of a card they cover. `ellipsoids` is the other kind of leaves, which
//! have none of these.

mod blade;
mod cover;
mod ellipsoids;
mod outline;
mod settings;
mod spray;
pub mod texture;
mod venation;

pub(in crate::tree) use cover::card_cover;
pub use ellipsoids::{LeafEllipsoids, LeafKind};
pub use settings::{Leaf, LeafArrangement, LeafMargin, LeafShape};
pub use texture::{LeafTextures, bare_spray_texture, leaf_textures};
