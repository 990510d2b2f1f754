//! A branch as rigid pieces on elastic hinges.
//!
//! Each beam is cut into equal lengths. A length gives as much as a hinge that bends by
//!
//! ```text
//! int dx / E I = 4 l (1 + q + q^2) / (3 pi E R^4 q^3),    q = r / R, R and r the radii at its ends, I = pi R^4 / 4
//! ```
//!
//! for 1 N m and stands where that has its centre, `(q + 2) / (2 (1 + q + q^2))` of the way: so it turns the end of the length
//! and moves it exactly as a taper does under a constant moment. It twists by `E / 2 G` as much. A stem stands on one more hinge, that of its roots.

use crate::tree::{
    skeleton::{Skeleton, SkeletonBeam},
    species::Species,
};
use bevy::math::{DMat3, DVec3};
use std::f64::consts::PI;

/// Thickness of bark that bears nothing, as a share of the radius. Single bark thickness of conifers and of oaks is some 3
/// to 10% of the radius; this is the middle.
pub(super) const BARK_SHARE: f64 = 0.06;
/// Shear modulus along the grain by Young's modulus: 0.06 of spruces to 0.09 of oaks (Wood Handbook 2010, table 5-1).
const SHEAR_BY_YOUNG: f64 = 0.07;
/// Radius of the root plate that turns with the stem, in stem radii: for stems of 0.4 m a plate of 2.4 m across, within
/// the 2 to 3 m of uprooted conifers of that size.
const ROOT_PLATE_RADII: f64 = 6.0;
/// Shear modulus of a forest's top soil under sway, Pa: soft moist loam.
const SOIL_SHEAR_PA: f64 = 1.0e6;
/// Poisson's ratio of the soil.
const SOIL_POISSON: f64 = 0.4;
/// Thinner wood counts as so thick, m: nothing that is drawn is thinner.
const LEAST_RADIUS_M: f64 = 1e-4;
/// Twigs that end in a point are taken as cut off at this share of their radius, where a force takes hold of them.
const LEAST_TAPER: f64 = 0.15;
/// Hinges of a beam of a branch that bears others, for its bend: within 1% for the cones in which stems end.
const BENDING_HINGES: usize = 12;
/// The same for its sway, of the whole branch, and of each beam at least.
const SWAYING_HINGES: usize = 6;
const LEAST_SWAYING_HINGES: usize = 2;
/// Hinges of a beam of a branch that bears leaves alone, for its bend, and of the whole branch for its sway.
const TWIG_HINGES: usize = 8;
const SWAYING_TWIG_HINGES: usize = 2;

/// A hinge, and the rigid piece beyond it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hinge {
    /// Its place along the branch, m, and in the tree's coordinates.
    pub along_m: f64,
    pub at: DVec3,
    /// Of the piece beyond.
    pub direction: DVec3,
    /// Which of the branch's beams it belongs to.
    pub beam: usize,
    /// Radius of the wood there, m.
    pub radius_m: f64,
    /// Turn for 1 N m across the branch, and along it, 1/(N m).
    pub bend_compliance: f64,
    pub twist_compliance: f64,
}

impl Hinge {
    /// The turn under a moment.
    pub fn turn(&self, moment_nm: DVec3) -> DVec3 {
        let along = self.direction * self.direction.dot(moment_nm);
        (moment_nm - along) * self.bend_compliance + along * self.twist_compliance
    }

    /// Moment for a turn, N m.
    pub fn stiffness(&self) -> DMat3 {
        let (bend, twist) = (self.bend_compliance.recip(), self.twist_compliance.recip());
        DMat3::from_diagonal(DVec3::splat(bend)) + outer(self.direction, self.direction) * (twist - bend)
    }
}

/// The matrix `a b^T`.
pub(super) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// The hinges of a branch of these beams, which bears others or not: many for its bend, and few for its sway.
pub(super) fn branch_hinges(species: &Species, skeleton: &Skeleton, beams: &[u32], bears: bool) -> [Vec<Hinge>; 2] {
    let bending = if bears { BENDING_HINGES } else { TWIG_HINGES };
    let swaying = match bears {
        true => SWAYING_HINGES.div_ceil(beams.len()).max(LEAST_SWAYING_HINGES),
        false => SWAYING_TWIG_HINGES.div_ceil(beams.len()),
    };
    [bending, swaying].map(|count| hinges(species, skeleton, beams, count))
}

