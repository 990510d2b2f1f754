//! The stand that the trees of a cell stand in, which is worked out in the background.

use super::stands::Stands;
use crate::{
    background::{Work, spawn_work},
    wind::Canopy,
};
use bevy::{
    math::{DVec2, FloatExt},
    prelude::*,
};
use std::sync::Arc;

/// Places of a cell at which its stand is worked out are at least so far apart, m, but for the corners of a small cell.
const SPACING_M: f32 = 16.0;
/// Places along a side of a cell, at most.
const MOST_PLACES: u32 = 9;

/// The stand of a cell: at places in rows from corner to corner.
#[derive(PartialEq)]
pub(super) struct CellCanopies {
    corner_m: DVec2,
    spacing_m: f32,
    /// Places along a side.
    side: u32,
    canopies: Vec<Canopy>,
}

/// The stand of a cell, which is being worked out.
pub(super) type CanopyTask = Work<CellCanopies>;

impl CellCanopies {
    /// Has the stand of a cell with that least corner and side worked out.
    pub fn spawn(stands: Arc<Stands>, corner_m: DVec2, cell_m: f32) -> CanopyTask {
        spawn_work(move || {
            let side = 1 + ((cell_m / SPACING_M) as u32).clamp(1, MOST_PLACES - 1);
            let spacing_m = cell_m / (side - 1) as f32;
            Self { corner_m, spacing_m, side, canopies: stands.canopies(corner_m, spacing_m, side) }
        })
    }

    /// That of any cell in the open.
    pub fn open() -> Self {
        Self { corner_m: DVec2::ZERO, spacing_m: SPACING_M, side: 2, canopies: vec![Canopy::default(); 4] }
    }

    /// The stand at a place of the cell: between the four places about it.
    pub fn at(&self, place: Vec3) -> Canopy {
        let within = ((place.xz().as_dvec2() - self.corner_m).as_vec2() / self.spacing_m).max(Vec2::ZERO);
        let first = within.as_uvec2().min(UVec2::splat(self.side - 2));
        let share = (within - first.as_vec2()).min(Vec2::ONE);
        let at = |x: u32, y: u32| self.canopies[((first.y + y) * self.side + first.x + x) as usize];
        let row = |y: u32| between(&at(0, y), &at(1, y), share.x);
        between(&row(0), &row(1), share.y)
    }
}

/// Between two canopies. Where one has no trees, those of the other reach as far.
fn between(a: &Canopy, b: &Canopy, share: f32) -> Canopy {
    let height_m = match (a.height_m > 0.0, b.height_m > 0.0) {
        (true, true) => a.height_m.lerp(b.height_m, share),
        _ => a.height_m.max(b.height_m),
    };
    Canopy {
        height_m,
        frontal_area_index: a.frontal_area_index.lerp(b.frontal_area_index, share),
        exposure: std::array::from_fn(|number| a.exposure[number].lerp(b.exposure[number], share)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_of_a_cell_have_the_stand_between_those_about_them() {
        let canopy = |number: u32| Canopy { height_m: 10.0 + number as f32, ..Canopy::default() };
        let canopies = (0..25).map(canopy).collect();
        let cell = CellCanopies { corner_m: DVec2::new(128.0, -64.0), spacing_m: 16.0, side: 5, canopies };
        assert_eq!(cell.at(Vec3::new(128.0, 3.0, -64.0)).height_m, 10.0);
        assert_eq!(cell.at(Vec3::new(136.0, 0.0, -64.0)).height_m, 10.5);
        assert_eq!(cell.at(Vec3::new(128.0, 0.0, -40.0)).height_m, 17.5);
        assert_eq!(cell.at(Vec3::new(192.0, 0.0, 0.0)).height_m, 34.0);
        assert!(cell.at(Vec3::NAN).height_m.is_finite());
    }

    #[test]
    fn at_a_border_the_stand_reaches_as_high_as_within() {
        let tall = Canopy { height_m: 20.0, frontal_area_index: 1.0, exposure: [0.0; 8] };
        let middle = between(&tall, &Canopy::default(), 0.5);
        assert_eq!(middle, Canopy { height_m: 20.0, frontal_area_index: 0.5, exposure: [0.5; 8] });
    }
}
