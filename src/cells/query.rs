//! Stems by place: the nearest, and all within a radius; and the first trunk on a ray.
//!
//! Distances are on the map: a stem is a vertical line. Only the blocks and cells within reach are searched; a search for
//! the nearest widens its reach step by step until it finds one, so that in a dense forest it looks into a few cells and in
//! a sparse one not into all.

pub(super) mod ray;
pub(super) mod trunk;

use super::{
    block::{Block, SIDE},
    store::CellStore,
};
use crate::scatter::Stem;
use bevy::math::{DVec2, IVec2, Vec2};

/// A search for the nearest begins with this share of a cell's side.
const FIRST_REACH: f32 = 0.25;
/// In this proportion it widens.
const WIDENING: f32 = 4.0;

/// A stem that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Its cell.
    pub cell: IVec2,
    /// Its number among the cell's [`records`](super::Cell::records).
    pub index: usize,
    /// The stem itself.
    pub stem: Stem,
    /// From the place that was asked about, on the map, m.
    pub distance_m: f32,
}

/// A candidate for it.
#[derive(Clone, Copy)]
struct Near {
    cell: IVec2,
    index: usize,
    square: f32,
}

impl CellStore {
    /// The stem that is nearest to a place (x, z), within a radius, m. Of equally near ones it is the first in the order of
    /// [`iter`](Self::iter).
    pub fn nearest(&self, place_m: Vec2, radius_m: f32) -> Option<Found> {
        if !place_m.is_finite() || radius_m.is_nan() {
            return None;
        }
        let mut reach_m = (FIRST_REACH * self.cell_m()).min(radius_m);
        loop {
            let mut nearest: Option<Near> = None;
            self.visit_near(place_m, reach_m, |near| {
                nearest = Some(near);
                // The next must be nearer.
                near.square.next_down()
            });
            if let Some(near) = nearest {
                return self.found(near);
            }
            if reach_m >= radius_m {
                return None;
            }
            reach_m = (WIDENING * reach_m).min(radius_m);
        }
    }

    /// Visits the stems within a radius of a place (x, z), m, in the order of [`iter`](Self::iter).
    pub fn within(&self, place_m: Vec2, radius_m: f32, mut visit: impl FnMut(Found)) {
        if !place_m.is_finite() || radius_m.is_nan() {
            return;
        }
        let all = radius_m * radius_m;
        self.visit_near(place_m, radius_m, |near| {
            self.found(near).into_iter().for_each(&mut visit);
            all
        });
    }

    fn found(&self, Near { cell, index, square }: Near) -> Option<Found> {
        Some(Found { cell, index, stem: self.stem(cell, index)?, distance_m: square.sqrt() })
    }

    /// Visits stems within a radius; `visit` answers with the square of the radius from then on.
    fn visit_near(&self, place_m: Vec2, radius_m: f32, mut visit: impl FnMut(Near) -> f32) {
        if radius_m < 0.0 {
            return;
        }
        let cell_m = self.cell_m();
        let mut square = radius_m * radius_m;
        self.visit_blocks(self.blocks_about(place_m, radius_m), |place, block: &Block| {
            let off_corner = self.off_corner(place_m, place * SIDE);
            if square_to_box(off_corner, cell_m * SIDE as f32) > square {
                return;
            }
            for (cell, content) in block.cells(place) {
                let off_corner = self.off_corner(place_m, cell);
                if square_to_box(off_corner, cell_m) > square {
                    continue;
                }
                for (index, record) in content.records().iter().enumerate() {
                    let to_stem = Stem::place_in_cell(*record, cell_m).distance_squared(off_corner);
                    if to_stem <= square {
                        square = visit(Near { cell, index, square: to_stem });
                    }
                }
            }
        });
    }

    /// A place, from the least corner of a cell, m.
    fn off_corner(&self, place_m: Vec2, cell: IVec2) -> Vec2 {
        let corner: DVec2 = self.corner_m(cell);
        (place_m.as_dvec2() - corner).as_vec2()
    }
}

/// Square of the distance from a square whose least corner is the origin.
fn square_to_box(place: Vec2, side_m: f32) -> f32 {
    place.distance_squared(place.clamp(Vec2::ZERO, Vec2::splat(side_m)))
}

#[cfg(test)]
mod tests;
