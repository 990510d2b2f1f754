//! Where nothing grows: paths, houses, clearings, water.

use bevy::{math::DVec2, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{
    place::{MOST_CORNERS, Place, in_f64, require_place},
    polygon::{self, Polygon},
};
use crate::setting::{SettingError, require};

/// A shape that is kept free of stems.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum KeepOut {
    /// A path along a line.
    Path {
        /// Its points (x, z), 2 to 4096. units: m.
        points_m: Vec<Place>,
        /// units: m, domain: \[0.1, 1000\].
        width_m: f32,
    },
    /// A rectangle, turned about its centre.
    House {
        /// Its centre (x, z). units: m.
        centre_m: Place,
        /// Its sides. units: m, domain: \[0.1, 1000\].
        size_m: Place,
        /// Angle of its first side against the x axis, towards z. units: degrees, domain: \[-360, 360\].
        turn_deg: f32,
    },
    /// A disc.
    Disc {
        /// Its centre (x, z). units: m.
        centre_m: Place,
        /// units: m, domain: \[0.1, 10000\].
        radius_m: f32,
    },
    /// A lake or a wide river.
    Water {
        /// The corners of its shore (x, z), a polygon that does not cross itself. units: m.
        shore_m: Vec<Place>,
    },
}

impl KeepOut {
    pub(super) fn validate(&self) -> Result<(), SettingError> {
        match self {
            Self::Path { points_m, width_m } => {
                require("points_m.len()", points_m.len(), 2..=MOST_CORNERS)?;
                for (index, point) in points_m.iter().enumerate() {
                    require_place(&format!("points_m[{index}]"), *point)?;
                }
                require("width_m", *width_m, 0.1..=1000.0)
            }
            Self::House { centre_m, size_m, turn_deg } => {
                require_place("centre_m", *centre_m)?;
                size_m.iter().try_for_each(|&side| require("size_m", side, 0.1..=1000.0))?;
                require("turn_deg", *turn_deg, -360.0..=360.0)
            }
            Self::Disc { centre_m, radius_m } => {
                require_place("centre_m", *centre_m)?;
                require("radius_m", *radius_m, 0.1..=1e4)
            }
            Self::Water { shore_m } => polygon::validate("shore_m", shore_m),
        }
    }

    /// The simple pieces of which the shape is made; a path has one for each segment, so that far ones cost nothing.
    pub(in crate::scatter) fn blockers(&self) -> Vec<Blocker> {
        match self {
            Self::Path { points_m, width_m } => {
                let half_width = 0.5 * f64::from(*width_m);
                let segment = |pair: &[Place]| Blocker::Segment { a: in_f64(pair[0]), b: in_f64(pair[1]), half_width };
                points_m.windows(2).map(segment).collect()
            }
            Self::House { centre_m, size_m, turn_deg } => vec![Blocker::House {
                centre: in_f64(*centre_m),
                half_size: 0.5 * in_f64(*size_m),
                along: direction(f64::from(*turn_deg).to_radians()),
            }],
            Self::Disc { centre_m, radius_m } => {
                let centre = in_f64(*centre_m);
                vec![Blocker::Segment { a: centre, b: centre, half_width: f64::from(*radius_m) }]
            }
            Self::Water { shore_m } => vec![Blocker::Water(Polygon::new(shore_m))],
        }
    }
}

fn direction(angle_rad: f64) -> DVec2 {
    let (sine, cosine) = libm::sincos(angle_rad);
    DVec2::new(cosine, sine)
}

/// A piece of a shape that is kept free, prepared for queries.
#[derive(Clone, Debug)]
pub(in crate::scatter) enum Blocker {
    Segment { a: DVec2, b: DVec2, half_width: f64 },
    House { centre: DVec2, half_size: DVec2, along: DVec2 },
    Water(Polygon),
}

impl Blocker {
    /// The rectangle around the piece.
    pub(in crate::scatter) fn bounds(&self) -> [DVec2; 2] {
        match self {
            Self::Segment { a, b, half_width } => [a.min(*b) - *half_width, a.max(*b) + *half_width],
            Self::House { centre, half_size, along } => {
                let reach = along.abs() * half_size.x + along.perp().abs() * half_size.y;
                [centre - reach, centre + reach]
            }
            Self::Water(polygon) => polygon.bounds(),
        }
    }

