//! Ground that is found by rays: a physics engine's, or any other that can be asked what lies below a point.

use crate::{
    ground::Ground,
    setting::{SettingError, require},
};
use bevy::math::{DVec2, DVec3};
use std::ops::RangeInclusive;

const HEIGHT_M: RangeInclusive<f64> = -1e6..=1e6;

/// Ground found by casting rays straight down.
///
/// Forests, grass and terrains read their ground in the background, and for as long as they live. So the function that casts has to own
/// what it asks: a copy or an `Arc` of the physics engine's query structure, not a system parameter. (For Bevy's meshes there is
/// [`TriangleGround`](super::TriangleGround).)
///
/// ```
/// # use bevy::math::{DVec2, DVec3};
/// # use bevy_windwood::{Ground, terrain::RayCastGround};
/// # #[derive(Clone)] struct Physics;
/// # impl Physics { fn distance_down(&self, from: DVec3, reach_m: f64) -> Option<f64> { Some(from.y - 5.0) } }
/// # let physics = Physics;
/// let ground = RayCastGround::new(-50.0..=400.0, move |from, reach_m| physics.distance_down(from, reach_m))?;
/// assert_eq!(ground.height_m(DVec2::new(3.0, 4.0)), 5.0);
/// # Ok::<(), bevy_windwood::SettingError>(())
/// ```
#[derive(Clone, Copy)]
pub struct RayCastGround<F> {
    highest_m: f64,
    reach_m: f64,
    cast: F,
}

impl<F: Fn(DVec3, f64) -> Option<f64> + Send + Sync> RayCastGround<F> {
    /// Ground with all its elevations within `heights_m`, each -10^6 m to 10^6 m. `cast` is given the point from which a ray goes straight
    /// down and the length of the ray, m; it returns the distance to the first thing that counts as ground, or `None`.
    ///
    /// # Errors
    /// [`SettingError`] for heights outside their domain.
    pub fn new(heights_m: RangeInclusive<f64>, cast: F) -> Result<Self, SettingError> {
        let (lowest_m, highest_m) = heights_m.into_inner();
        require("heights_m.start", lowest_m, HEIGHT_M)?;
        require("heights_m.end", highest_m, lowest_m..=*HEIGHT_M.end())?;
        Ok(Self { highest_m, reach_m: highest_m - lowest_m, cast })
    }
}

impl<F: Fn(DVec3, f64) -> Option<f64> + Send + Sync> Ground for RayCastGround<F> {
    fn height_m(&self, place: DVec2) -> f64 {
        let from = DVec3::new(place.x, self.highest_m, place.y);
        (self.cast)(from, self.reach_m).map_or(f64::NAN, |distance_m| self.highest_m - distance_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn height_is_where_the_ray_ends() {
        let step = |from: DVec3, reach_m: f64| (from.x < 10.0).then_some(if from.z > 0.0 { reach_m } else { 30.0 });
        let ground = RayCastGround::new(-20.0..=100.0, step).unwrap();
        assert_eq!(ground.height_m(DVec2::new(0.0, -1.0)), 70.0);
        assert_eq!(ground.height_m(DVec2::new(0.0, 1.0)), -20.0);
        assert!(ground.height_m(DVec2::new(11.0, 1.0)).is_nan());
        assert_eq!(ground.gradient(DVec2::new(11.0, 1.0)), DVec2::ZERO);
    }

    #[test]
    fn heights_must_be_a_range() {
        let error = |low, high| match RayCastGround::new(low..=high, |_, _| None) {
            Ok(_) => panic!("it should have been refused"),
            Err(error) => error.to_string(),
        };
        assert_eq!(error(5.0, 4.0), "`heights_m.end` is 4, but must be 5 to 1000000");
        assert!(error(f64::NAN, 4.0).starts_with("`heights_m.start` is NaN"));
    }
}
