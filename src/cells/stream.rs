//! Which cells to plant, to keep and to drop about the viewers.
//!
//! Within the load radius everything is wanted; what stands is kept up to the greater keep radius. Between them a viewer
//! may go to and fro and nothing is planted twice. When a viewer has moved by a quarter of a cell, only the crescents are
//! walked by which its discs have changed; a leap is no special case, its crescents are the whole discs. Of the wanted cells
//! each step takes the nearest, those in front of a viewer first. They are kept block by block, and a step looks into a few
//! blocks only: what it costs hardly grows with the forest.

mod cell_bits;
mod disc;
mod priority;
pub(super) mod settings;
pub(super) mod viewer;

use super::{cell::Cell, store::CellStore};
use crate::setting::SettingError;
use bevy::{
    math::{IVec2, Vec2, Vec3Swizzles},
    platform::collections::HashMap,
};
use cell_bits::CellBits;
use disc::{Disc, any_contains, visit_difference};
use priority::Priority;
use settings::StreamSettings;
use std::{cmp::Ordering, collections::BTreeSet};
use viewer::ViewerPose;

/// After so much of a cell's side a viewer has moved.
const STEP: f32 = 0.25;
/// So many blocks a step searches: as many as lie in front of a viewer along a ring of 100 cells' radius.
const BLOCKS_PER_STEP: usize = 16;

/// What a step asks for. The buffers are reused.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Orders {
    /// Cells to plant, the first ones first; each is to be delivered or given back.
    pub plant: Vec<IVec2>,
    /// Cells to take out of the store.
    pub drop: Vec<IVec2>,
}

/// Cells that are there already.
pub trait CellSet {
    /// Whether a cell is there.
    fn contains(&self, cell: IVec2) -> bool;
    /// Visits all that are there, in an order of their own.
    fn visit(&self, visit: impl FnMut(IVec2));
}

impl CellSet for CellStore {
    fn contains(&self, cell: IVec2) -> bool {
        Self::contains(self, cell)
    }

    fn visit(&self, visit: impl FnMut(IVec2)) {
        self.iter().map(|(cell, _)| cell).for_each(visit);
    }
}

impl<T> CellSet for HashMap<IVec2, T> {
    fn contains(&self, cell: IVec2) -> bool {
        self.contains_key(&cell)
    }

    fn visit(&self, visit: impl FnMut(IVec2)) {
        self.keys().copied().for_each(visit);
    }
}

/// Decides which cells are to be planted and dropped as viewers move. What "planted" means is its owner's affair: packed
/// into a store, raised as trees, drawn as blocks.
#[derive(Clone, Debug)]
pub struct CellStream {
    settings: StreamSettings,
    cell_m: f32,
    bounds: Option<[IVec2; 2]>,
    /// Where the viewers were when the discs were last walked, (x, z).
    anchors: Vec<Vec2>,
    load: Vec<Disc>,
    keep: Vec<Disc>,
    /// All wanted cells that are neither in the store nor ordered, and some that are, which is found out when their turn
    /// comes.
    waiting: CellBits,
    ordered: BTreeSet<(i32, i32)>,
    /// All cells in the store that no viewer keeps, and some that are not there.
    leaving: CellBits,
    /// Buffers of a step: the viewers, blocks of `waiting`, and the cells to order next, with their delays.
    priority: Priority,
    blocks: Vec<(f32, IVec2)>,
    next: Vec<(f32, IVec2)>,
}

impl CellStream {
    /// For a forest whose cells lie within `bounds` (least, greatest cell), as [`Planter::cells`](crate::scatter::Planter::cells)
    /// tells.
    ///
    /// # Errors
    /// Where a setting is outside its domain.
    pub fn new(settings: StreamSettings, cell_m: f32, bounds: Option<[IVec2; 2]>) -> Result<Self, SettingError> {
        settings.validate(cell_m)?;
        Ok(Self {
            settings,
            cell_m,
            bounds,
            anchors: Vec::new(),
            load: Vec::new(),
            keep: Vec::new(),
            waiting: CellBits::default(),
            ordered: BTreeSet::new(),
            leaving: CellBits::default(),
            priority: Priority::default(),
            blocks: Vec::new(),
            next: Vec::new(),
        })
    }

    /// Follows the viewers for a step, and fills `orders`. The caller removes what is to be dropped from `there` before the
    /// next step. Without viewers, or with one whose eye is nowhere, everything stays as it is.
    pub fn step(&mut self, viewers: &[ViewerPose], there: &impl CellSet, orders: &mut Orders) {
        orders.plant.clear();
        orders.drop.clear();
        if viewers.is_empty() || viewers.iter().any(|viewer| !viewer.eye_m.is_finite()) {
            return;
        }
        if self.has_moved(viewers) {
            self.follow(viewers, there);
        }
        self.order(viewers, there, &mut orders.plant);
        self.drop(there, &mut orders.drop);
    }

    /// Puts an ordered cell into the store, unless all viewers have gone away from it meanwhile. Tells whether it did.
    pub fn deliver(&mut self, cell: IVec2, content: Cell, store: &mut CellStore) -> bool {
        let kept = self.fulfil(cell);
        if kept {
            store.insert(cell, content);
        }
        kept
    }

    /// Notes that an order is fulfilled. Tells whether the cell is still wanted; if not, the caller drops it.
    pub fn fulfil(&mut self, cell: IVec2) -> bool {
        self.ordered.remove(&(cell.y, cell.x));
        self.keeps(cell)
    }

