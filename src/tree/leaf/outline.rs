//! The margin of a leaf: a closed curve in the leaf's own frame.
//!
//! In that frame the blade runs from (0, 0), where the stalk ends, to (1, 0), its tip; y is across, in blade lengths.
//! Simple leaves have a half width
//!
//! ```text
//! w(x) = x^a (1 - x)^b / max,   widest at a / (a + b),
//! ```
//!
//! blunt at the base where a is small, drawn out at the tip where b is large. Lobes and teeth are waves along the margin;
//! a palmate leaf is a polar curve about the end of its stalk, and a digitate one a simple leaf for each leaflet, turned
//! about that end. [`distance`] is the signed distance to the closed polygon.

use std::f32::consts::{PI, TAU};

use bevy::math::Vec2;

use super::settings::{Leaf, LeafMargin, LeafShape};

impl LeafShape {
    /// The exponents a and b of the half width.
    fn exponents(self) -> (f32, f32) {
        match self {
            Self::Lobed => (0.95, 0.5),
            Self::Digitate => (1.15, 0.42),
            Self::Ovate | Self::Palmate => (0.55, 0.72),
            Self::Triangular => (0.42, 1.05),
            Self::Lanceolate => (0.7, 1.0),
            Self::Deltoid => (0.24, 1.0),
            Self::Obovate => (0.72, 0.42),
            Self::Needle | Self::NeedlePair | Self::NeedleRosette => (0.18, 0.3),
        }
    }
}

impl LeafMargin {
    /// What it adds to the half width at `u` along the margin, as a share.
    fn relief(self, u: f32) -> f32 {
        // Teeth rise slowly and fall off towards the tip.
        let saw = |teeth: f32| (u * teeth).fract() - 0.5;
        match self {
            Self::Entire => 0.0,
            Self::Wavy => 0.045 * (TAU * 8.0 * u).sin(),
            Self::Serrate => 0.12 * saw(15.0),
            Self::DoublySerrate => 0.15 * saw(8.0) + 0.08 * saw(24.0),
        }
    }
}

/// Lobes on each side of an oak's leaf.
const LOBES: f32 = 4.5;
/// Angle, length and half width of a maple's lobes: angle from the tip, rad; length as a share; half width, rad.
pub(super) const PALMATE_LOBES: [(f32, f32, f32); 3] = [(0.0, 1.0, 0.52), (0.92, 0.86, 0.5), (1.95, 0.55, 0.55)];
/// Where the stalk of a palmate leaf ends, as a share of the blade's length.
pub(super) const PALMATE_CENTRE: f32 = 0.26;
/// Angle and length of a horse chestnut's leaflets: angle from the tip, rad; length as a share.
pub(super) const LEAFLETS: [(f32, f32); 7] =
    [(-1.85, 0.5), (-1.22, 0.74), (-0.6, 0.93), (0.0, 1.0), (0.6, 0.93), (1.22, 0.74), (1.85, 0.5)];
/// Where the stalk of a digitate leaf ends, as a share of the blade's length.
pub(super) const DIGITATE_CENTRE: f32 = 0.2;
/// Width of a leaflet as a share of its length: neighbours just do not touch.
const LEAFLET_WIDTH: f32 = 0.37;
/// Points along one side of the margin, and of a leaflet's.
const POINTS: usize = 96;
const LEAFLET_POINTS: usize = 24;

/// The closed margin, from the base along one side to the tip and back along the other.
#[must_use]
pub fn outline(leaf: &Leaf) -> Vec<Vec2> {
    if leaf.shape == LeafShape::Digitate {
        return LEAFLETS.into_iter().flat_map(|leaflet| leaflet_margin(leaf, leaflet)).collect();
    }
    let right: Vec<Vec2> = (0..=POINTS)
        .map(|point| {
            let u = point as f32 / POINTS as f32;
            match leaf.shape {
                LeafShape::Palmate => palmate_margin(leaf, u),
                LeafShape::Lobed => lobed_margin(leaf, u),
                _ => simple_margin(leaf, u),
            }
        })
        .collect();
    let left = right[1..POINTS].iter().rev().map(|point| Vec2::new(point.x, -point.y));
    let mut closed = right.clone();
    closed.extend(left);
    closed
}

