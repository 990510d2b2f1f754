//! Forces at one place of a tree: blows, and bodies that push branches aside.
//!
//! A force `F` at `P` bends the beam on which it acts, and each beam that bears that one. Up to the place `s` where it comes
//! into a beam of length `L`, root `b`, direction `d` and bending compliance `C` (of the whole length), its moment turns that by
//!
//! ```text
//! turn = C s (P - (b + L s d / 2)) x F,      free tip angle = turn x d
//! ```
//!
//! the integral of the moment over the compliance, which is taken as even. Beams answer a blow as they answer the wind: each as an
//! oscillator of its own frequency, or as two, of which that is the static angle.
//!
//! A body that is pushed into a tree moves the branches that it meets just so far that they lie beside it, by the shares with which a force
//! there bends them. That is no force but a constraint, so it holds at any time step. It moves no beam farther
//! than its own force would: a walker parts a hazel, and an oak's trunk stops him.

use super::oscillators::LiveTree;
use crate::dynamics::{beam::BeamDynamics, beam_pose::BeamPose, bend::mode_shape};
use bevy::math::{Quat, Vec3, Vec3A};

/// A ball that is moved along a line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Capsule {
    /// Ends of the line, m.
    pub ends: [Vec3; 2],
    /// Radius of the ball, m.
    pub radius_m: f32,
}

/// A capsule that went straight on for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweptCapsule {
    /// Ends of its line where that began, and where it ended, m.
    pub ends: [[Vec3; 2]; 2],
    /// Radius of the ball, m.
    pub radius_m: f32,
    /// How long ago it was at the beginning and at the end, s.
    pub ages_s: [f32; 2],
}

/// A force of 1 N at a place, on one of the beams that it bends.
#[derive(Clone, Copy)]
struct Share {
    beam: usize,
    /// Where it comes into the beam.
    s: f32,
    /// The static free angle, rad.
    angle: Vec3A,
}

/// How far the place on a beam is from the root at which a force comes in.
#[derive(Clone, Copy)]
struct Struck {
    beam: usize,
    s: f32,
    place: Vec3A,
}

/// Places nearer to a beam's root than this count as of the beam that bears it.
const LEAST_S: f32 = 0.05;
/// Deeper hierarchies are cut here.
const MOST_DEPTH: usize = 64;

impl Struck {
    fn new(beams: &[BeamDynamics], beam: usize, s: f32) -> Self {
        let BeamDynamics { base, direction, length_m, .. } = beams[beam];
        Self { beam, s, place: Vec3A::from(base + direction * (length_m * s)) }
    }

    /// Calls `visit` with the shares of a force along a unit vector. `compliance` is the factor of the tree's scale.
    fn shares(self, beams: &[BeamDynamics], along: Vec3A, compliance: f32, mut visit: impl FnMut(Share)) {
        let (mut index, mut s) = (self.beam, self.s);
        for _ in 0..MOST_DEPTH {
            let beam = &beams[index];
            let direction = Vec3A::from(beam.direction);
            let lever = self.place - (Vec3A::from(beam.base) + direction * (0.5 * beam.length_m * s));
            let turn = lever.cross(along) * (compliance * beam.compliance_rad_n_m * s);
            let angle = turn.cross(direction);
            visit(Share { beam: index, s, angle: if angle.is_finite() { angle } else { Vec3A::ZERO } });
            let parent = beam.parent as usize;
            if parent >= index {
                return;
            }
            (index, s) = (parent, beam.attach.clamp(0.0, 1.0));
        }
    }

    /// By how much the place moves when a beam that bears it bends by a small free angle.
    fn moved(self, beams: &[BeamDynamics], share: &Share, angle: Vec3A) -> Vec3A {
        let beam = &beams[share.beam];
        let [h, h1, ..] = mode_shape(share.s);
        let direction = Vec3A::from(beam.direction);
        let lever = self.place - (Vec3A::from(beam.base) + direction * (beam.length_m * share.s));
        angle * (beam.length_m * h1) + (direction.cross(angle) * h).cross(lever)
    }
}

/// Strikes a tree at a place, with an impulse in N s, both in the tree's coordinates (at its own scale of 1). The beam is struck that passes
/// nearest to the place. `scale` is that of the instance.
pub fn strike(tree: &mut LiveTree, beams: &[BeamDynamics], scale: f32, place: Vec3, impulse_n_s: Vec3) {
    let size_n_s = impulse_n_s.length();
    if !(place.is_finite() && size_n_s.is_finite() && size_n_s > 0.0) {
        return;
    }
    let distance = |beam: &BeamDynamics| {
        let s = ((place - beam.base).dot(beam.direction) / beam.length_m).clamp(0.0, 1.0);
        ((beam.base + beam.direction * (beam.length_m * s)).distance_squared(place), s)
    };
    let nearest = beams.iter().map(distance).enumerate().min_by(|(_, (a, _)), (_, (b, _))| a.total_cmp(b));
    let Some((beam, (_, s))) = nearest else { return };
    let along = Vec3A::from(impulse_n_s / size_n_s);
    Struck::new(beams, beam, s).shares(beams, along, compliance_factor(scale), |share| {
        tree.strike(share.beam, share.angle * size_n_s);
    });
}

