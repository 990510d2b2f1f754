//! The workbench: panels that edit species, woods, the ground, the wind and levels of detail by hand and eye, while the program runs.
//!
//! It edits the assets and resources that games use. Fields come from reflection: a new field of a settings struct
//! shows up by itself, with its documentation, its unit and its range.
//!
//! # Files
//! - Plain code without an app:
//!   - fields: `fields` (the table of all fields), `field_table` (how it is made), `field_text` (labels, units, ranges), `variants`,
//!     `randomise`;
//!   - what is edited: `document` (anything with a file), `species_document`, `plan_document`, `ground_documents`; `session` and
//!     `file_session`, `steps`, `history`, `document_file`, and `ron_tree` and `ron_merge`, which write changes into the text that a person wrote;
//!     `randomiser` and `envelope_handles` for a species; `live_settings` for what the program has without a file;
//!   - a wood: `woods` (what is chosen, the tool in hand, masks as pictures), `plan_element` (areas and what is kept free, by their
//!     corners), `brush`, `quadrat_histogram`;
//!   - ground: `ground_desk`, `spline_points`, `ground_variogram`, `map_fit`;
//!   - what is shown: `stage` (which trees, from where), `land_pose` and `scene_view` (a wood or ground), `diagram` (other views of a
//!     tree), `wind_measures` and `tip_motion` with `spectrum`, `costs`.
//! - `ui`: the panels, drawn by egui; nothing of the engine.
//! - `ecs`: [`EditorPlugin`], the [`Workbench`], the turntable, the land.

mod brush;
mod costs;
mod diagram;
mod document;
mod document_file;
mod ecs;
mod envelope_handles;
mod field_table;
mod field_text;
mod fields;
mod file_session;
mod ground_desk;
mod ground_documents;
mod ground_variogram;
mod history;
mod land_pose;
mod live_settings;
mod map_fit;
mod plan_document;
mod plan_element;
mod quadrat_histogram;
mod randomise;
mod randomiser;
mod ron_merge;
mod ron_tree;
mod scene_view;
mod session;
mod species_document;
mod spectrum;
mod spline_points;
mod stage;
mod steps;
mod tip_motion;
mod ui;
mod variants;
mod wind_measures;
mod woods;

pub use diagram::View;
pub use ecs::{EditorPlugin, turntable::StageCamera, workbench::Workbench};
pub use stage::{Arrangement, Stage};
pub use ui::{Panel, dialogs::Dialog};
