//! Fires after Zaharia, *Procedural Modeling of Natural Phenomena* (section 2.1): self-similar rhombs, animated, that lean
//! with the wind.
//!
//! A [`Fire`] is one entity with one draw, and a light that flickers with it. Its pose is a pure function of time, place and
//! seed: nothing is simulated, so nothing is lost while it is out of view, and the clock may jump.
//!
//! - `settings` is what can be chosen, [`rhombs`] the shape, [`flicker`] the brightness in time: plain arithmetic.
//! - `components` has the entities: it generates the flames of a fire and keeps the last good ones.
//! - With the feature `render`, `mesh`, `material` and `draw` draw it (`shaders/fire.wesl`) and make it give light.

mod components;
pub mod flicker;
mod plugin;
pub mod rhombs;
mod settings;

#[cfg(feature = "render")]
mod draw;
#[cfg(feature = "render")]
mod material;
#[cfg(feature = "render")]
mod mesh;

pub use components::{Fire, Flames};
pub use plugin::FirePlugin;
pub use settings::{FireLook, FireShape};

#[cfg(feature = "render")]
pub use draw::{FireDrawPlugin, FireLight};
