//! How far cells are streamed about the viewers.

use super::components::ForestSettings;
use crate::{
    cells::{CellStream, StreamSettings},
    scatter::Planter,
    setting::SettingError,
};
use bevy::math::IVec2;

/// What comes stays until a viewer is farther from it than the distance at which it comes by this factor: nobody who walks to and fro
/// at a border has it planted and cleared.
pub(super) const HYSTERESIS: f32 = 1.15;
/// No more cells than this lie from a viewer to the border of what is kept: `CellStream` follows at most 512.
const MOST_CELLS: f32 = 500.0;

/// Cells whose tiles are ordered in a frame, are being planted, and are dropped in a frame, at most; but one tile always.
const CELLS_PER_STEP: u32 = 128;
const MOST_CELLS_ORDERED: u32 = 256;
const CELLS_DROPPED_PER_STEP: u32 = 128;

/// Follows viewers over so many metres, with squares of that side.
pub(super) fn reaching(load_m: f32, side_m: f32) -> StreamSettings {
    let load_m = load_m.min(MOST_CELLS / HYSTERESIS * side_m);
    StreamSettings { load_m, keep_m: (HYSTERESIS * load_m).max(load_m + side_m), ..StreamSettings::default() }
}

/// How far stems are known about the viewers, m.
pub(super) fn known_m(settings: &ForestSettings) -> f32 {
    settings.trees_to_m.max(settings.far_to_m)
}

/// Streams the tiles of a forest, of so many cells along a side.
pub(super) fn tile_stream(
    planter: &Planter,
    settings: &ForestSettings,
    tile_cells: i32,
) -> Result<CellStream, SettingError> {
    let side_m = planter.cell_m() * tile_cells as f32;
    let tiles = |cells: u32| (cells / tile_cells.pow(2).cast_unsigned()).max(1);
    let stream = StreamSettings {
        plants_per_step: tiles(CELLS_PER_STEP),
        most_ordered: tiles(MOST_CELLS_ORDERED),
        drops_per_step: tiles(CELLS_DROPPED_PER_STEP),
        ..reaching(known_m(settings), side_m)
    };
    let bounds = planter.cells().map(|cells| cells.map(|cell| cell.div_euclid(IVec2::splat(tile_cells))));
    CellStream::new(stream, side_m, bounds)
}
