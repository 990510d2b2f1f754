//! The plan of a forest: what the user gives, as data.
//!
//! After Starling & Ashdown, *Impressionistic techniques for rendering woodland scenes*: "The user will input the type of
//! tree required in a given area, the density of planting, age and season. From this the tree position, shape, size and
//! colour will be computed." A [`ForestPlan`] has [`Area`]s, each with a [`Shape`] on the map, a density, a point pattern
//! and its [`Stock`] of species; and shapes that are kept free, [`KeepOut`]. Plans are written in RON
//! (`assets/forests/*.forest.ron`); [`ForestPlan::from_ron`] names the field that is wrong.

mod forest;
mod keep_out;
mod mask;
mod polygon;
mod shape;
mod stock;

pub use forest::{Area, ForestPlan};
pub(super) use keep_out::Blocker;
pub use keep_out::KeepOut;
pub(super) use shape::Region;
pub use shape::Shape;
pub use stock::{GroundLimits, Stock};

use super::error::{ScatterError, require};

/// A place on the map: (x, z), m.
pub type Place = [f32; 2];

/// How far from the origin a plan may reach, m: there a place in `f32` is known to 8 mm.
pub const FARTHEST_M: f32 = 1e5;
/// The most corners of a polygon or points of a path.
const MOST_CORNERS: usize = 4096;

fn require_place(field: &str, place: Place) -> Result<(), ScatterError> {
    place.into_iter().try_for_each(|value| require(field, value, -FARTHEST_M..=FARTHEST_M))
}

/// Refuses a rectangle without area.
fn require_rectangle(min_m: Place, max_m: Place) -> Result<(), ScatterError> {
    require_place("min_m", min_m)?;
    require_place("max_m", max_m)?;
    for axis in 0..2 {
        if max_m[axis] - min_m[axis] < 0.1 {
            let (low, high) = (min_m[axis], max_m[axis]);
            return Err(ScatterError::out_of_range("max_m", high, format!("at least 0.1 more than `min_m`, {low}")));
        }
    }
    Ok(())
}
