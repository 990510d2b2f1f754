//! The areas of a plan and what is kept free, as things that are chosen and dragged on the map.

use bevy::math::{DVec2, Vec2};

use crate::scatter::{
    ForestPlan,
    plan::{Area, KeepOut, Place, Shape},
};

/// Places are kept to so many parts of a metre: what a hand can do, and what is easily read.
const PARTS_OF_A_METRE: f32 = 10.0;
/// Edges of a disc that is drawn.
const DISC_EDGES: u32 = 32;
/// Points along the longer side of a shape that becomes a mask.
const MASK_POINTS: f32 = 64.0;
/// The least distance of a mask's points, m.
const FINEST_POINT_M: f32 = 1.0;

/// An area or a shape that is kept free, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    Area(usize),
    KeepOut(usize),
}

impl Element {
    /// All of a plan.
    pub fn all(plan: &ForestPlan) -> impl Iterator<Item = Self> + use<> {
        let (areas, kept_out) = (plan.areas.len(), plan.keep_out.len());
        (0..areas).map(Self::Area).chain((0..kept_out).map(Self::KeepOut))
    }

    /// What it is called.
    pub fn name(self, plan: &ForestPlan) -> String {
        match self {
            Self::Area(number) => plan.areas.get(number).map_or_else(String::new, |area| area.name.clone()),
            Self::KeepOut(number) => {
                let kind = plan.keep_out.get(number).map_or("", |kept| match kept {
                    KeepOut::Path { .. } => "path",
                    KeepOut::House { .. } => "house",
                    KeepOut::Disc { .. } => "clearing",
                    KeepOut::Water { .. } => "water",
                });
                format!("{kind} {}", number + 1)
            }
        }
    }

    /// Whether the plan has it.
    pub fn exists(self, plan: &ForestPlan) -> bool {
        match self {
            Self::Area(number) => number < plan.areas.len(),
            Self::KeepOut(number) => number < plan.keep_out.len(),
        }
    }

    /// The places (x, z) by which it is dragged, m.
    pub fn handles(self, plan: &ForestPlan) -> Vec<Vec2> {
        let places = |places: &[Place]| places.iter().copied().map(Vec2::from).collect();
        match self {
            Self::Area(number) => match plan.areas.get(number).map(|area| &area.shape) {
                Some(Shape::Polygon { corners_m }) => places(corners_m),
                Some(Shape::Rectangle { min_m, max_m } | Shape::Mask { min_m, max_m, .. }) => {
                    rectangle(*min_m, *max_m).to_vec()
                }
                None => Vec::new(),
            },
            Self::KeepOut(number) => match plan.keep_out.get(number) {
                Some(KeepOut::Path { points_m, .. }) => places(points_m),
                Some(KeepOut::Water { shore_m }) => places(shore_m),
                Some(KeepOut::House { centre_m, size_m, turn_deg }) => {
                    let [centre, size] = [*centre_m, *size_m].map(Vec2::from);
                    vec![centre, centre + Vec2::from_angle(turn_deg.to_radians()).rotate(0.5 * size)]
                }
                Some(KeepOut::Disc { centre_m, radius_m }) => {
                    let centre = Vec2::from(*centre_m);
                    vec![centre, centre + Vec2::X * *radius_m]
                }
                None => Vec::new(),
            },
        }
    }

    /// The line around it, or along it, m; and whether its ends meet.
    pub fn outline(self, plan: &ForestPlan) -> (Vec<Vec2>, bool) {
        let handles = self.handles(plan);
        let Self::KeepOut(number) = self else { return (handles, true) };
        match plan.keep_out.get(number) {
            Some(KeepOut::Path { .. }) => (handles, false),
            Some(KeepOut::House { centre_m, size_m, turn_deg }) => {
                let half = 0.5 * Vec2::from(*size_m);
                let turn = Vec2::from_angle(turn_deg.to_radians());
                let corners = rectangle((-half).into(), half.into());
                (corners.map(|corner| Vec2::from(*centre_m) + turn.rotate(corner)).to_vec(), true)
            }
            Some(KeepOut::Disc { centre_m, radius_m }) => (disc(Vec2::from(*centre_m), *radius_m), true),
            Some(KeepOut::Water { .. }) | None => (handles, true),
        }
    }

