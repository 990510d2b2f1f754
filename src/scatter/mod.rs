//! Point patterns and forest plans: where plants stand.
//!
//! - [`counts`] has the laws of the quadrat method: the number of plants in a square of ground, and which law a real pattern
//!   follows.
//! - [`quadrat`] draws point patterns from them, and counts the points of real ones.
//! - [`plan`] is what the user gives: areas with their density, species, ages and season, and what is kept free.
//! - [`Planter`] turns a plan into plants, cell by cell, on any [`Ground`](crate::Ground).
//!
//! This room is plain arithmetic without an app. Species are names here, and the ground is a trait.

pub mod counts;
mod error;
pub mod plan;
mod planting;
pub mod quadrat;

pub use error::ScatterError;
pub use plan::ForestPlan;
pub(crate) use planting::GREATEST_SIZE;
pub use planting::{Planted, Planter, Stem};
