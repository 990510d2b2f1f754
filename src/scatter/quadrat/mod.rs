//! The quadrat method (algorithm 2 of Setas et al.): a grid over the ground, and how many plants stand in each square.
//!
//! - [`QuadratGrid`] counts the points of a real pattern.
//! - [`draw_counts`] draws every quadrat's count from a law, independently: the pattern has the law's own variation.
//! - [`exact_counts`] is the algorithm as printed, with exactly N points: the quadrats follow the law as closely as whole
//!   numbers can.
//! - [`place_points`] puts the points into their quadrats.

mod allocation;
pub(super) mod grid;
pub(super) mod place;

pub use allocation::{draw_counts, exact_counts};
pub use grid::QuadratGrid;
pub use place::place_points;