    /// The plan with one of its handles at another place.
    pub fn with_handle_at(self, plan: &ForestPlan, handle: usize, place: Vec2) -> Option<ForestPlan> {
        let place = rounded(place);
        let mut plan = plan.clone();
        if let Some(corners) = self.corners_mut(&mut plan) {
            *corners.get_mut(handle)? = place.into();
            return Some(plan);
        }
        match self {
            Self::Area(number) => match &mut plan.areas.get_mut(number)?.shape {
                Shape::Rectangle { min_m, max_m } | Shape::Mask { min_m, max_m, .. } => {
                    let (x, z) = ([min_m[0], max_m[0]], [min_m[1], max_m[1]]);
                    // Corners go round: which side each is at.
                    let [right, far] = [matches!(handle, 1 | 2), matches!(handle, 2 | 3)].map(usize::from);
                    let (mut x, mut z) = (x, z);
                    (x[right], z[far]) = (place.x, place.y);
                    (*min_m, *max_m) = ([x[0], z[0]], [x[1], z[1]]);
                }
                Shape::Polygon { .. } => return None,
            },
            Self::KeepOut(number) => match (plan.keep_out.get_mut(number)?, handle) {
                (KeepOut::Disc { centre_m, .. } | KeepOut::House { centre_m, .. }, 0) => *centre_m = place.into(),
                (KeepOut::Disc { centre_m, radius_m }, _) => {
                    *radius_m = rounded(Vec2::X * place.distance(Vec2::from(*centre_m))).x.max(0.1);
                }
                (KeepOut::House { centre_m, size_m, turn_deg }, _) => {
                    let corner = Vec2::from_angle(-turn_deg.to_radians()).rotate(place - Vec2::from(*centre_m));
                    *size_m = rounded(2.0 * corner.abs()).max(Vec2::splat(0.1)).into();
                }
                (KeepOut::Path { .. } | KeepOut::Water { .. }, _) => return None,
            },
        }
        Some(plan)
    }

    /// The plan with one more corner, in the middle of the edge that is nearest to a place; and the number of the corner.
    pub fn with_corner_near(self, plan: &ForestPlan, place: Vec2) -> Option<(ForestPlan, usize)> {
        let (line, is_closed) = self.outline(plan);
        let edges = if is_closed { line.len() } else { line.len().saturating_sub(1) };
        let edge = |number: usize| [line[number], line[(number + 1) % line.len()]];
        let nearest = (0..edges).min_by(|a, b| {
            let distance = |number: usize| distance_to_edge(place, edge(number));
            distance(*a).total_cmp(&distance(*b))
        })?;
        let [from, to] = edge(nearest);
        let mut plan = plan.clone();
        self.corners_mut(&mut plan)?.insert(nearest + 1, rounded(0.5 * (from + to)).into());
        Some((plan, nearest + 1))
    }

    /// The plan without one of its corners.
    pub fn without_corner(self, plan: &ForestPlan, corner: usize) -> Option<ForestPlan> {
        let least = if matches!(self, Self::KeepOut(_)) && !self.outline(plan).1 { 2 } else { 3 };
        let mut plan = plan.clone();
        let corners = self.corners_mut(&mut plan)?;
        if corner >= corners.len() || corners.len() <= least {
            return None;
        }
        corners.remove(corner);
        Some(plan)
    }

    /// The plan without it.
    pub fn removed(self, plan: &ForestPlan) -> ForestPlan {
        let mut plan = plan.clone();
        match self {
            Self::Area(number) => drop(plan.areas.remove(number)),
            Self::KeepOut(number) => drop(plan.keep_out.remove(number)),
        }
        plan
    }

