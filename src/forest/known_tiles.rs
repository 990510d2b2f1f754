//! The tiles of a forest whose cells are known, and which of them are up to date.

use crate::cells::CellSet;
use bevy::{math::IVec2, platform::collections::HashMap};

/// A tile whose cells are in the store.
pub(super) struct KnownTile {
    /// Of the plants that the store and the impostors have; none where some of them are known to be others.
    pub fingerprint: Option<u64>,
    pub is_outdated: bool,
}

/// The tiles that are up to date.
pub(super) struct UpToDate<'a>(pub &'a HashMap<IVec2, KnownTile>);

impl CellSet for UpToDate<'_> {
    fn contains(&self, tile: IVec2) -> bool {
        self.0.get(&tile).is_some_and(|tile| !tile.is_outdated)
    }

    fn visit(&self, visit: impl FnMut(IVec2)) {
        self.0.iter().filter(|(_, tile)| !tile.is_outdated).map(|(tile, _)| *tile).for_each(visit);
    }
}
