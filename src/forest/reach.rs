//! How far cells are streamed about the viewers.

use crate::cells::StreamSettings;

/// What comes stays until a viewer is farther from it than the distance at which it comes by this factor: nobody who walks to and fro
/// at a border has it planted and cleared.
pub(super) const HYSTERESIS: f32 = 1.15;
/// No more cells than this lie from a viewer to the border of what is kept: `CellStream` follows at most 512.
const MOST_CELLS: f32 = 500.0;

/// Follows viewers over so many metres, with squares of that side.
pub(super) fn reaching(load_m: f32, side_m: f32) -> StreamSettings {
    let load_m = load_m.min(MOST_CELLS / HYSTERESIS * side_m);
    StreamSettings { load_m, keep_m: (HYSTERESIS * load_m).max(load_m + side_m), ..StreamSettings::default() }
}
