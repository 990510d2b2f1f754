//! Fires after Zaharia, *Procedural Modeling of Natural Phenomena* (section 2.1): rhombs that grow on rhombs, alive and
//! leaning with the wind.
//!
//! A [`Fire`] is one entity with one draw, and a light that flickers with it. Its pose is a pure function of time, place and
//! seed: nothing is simulated, so fires may be looked away from, and clocks may jump.
//!
//! - [`rhombs`] grows the shape, [`flicker`] its rhythm: plain arithmetic.
//! - `burn` keeps the last good fire of an entity.
//! - With the feature `render`, `mesh`, `material` and `draw` draw it (`shaders/fire.wesl`) and make it give light.

mod burn;
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

pub use burn::{Burning, Fire};
pub use plugin::FirePlugin;
pub use settings::{FireLook, FireShape};

#[cfg(feature = "render")]
pub use draw::{FireDrawPlugin, FireLight};
