//! The surface of the wood: one tube per branch, from its root inside the parent to its closed tip.
//!
//! Every vertex is bound to one beam at one place on it and moves with that cross-section. No gap opens when the
//! beams bend, for three reasons. A branch's beams share the ring at their joint: the end of one and the start of the
//! next move alike. A branch's first ring lies on its parent, a little below the bark, and moves with it (see `joint`); a
//! thin or steep branch starts inside its parent instead. The trunk starts below the ground.

use bevy::math::Vec3;

use super::{
    growth::trunk::Trunk,
    joint::{Fillet, Limb},
    skeleton::{Skeleton, SkeletonBeam},
    species::Species,
    tube::{Ring, Tube, inradius},
    vertices::WoodVertices,
};

/// How far the trunk reaches into the ground, m, so that a slope uncovers no hole.
const ROOT_DEPTH_M: f32 = 0.35;
/// Thinner branches have no fillet: it would be too small to be seen.
const FILLET_LEAST_RADIUS_M: f32 = 0.02;
/// How much wider than the branch the foot of its fillet is, and how high the fillet, in radii of the branch.
const FILLET_SPREAD: f32 = 0.8;
const FILLET_RISE: f32 = 1.5;
/// Least sine of the angle between a branch and its parent, and greatest share of a beam, that a fillet is made for.
const FILLET_LEAST_SLANT: f32 = 0.35;
const FILLET_LONGEST: f32 = 0.4;
/// Thinner tips run into a point, thicker ones end in a cap.
const POINTED_TIP_RADIUS_M: f32 = 0.02;
/// Longest stretch of a beam without a ring, m: what its bending may be drawn with.
const LONGEST_RING_STEP_M: f32 = 2.2;

/// Builds the surface of all branches of a skeleton.
#[must_use]
pub fn wood(species: &Species, skeleton: &Skeleton) -> WoodVertices {
    tubes(species, skeleton, WoodDetail::Full, |_| true)
}

/// The surface of some branches, by their first beams, with as few vertices as show where branches are a pixel or two wide.
#[must_use]
pub(crate) fn coarse_wood(species: &Species, skeleton: &Skeleton, stays: impl Fn(usize) -> bool) -> WoodVertices {
    tubes(species, skeleton, WoodDetail::Coarse, stays)
}

/// How closely branches are drawn.
#[derive(Clone, Copy, PartialEq)]
enum WoodDetail {
    Full,
    /// Without fillets, with rings as few as bends need, and with sides as few as tubes of a quarter of the radius have.
    Coarse,
}

/// Coarse tubes have the sides of tubes so many times as thin, and rings so many times as far apart.
const COARSE_THINNER: f32 = 4.0;
const COARSE_STEPS: f32 = 2.0;

fn tubes(species: &Species, skeleton: &Skeleton, detail: WoodDetail, stays: impl Fn(usize) -> bool) -> WoodVertices {
    let mut vertices = WoodVertices::default();
    let continuations = skeleton.continuations();
    let last_order = skeleton.beams.iter().map(|beam| beam.order).max().unwrap_or(0);
    let mut continues = vec![false; skeleton.beams.len()];
    continuations.iter().flatten().for_each(|&next| continues[next as usize] = true);

    for first in (0..skeleton.beams.len()).filter(|&index| !continues[index] && stays(index)) {
        let chain: Vec<usize> =
            std::iter::successors(Some(first), |&beam| continuations[beam].map(|next| next as usize)).collect();
        let branch = BranchChain { skeleton, chain: &chain, continuations: &continuations, detail };
        let base_radius_m = skeleton.beams[first].base_radius_m;
        let tube = Tube::new(base_radius_m, species.wood.bark.tile_m);
        let mut tube = match detail {
            WoodDetail::Full => tube,
            WoodDetail::Coarse => tube.coarsened(COARSE_THINNER, base_radius_m),
        };
        branch.rings(&skeleton.trunk, |ring| tube.push(ring));
        let green = species.wood.green.of_order(skeleton.beams[first].order, last_order);
        tube.write(&mut vertices, green, |point| species.foliage.light(skeleton.envelope.depth(point)));
    }
    vertices
}

