//! What the examples share: options, start-up, the window, pictures instead of a window, ground and sky.

// Each example uses a part of it.
#![allow(dead_code)]

pub mod arguments;
pub mod cameras;
pub mod capture;
pub mod course;
pub mod daylight;
pub mod dusk;
pub mod effects;
pub mod landscape;
pub mod meadow;
pub mod mist;
pub mod options;
pub mod pictures;
pub mod scene;
pub mod sky;
pub mod start;
pub mod window;
