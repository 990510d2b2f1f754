//! How far cells are streamed about the viewers.

use super::components::ForestSettings;
use crate::{
    cells::{CellStream, StreamSettings},
    scatter::Planter,
    setting::SettingError,
};
use bevy::math::IVec2;

/// The tile of a cell, where tiles have so many cells along a side.
pub(super) fn tile_of(cell: IVec2, tile_cells: i32) -> IVec2 {
    cell.div_euclid(IVec2::splat(tile_cells))
}

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
    let keep_m = (HYSTERESIS * load_m).max(load_m + side_m);
    // What is kept lies at least a square beyond, and their sum may have been rounded down.
    StreamSettings { load_m: load_m.min(keep_m - side_m), keep_m, ..StreamSettings::default() }
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
    let bounds = planter.cells().map(|cells| cells.map(|cell| tile_of(cell, tile_cells)));
    CellStream::new(stream, side_m, bounds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    #[test]
    fn any_forest_can_be_streamed() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        for _ in 0..100_000 {
            let (load_m, side_m) = (random.random_range(0.0..5e4), random.random_range(8.0..1024.0));
            let settings = reaching(load_m, side_m);
            assert!(CellStream::new(settings, side_m, None).is_ok(), "{load_m} with {side_m}: {settings:?}");
        }
    }
}