struct BranchChain<'a> {
    skeleton: &'a Skeleton,
    chain: &'a [usize],
    continuations: &'a [Option<u32>],
    detail: WoodDetail,
}

impl BranchChain<'_> {
    /// All rings from root to tip.
    fn rings(&self, trunk: &Trunk, mut push: impl FnMut(Ring)) {
        let first = &self.skeleton.beams[self.chain[0]];
        let covered = match first.parent {
            None => self.root_rings(trunk, &mut push),
            Some(parent) => self.joint_rings(parent as usize, &mut push),
        };
        for (place, &index) in self.chain.iter().enumerate() {
            let beam = &self.skeleton.beams[index];
            let next = self.chain.get(place + 1).map(|&next| &self.skeleton.beams[next]);
            let steps = match self.detail {
                WoodDetail::Full => steps(beam),
                WoodDetail::Coarse => (steps(beam) as f32 / COARSE_STEPS).ceil() as usize,
            };
            for step in 1..=steps {
                let s = step as f32 / steps as f32;
                let buried = place == 0 && s <= covered;
                if buried || (step == steps && next.is_none() && beam.tip_radius_m < POINTED_TIP_RADIUS_M) {
                    continue;
                }
                let onward = if step == steps { next.map_or(Vec3::ZERO, |next| next.tangent(0.0)) } else { Vec3::ZERO };
                let mut ring = ring(beam, index, s);
                ring.tangent = (ring.tangent + onward).try_normalize().unwrap_or(ring.tangent);
                push(ring);
            }
        }
        self.tip(&mut push);
    }

    /// The trunk's rings up to the end of its flare; returns the place on the beam that they reach.
    fn root_rings(&self, trunk: &Trunk, push: &mut impl FnMut(Ring)) -> f32 {
        let index = self.chain[0];
        let beam = &self.skeleton.beams[index];
        let height_m = trunk.flare_height_m;
        let mut covered = 0.0;
        let shares: &[f32] = match self.detail {
            WoodDetail::Full => &[-1.0, 0.0, 0.3, 0.7, 1.3, 2.2, 3.5],
            WoodDetail::Coarse => &[-1.0, 0.0, 0.7, 2.2],
        };
        for &share in shares {
            let at_m = if share < 0.0 { -ROOT_DEPTH_M } else { share * height_m };
            let s = at_m / beam.length_m;
            if s > 0.9 {
                break;
            }
            let flare = trunk.flare * (-at_m.max(0.0) / height_m).exp();
            let mut ring = ring(beam, index, s.max(0.0));
            ring.centre = beam.path(s.max(0.0)) + beam.direction * at_m.min(0.0);
            ring.radius_m *= 1.0 + flare;
            ring.lobes = (trunk.buttresses, 0.6 * flare / (1.0 + flare));
            push(ring);
            covered = s.max(0.0);
        }
        covered
    }

    /// The fillet around the joint, or one ring inside the parent; returns the place on the beam that they reach.
    fn joint_rings(&self, parent: usize, push: &mut impl FnMut(Ring)) -> f32 {
        let index = self.chain[0];
        let beam = &self.skeleton.beams[index];
        let limb = limb(&self.skeleton.beams[parent], parent, beam.attach, self.continuations[parent].is_none());
        let mut root = ring(beam, index, 0.0);
        let slant = root.tangent.cross(limb.axis).length();
        let room_m = 0.92 * limb.radius_m - beam.base_radius_m;
        let spread_m = (FILLET_SPREAD * beam.base_radius_m).min(room_m);
        let rise_m = FILLET_RISE * beam.base_radius_m;
        let surface_m = limb.exit_m(beam.base, root.tangent).max(0.0);
        let neck = (surface_m + rise_m) / beam.length_m;
        let is_coarse = self.detail == WoodDetail::Coarse;
        let thin = is_coarse || beam.base_radius_m < FILLET_LEAST_RADIUS_M || spread_m <= 0.0;
        if thin || slant < FILLET_LEAST_SLANT || neck > FILLET_LONGEST || beam.attach > 0.98 {
            root.radius_m = root.radius_m.min(0.95 * limb.radius_m);
            push(root);
            return 0.0;
        }
        for phi_rad in Fillet::PHI_RAD {
            let fillet = Fillet { limb, phi_rad, spread_m, rise_m };
            let along_m = surface_m + fillet.height_m();
            let s = along_m / beam.length_m;
            // The line from the root is straight, the branch may be bowed: its neck must lie on the branch.
            let foot = beam.path(s) - root.tangent * along_m;
            let foot = beam.base.lerp(foot, phi_rad.sin());
            push(Ring {
                centre: foot + root.tangent * along_m,
                tangent: root.tangent,
                radius_m: beam.radius_m(s),
                s: if phi_rad < 1.0 { 0.0 } else { s },
                joint: Some((fillet, foot)),
                ..root
            });
        }
        1.15 * neck
    }

    fn tip(&self, push: &mut impl FnMut(Ring)) {
        let index = self.chain[self.chain.len() - 1];
        let beam = &self.skeleton.beams[index];
        let mut apex = ring(beam, index, 1.0);
        if apex.radius_m >= POINTED_TIP_RADIUS_M {
            apex.centre += apex.tangent * (0.7 * apex.radius_m);
        }
        apex.radius_m = 0.0;
        push(apex);
    }
}

