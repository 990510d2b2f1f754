//! Which cells to plant, to keep and to drop about the viewers.
//!
//! Within the load radius everything is wanted; what stands is kept up to the greater keep radius. Between them a viewer
//! may go to and fro and nothing is planted twice. When a viewer has moved by a quarter of a cell, only the crescents are
//! walked by which its discs have changed; a leap is no special case, its crescents are the whole discs. Wanted cells wait
//! in a queue of which each step takes the nearest, those in front of a viewer first.

mod disc;
mod urgency;

use super::{cell::Cell, store::CellStore};
use crate::setting::{SettingError, require};
use bevy::{
    math::{IVec2, Vec2, Vec3, Vec3Swizzles},
    platform::collections::HashMap,
    reflect::Reflect,
};
use disc::{Disc, visit_difference};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use urgency::Urgency;

/// After so much of a cell's side a viewer has moved.
const STEP: f32 = 0.25;
/// The most cells from a viewer to the keep radius: 830,000 in all.
const FARTHEST_CELLS: f32 = 512.0;

/// How far the forest is planted about viewers, and how fast.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StreamSettings {
    /// Cells nearer than this to a viewer are planted. units: m, domain: 0 to `keep_m` less the side of a cell.
    pub load_m: f32,
    /// Cells farther than this from every viewer are dropped. units: m, domain: up to 512 cells.
    pub keep_m: f32,
    /// The most cells that one step orders. domain: \[1, 100000\].
    pub plants_per_step: u32,
    /// The most cells that are ordered and not yet delivered. domain: \[1, 100000\].
    pub most_ordered: u32,
    /// The most cells that one step drops. domain: \[1, 100000\].
    pub drops_per_step: u32,
}

impl Default for StreamSettings {
    fn default() -> Self {
        Self { load_m: 10_000.0, keep_m: 10_500.0, plants_per_step: 64, most_ordered: 256, drops_per_step: 64 }
    }
}

impl StreamSettings {
    /// Checks every field, for cells with this side, m.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self, cell_m: f32) -> Result<(), SettingError> {
        require("cell_m", cell_m, 8.0..=8192.0)?;
        require("keep_m", self.keep_m, cell_m..=FARTHEST_CELLS * cell_m)?;
        require("load_m", self.load_m, 0.0..=self.keep_m - cell_m)?;
        require("plants_per_step", self.plants_per_step as f32, 1.0..=1e5)?;
        require("most_ordered", self.most_ordered as f32, 1.0..=1e5)?;
        require("drops_per_step", self.drops_per_step as f32, 1.0..=1e5)
    }
}

/// Someone who looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Where the eye is, m.
    pub eye_m: Vec3,
    /// Where it looks; its length does not matter, and zero is no direction.
    pub forward: Vec3,
}