/// Half width of a simple leaf, 0 to 1.
fn half_width(shape: LeafShape, x: f32) -> f32 {
    let (a, b) = shape.exponents();
    let widest = a / (a + b);
    let at = |x: f32| x.max(0.0).powf(a) * (1.0 - x).max(0.0).powf(b);
    at(x) / at(widest)
}

/// Points crowd at both ends, where margins curve most: x = (1 - cos pi u) / 2.
fn spread(u: f32) -> f32 {
    0.5 - 0.5 * (PI * u).cos()
}

fn simple_margin(leaf: &Leaf, u: f32) -> Vec2 {
    let x = spread(u);
    let ends = (8.0 * x * (1.0 - x)).min(1.0);
    let relief = if leaf.shape.is_needle() { 0.0 } else { leaf.margin.relief(x) * ends };
    Vec2::new(x, 0.5 * leaf.width * half_width(leaf.shape, x) * (1.0 + relief))
}

/// Lobes are round, the bays between them narrow, and both lean forward.
fn lobed_margin(leaf: &Leaf, u: f32) -> Vec2 {
    let x = spread(u);
    let wave = (PI * (LOBES * x + 0.5)).sin().abs().powf(0.7);
    let depth = 0.42 * (PI * x).sin();
    let width = half_width(leaf.shape, x) * (1.0 - depth * (1.0 - wave));
    let forward = 0.05 * (wave - 0.5) * (PI * x).sin();
    Vec2::new(x + forward, 0.5 * leaf.width * width)
}

/// From the bay at the stalk round to the tip: the farthest of all lobes in each direction.
fn palmate_margin(leaf: &Leaf, u: f32) -> Vec2 {
    let angle = (PI - 0.12) * (1.0 - u);
    let reach = PALMATE_LOBES
        .iter()
        .map(|&(towards, length, half)| {
            let off = (angle - towards).abs() / half;
            // Shoulders before the point: a maple's lobes have two teeth each.
            let teeth = 0.13 * (1.0 - (2.6 * off - 1.0).abs()).max(0.0);
            length * ((1.0 - 0.52 * off.powf(0.7)).max(0.0) + teeth)
        })
        .fold(0.16, f32::max);
    let radius = (1.0 - PALMATE_CENTRE) * reach;
    Vec2::new(PALMATE_CENTRE + radius * angle.cos(), leaf.width * radius * angle.sin())
}

/// Round a leaflet, from the end of the stalk and back to it.
fn leaflet_margin(leaf: &Leaf, (towards, length): (f32, f32)) -> impl Iterator<Item = Vec2> + use<> {
    let leaflet = Leaf { width: LEAFLET_WIDTH, ..*leaf };
    let (reach, wide) = ((1.0 - DIGITATE_CENTRE) * length, leaf.width);
    let around = (0..2 * LEAFLET_POINTS).map(move |point| {
        let u = 1.0 - (point as f32 / LEAFLET_POINTS as f32 - 1.0).abs();
        let side = if point < LEAFLET_POINTS { -1.0 } else { 1.0 };
        let margin = simple_margin(&leaflet, u);
        Vec2::new(margin.x, side * margin.y)
    });
    around.map(move |at| {
        let turned = at.rotate(Vec2::from_angle(towards)) * reach;
        Vec2::new(DIGITATE_CENTRE + turned.x, wide * turned.y)
    })
}

/// Distance to a closed polygon, positive inside (the crossing rule).
#[must_use]
pub fn distance(polygon: &[Vec2], point: Vec2) -> f32 {
    let mut nearest = f32::INFINITY;
    let mut inside = false;
    let mut before = polygon.last().copied().unwrap_or(Vec2::ZERO);
    for &corner in polygon {
        let (edge, from) = (corner - before, point - before);
        let share = (from.dot(edge) / edge.length_squared().max(1e-12)).clamp(0.0, 1.0);
        nearest = nearest.min((from - edge * share).length_squared());
        if (before.y > point.y) != (corner.y > point.y) {
            let crossing = before.x + (point.y - before.y) / (corner.y - before.y) * edge.x;
            inside ^= point.x < crossing;
        }
        before = corner;
    }
    if inside { nearest.sqrt() } else { -nearest.sqrt() }
}
