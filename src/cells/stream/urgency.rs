//! Which of the waiting cells are planted first.

use super::Viewpoint;
use bevy::math::{IVec2, Vec2, Vec3Swizzles};

/// Cells that are not in front of a viewer wait as if they were so much farther.
const BEHIND: f32 = 3.0;
/// Nearer than this many cells, all cells count as in front.
const AROUND_CELLS: f32 = 2.0;

/// The viewers as the queue sees them, in cells: (place, direction).
pub(super) struct Urgency(Vec<(Vec2, Vec2)>);

impl Urgency {
    pub(super) fn new(viewpoints: &[Viewpoint], cell_m: f32) -> Self {
        let one = |viewpoint: &Viewpoint| {
            // Towards the middles of cells.
            (viewpoint.eye_m.xz() / cell_m - 0.5, viewpoint.forward.xz().normalize_or_zero())
        };
        Self(viewpoints.iter().map(one).collect())
    }

    /// How long a cell may wait: the square of its distance, in cells, greater where no viewer looks. In front is what is
    /// within 60° of the direction.
    pub(super) fn delay(&self, cell: IVec2) -> f32 {
        let one = |&(place, forward): &(Vec2, Vec2)| {
            let to = cell.as_vec2() - place;
            let square = to.length_squared();
            let ahead = to.dot(forward).max(0.0);
            let in_front = 4.0 * ahead * ahead >= square || square <= AROUND_CELLS * AROUND_CELLS;
            if in_front { square } else { square * BEHIND * BEHIND }
        };
        self.0.iter().map(one).fold(f32::INFINITY, f32::min)
    }
}
