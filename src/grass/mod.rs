//! Meadows: tufts of grass blades after Zaharia, *Procedural Modeling of Natural Phenomena* (section 2.2), that bend in the
//! wind field.
//!
//! A [`GrassPatch`] is one entity and one draw. Its blades are laid out once, off the frame ([`blades`]); after that the
//! vertex shader bends each of them by the wind at its own place and time, so that gusts run over the meadow as waves.
//!
//! - `settings` is what can be chosen, `blades` lays out tufts, `spine` bends a blade: plain arithmetic.
//! - `grow` builds in the background what a patch asks for and keeps the last good meadow.
//! - With the feature `render`, `mesh`, `material` and `draw` draw it (`shaders/blade.wesl` is the twin of `spine`).

pub mod blades;
mod grow;
mod plugin;
mod settings;
pub mod spine;

#[cfg(feature = "render")]
mod draw;
#[cfg(feature = "render")]
mod material;
#[cfg(feature = "render")]
mod mesh;

pub use grow::{GrassGround, GrassPatch, Meadow};
pub use plugin::GrassPlugin;
pub use settings::{GrassLook, GrassResponse, Sward, Tuft};

#[cfg(feature = "render")]
pub use {draw::GrassDrawPlugin, material::GrassMaterial};
