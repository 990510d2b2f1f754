//! How stiff, heavy and exposed each beam of a tree is: from a skeleton to the rows that are posed.
//!
//! A branch is a chain of tapered beams that continue one another, clamped where it grows from its parent. Every other
//! beam and leaf cluster that it carries is a lump of mass and drag on a rigid arm, which is fixed somewhere along the
//! chain and ends at `x` along it (and `r` beside it). With the bending moment `M(x)` of forces on the lumps that are fixed
//! beyond `x`, and `E I(x)` of the round section
//! (I = pi R^4/4, eq. 20 corrected),
//!
//! ```text
//! slope(x) = int_0^x M / E I,    y(x) = int_0^x slope
//! gain of a beam  = (slope at its tip - slope at its root) under the drag for |u|u = 1 m^2/s^2, over phi_1'(1)
//! w^2 of a branch = sum m y / sum m (y^2 + (r slope)^2),   y and slope under the forces m in place of the drag
//! ```
//!
//! The second is Rayleigh's method with the shape of the static deflection, which takes taper and load as they are: the
//! generalised mass and stiffness (eqs. 20, 23) of the uniform beam's mode would make a tapering trunk a third too fast.
//! All beams of a branch sway with its frequency. Without what it bears a trunk would sway much faster (80% of the
//! crown must go before it shows: Moore & Maguire 2004).
//!
//! Three things make a standing tree slower than a clamped pole of clear wood, and are taken in:
//! - bark is thick but bears little: `I` is that of the wood inside it;
//! - the ground gives: a stem stands on a rotational spring `k` (Neild & Wood 1999), whose turn `M(0) / k` comes before
//!   the slope above. The root plate is a rigid disc of radius `a` that rocks on an elastic half-space,
//!   `k = 8 G a^3 / (3 (1 - nu))` (Borowicka 1943);
//! - weight pulls over what leans: `sum m g int slope^2 dx` over the way to each lump is taken from the numerator
//!   (`sum m y` is twice the elastic energy for forces `m`), with the sine of the beam's elevation: a hanging branch is
//!   stiffened.
//!
//! `branches.rs` cuts the skeleton into branches with their lumps, `response.rs` has the formulas above.

mod branches;
mod response;

use self::branches::branches;
use super::{
    skeleton::{Skeleton, SkeletonBeam},
    species::Species,
};
use crate::dynamics::{
    frequency_classes::FrequencyClasses,
    pose::{BeamDynamics, NO_PARENT},
};

/// Height at which foresters measure a trunk's diameter, m.
const BREAST_HEIGHT_M: f32 = 1.3;

/// The beams of `skeleton` as rows for posing, in the same order.
pub(super) fn beam_dynamics(species: &Species, skeleton: &Skeleton) -> Vec<BeamDynamics> {
    let classes = FrequencyClasses::default();
    let mut rows: Vec<BeamDynamics> = skeleton.beams.iter().map(at_rest).collect();
    for branch in branches(species, skeleton) {
        let beams = branch.beams.clone();
        let response = branch.response(species, skeleton);
        for (beam, gain) in beams.into_iter().zip(response.gains) {
            // Boughs that reach back past their root would bend a beam against the wind: it is kept still instead.
            rows[beam as usize].gain = gain.max(0.0) as f32;
            rows[beam as usize].class = classes.coordinate(response.frequency_hz as f32);
        }
    }
    rows
}

/// The measures of a tree that foresters take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeSway {
    /// First natural frequency of the trunk with all that it bears, Hz.
    pub frequency_hz: f32,
    /// Diameter over bark at breast height (1.3 m along the stem; at the tip of a lower one), m.
    pub dbh_m: f32,
    /// Height of the highest wood, m.
    pub height_m: f32,
}

/// First sway frequency and size of a tree; of a shrub those of its first stem.
#[must_use]
pub fn tree_sway(species: &Species, skeleton: &Skeleton) -> TreeSway {
    let trunk = branches(species, skeleton).into_iter().next();
    let (frequency_hz, dbh_m) = trunk.map_or((0.0, 0.0), |trunk| {
        let dbh_m = 2.0 * trunk.radius_m(skeleton, BREAST_HEIGHT_M);
        (trunk.response(species, skeleton).frequency_hz as f32, dbh_m)
    });
    TreeSway { frequency_hz, dbh_m, height_m: skeleton.height_m() }
}

fn at_rest(beam: &SkeletonBeam) -> BeamDynamics {
    BeamDynamics {
        base: beam.base,
        length_m: beam.length_m,
        direction: beam.direction,
        attach: beam.attach,
        parent: beam.parent.unwrap_or(NO_PARENT),
        gain: 0.0,
        class: 0.0,
    }
}

#[cfg(test)]
mod tests;
