//! Polygons: whether they are simple, and which places are inside.

use bevy::math::DVec2;

use super::place::{MOST_CORNERS, Place, in_f64, require_place};
use crate::setting::{SettingError, require};

/// Rows of equal height into which the edges are sorted: as many as edges, up to this.
const MOST_BANDS: usize = 1024;

/// Refuses a polygon with too few or too many corners, without area, or that touches or crosses itself.
pub(super) fn validate(field: &str, corners: &[Place]) -> Result<(), SettingError> {
    require(&format!("{field}.len()"), corners.len(), 3..=MOST_CORNERS)?;
    for (index, corner) in corners.iter().enumerate() {
        require_place(&format!("{field}[{index}]"), *corner)?;
    }
    let edges: Vec<[DVec2; 2]> = edges(corners).collect();
    for (first, a) in edges.iter().enumerate() {
        for (second, b) in edges.iter().enumerate().skip(first + 1) {
            let follows = second == first + 1;
            let closes = first == 0 && second == edges.len() - 1;
            let wrong = if follows && closes {
                false
            } else if follows {
                turns_back(a[0], a[1], b[1])
            } else if closes {
                turns_back(b[0], b[1], a[1])
            } else {
                meet(*a, *b)
            };
            if wrong {
                let edges = format!("crossing itself, edge {first} and edge {second}");
                return Err(SettingError::new(field, edges, "a polygon that does not touch itself"));
            }
        }
    }
    let area = 0.5 * edges.iter().map(|[a, b]| a.perp_dot(*b)).sum::<f64>().abs();
    require(&format!("{field}.area()"), area, 0.01..=f64::MAX)
}

/// Whether the path from `a` by `b` to `c` goes back over itself, or has an edge without length.
fn turns_back(a: DVec2, b: DVec2, c: DVec2) -> bool {
    a == b || b == c || ((b - a).perp_dot(c - b) == 0.0 && (b - a).dot(c - b) < 0.0)
}

/// Whether two edges without a common corner touch. Places are `f32`, so that the products here are exact, or nearly.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let apart = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
    if apart {
        return false;
    }
    let side = |from: DVec2, to: DVec2, of: DVec2| (to - from).perp_dot(of - from);
    side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
}

fn edges(corners: &[Place]) -> impl Iterator<Item = [DVec2; 2]> {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| [in_f64(*a), in_f64(*b)])
}

/// A polygon whose edges are sorted into bands of z, so that a place is compared with those of its own band only.
#[derive(Clone, Debug)]
pub(in crate::scatter) struct Polygon {
    min: DVec2,
    max: DVec2,
    bands: Vec<Vec<[DVec2; 2]>>,
}

impl Polygon {
    /// Of corners that have been validated.
    pub(super) fn new(corners: &[Place]) -> Self {
        let places = corners.iter().copied().map(in_f64);
        let (min, max) = places
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(min, max), corner| (min.min(corner), max.max(corner)));
        let mut polygon = Self { min, max, bands: vec![Vec::new(); corners.len().clamp(1, MOST_BANDS)] };
        for edge in edges(corners) {
            let (low, high) = (edge[0].y.min(edge[1].y), edge[0].y.max(edge[1].y));
            for band in polygon.band(low)..=polygon.band(high) {
                polygon.bands[band].push(edge);
            }
        }
        polygon
    }

    pub(super) fn bounds(&self) -> [DVec2; 2] {
        [self.min, self.max]
    }

    fn band(&self, z: f64) -> usize {
        let band = (z - self.min.y) / (self.max.y - self.min.y) * self.bands.len() as f64;
        (band.max(0.0) as usize).min(self.bands.len() - 1)
    }

    /// Whether a ray from the place along x crosses the outline an odd number of times.
    pub(super) fn contains(&self, at: DVec2) -> bool {
        if at.cmplt(self.min).any() || at.cmpgt(self.max).any() {
            return false;
        }
        let crosses =
            |[a, b]: &[DVec2; 2]| (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x);
        self.bands[self.band(at.y)].iter().filter(|edge| crosses(edge)).count() % 2 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const L_SHAPE: [Place; 6] = [[0.0, 0.0], [30.0, 0.0], [30.0, 10.0], [10.0, 10.0], [10.0, 30.0], [0.0, 30.0]];

    #[test]
    fn an_l_contains_its_two_parts_and_not_the_rest_of_its_box() {
        let polygon = Polygon::new(&L_SHAPE);
        let inside = |x, z| polygon.contains(DVec2::new(x, z));
        assert!(inside(5.0, 25.0) && inside(25.0, 5.0) && inside(1.0, 1.0));
        assert!(!inside(20.0, 20.0) && !inside(-1.0, 5.0) && !inside(5.0, 31.0) && !inside(f64::NAN, 5.0));
    }

    #[test]
    fn polygons_that_are_not_simple_are_refused() {
        let error = |corners: &[Place]| validate("corners_m", corners).unwrap_err().to_string();
        validate("corners_m", &L_SHAPE).unwrap();
        assert!(error(&[[0.0, 0.0], [1.0, 0.0]]).starts_with("`corners_m.len()` is 2"));
        let bow = [[0.0, 0.0], [10.0, 10.0], [10.0, 0.0], [0.0, 10.0]];
        assert_eq!(
            error(&bow),
            "`corners_m` is crossing itself, edge 0 and edge 2, but must be a polygon that does not touch itself"
        );
        let spike = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [20.0, 10.0], [10.0, 10.0]];
        assert!(error(&spike).contains("crossing itself"));
        assert!(error(&[[0.0, 0.0], [5.0, 0.0], [10.0, 0.0]]).contains("crossing itself"));
        assert!(error(&[[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]]).starts_with("`corners_m.area()` is 0.005"));
        assert!(error(&[[0.0, 0.0], [0.0, 0.0], [10.0, 0.0], [0.0, 9.0]]).contains("crossing itself"));
        assert!(error(&[[0.0, 0.0], [f32::NAN, 0.0], [10.0, 9.0]]).starts_with("`corners_m[1]` is NaN"));
    }

    proptest! {
        /// A star about a centre: a place is inside if it is nearer to the centre than the outline in its direction.
        #[test]
        fn stars_contain_the_places_in_their_triangles(
            radii in prop::collection::vec(5.0_f32..40.0, 3..60), x in -45.0_f64..45.0, z in -45.0_f64..45.0,
        ) {
            let count = radii.len() as f32;
            let corner = |(index, radius): (usize, &f32)| {
                let angle = index as f32 / count * std::f32::consts::TAU;
                [radius * angle.cos(), radius * angle.sin()]
            };
            let corners: Vec<Place> = radii.iter().enumerate().map(corner).collect();
            prop_assume!(validate("star", &corners).is_ok());
            let at = DVec2::new(x, z);
            let same_side = |[a, b]: [DVec2; 2]| {
                a.perp_dot(at) >= 0.0 && at.perp_dot(b) >= 0.0 && (b - a).perp_dot(at - a) >= 0.0
            };
            prop_assert_eq!(Polygon::new(&corners).contains(at), edges(&corners).any(same_side));
        }
    }
}