    /// Whether a cell stays from where the viewers are, if it is there.
    pub fn keeps(&self, cell: IVec2) -> bool {
        self.is_in(cell, &self.keep)
    }

    /// Takes back an order that will not be fulfilled; the cell waits again if it is still wanted.
    pub fn give_back(&mut self, cell: IVec2) {
        if self.ordered.remove(&(cell.y, cell.x)) && self.is_in(cell, &self.load) {
            self.waiting.insert(cell);
        }
    }

    /// Whether all is there that is wanted from where the viewers are.
    pub fn is_complete(&self) -> bool {
        !self.anchors.is_empty() && self.waiting.is_empty() && self.ordered.is_empty()
    }

    /// Number of cells that wait to be ordered; where a viewer has come back, some of them may turn out to be there.
    pub fn waiting(&self) -> usize {
        self.waiting.len()
    }

    /// Number of cells that are ordered and not delivered.
    pub fn ordered(&self) -> usize {
        self.ordered.len()
    }

    fn is_in(&self, cell: IVec2, discs: &[Disc]) -> bool {
        any_contains(discs, cell, f64::from(self.cell_m))
    }

    fn has_moved(&self, viewers: &[ViewerPose]) -> bool {
        let far = |(anchor, viewer): (&Vec2, &ViewerPose)| anchor.distance(viewer.eye_m.xz()) > STEP * self.cell_m;
        self.anchors.len() != viewers.len() || self.anchors.iter().zip(viewers).any(far)
    }

    /// Walks the crescents by which the viewers' discs have changed.
    fn follow(&mut self, viewers: &[ViewerPose], there: &impl CellSet) {
        let first = self.anchors.is_empty();
        self.anchors.clear();
        self.anchors.extend(viewers.iter().map(|viewer| viewer.eye_m.xz()));
        let Some(bounds) = self.bounds else { return };
        let load = self.discs(self.settings.load_m);
        let keep = self.discs(self.settings.keep_m);
        let cell_m = f64::from(self.cell_m);
        let Self { waiting, leaving, .. } = self;
        visit_difference(&self.load, &load, cell_m, bounds, |row, first, last| waiting.remove_run(row, first, last));
        visit_difference(&load, &self.load, cell_m, bounds, |row, first, last| waiting.insert_run(row, first, last));
        visit_difference(&keep, &self.keep, cell_m, bounds, |row, first, last| leaving.remove_run(row, first, last));
        visit_difference(&self.keep, &keep, cell_m, bounds, |row, first, last| leaving.insert_run(row, first, last));
        if first {
            there.visit(|cell| {
                if !any_contains(&keep, cell, cell_m) {
                    leaving.insert(cell);
                }
            });
        }
        (self.load, self.keep) = (load, keep);
    }

    /// So large about the anchors that they hold the radius about a viewer that has not yet moved.
    fn discs(&self, radius_m: f32) -> Vec<Disc> {
        let radius_m = f64::from(radius_m + STEP * self.cell_m);
        self.anchors.iter().map(|anchor| Disc { centre: anchor.as_dvec2(), radius_m }).collect()
    }

    /// Orders the first of the cells that wait.
    fn order(&mut self, viewers: &[ViewerPose], there: &impl CellSet, plant: &mut Vec<IVec2>) {
        let Self { settings, waiting, ordered, priority, blocks, next, .. } = self;
        let room = (settings.most_ordered as usize).saturating_sub(ordered.len());
        let wanted = room.min(settings.plants_per_step as usize);
        if wanted == 0 || waiting.is_empty() {
            return;
        }
        priority.follow(viewers, self.cell_m);
        blocks.clear();
        blocks.extend(waiting.blocks().map(|block| (priority.delay_of_block(block), block)));
        keep_first(blocks, BLOCKS_PER_STEP);
        blocks.sort_unstable_by(by_delay);
        next.clear();
        for &(delay, block) in &*blocks {
            if next.len() == wanted && next.iter().all(|(others, _)| *others <= delay) {
                break;
            }
            waiting.retain(block, |cell| {
                let waits = !there.contains(cell) && !ordered.contains(&(cell.y, cell.x));
                next.extend(waits.then(|| (priority.delay(cell), cell)));
                waits
            });
            keep_first(next, wanted);
        }
        next.sort_unstable_by(by_delay);
        for &(_, cell) in &*next {
            waiting.remove(cell);
            ordered.insert((cell.y, cell.x));
            plant.push(cell);
        }
    }

    /// Drops cells that no viewer keeps.
    fn drop(&mut self, there: &impl CellSet, drop: &mut Vec<IVec2>) {
        for _ in 0..BLOCKS_PER_STEP {
            let most = self.settings.drops_per_step as usize;
            let Some(block) = self.leaving.blocks().next().filter(|_| drop.len() < most) else { return };
            self.leaving.retain(block, |cell| {
                let has_room = drop.len() < most;
                drop.extend((has_room && there.contains(cell)).then_some(cell));
                !has_room
            });
        }
    }
}

/// The shorter delay first; cells with the same in the order of their places.
fn by_delay(one: &(f32, IVec2), other: &(f32, IVec2)) -> Ordering {
    one.0.total_cmp(&other.0).then_with(|| (one.1.y, one.1.x).cmp(&(other.1.y, other.1.x)))
}

/// Keeps the first so many of a list, in no order.
fn keep_first(list: &mut Vec<(f32, IVec2)>, count: usize) {
    if list.len() > count {
        list.select_nth_unstable_by(count, by_delay);
        list.truncate(count);
    }
}

#[cfg(test)]
mod tests;
