//! The stand of a forest as time goes: what it is now, since when it is so about each tile, and what of it has to be worked out again.

use super::{
    reach::tile_of,
    stand::Stand,
    stands::{OtherStand, REACH_M, Stands},
};
use crate::background::{Work, WorkerPanic};
use bevy::{
    math::IVec2,
    platform::collections::{HashMap, HashSet},
    tasks::{block_on, poll_once},
};
use std::sync::Arc;

/// A stand that was worked out again, and the tiles about which it is another: none for all.
pub(super) type RenewedStand = (Stand, Option<Vec<IVec2>>);

/// The stand of a forest, and those of all others. What is due waits until it is begun.
#[derive(Default)]
pub(super) struct ForestStand {
    /// None until its species are known.
    stands: Option<Arc<Stands>>,
    generations: StandGenerations,
    due: DueStand,
    renewal: Option<Work<RenewedStand>>,
}

/// What of a stand is out of date.
#[derive(Default)]
pub(super) struct DueStand {
    /// Whether all of it is.
    pub everywhere: bool,
    /// Else these cells are.
    pub cells: HashSet<IVec2>,
}

/// The generation of a forest's stand, which grows whenever the stand is another, and since which one it is the same about a tile.
#[derive(Clone, Debug, Default)]
pub(super) struct StandGenerations {
    newest: u64,
    everywhere: u64,
    tiles: HashMap<IVec2, u64>,
}

impl ForestStand {
    /// That of a forest which follows upon another: trees that stay keep the stand that they have until this one is worked out.
    pub fn after(before: &Self) -> Self {
        let generations = StandGenerations { newest: before.generations.newest, ..StandGenerations::default() };
        Self { generations, ..Self::default() }
    }

    pub fn get(&self) -> Option<&Arc<Stands>> {
        self.stands.as_ref()
    }

    pub fn generations(&self) -> &StandGenerations {
        &self.generations
    }

    /// Takes over the stand of the plan, which has to be worked out again where something is changed.
    pub fn begin(&mut self, stand: Stand, is_changed: bool) {
        self.renewal = None;
        self.due = DueStand { everywhere: is_changed, ..DueStand::default() };
        self.set(stand);
        self.generations.renew_everywhere();
    }

    fn set(&mut self, stand: Stand) {
        let others = self.stands.as_ref().map_or_else(Vec::new, |stands| stands.others.clone());
        self.stands = Some(Arc::new(Stands { own: Arc::new(stand), others }));
    }

    /// Takes over what other forests there are, once its own stand is known.
    pub fn set_others(&mut self, others: Vec<OtherStand>) {
        let Some(stands) = &mut self.stands else { return };
        *stands = Arc::new(Stands { own: stands.own.clone(), others });
        self.generations.renew_everywhere();
    }

    /// Notes that trees were felled or planted in cells.
    pub fn note_changed_cells(&mut self, cells: &[IVec2]) {
        if !self.due.everywhere {
            self.due.cells.extend(cells);
        }
    }

    /// Notes that anything may be other than in the plan.
    pub fn note_changes(&mut self) {
        self.due = DueStand { everywhere: true, ..DueStand::default() };
    }

    /// Whether something has to be worked out again, or is being worked out.
    pub fn is_due(&self) -> bool {
        self.is_being_renewed() || self.has_due()
    }

    pub fn has_due(&self) -> bool {
        self.due.everywhere || !self.due.cells.is_empty()
    }

    pub fn is_being_renewed(&self) -> bool {
        self.renewal.is_some()
    }

    /// Begins to work out again what is due, in the background.
    pub fn renew(&mut self, begin: impl FnOnce(DueStand) -> Work<RenewedStand>) {
        self.renewal = Some(begin(std::mem::take(&mut self.due)));
    }

    /// Takes over what was worked out again.
    pub fn receive(&mut self) -> Result<(), WorkerPanic> {
        let Some(renewed) = self.renewal.as_mut().and_then(|task| block_on(poll_once(task))) else { return Ok(()) };
        self.renewal = None;
        let (stand, tiles) = renewed?;
        self.set(stand);
        match tiles {
            Some(tiles) => self.generations.renew_about(&tiles),
            None => self.generations.renew_everywhere(),
        }
        Ok(())
    }
}

impl StandGenerations {
    pub fn newest(&self) -> u64 {
        self.newest
    }

    /// Since which generation the stand about a tile is the same.
    pub fn since(&self, tile: IVec2) -> u64 {
        self.tiles.get(&tile).copied().unwrap_or(self.everywhere)
    }

    fn renew_everywhere(&mut self) {
        self.newest += 1;
        self.everywhere = self.newest;
        self.tiles.clear();
    }

    fn renew_about(&mut self, tiles: &[IVec2]) {
        self.newest += 1;
        self.tiles.extend(tiles.iter().map(|tile| (*tile, self.newest)));
    }
}

/// The tiles, of so many cells along a side, in which trees feel what stands in some cells: row after row.
pub(super) fn tiles_that_feel(cells: &HashSet<IVec2>, cell_m: f32, tile_cells: i32) -> Vec<IVec2> {
    let reach = (REACH_M / cell_m).ceil() as i32;
    let mut tiles = HashSet::new();
    for cell in cells {
        let [first, last] = [*cell - reach, *cell + reach].map(|corner| tile_of(corner, tile_cells));
        tiles.extend((first.y..=last.y).flat_map(|y| (first.x..=last.x).map(move |x| IVec2::new(x, y))));
    }
    let mut tiles: Vec<IVec2> = tiles.into_iter().collect();
    tiles.sort_unstable_by_key(|tile| (tile.y, tile.x));
    tiles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_tiles_about_a_change_have_a_new_stand() {
        let mut generations = StandGenerations::default();
        generations.renew_everywhere();
        let (near, far) = (IVec2::new(1, 0), IVec2::new(-4, 2));
        generations.renew_about(&[near]);
        assert_eq!((generations.since(near), generations.since(far), generations.newest()), (2, 1, 2));
        generations.renew_everywhere();
        assert_eq!((generations.since(near), generations.since(far), generations.newest()), (3, 3, 3));
    }

    /// Cells of 64 m: 320 m are five of them. Tiles have four along a side.
    #[test]
    fn trees_feel_what_stands_within_reach() {
        let tiles = |cells: &[IVec2]| tiles_that_feel(&cells.iter().copied().collect(), 64.0, 4);
        let square = |from: i32, to: i32| -> Vec<IVec2> {
            (from..=to).flat_map(|y| (from..=to).map(move |x| IVec2::new(x, y))).collect()
        };
        assert_eq!(tiles(&[IVec2::ZERO]), square(-2, 1));
        assert_eq!(tiles(&[IVec2::new(1, 1), IVec2::new(2, 2)]), square(-1, 1));
        assert_eq!(tiles(&[]), []);
    }
}
