//! Which boxes a camera sees, and which of those that it does not see throw shadows into its view.
//!
//! A box out of view still matters where the sun throws its shadow into view. Moved along the sun's rays down to the lowest
//! ground, it sweeps a volume. The volume is the hull of the box at both ends, so its greatest height over a plane is that
//! of one of them. A volume that lies behind no plane of the view is kept. Near an edge of the view that keeps a few boxes
//! too many, and never one too few.

use super::bounds::{Bounds, clamped_length};
use bevy::math::{Vec3, Vec4, Vec4Swizzles};

/// No shadow is followed farther, m.
const LONGEST_SHADOW_M: f32 = 1e5;

/// What a camera sees, in the forest's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CullingView {
    /// The planes around it, normals inwards: a point p is within where n·p + d ≥ 0 for every (n, d). They may have any
    /// length; one that is not finite, such as the far plane of an endless view, keeps nothing out.
    pub planes: [Vec4; 6],
    /// Where the eye is, m.
    pub eye_m: Vec3,
    /// What is farther from the eye is not seen, m.
    pub distance_m: f32,
    /// The sun that throws shadows.
    pub sun: Option<SunShadows>,
}

/// The shadows of a sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunShadows {
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

/// Tests boxes against a view.
#[derive(Clone, Copy, Debug)]
pub struct Culler {
    planes: [Vec4; 6],
    eye_m: Vec3,
    distance_m: f32,
    sun: Option<SunShadows>,
}

/// How a box is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Visibility {
    InView,
    /// Its shadow may be seen, and nothing else of it.
    ShadowOnly,
}

impl Culler {
    /// For what a camera sees.
    pub fn new(view: &CullingView) -> Self {
        // Everything is in front of this one.
        let nowhere = Vec4::new(0.0, 0.0, 0.0, 1.0);
        let planes = view.planes.map(|plane| if plane.is_finite() { plane } else { nowhere });
        let sun = view.sun.and_then(|sun| Some(SunShadows { direction: sun.direction.try_normalize()?, ..sun }));
        Self { planes, eye_m: view.eye_m, distance_m: view.distance_m, sun }
    }

    /// Whether a box with these corners, m, is seen, or its shadow may be.
    pub fn sees(&self, min: Vec3, max: Vec3) -> bool {
        self.visibility(&Bounds::from_min_max(min, max)).is_some()
    }

    /// Where the eye is, m.
    pub fn eye_m(&self) -> Vec3 {
        self.eye_m
    }

    /// How a box is seen; `None` where neither it nor its shadow is.
    fn visibility(&self, bounds: &Bounds) -> Option<Visibility> {
        // An eye or a distance that is no number sees nothing.
        let is_in_reach = self.eye_m.is_finite() && bounds.distance(self.eye_m) <= self.distance_m;
        if !is_in_reach {
            return None;
        }
        let mut visibility = Visibility::InView;
        for plane in self.planes {
            let height_m = bounds.greatest_height(plane);
            if height_m < 0.0 {
                visibility = Visibility::ShadowOnly;
                let at_the_end_m = height_m + plane.xyz().dot(self.sun?.path(bounds));
                if at_the_end_m < 0.0 {
                    return None;
                }
            }
        }
        let is_seen = visibility == Visibility::InView || self.sun.is_some_and(|sun| sun.reaches(bounds, self.eye_m));
        is_seen.then_some(visibility)
    }
}

impl SunShadows {
    /// How far along the light a box is swept.
    fn path(&self, bounds: &Bounds) -> Vec3 {
        let longest_m = clamped_length(self.longest_m, LONGEST_SHADOW_M);
        let fall_m = bounds.top_m() - self.lowest_m;
        let sinks = self.direction.y < 0.0 && fall_m.is_finite();
        let length_m = if sinks { clamped_length(fall_m / -self.direction.y, longest_m) } else { longest_m };
        self.direction * length_m
    }

    /// Whether the shadow may fall so near to the eye that it is drawn.
    fn reaches(&self, bounds: &Bounds, eye_m: Vec3) -> bool {
        bounds.swept(self.path(bounds)).distance(eye_m) <= self.shadow_distance_m
    }
}

#[cfg(test)]
mod tests;