/// Angles go with the moment over the third power of the scale, and levers with the scale.
fn compliance_factor(scale: f32) -> f32 {
    if scale > 0.0 { scale.powi(-2) } else { 0.0 }
}

/// Bodies that push the branches of one tree.
pub struct Contacts<'a> {
    /// The tree's beams.
    pub beams: &'a [BeamDynamics],
    /// Where they are.
    pub poses: &'a [BeamPose],
    /// Size of the instance.
    pub scale: f32,
}

impl Contacts<'_> {
    /// Whether a body comes nearer than `margin_m` to any beam where that is now; in the tree's coordinates at its own scale of 1.
    #[must_use]
    pub fn is_near(&self, body: &Capsule, margin_m: f32) -> bool {
        let within_m = body.radius_m + margin_m;
        (0..self.beams.len()).any(|beam| {
            let Some(axis) = self.axis(beam) else { return false };
            let nearest = nearest_points(axis, body.ends);
            nearest.on_first.distance_squared(nearest.on_second) < within_m * within_m
        })
    }

    /// The ends of a beam now; for one without a pose, at rest.
    fn axis(&self, beam: usize) -> Option<[Vec3; 2]> {
        let rest = self.beams.get(beam)?;
        let pose = self.poses.get(beam).unwrap_or(&BeamPose::REST);
        let end = |s: f32| pose.carry(rest, s, rest.base + rest.direction * (rest.length_m * s)).0;
        Some([end(0.0), end(1.0)])
    }

    /// Moves branches out of a body that presses with a force of `most_n` at most.
    pub fn push(&self, tree: &mut LiveTree, body: &Capsule, most_n: f32) {
        // What this body has bent so far: a beam is moved by all that its own branches need.
        let mut bent = std::mem::take(&mut tree.bent);
        bent.clear();
        bent.resize(self.beams.len(), Vec3A::ZERO);
        for beam in 0..self.beams.len() {
            self.push_beam(tree, beam, body, most_n, &mut bent);
        }
        tree.bent = bent;
    }

    fn push_beam(&self, tree: &mut LiveTree, beam: usize, body: &Capsule, most_n: f32, bent: &mut [Vec3A]) {
        let Some(axis) = self.axis(beam) else { return };
        let nearest = nearest_points(axis, body.ends);
        let gap = nearest.on_first - nearest.on_second;
        let depth_m = body.radius_m - gap.length();
        if depth_m.is_nan() || depth_m <= 0.0 || nearest.first < LEAST_S {
            return;
        }
        let aside =
            gap.try_normalize().unwrap_or_else(|| (axis[1] - axis[0]).normalize_or(Vec3::Y).any_orthonormal_vector());
        let to_rest = self.poses.get(beam).map_or(Quat::IDENTITY, |pose| pose.rotation.inverse());
        let along = Vec3A::from(to_rest * aside);
        let struck = Struck::new(self.beams, beam, nearest.first);
        let (mut moved_m, mut by_force_m) = (0.0, 0.0);
        let factor = compliance_factor(self.scale);
        struck.shares(self.beams, along, factor, |share| {
            moved_m += struck.moved(self.beams, &share, bent[share.beam]).dot(along);
            by_force_m += struck.moved(self.beams, &share, share.angle).dot(along).max(0.0);
        });
        let force_n = (depth_m - moved_m) / by_force_m;
        if !(force_n > 0.0 && force_n.is_finite()) {
            return;
        }
        struck.shares(self.beams, along, factor, |share| {
            bent[share.beam] += tree.push(share.beam, share.angle * force_n, share.angle.length() * most_n);
        });
    }
}

/// Where two segments are nearest to each other.
struct Nearest {
    /// Share of the first segment.
    first: f32,
    on_first: Vec3,
    on_second: Vec3,
}

/// Ericson, *Real-Time Collision Detection* (2005), section 5.1.9.
fn nearest_points([p1, q1]: [Vec3; 2], [p2, q2]: [Vec3; 2]) -> Nearest {
    const LEAST: f32 = 1e-9;
    let (d1, d2, r) = (q1 - p1, q2 - p2, p1 - p2);
    let (a, e, f, c, b) = (d1.length_squared(), d2.length_squared(), d2.dot(r), d1.dot(r), d1.dot(d2));
    let (first, second) = if a <= LEAST {
        (0.0, if e <= LEAST { 0.0 } else { (f / e).clamp(0.0, 1.0) })
    } else if e <= LEAST {
        ((-c / a).clamp(0.0, 1.0), 0.0)
    } else {
        let determinant = a * e - b * b;
        let first = if determinant > LEAST { ((b * f - c * e) / determinant).clamp(0.0, 1.0) } else { 0.0 };
        let second = (b * first + f) / e;
        if second < 0.0 {
            ((-c / a).clamp(0.0, 1.0), 0.0)
        } else if second > 1.0 {
            (((b - c) / a).clamp(0.0, 1.0), 1.0)
        } else {
            (first, second)
        }
    };
    Nearest { first, on_first: p1 + d1 * first, on_second: p2 + d2 * second }
}

#[cfg(test)]
mod tests;
