//! Trees that something touches: live oscillators beside the periodic table.
//!
//! The table has the response to the wind, which is periodic. What a game does is not: a blast, a rotor, a blow, a body that walks
//! through a bush. A tree that is touched gets, for each of its beams, oscillators of its own. They hold what is added to the angle of
//! the table, before that saturates: so nothing is bent past the limit, and a tree at rest needs none.
//!
//! - `beam`: what a wind of a source adds to a beam's load, by that which blows anyhow.
//! - `oscillators`: the state of a tree, carried on by the [exact step](super::ExactStep) of each class of frequency and of the two
//!   damping ratios of the [grid](super::OscillatorGrid), with the weights with which the beam reads them in the table. So under the
//!   table's own load it moves as the table says. A beam of two natural frequencies has those of both, each with its share; there the
//!   table's rows are of a rounded size, and these have none. Beams too stiff for a class of their own ring as those of the last.
//! - `contact`: forces at one place: blows, and bodies that push branches aside.
//!
//! All is in the tree's own coordinates. Angles are free tip angles in rad, as [`pose`](super::pose) has them.

mod beam;
mod contact;
mod oscillators;

pub use beam::LiveBeam;
pub use contact::{Capsule, Contacts, SweptCapsule, strike};
pub use oscillators::{BeamLoad, LiveSteps, LiveTree};
