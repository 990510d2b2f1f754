//! Slow and exact forms of what this room computes fast, for the tests.
//!
//! `validate` and the benches take `cantilever` and `oscillator` in by their paths, so these import nothing of the crate.

pub mod cantilever;
pub mod oscillator;
pub mod series;
mod tests;
