//! How a beam answers a load: pure functions of plain data, without a word of the engine's entities.
//!
//! The path from the wind to a moving branch, after section 3.2 of Setas, Gomes & Rebordão, "Dynamic Simulation of
//! Natural Environments in Virtual Reality" (equation numbers in this room are that paper's):
//!
//! 1. [`cantilever`]: mode shapes, generalised mass, stiffness and load of a branch (18-20, 22, 23);
//! 2. [`oscillator`]: one mode's equation of motion (21), by the Duhamel integral (24), step by step, and periodic;
//! 3. [`load_basis`]: four signals that stand for the wind's load on a beam of *any* direction, in place of the three
//!    orthogonal beams of (25); [`direction_map`] holds each direction's share of them;
//! 4. [`response`]: what oscillators of some twenty classes of frequency make of these signals, as one table;
//! 5. [`pose`]: a tree's bent beams, children riding on parents, read from that table;
//! 6. [`leaf`]: leaves that turn into the wind and flutter (26).
//!
//! Steps 1 to 4 happen once for a species or a wind, step 5 and 6 in every frame: since (21) is linear, a branch costs
//! a few multiplications, whatever its frequency and its place in the tree.
//!
//! Lengths are in metres, times in seconds. *Wind coordinates* are (along, up, across): along the mean wind, the world's
//! up, and along x up.

pub mod cantilever;
pub mod direction_map;
pub mod leaf;
pub mod load_basis;
pub mod oscillator;
pub mod pose;
pub mod response;

pub use cantilever::{CantileverMode, TaperedBeam};
pub use direction_map::{DirectionMap, LoadCoefficients};
pub use leaf::LeafResponse;
pub use load_basis::{BASIS_RANK, LoadBasis, LoadBasisKind};
pub use oscillator::{ExactStep, Oscillator, OscillatorState};
pub use pose::{BeamDynamics, BeamPose, NO_PARENT, TreePoser};
pub use response::{FrequencyClasses, ResponseTable};