/// What a step asks for. The buffers are reused.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Orders {
    /// Cells to plant, most urgent first; each is to be delivered or given back.
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
    /// All wanted cells that are neither in the store nor ordered, with their urgency; in no order.
    waiting: Vec<(f32, IVec2)>,
    ordered: BTreeSet<(i32, i32)>,
    /// All cells in the store that no viewer keeps.
    leaving: Vec<IVec2>,
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
            waiting: Vec::new(),
            ordered: BTreeSet::new(),
            leaving: Vec::new(),
        })
    }

    /// Follows the viewers for a step, and fills `orders`. The caller removes what is to be dropped from `there` before the
    /// next step. Without viewers, or with one whose eye is nowhere, everything stays as it is.
    pub fn step(&mut self, viewpoints: &[Viewpoint], there: &impl CellSet, orders: &mut Orders) {
        orders.plant.clear();
        orders.drop.clear();
        if viewpoints.is_empty() || viewpoints.iter().any(|viewpoint| !viewpoint.eye_m.is_finite()) {
            return;
        }
        if self.has_moved(viewpoints) {
            self.follow(viewpoints, there);
        }
        self.order(viewpoints, there, &mut orders.plant);
        while orders.drop.len() < self.settings.drops_per_step as usize
            && let Some(cell) = self.leaving.pop()
        {
            orders.drop.push(cell);
        }
    }

    /// Puts an ordered cell into the store, unless everyone has gone away from it meanwhile. Tells whether it did.
    pub fn deliver(&mut self, cell: IVec2, content: Cell, store: &mut CellStore) -> bool {
        let kept = self.fulfil(cell);
        if kept {
            store.insert(cell, content);
        }
        kept
    }

    /// Notes that an order is fulfilled. Tells whether anyone still wants it; if not, the caller throws it away.
    pub fn fulfil(&mut self, cell: IVec2) -> bool {
        self.ordered.remove(&(cell.y, cell.x));
        self.is_in(cell, &self.keep)
    }

    /// Takes an order back that will not be fulfilled; the cell waits again if it is still wanted.
    pub fn give_back(&mut self, cell: IVec2) {
        if self.ordered.remove(&(cell.y, cell.x)) && self.is_in(cell, &self.load) {
            self.waiting.push((0.0, cell));
        }
    }

    /// Whether nobody waits for anything: from where the viewers are, all is there that is wanted.
    pub fn is_complete(&self) -> bool {
        !self.anchors.is_empty() && self.waiting.is_empty() && self.ordered.is_empty()
    }

    /// Number of cells that wait to be ordered.
    pub fn waiting(&self) -> usize {
        self.waiting.len()
    }

    /// Number of cells that are ordered and not delivered.
    pub fn ordered(&self) -> usize {
        self.ordered.len()
    }

    fn is_in(&self, cell: IVec2, discs: &[Disc]) -> bool {
        discs.iter().any(|disc| disc.contains(cell, f64::from(self.cell_m)))
    }

    fn has_moved(&self, viewpoints: &[Viewpoint]) -> bool {
        let far = |(anchor, viewpoint): (&Vec2, &Viewpoint)| anchor.distance(viewpoint.eye_m.xz()) > STEP * self.cell_m;
        self.anchors.len() != viewpoints.len() || self.anchors.iter().zip(viewpoints).any(far)
    }

    /// Walks the crescents by which the viewers' discs have changed.
    fn follow(&mut self, viewpoints: &[Viewpoint], there: &impl CellSet) {
        let first = self.anchors.is_empty();
        self.anchors.clear();
        self.anchors.extend(viewpoints.iter().map(|viewpoint| viewpoint.eye_m.xz()));
        let Some(bounds) = self.bounds else { return };
        let load = self.discs(self.settings.load_m);
        let keep = self.discs(self.settings.keep_m);
        let cell_m = f64::from(self.cell_m);
        let is_in = |cell: IVec2, discs: &[Disc]| discs.iter().any(|disc| disc.contains(cell, cell_m));

        self.waiting.retain(|(_, cell)| is_in(*cell, &load));
        visit_difference(&load, &self.load, cell_m, bounds, |row, first, last| {
            let cells = (first..=last).map(|column| IVec2::new(column, row));
            self.waiting.extend(cells.filter(|&cell| !there.contains(cell)).map(|cell| (0.0, cell)));
        });
        self.leaving.retain(|cell| !is_in(*cell, &keep));
        if first {
            there.visit(|cell| self.leaving.extend((!is_in(cell, &keep)).then_some(cell)));
        }
        visit_difference(&self.keep, &keep, cell_m, bounds, |row, first, last| {
            let cells = (first..=last).map(|column| IVec2::new(column, row));
            self.leaving.extend(cells.filter(|&cell| there.contains(cell)));
        });
        (self.load, self.keep) = (load, keep);
    }

    /// So large about the anchors that they hold the radius about a viewer that has not yet moved.
    fn discs(&self, radius_m: f32) -> Vec<Disc> {
        let radius_m = f64::from(radius_m + STEP * self.cell_m);
        self.anchors.iter().map(|anchor| Disc { centre: anchor.as_dvec2(), radius_m }).collect()
    }

    /// Takes the most urgent cells out of the queue.
    fn order(&mut self, viewpoints: &[Viewpoint], there: &impl CellSet, plant: &mut Vec<IVec2>) {
        let room = (self.settings.most_ordered as usize).saturating_sub(self.ordered.len());
        let wanted = room.min(self.settings.plants_per_step as usize);
        if wanted == 0 || self.waiting.is_empty() {
            return;
        }
        let urgency = Urgency::new(viewpoints, self.cell_m);
        for (delay, cell) in &mut self.waiting {
            *delay = urgency.delay(*cell);
        }
        // Some of the first may turn out to be ordered already: a viewer went away and came back.
        let candidates = (wanted + self.ordered.len()).min(self.waiting.len());
        let others = self.waiting.len() - candidates;
        let last_first = |one: &(f32, IVec2), other: &(f32, IVec2)| {
            other.0.total_cmp(&one.0).then_with(|| (other.1.y, other.1.x).cmp(&(one.1.y, one.1.x)))
        };
        if others > 0 {
            self.waiting.select_nth_unstable_by(others, last_first);
        }
        self.waiting[others..].sort_unstable_by(last_first);
        while plant.len() < wanted
            && let Some((_, cell)) = self.waiting.pop()
        {
            if !there.contains(cell) && self.ordered.insert((cell.y, cell.x)) {
                plant.push(cell);
            }
        }
    }
}

#[cfg(test)]
mod tests;
