//! What is seen: the cells in view, and those whose shadows fall into view.
//!
//! Blocks of cells are compared with the view first, then the cells of those that are partly within it. A cell out of view
//! still matters where the sun throws its shadow into view. Its box, moved along the sun's rays down to the lowest ground,
//! sweeps a volume; the volume is the hull of the box at both ends, so its greatest height over a plane is that of one of
//! them. A volume that lies behind no plane of the view is kept. Near an edge of the view that keeps a few cells too many,
//! and never one too few.

use super::{
    bounds::{Bounds, bounded},
    store::CellStore,
};
use crate::scatter::GREATEST_SIZE;
use bevy::math::{IVec2, Vec3, Vec3Swizzles, Vec4, Vec4Swizzles};

/// Nothing that grows is as large, m.
const LARGEST_M: f32 = 1000.0;
/// No shadow is followed farther, m.
const LONGEST_SHADOW_M: f32 = 1e5;

/// What a camera sees, in the forest's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The planes around it, normals inwards: a point p is within where n·p + d ≥ 0 for every (n, d). They may have any
    /// length; one that is not finite, such as the far plane of an endless view, keeps nothing out.
    pub planes: [Vec4; 6],
    /// Where the eye is, m.
    pub eye_m: Vec3,
    /// What is farther from the eye is not seen, m.
    pub distance_m: f32,
    /// The sun that throws shadows.
    pub sun: Option<Sun>,
}

/// The sun and its shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// The direction in which its light travels: mostly down.
    pub direction: Vec3,
    /// Shadows that fall farther from the eye are not drawn, m. A camera whose shadows end at a depth draws them in the
    /// corners of the picture at a greater distance.
    pub shadow_distance_m: f32,
    /// Height of the lowest ground on which shadows fall, m.
    pub lowest_m: f32,
    /// No shadow is followed farther along the light than this, however low the sun is, m.
    pub longest_m: f32,
}

/// How far full-grown trees reach: the largest of all species, swaying.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeExtent {
    /// Above the ground at the stem, m.
    pub height_m: f32,
    /// From the stem sideways, m.
    pub reach_m: f32,
}

/// A cell that is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Its place.
    pub cell: IVec2,
    /// From the eye to the nearest point of the box about its plants, m.
    pub distance_m: f32,
    /// Whether it is in view itself; otherwise only its shadow may be.
    pub in_view: bool,
}

impl CellStore {
    /// Fills `seen` with the cells that are in view, or whose shadows may be. The order is that of
    /// [`iter`](CellStore::iter); cells where nothing stands are left out.
    pub fn see(&self, view: &View, extent: TreeExtent, seen: &mut Vec<Seen>) {
        seen.clear();
        let usable = view.eye_m.is_finite() && view.distance_m > 0.0;
        if !usable {
            return;
        }
        let extent = extent.bounded();
        let watch = Watch::new(view);
        let reach_m = view.distance_m + GREATEST_SIZE * extent.reach_m;
        self.visit_blocks(self.blocks_about(view.eye_m.xz(), reach_m), |place, block| {
            if block.spread().is_nothing() {
                return;
            }
            let around = Bounds::of_block(place, self.cell_m(), block.spread(), extent);
            let Some(around) = watch.sight(&around, ALL_PLANES) else { return };
            for (cell, content) in block.cells(place).filter(|(_, content)| !content.is_empty()) {
                let bounds = Bounds::of_cell(cell, self.cell_m(), content.spread(), extent);
                if let Some(Sight { distance_m, in_view, .. }) = watch.sight(&bounds, around.undecided) {
                    seen.push(Seen { cell, distance_m, in_view });
                }
            }
        });
    }
}

impl TreeExtent {
    fn bounded(self) -> Self {
        Self { height_m: bounded(self.height_m, LARGEST_M), reach_m: bounded(self.reach_m, LARGEST_M) }
    }
}

/// Planes of the view, each a bit.
type Planes = u8;
const ALL_PLANES: Planes = 0b11_1111;

/// A view made ready for questions.
#[derive(Clone, Copy, Debug)]
pub struct Watch {
    planes: [Vec4; 6],
    eye_m: Vec3,
    distance_m: f32,
    sun: Option<Sun>,
}

/// How a box is seen.
struct Sight {
    distance_m: f32,
    in_view: bool,
    /// The planes of which not the whole box is on the inner side: parts of it must be compared with these only.
    undecided: Planes,
}

impl Watch {
    /// How a box with these corners, m, is seen: in view itself (true), or only by its shadow (false); `None` where neither
    /// is.
    pub fn sees(&self, min: Vec3, max: Vec3) -> Option<bool> {
        let bounds = Bounds { centre: 0.5 * (min + max), half: 0.5 * (max - min) };
        self.sight(&bounds, ALL_PLANES).map(|sight| sight.in_view)
    }

    /// Where the eye is, m.
    pub fn eye_m(&self) -> Vec3 {
        self.eye_m
    }

    /// Makes a view ready.
    pub fn new(view: &View) -> Self {
        // Everything is in front of this one.
        let nowhere = Vec4::new(0.0, 0.0, 0.0, 1.0);
        let planes = view.planes.map(|plane| if plane.is_finite() { plane } else { nowhere });
        let sun = view.sun.and_then(|sun| Some(Sun { direction: sun.direction.try_normalize()?, ..sun }));
        Self { planes, eye_m: view.eye_m, distance_m: view.distance_m, sun }
    }

    /// Compares a box with the `undecided` planes; `None` where neither it nor its shadow is seen.
    fn sight(&self, bounds: &Bounds, undecided: Planes) -> Option<Sight> {
        let mut sight = Sight { distance_m: bounds.distance(self.eye_m), in_view: true, undecided: 0 };
        if sight.distance_m > self.distance_m {
            return None;
        }
        for number in (0..6).filter(|number| undecided >> number & 1 == 1) {
            let plane = self.planes[number];
            let [least, greatest] = bounds.heights(plane);
            if least < 0.0 {
                sight.undecided |= 1 << number;
            }
            if greatest < 0.0 {
                sight.in_view = false;
                let at_the_end = greatest + plane.xyz().dot(self.sun?.path(bounds));
                if at_the_end < 0.0 {
                    return None;
                }
            }
        }
        let seen = sight.in_view || self.sun.is_some_and(|sun| sun.is_near(bounds, self.eye_m));
        seen.then_some(sight)
    }
}

impl Sun {
    /// How far along the light a box is swept.
    fn path(&self, bounds: &Bounds) -> Vec3 {
        let longest_m = bounded(self.longest_m, LONGEST_SHADOW_M);
        let fall_m = bounds.top_m() - self.lowest_m;
        let sinks = self.direction.y < 0.0 && fall_m.is_finite();
        let length_m = if sinks { bounded(fall_m / -self.direction.y, longest_m) } else { longest_m };
        self.direction * length_m
    }

    /// Whether the shadow may fall so near that it is drawn.
    fn is_near(&self, bounds: &Bounds, eye_m: Vec3) -> bool {
        bounds.swept(self.path(bounds)).distance(eye_m) <= self.shadow_distance_m
    }
}

#[cfg(test)]
mod tests;