/// The hinges of a branch of these beams, root first, so many a beam.
fn hinges(species: &Species, skeleton: &Skeleton, beams: &[u32], count: usize) -> Vec<Hinge> {
    let young_pa = f64::from(species.wood.young_modulus_pa);
    let mut hinges = Vec::with_capacity(beams.len() * count + 1);
    let root = &skeleton.beams[beams[0] as usize];
    if root.parent.is_none() {
        hinges.push(roots(root.base.as_dvec3(), f64::from(root.base_radius_m)));
    }
    let mut before_m = 0.0;
    for (index, &beam) in beams.iter().enumerate() {
        let beam = &skeleton.beams[beam as usize];
        let wood_m = |s: f64| ((1.0 - BARK_SHARE) * f64::from(beam.radius_m(s as f32))).max(LEAST_RADIUS_M);
        let direction = beam.direction.as_dvec3();
        let length_m = f64::from(beam.length_m) / count as f64;
        for length in 0..count {
            let [start, end] = [0, 1].map(|end| (length + end) as f64 / count as f64);
            let (radius_m, taper) = (wood_m(start), wood_m(end) / wood_m(start));
            let sum = 1.0 + taper + taper * taper;
            let centre_m = length_m * (length as f64 + (taper + 2.0) / (2.0 * sum));
            let bend_compliance = 4.0 * length_m * sum / (3.0 * PI * young_pa * (radius_m * taper).powi(3) * radius_m);
            hinges.push(Hinge {
                along_m: before_m + centre_m,
                at: beam.base.as_dvec3() + direction * centre_m,
                direction,
                beam: index,
                radius_m: wood_m(centre_m / f64::from(beam.length_m)),
                bend_compliance,
                twist_compliance: bend_compliance / (2.0 * SHEAR_BY_YOUNG),
            });
        }
        before_m += f64::from(beam.length_m);
    }
    hinges
}

/// The even compliance by which a force at a beam's tip turns that as it turns the taper, 1/(N m): of a cone that ends with the share
/// `q` of its radius `R` it is `L (1 + 2q) / (3 q^2 E I)`, from `int (1 - u) / (1 - (1 - q) u)^4 du = (1 + 2q) / (6 q^2)`. A stem's has that
/// of its roots.
pub(super) fn beam_compliance(species: &Species, beam: &SkeletonBeam) -> f64 {
    let young_pa = f64::from(species.wood.young_modulus_pa);
    let [base_m, tip_m] = [beam.base_radius_m, beam.tip_radius_m]
        .map(|radius_m| ((1.0 - BARK_SHARE) * f64::from(radius_m)).max(LEAST_RADIUS_M));
    let taper = (tip_m / base_m).clamp(LEAST_TAPER, 1.0);
    let stiffness_nm2 = young_pa * PI / 4.0 * base_m.powi(4);
    let wood = f64::from(beam.length_m) * (1.0 + 2.0 * taper) / (3.0 * taper * taper * stiffness_nm2);
    if beam.parent.is_none() { wood + 1.0 / root_stiffness_nm_rad(f64::from(beam.base_radius_m)) } else { wood }
}

/// The hinge of a stem's roots. They do not let it twist, which the wood does far more.
fn roots(at: DVec3, base_radius_m: f64) -> Hinge {
    let bend_compliance = 1.0 / root_stiffness_nm_rad(base_radius_m);
    Hinge {
        along_m: 0.0,
        at,
        direction: DVec3::Y,
        beam: 0,
        radius_m: base_radius_m,
        bend_compliance,
        twist_compliance: 1e-3 * bend_compliance,
    }
}

/// Rocking stiffness of the roots of a stem, N m/rad.
fn root_stiffness_nm_rad(base_radius_m: f64) -> f64 {
    let plate_m = ROOT_PLATE_RADII * base_radius_m.max(LEAST_RADIUS_M);
    8.0 * SOIL_SHEAR_PA * plate_m.powi(3) / (3.0 * (1.0 - SOIL_POISSON))
}
