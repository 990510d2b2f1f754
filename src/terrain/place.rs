//! Places that maps and random fields can be asked about.

use bevy::math::DVec2;

/// Beyond, double precision knows no tenths of a millimetre.
const FARTHEST_M: f64 = 1e12;

/// The place itself, with 0 for a coordinate that is not finite, and the farthest for one that is farther.
#[inline]
pub(super) fn finite(place: DVec2) -> DVec2 {
    let within = |value: f64| if value.is_finite() { value.clamp(-FARTHEST_M, FARTHEST_M) } else { 0.0 };
    DVec2::new(within(place.x), within(place.y))
}
