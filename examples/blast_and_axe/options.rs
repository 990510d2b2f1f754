//! Command-line options.

use crate::support::options::SceneOptions;
use clap::{Parser, ValueEnum};

/// What a game does to trees and grass.
#[derive(Parser, Clone, Debug)]
#[command(
    about = "A blast, an axe, a ball and a helicopter. Flies in a window, or renders pictures where there is none.",
    mut_arg("wind", |speed| speed.default_value("3")),
    mut_arg("interval", |seconds| seconds.default_value("0.35")),
)]
pub struct Options {
    /// What happens.
    #[arg(long, value_enum, default_value_t = Event::Blast)]
    pub event: Event,
    #[command(flatten)]
    pub scene: SceneOptions,
}

/// What happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Event {
    /// A charge goes off beside a birch.
    Blast,
    /// An axe strikes the birch, over and over.
    Axe,
    /// A ball rolls through the meadow and a hazel.
    Ball,
    /// A helicopter hovers over the meadow.
    Helicopter,
}
