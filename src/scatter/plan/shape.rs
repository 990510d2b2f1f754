//! The outline of an area.

use bevy::{math::DVec2, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{
    mask::{self, DensityMask},
    place::{Place, in_f64, require_rectangle},
    polygon::{self, Polygon},
};
use crate::setting::SettingError;

/// The outline of an area on the map.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Shape {
    /// A rectangle along the axes.
    Rectangle {
        /// Least corner (x, z). units: m.
        min_m: Place,
        /// Greatest corner (x, z). units: m.
        max_m: Place,
    },
    /// A polygon that does not cross itself.
    Polygon {
        /// Its corners (x, z) in either sense, 3 to 4096. units: m.
        corners_m: Vec<Place>,
    },
    /// A map of the density, spread over a rectangle and smoothed between its points.
    Mask {
        /// Least corner (x, z). units: m.
        min_m: Place,
        /// Greatest corner (x, z). units: m.
        max_m: Place,
        /// Rows of equal length, the first at least z, each character a point: a digit from 0 (nothing) to 9 (the
        /// area's full density), or a dot for nothing. At most 4096 x 4096.
        rows: Vec<String>,
    },
}

impl Default for Shape {
    /// A hectare about the origin.
    fn default() -> Self {
        Self::Rectangle { min_m: [-50.0; 2], max_m: [50.0; 2] }
    }
}

impl Shape {
    pub(super) fn validate(&self) -> Result<(), SettingError> {
        match self {
            Self::Rectangle { min_m, max_m } => require_rectangle(*min_m, *max_m),
            Self::Polygon { corners_m } => polygon::validate("corners_m", corners_m),
            Self::Mask { min_m, max_m, rows } => {
                require_rectangle(*min_m, *max_m)?;
                mask::validate(rows)
            }
        }
    }
}

impl Shape {
    /// The rectangle around it: least and greatest corner (x, z), m. For a shape that is valid.
    #[must_use]
    pub fn bounds_m(&self) -> [Place; 2] {
        Region::new(self).bounds().map(|corner| corner.as_vec2().to_array())
    }

    /// The shares of the area's density at places (x, z), m, each 0 to 1. For a shape that is valid.
    pub fn coverage<'a>(&self, places: impl IntoIterator<Item = DVec2> + 'a) -> impl Iterator<Item = f32> + 'a {
        let region = Region::new(self);
        let [min, max] = region.bounds();
        let is_inside = move |at: DVec2| at.cmpge(min).all() && at.cmple(max).all();
        places.into_iter().map(move |at| if is_inside(at) { region.coverage(at) } else { 0.0 })
    }
}

/// A shape, prepared for queries.
#[derive(Clone, Debug)]
pub(in crate::scatter) enum Region {
    Rectangle { min: DVec2, max: DVec2 },
    Polygon(Polygon),
    Mask(DensityMask),
}

impl Region {
    pub(in crate::scatter) fn new(shape: &Shape) -> Self {
        match shape {
            Shape::Rectangle { min_m, max_m } => Self::Rectangle { min: in_f64(*min_m), max: in_f64(*max_m) },
            Shape::Polygon { corners_m } => Self::Polygon(Polygon::new(corners_m)),
            Shape::Mask { min_m, max_m, rows } => Self::Mask(DensityMask::new(*min_m, *max_m, rows)),
        }
    }

    /// The rectangle around the shape.
    pub(in crate::scatter) fn bounds(&self) -> [DVec2; 2] {
        match self {
            Self::Rectangle { min, max } => [*min, *max],
            Self::Polygon(polygon) => polygon.bounds(),
            Self::Mask(mask) => mask.bounds(),
        }
    }

    /// The share of the area's density at a place within the bounds, 0 to 1.
    pub(in crate::scatter) fn coverage(&self, at: DVec2) -> f32 {
        match self {
            Self::Rectangle { .. } => 1.0,
            Self::Polygon(polygon) => f32::from(u8::from(polygon.contains(at))),
            Self::Mask(mask) => mask.coverage(at),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_cover_what_is_inside_and_nothing_beyond() {
        let corners_m = vec![[0.0, 0.0], [30.0, 0.0], [30.0, 10.0], [10.0, 10.0], [10.0, 30.0], [0.0, 30.0]];
        let corner = Shape::Polygon { corners_m };
        assert_eq!(corner.bounds_m(), [[0.0, 0.0], [30.0, 30.0]]);
        let places = [(5.0, 25.0), (20.0, 20.0), (-1.0, 5.0), (f64::NAN, 5.0)].map(DVec2::from);
        assert_eq!(corner.coverage(places).collect::<Vec<_>>(), [1.0, 0.0, 0.0, 0.0]);
        let mask = Shape::Mask { min_m: [0.0; 2], max_m: [10.0; 2], rows: vec!["9".into()] };
        let places = [(5.0, 5.0), (10.0, 10.0), (10.1, 5.0)].map(DVec2::from);
        assert_eq!(mask.coverage(places).collect::<Vec<_>>(), [1.0, 1.0, 0.0]);
    }
}
