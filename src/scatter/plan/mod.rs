//! The plan of a forest: what the user gives, as data.
//!
//! After Starling & Ashdown, *Impressionistic techniques for rendering woodland scenes*: "The user will input the type of
//! tree required in a given area, the density of planting, age and season. From this the tree position, shape, size and
//! colour will be computed." A [`ForestPlan`] has [`Area`]s, each with a [`Shape`] on the map, a density, a point pattern
//! and its [`Stock`] of species; and shapes that are kept free, [`KeepOut`]. Plans are written in RON
//! (`assets/forests/*.forest.ron`); [`ForestPlan::from_ron`] names the field that is wrong.

pub(super) mod forest;
pub(super) mod keep_out;
mod mask;
#[cfg(feature = "editor")]
pub(crate) mod mask_image;
mod place;
mod polygon;
pub(super) mod shape;
pub(super) mod stock;

pub use forest::{Area, ForestPlan};
pub use keep_out::KeepOut;
pub use place::Place;
pub use shape::Shape;
pub use stock::{GroundLimits, Stock};