    /// Whether a stem may not stand here.
    pub(in crate::scatter) fn covers(&self, at: DVec2) -> bool {
        match self {
            Self::Segment { a, b, half_width } => {
                let way = b - a;
                let share = (at - a).dot(way) / way.length_squared();
                let nearest = if share.is_nan() { *a } else { a + way * share.clamp(0.0, 1.0) };
                at.distance_squared(nearest) < half_width * half_width
            }
            Self::House { centre, half_size, along } => {
                let way = at - centre;
                // Along the house and across it.
                DVec2::new(along.dot(way), along.perp_dot(way)).abs().cmplt(*half_size).all()
            }
            Self::Water(polygon) => polygon.contains(at),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covers(keep_out: &KeepOut, x: f64, z: f64) -> bool {
        keep_out.validate().unwrap();
        keep_out.blockers().iter().any(|blocker| blocker.covers(DVec2::new(x, z)))
    }

    #[test]
    fn a_path_has_its_width_and_round_ends() {
        let path = KeepOut::Path { points_m: vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [10.0, 10.0]], width_m: 2.0 };
        assert!(covers(&path, 5.0, 0.99) && covers(&path, 10.9, 5.0) && covers(&path, -0.9, 0.0));
        assert!(!covers(&path, 5.0, 1.01) && !covers(&path, 8.9, 5.0) && !covers(&path, -0.8, 0.8));
    }

    #[test]
    fn a_house_turns_about_its_centre() {
        let house = KeepOut::House { centre_m: [100.0, 0.0], size_m: [20.0, 2.0], turn_deg: 90.0 };
        assert!(covers(&house, 100.0, 9.9) && covers(&house, 100.9, -9.0));
        assert!(!covers(&house, 109.0, 0.0) && !covers(&house, 101.1, 0.0));
    }

    #[test]
    fn bounds_are_tight() {
        let shapes = [
            KeepOut::House { centre_m: [3.0, 4.0], size_m: [20.0, 7.0], turn_deg: 33.0 },
            KeepOut::Disc { centre_m: [-3.0, 4.0], radius_m: 11.0 },
            KeepOut::Path { points_m: vec![[0.0, 0.0], [9.0, 13.0]], width_m: 4.0 },
            KeepOut::Water { shore_m: vec![[0.0, 0.0], [9.0, 3.0], [2.0, 8.0]] },
        ];
        for shape in shapes {
            let [min, max] = shape.blockers()[0].bounds();
            let mut covered = [DVec2::INFINITY, DVec2::NEG_INFINITY];
            for index in 0..160_000 {
                let at = DVec2::new(f64::from(index % 400), f64::from(index / 400)) * 0.1 - 20.0;
                if covers(&shape, at.x, at.y) {
                    covered = [covered[0].min(at), covered[1].max(at)];
                }
            }
            // The bounds are as tight as the 0.1 m between the places lets one see, but for the round ends' corners.
            assert!((covered[0] - min).cmpge(DVec2::ZERO).all() && (max - covered[1]).cmpge(DVec2::ZERO).all());
            assert!((covered[0] - min).max_element() < 0.35 && (max - covered[1]).max_element() < 0.35, "{shape:?}");
        }
    }

    #[test]
    fn bad_shapes_are_refused() {
        let error = |keep_out: KeepOut| keep_out.validate().unwrap_err().to_string();
        let path = KeepOut::Path { points_m: vec![[0.0, 0.0]], width_m: 2.0 };
        assert!(error(path).starts_with("`points_m.len()` is 1"));
        assert!(error(KeepOut::Disc { centre_m: [0.0, 0.0], radius_m: -1.0 }).starts_with("`radius_m` is -1"));
        let house = KeepOut::House { centre_m: [0.0, f32::NAN], size_m: [1.0, 1.0], turn_deg: 0.0 };
        assert!(error(house).starts_with("`centre_m` is NaN"));
    }
}
