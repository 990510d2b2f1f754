//! Which of the waiting cells are planted first.

use super::viewer::ViewerPose;
use crate::cells::block::SIDE;
use bevy::math::{IVec2, Vec2, Vec3Swizzles};

/// Cells that are not in front of a viewer wait as if they were so much farther.
const BEHIND: f32 = 3.0;
/// In front is what is within 60° of the direction.
const IN_FRONT: Vec2 = Vec2::new(0.5, 0.866_025_4);
/// Nearer than this many cells, all cells count as in front.
const AROUND_CELLS: f32 = 2.0;

/// The order in which cells are planted for some viewers.
#[derive(Clone, Debug, Default)]
pub(super) struct Priority(Vec<Eye>);

/// A viewer, in cells.
#[derive(Clone, Copy, Debug)]
struct Eye {
    place: Vec2,
    forward: Vec2,
}

impl Priority {
    /// Notes where the viewers are.
    pub(super) fn follow(&mut self, viewers: &[ViewerPose], cell_m: f32) {
        self.0.clear();
        self.0.extend(viewers.iter().map(|viewer| Eye {
            // Towards the middles of cells.
            place: viewer.eye_m.xz() / cell_m - 0.5,
            forward: viewer.forward.xz().normalize_or_zero(),
        }));
    }

    /// How long a cell may wait: the square of its distance, in cells, greater where no viewer looks.
    pub(super) fn delay(&self, cell: IVec2) -> f32 {
        self.least(|eye| {
            let to = cell.as_vec2() - eye.place;
            eye.delay(to, eye.is_ahead(to, 0.0))
        })
    }

    /// No cell of a block may wait less long than this.
    pub(super) fn delay_of_block(&self, block: IVec2) -> f32 {
        let (min, max) = ((block * SIDE).as_vec2(), (block * SIDE + (SIDE - 1)).as_vec2());
        let [middle, corner] = [0.5 * (min + max), 0.5 * (max - min)];
        self.least(|eye| {
            let is_ahead = eye.is_ahead(middle - eye.place, corner.length());
            eye.delay(eye.place.clamp(min, max) - eye.place, is_ahead)
        })
    }

    fn least(&self, delay: impl Fn(&Eye) -> f32) -> f32 {
        self.0.iter().map(delay).fold(f32::INFINITY, f32::min)
    }
}

impl Eye {
    /// Whether a place lies in front of it, or not farther than `within` beside what does.
    fn is_ahead(&self, to: Vec2, within: f32) -> bool {
        let (aside, ahead) = (to.perp_dot(self.forward).abs(), to.dot(self.forward));
        aside * IN_FRONT.x - ahead * IN_FRONT.y <= within
    }

    fn delay(&self, to: Vec2, is_ahead: bool) -> f32 {
        let square = to.length_squared();
        if is_ahead || square <= AROUND_CELLS * AROUND_CELLS { square } else { square * BEHIND * BEHIND }
    }
}