fn ring(beam: &SkeletonBeam, index: usize, s: f32) -> Ring {
    Ring {
        centre: beam.path(s),
        tangent: beam.tangent(s),
        radius_m: beam.radius_m(s),
        lobes: (0, 0.0),
        beam: index as u32,
        s,
        joint: None,
    }
}

/// A beam about a place on it, as it is drawn: between its rings it is straight.
fn limb(beam: &SkeletonBeam, index: usize, at: f32, ends: bool) -> Limb {
    let steps = steps(beam) as f32;
    let low = (at * steps).floor().min(steps - 1.0);
    let (from, to) = (beam.path(low / steps), beam.path((low + 1.0) / steps));
    // The first beam of a branch has other rings near its root: there the parabola's sag over a chord is unsure.
    let unsure_m = if beam.attach < 1.0 { beam.bow.length() / (steps * steps) } else { 0.0 };
    let inscribed = FOOT_DEPTH * inradius(beam.base_radius_m);
    // A pointed tip runs out over the whole last stretch.
    let to_radius_m = match ends && low + 1.0 >= steps && beam.tip_radius_m < POINTED_TIP_RADIUS_M {
        true => 0.0,
        false => inscribed * beam.radius_m((low + 1.0) / steps),
    };
    let from_radius_m = inscribed * beam.radius_m(low / steps);
    let radius_m = from_radius_m + (to_radius_m - from_radius_m) * (at * steps - low);
    Limb {
        point: from.lerp(to, at * steps - low),
        axis: (to - from).try_normalize().unwrap_or(beam.direction),
        radius_m: (radius_m - unsure_m).max(0.3 * radius_m),
        taper: (from_radius_m - to_radius_m) * steps / beam.length_m,
        beam: index as u32,
        at,
        length_m: beam.length_m,
    }
}

/// The foot of a fillet lies at this share of the parent's inscribed radius, so that kinks of a branch show no gap.
const FOOT_DEPTH: f32 = 0.9;

/// Rings a beam needs: enough that the polygon keeps within a third of its radius (and 6 cm for the thinnest) of the
/// bowed path, and that long beams bend smoothly.
fn steps(beam: &SkeletonBeam) -> usize {
    let tolerance_m = 0.35 * beam.base_radius_m + 0.06;
    let curved = (beam.bow.length() / tolerance_m).sqrt();
    let long = beam.length_m / LONGEST_RING_STEP_M;
    curved.max(long).ceil().clamp(1.0, 24.0) as usize
}
