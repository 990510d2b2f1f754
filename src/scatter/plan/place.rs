//! Places on the map, and the checks that all shapes share.

use bevy::math::DVec2;

use crate::setting::{SettingError, require};

/// A place on the map: (x, z), m.
pub type Place = [f32; 2];

/// How far from the origin a plan may reach, m: there a place in `f32` is known to 8 mm.
const FARTHEST_M: f32 = 1e5;
/// The most corners of a polygon or points of a path.
pub(super) const MOST_CORNERS: usize = 4096;

/// Refuses a place too far from the origin, or one that is not a number.
pub(super) fn require_place(field: &str, place: Place) -> Result<(), SettingError> {
    place.into_iter().try_for_each(|value| require(field, value, -FARTHEST_M..=FARTHEST_M))
}

/// Refuses a rectangle without area.
pub(super) fn require_rectangle(min_m: Place, max_m: Place) -> Result<(), SettingError> {
    require_place("min_m", min_m)?;
    require_place("max_m", max_m)?;
    for axis in 0..2 {
        if max_m[axis] - min_m[axis] < 0.1 {
            let (low, high) = (min_m[axis], max_m[axis]);
            return Err(SettingError::new("max_m", high, format!("at least 0.1 more than `min_m`, {low}")));
        }
    }
    Ok(())
}

/// The place as two `f64`.
pub(super) fn in_f64([x, z]: Place) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(z))
}
