//! The stands about the tiles of impostors, which change with the seasons and with what is felled and planted.

use crate::{
    background::{Work, spawn_work},
    forest::stands::Stands,
    render::impostors::near_mask::CANOPY_BLOCKS,
    wind::{Canopy, PackedCanopy},
};
use bevy::{
    math::{DVec2, IVec2},
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::sync::Arc;

/// The canopies of a tile's blocks, row after row.
pub(super) type BlockCanopies = Vec<PackedCanopy>;

/// The stand in the middle of each block of a tile with that least corner and side, m.
pub(super) fn block_canopies(stands: &Stands, corner_m: DVec2, tile_m: f32) -> BlockCanopies {
    let block_m = tile_m / CANOPY_BLOCKS as f32;
    let canopies = stands.canopies(corner_m + f64::from(0.5 * block_m), block_m, CANOPY_BLOCKS);
    canopies.iter().map(Canopy::pack).collect()
}

/// Canopies of tiles that are being worked out again, for a generation of the forest's stands.
pub(super) struct Renewal {
    generation: u64,
    task: Work<Vec<(IVec2, BlockCanopies)>>,
}

impl Renewal {
    /// Has those of tiles worked out, of which places and least corners are given, m.
    pub fn start(generation: u64, stands: Arc<Stands>, tiles: Vec<(IVec2, DVec2)>, tile_m: f32) -> Self {
        let renewed = move |(place, corner_m)| (place, block_canopies(&stands, corner_m, tile_m));
        Self { generation, task: spawn_work(move || tiles.into_iter().map(renewed).collect()) }
    }

    /// For which generation something was worked out, once it is there, and what: nothing where a worker has panicked.
    pub fn finished(&mut self) -> Option<(u64, Option<Vec<(IVec2, BlockCanopies)>>)> {
        let renewed = block_on(poll_once(&mut self.task))?.inspect_err(|panic| {
            error_once!("forest: {panic}; its impostors keep the stands that they have");
        });
        Some((self.generation, renewed.ok()))
    }
}
