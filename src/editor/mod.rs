//! The workbench: panels that edit species, the wind and levels of detail by hand and eye, while the program runs.
//!
//! It edits the assets and resources that games use. Fields come from reflection: a new field of a settings struct
//! shows up by itself, with its documentation, its unit and its range.
//!
//! # Files
//! - Plain code without an app:
//!   - fields: `fields` (the table of all fields), `field_text` (labels, units, ranges), `variants`, `randomise`;
//!   - a species that is edited: `session`, `history`, `species_file`, and `ron_tree` and `ron_merge`, which write changes into
//!     the text that a person wrote;
//!   - what is shown: `stage` (which trees, from where), `diagram` (other views of a tree), `wind_measures` and `tip_motion` with
//!     `spectrum`, `costs`.
//! - `ui`: the panels, drawn by egui; nothing of the engine.
//! - `ecs`: [`EditorPlugin`], the [`Workbench`], the turntable.

mod costs;
mod diagram;
mod ecs;
mod field_text;
mod fields;
mod history;
mod randomise;
mod ron_merge;
mod ron_tree;
mod session;
mod species_file;
mod spectrum;
mod stage;
mod tip_motion;
mod ui;
mod variants;
mod wind_measures;

pub use diagram::View;
pub use ecs::{EditorPlugin, turntable::StageCamera, workbench::Workbench};
pub use stage::{Arrangement, Stage};
pub use ui::{Panel, dialogs::Dialog};
