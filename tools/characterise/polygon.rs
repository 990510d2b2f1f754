//! Polygons: their area, what is inside, and the part on one side of a line.

use bevy::math::DVec2;

fn edges(corners: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// The area of a polygon, about its first corner, so that large coordinates do no harm.
pub fn area(corners: &[DVec2]) -> f64 {
    let Some(&first) = corners.first() else { return 0.0 };
    0.5 * edges(corners).map(|[a, b]| (a - first).perp_dot(b - first)).sum::<f64>().abs()
}

/// The part of a polygon on that side of a line which an axis points to (Sutherland and Hodgman); the line crosses the axis at `at_m`, x or y.
/// Of a polygon that is not convex parts may hang together by edges without width, which have no area.
pub fn cut(corners: &[DVec2], axis: DVec2, at_m: f64) -> Vec<DVec2> {
    let line = axis.dot(DVec2::splat(at_m));
    let depth = |corner: DVec2| axis.dot(corner) - line;
    let mut kept = Vec::new();
    for [a, b] in edges(corners) {
        let (of_a, of_b) = (depth(a), depth(b));
        if of_a >= 0.0 {
            kept.push(a);
        }
        if (of_a >= 0.0) != (of_b >= 0.0) {
            kept.push(a + (b - a) * (of_a / (of_a - of_b)));
        }
    }
    kept
}

/// Whether a point lies in a polygon, or nearer to its edge than `slack_m`.
pub fn contains(corners: &[DVec2], at: DVec2, slack_m: f64) -> bool {
    let crosses =
        |[a, b]: &[DVec2; 2]| (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x);
    let is_near = |[a, b]: [DVec2; 2]| {
        let along = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        at.distance(a + along * (b - a)) <= slack_m
    };
    edges(corners).filter(crosses).count() % 2 == 1 || edges(corners).any(is_near)
}

/// Two edges of a polygon that meet elsewhere than in a common corner.
pub fn crossing(corners: &[DVec2]) -> Option<[usize; 2]> {
    let edges: Vec<[DVec2; 2]> = edges(corners).collect();
    for (first, a) in edges.iter().enumerate() {
        for (second, b) in edges.iter().enumerate().skip(first + 2) {
            let closes = first == 0 && second == edges.len() - 1;
            if !closes && meet(*a, *b) {
                return Some([first, second]);
            }
        }
    }
    None
}

fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let apart = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
    let side = |from: DVec2, to: DVec2, of: DVec2| (to - from).perp_dot(of - from);
    !apart && side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
}
