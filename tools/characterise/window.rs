//! The area in which plants were recorded: a rectangle, a circle or a polygon.

use crate::polygon::{area, contains, crossing, cut};
use bevy::math::DVec2;
use std::f64::consts::{PI, TAU};

/// Length of the equator, m.
pub const FARTHEST_M: f64 = 4e7;
/// Narrowest side of the box around a window, m.
pub const NARROWEST_M: f64 = 1e-3;
/// Greatest number of corners of a polygon.
const MOST_CORNERS: usize = 1000;
/// Corners of the polygon that stands for a circle where areas are cut.
const CIRCLE_CORNERS: u32 = 720;
/// The share of a box by which its sides may lie beyond the edge.
const ROUNDING: f64 = 1e-6;
/// Places are inside if they are outside by less than this share of the window's size: coordinates were rounded.
const SLACK: f64 = 1e-9;

/// The area in which all plants were recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    pub shape: Shape,
    /// The box around it, m.
    pub min_m: DVec2,
    pub max_m: DVec2,
}

/// The shape of a window.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    Rectangle,
    Circle {
        centre_m: DVec2,
        radius_m: f64,
    },
    /// Corners in their order, m.
    Polygon(Vec<DVec2>),
}

/// A side of the box around a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    West,
    East,
    South,
    North,
}

impl Side {
    pub const ALL: [Self; 4] = [Self::West, Self::East, Self::South, Self::North];

    /// The direction outwards.
    fn outwards(self) -> DVec2 {
        match self {
            Self::West => DVec2::NEG_X,
            Self::East => DVec2::X,
            Self::South => DVec2::NEG_Y,
            Self::North => DVec2::Y,
        }
    }

    /// As words.
    pub fn name(self) -> &'static str {
        match self {
            Self::West => "least x",
            Self::East => "greatest x",
            Self::South => "least y",
            Self::North => "greatest y",
        }
    }
}

impl Window {
    /// A rectangle.
    ///
    /// # Errors
    /// Where it has no area.
    pub fn rectangle(min_m: DVec2, max_m: DVec2) -> Result<Self, String> {
        Self { shape: Shape::Rectangle, min_m, max_m }.checked()
    }

    /// A circle.
    ///
    /// # Errors
    /// Where it has no area.
    pub fn circle(centre_m: DVec2, radius_m: f64) -> Result<Self, String> {
        let half = DVec2::splat(radius_m);
        Self { shape: Shape::Circle { centre_m, radius_m }, min_m: centre_m - half, max_m: centre_m + half }.checked()
    }

    /// A polygon. A last corner that is the first again is left out.
    ///
    /// # Errors
    /// Where it has fewer than three corners or too many, has no area, or crosses itself.
    pub fn polygon(mut corners: Vec<DVec2>) -> Result<Self, String> {
        corners.dedup();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if !(3..=MOST_CORNERS).contains(&corners.len()) {
            return Err(format!("the polygon has {} corners, but must have 3 to {MOST_CORNERS}", corners.len()));
        }
        if let Some([first, second]) = crossing(&corners) {
            return Err(format!("the polygon crosses or touches itself: its edges {} and {}", first + 1, second + 1));
        }
        let bounds = |of: fn(DVec2, DVec2) -> DVec2| corners.iter().copied().reduce(of).unwrap_or_default();
        let (min_m, max_m) = (bounds(DVec2::min), bounds(DVec2::max));
        Self { shape: Shape::Polygon(corners), min_m, max_m }.checked()
    }

    fn checked(self) -> Result<Self, String> {
        let size_m = self.size_m();
        if size_m.min_element() >= NARROWEST_M && self.area_m2() > 0.0 {
            return Ok(self);
        }
        Err(format!(
            "its size is {} x {} m, but must be at least {NARROWEST_M} m each way (X0 < X1, Y0 < Y1)",
            size_m.x, size_m.y
        ))
    }

    /// Width and height of the box around it, m.
    pub fn size_m(&self) -> DVec2 {
        self.max_m - self.min_m
    }

    pub fn area_m2(&self) -> f64 {
        match &self.shape {
            Shape::Rectangle => self.size_m().x * self.size_m().y,
            Shape::Circle { radius_m, .. } => PI * radius_m * radius_m,
            Shape::Polygon(corners) => area(corners),
        }
    }

    /// Whether a point lies inside or on the edge. NaN does not.
    pub fn contains(&self, point: DVec2) -> bool {
        let slack_m = SLACK * self.size_m().max_element();
        match &self.shape {
            Shape::Rectangle => point.cmpge(self.min_m).all() && point.cmple(self.max_m).all(),
            Shape::Circle { centre_m, radius_m } => point.distance(*centre_m) <= radius_m + slack_m,
            Shape::Polygon(corners) => contains(corners, point, slack_m),
        }
    }

    /// Whether all of a box lies inside, but for what rounding puts beyond the edge.
    pub fn contains_box(&self, min_m: DVec2, max_m: DVec2) -> bool {
        let rounding_m = ROUNDING * (max_m - min_m);
        let (min_m, max_m) = (min_m + rounding_m, max_m - rounding_m);
        let corners = [min_m, DVec2::new(max_m.x, min_m.y), max_m, DVec2::new(min_m.x, max_m.y)];
        if !corners.into_iter().all(|corner| self.contains(corner)) {
            return false;
        }
        let Shape::Polygon(polygon) = &self.shape else { return true };
        // An edge of the polygon may still pass through the box.
        let sides = [(Side::West, min_m.x), (Side::East, max_m.x), (Side::South, min_m.y), (Side::North, max_m.y)];
        let inside = sides.into_iter().fold(polygon.clone(), |rest, (side, at)| cut(&rest, -side.outwards(), at));
        let size_m = max_m - min_m;
        area(&inside) >= (1.0 - 1e-6) * size_m.x * size_m.y
    }

