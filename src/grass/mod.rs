//! Meadows: tufts of grass blades after Zaharia, *Procedural Modeling of Natural Phenomena* (section 2.2), that bend in the
//! wind field.
//!
//! A [`GrassPatch`] is one entity and one draw. Its blades are laid out once, in the background ([`blades`]). After that the
//! vertex shader bends each of them by the wind at its own place and time, so gusts run over the meadow as waves.
//!
//! - `settings` is what can be chosen, `blades` lays out tufts, `spine` bends a blade, `swing` lets it swing back: plain arithmetic.
//! - `ecs` repeats a patch about the viewers, on the grid of `field_grid`: a meadow without end.
//! - `components` has the entities: it lays out the blades of a patch in the background and keeps the last good ones.
//! - With the feature `render`, `mesh`, `material` and `draw` draw it. `shaders/blade.wesl` has the formulas of `spine`.

pub mod blades;
mod components;
mod ecs;
mod field_grid;
mod plugin;
mod settings;
pub mod spine;
pub mod swing;

#[cfg(feature = "render")]
mod draw;
#[cfg(feature = "render")]
mod material;
#[cfg(feature = "render")]
mod mesh;

pub use components::{GrassGround, GrassPatch, GrassShade, Meadow};
pub use ecs::{GrassField, GrassFieldPatches};
pub use plugin::GrassPlugin;
pub use settings::{GrassLook, GrassResponse, Sward, Tuft};

#[cfg(feature = "render")]
pub use {draw::GrassDrawPlugin, material::GrassMaterial};