    /// The corners or points, where it has a list of them.
    fn corners_mut(self, plan: &mut ForestPlan) -> Option<&mut Vec<Place>> {
        match self {
            Self::Area(number) => match &mut plan.areas.get_mut(number)?.shape {
                Shape::Polygon { corners_m } => Some(corners_m),
                Shape::Rectangle { .. } | Shape::Mask { .. } => None,
            },
            Self::KeepOut(number) => match plan.keep_out.get_mut(number)? {
                KeepOut::Path { points_m, .. } => Some(points_m),
                KeepOut::Water { shore_m } => Some(shore_m),
                KeepOut::House { .. } | KeepOut::Disc { .. } => None,
            },
        }
    }
}

/// A new area of a hectare about a place, with the species of the plan's last one.
pub fn new_area(plan: &ForestPlan, place: Vec2) -> Area {
    let place = rounded(place);
    let corners = rectangle((place - 50.0).into(), (place + 50.0).into());
    let shape = Shape::Polygon { corners_m: corners.map(Into::into).to_vec() };
    let like = plan.areas.last().cloned().unwrap_or_default();
    Area { name: format!("area {}", plan.areas.len() + 1), shape, ..like }
}

/// The same shape as a polygon with the corners of its rectangle. None of a polygon.
pub fn as_polygon(shape: &Shape) -> Option<Shape> {
    let (Shape::Rectangle { min_m, max_m } | Shape::Mask { min_m, max_m, .. }) = shape else { return None };
    Some(Shape::Polygon { corners_m: rectangle(*min_m, *max_m).map(Into::into).to_vec() })
}

/// The same shape as a mask, which can be painted. None of a mask. The shape has to be valid.
pub fn as_mask(shape: &Shape) -> Option<Shape> {
    if matches!(shape, Shape::Mask { .. }) {
        return None;
    }
    let [min_m, max_m] = shape.bounds_m();
    let size = Vec2::from(max_m) - Vec2::from(min_m);
    let point_m = (size.max_element() / MASK_POINTS).max(FINEST_POINT_M);
    let [columns, rows] = (size / point_m).round().max(Vec2::ONE).to_array().map(|points| points as usize);
    let cell = DVec2::new(f64::from(size.x) / columns as f64, f64::from(size.y) / rows as f64);
    let centre = |index: usize| {
        let point = DVec2::new((index % columns) as f64 + 0.5, (index / columns) as f64 + 0.5);
        Vec2::from(min_m).as_dvec2() + point * cell
    };
    let levels: String =
        shape.coverage((0..columns * rows).map(centre)).map(|share| if share > 0.5 { '9' } else { '.' }).collect();
    let rows = (0..rows).map(|row| levels[row * columns..(row + 1) * columns].to_owned()).collect();
    Some(Shape::Mask { min_m, max_m, rows })
}

/// To a tenth of a metre.
pub fn rounded(place: Vec2) -> Vec2 {
    (place * PARTS_OF_A_METRE).round() / PARTS_OF_A_METRE
}

/// The corners of a rectangle, around it.
fn rectangle(min: Place, max: Place) -> [Vec2; 4] {
    [[min[0], min[1]], [max[0], min[1]], [max[0], max[1]], [min[0], max[1]]].map(Vec2::from)
}

/// The corners of a polygon that is nearly a disc.
pub fn disc(centre: Vec2, radius_m: f32) -> Vec<Vec2> {
    let corner =
        |edge: u32| centre + Vec2::from_angle(edge as f32 / DISC_EDGES as f32 * std::f32::consts::TAU) * radius_m;
    (0..DISC_EDGES).map(corner).collect()
}

fn distance_to_edge(place: Vec2, [from, to]: [Vec2; 2]) -> f32 {
    let way = to - from;
    let share = (place - from).dot(way) / way.length_squared();
    let nearest = if share.is_nan() { from } else { from + way * share.clamp(0.0, 1.0) };
    place.distance(nearest)
}

#[cfg(test)]
mod tests;