    /// The share of its area beyond a line across, which lies at x or y, towards one side.
    pub fn share_beyond(&self, side: Side, at_m: f64) -> f64 {
        area(&cut(&self.outline(), side.outwards(), at_m)) / area(&self.outline())
    }

    /// Its corners, m; those of a fine polygon for a circle.
    pub fn outline(&self) -> Vec<DVec2> {
        let (min_m, max_m) = (self.min_m, self.max_m);
        match &self.shape {
            Shape::Rectangle => vec![min_m, DVec2::new(max_m.x, min_m.y), max_m, DVec2::new(min_m.x, max_m.y)],
            Shape::Circle { centre_m, radius_m } => {
                let angle = |corner| TAU * f64::from(corner) / f64::from(CIRCLE_CORNERS);
                (0..CIRCLE_CORNERS).map(|corner| centre_m + radius_m * DVec2::from_angle(angle(corner))).collect()
            }
            Shape::Polygon(corners) => corners.clone(),
        }
    }

    /// In words.
    pub fn describe(&self) -> String {
        match &self.shape {
            Shape::Rectangle => format!("{} x {} m", self.size_m().x, self.size_m().y),
            Shape::Circle { radius_m, .. } => format!("a circle of radius {radius_m} m"),
            Shape::Polygon(corners) => format!("a polygon of {} corners, {:.1} m2", corners.len(), self.area_m2()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn l_shape() -> Window {
        let corners = [(0.0, 0.0), (30.0, 0.0), (30.0, 10.0), (10.0, 10.0), (10.0, 30.0), (0.0, 30.0), (0.0, 0.0)];
        Window::polygon(corners.map(DVec2::from).to_vec()).unwrap()
    }

    #[test]
    fn boxes_are_inside_only_if_all_of_them_is() {
        let circle = Window::circle(DVec2::new(50.0, -20.0), 10.0).unwrap();
        let inside = |window: &Window, min: (f64, f64), max: (f64, f64)| window.contains_box(min.into(), max.into());
        assert!(inside(&circle, (43.0, -27.0), (57.0, -13.0)));
        assert!(!inside(&circle, (42.0, -28.0), (58.0, -12.0)));
        assert!(inside(&l_shape(), (0.0, 0.0), (30.0, 10.0)));
        assert!(inside(&l_shape(), (2.0, 2.0), (9.0, 29.0)));
        assert!(!inside(&l_shape(), (5.0, 5.0), (15.0, 15.0)));
        // All four corners of this box lie in the U, and its notch passes through.
        let u =
            [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (16.0, 20.0), (16.0, 5.0), (14.0, 5.0), (14.0, 20.0), (0.0, 20.0)];
        let u = Window::polygon(u.map(DVec2::from).to_vec()).unwrap();
        assert!(!inside(&u, (10.0, 2.0), (20.0, 12.0)));
        assert!(inside(&u, (10.0, 0.0), (20.0, 5.0)));
    }

    #[test]
    fn areas_are_those_of_geometry() {
        assert_relative_eq!(l_shape().area_m2(), 500.0, max_relative = 1e-12);
        assert_relative_eq!(l_shape().share_beyond(Side::North, 20.0), 0.2, max_relative = 1e-12);
        assert_relative_eq!(l_shape().share_beyond(Side::West, 5.0), 0.3, max_relative = 1e-12);
        let circle = Window::circle(DVec2::splat(4e6), 10.0).unwrap();
        assert_relative_eq!(circle.share_beyond(Side::East, 4e6), 0.5, max_relative = 1e-6);
        // A cap of half the radius: (pi/3 - sqrt(3)/4) / pi.
        let cap = (PI / 3.0 - 3f64.sqrt() / 4.0) / PI;
        assert_relative_eq!(circle.share_beyond(Side::South, 4e6 - 5.0), cap, max_relative = 1e-4);
        let rectangle = Window::rectangle(DVec2::ZERO, DVec2::new(10.0, 4.0)).unwrap();
        assert_relative_eq!(rectangle.share_beyond(Side::East, 9.0), 0.1, max_relative = 1e-12);
    }

    #[test]
    fn edges_belong_to_the_window_and_nothing_beyond_does() {
        let inside = |x, y| l_shape().contains(DVec2::new(x, y));
        assert!(inside(0.0, 15.0) && inside(10.0, 10.0) && inside(30.0, 0.0) && inside(10.0, 20.0));
        assert!(!inside(10.1, 10.1) && !inside(-0.1, 5.0) && !inside(f64::NAN, 5.0));
        let circle = Window::circle(DVec2::ZERO, 5.0).unwrap();
        assert!(circle.contains(DVec2::new(3.0, 4.0)) && !circle.contains(DVec2::new(3.1, 4.0)));
    }

    #[test]
    fn what_is_no_window_is_refused() {
        let polygon =
            |corners: &[(f64, f64)]| Window::polygon(corners.iter().copied().map(DVec2::from).collect()).unwrap_err();
        assert_eq!(polygon(&[(0.0, 0.0), (1.0, 1.0)]), "the polygon has 2 corners, but must have 3 to 1000");
        let bow = polygon(&[(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)]);
        assert_eq!(bow, "the polygon crosses or touches itself: its edges 1 and 3");
        assert!(Window::circle(DVec2::ZERO, 0.0).is_err() && Window::circle(DVec2::ZERO, f64::NAN).is_err());
        assert!(Window::rectangle(DVec2::ZERO, DVec2::new(0.0, 1.0)).unwrap_err().starts_with("its size is 0 x 1 m"));
    }
}
