//! One leaf as a field: distance to its margin, veins and relief on a grid, looked up while it is drawn.
//!
//! A distance can be interpolated where coverage cannot (Green, "Improved alpha-tested magnification", 2007), so that
//! one small grid serves leaves of all sizes, turns and bends.

use bevy::math::Vec2;

use super::{
    outline,
    settings::{Leaf, LeafShape},
    venation,
};

/// What is known of a place on a leaf.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    /// Distance to the margin in blade lengths, positive inside.
    pub inside: f32,
    /// 1 in the middle of a vein to 0.
    pub vein: f32,
    /// Slope of the upper side, along and across.
    pub slope: Vec2,
}

/// The field of one kind of leaf.
pub(super) struct Blade {
    low: Vec2,
    cells_per_unit: Vec2,
    places: Vec<Place>,
}

const ALONG: usize = 160;
const ACROSS: usize = 96;
/// Room around the leaf, in blade lengths; shadows fall into it.
pub(super) const MARGIN: f32 = 0.1;
/// Half width of a stalk, in blade lengths.
const STALK_RADIUS: f32 = 0.013;
/// How deep veins lie in the upper side, in blade lengths.
const VEIN_DEPTH: f32 = 0.012;
/// How steeply the halves of a blade rise from the midrib.
const KEEL: f32 = 0.22;

impl Blade {
    pub(super) fn new(leaf: &Leaf) -> Self {
        let margin = outline::outline(leaf);
        let veins = venation::veins(leaf);
        let (mut low, mut high) = (Vec2::new(-leaf.stalk, 0.0), Vec2::X);
        for &point in &margin {
            (low, high) = (low.min(point), high.max(point));
        }
        // A narrow leaf has little room beside it, or its cells would be wider than itself.
        let room = Vec2::new(MARGIN, MARGIN.min(0.6 * (high.y - low.y)));
        (low, high) = (low - room, high + room);
        let cells_per_unit = Vec2::new((ALONG - 1) as f32, (ACROSS - 1) as f32) / (high - low);
        let mut blade = Self { low, cells_per_unit, places: Vec::with_capacity(ALONG * ACROSS) };
        let mut heights = Vec::with_capacity(ALONG * ACROSS);
        for row in 0..ACROSS {
            for column in 0..ALONG {
                let point = low + Vec2::new(column as f32, row as f32) / cells_per_unit;
                let place = place(leaf, &margin, &veins, point);
                heights.push(height(leaf, point, &place));
                blade.places.push(place);
            }
        }
        blade.find_slopes(&heights);
        blade
    }

    fn find_slopes(&mut self, heights: &[f32]) {
        for row in 0..ACROSS {
            for column in 0..ALONG {
                let at = |column: usize, row: usize| heights[row * ALONG + column];
                let (left, right) = (column.saturating_sub(1), (column + 1).min(ALONG - 1));
                let (under, over) = (row.saturating_sub(1), (row + 1).min(ACROSS - 1));
                let rise = Vec2::new(at(right, row) - at(left, row), at(column, over) - at(column, under));
                let run = Vec2::new((right - left) as f32, (over - under) as f32) / self.cells_per_unit;
                self.places[row * ALONG + column].slope = rise / run;
            }
        }
    }

    /// Looks a point up; `None` beyond the grid.
    pub(super) fn at(&self, point: Vec2) -> Option<Place> {
        let cell = (point - self.low) * self.cells_per_unit;
        if !(cell.x >= 0.0 && cell.y >= 0.0 && cell.x < (ALONG - 1) as f32 && cell.y < (ACROSS - 1) as f32) {
            return None;
        }
        let (column, row) = (cell.x as usize, cell.y as usize);
        let (x, y) = (cell.x - column as f32, cell.y - row as f32);
        let mut sum = Place::default();
        for (dx, dy, share) in
            [(0, 0, (1.0 - x) * (1.0 - y)), (1, 0, x * (1.0 - y)), (0, 1, (1.0 - x) * y), (1, 1, x * y)]
        {
            let place = &self.places[(row + dy) * ALONG + column + dx];
            sum.inside += share * place.inside;
            sum.vein += share * place.vein;
            sum.slope += share * place.slope;
        }
        Some(sum)
    }

    /// Radius about the blade's middle that holds all of it, in blade lengths.
    pub(super) fn reach(&self) -> f32 {
        let high = self.low + Vec2::new((ALONG - 1) as f32, (ACROSS - 1) as f32) / self.cells_per_unit;
        let middle = Vec2::new(0.5, 0.0);
        (self.low - middle).length().max((high - middle).length())
    }
}

fn place(leaf: &Leaf, margin: &[Vec2], veins: &[venation::Vein], point: Vec2) -> Place {
    let blade = outline::distance(margin, point);
    let start = match leaf.shape {
        LeafShape::Palmate => outline::PALMATE_CENTRE,
        LeafShape::Digitate => outline::DIGITATE_CENTRE,
        _ => 0.05,
    };
    let stalk = venation::Vein { from: Vec2::new(start, 0.0), to: Vec2::new(-leaf.stalk, 0.0), radius: STALK_RADIUS };
    let on_stalk = if leaf.stalk > 0.0 { STALK_RADIUS * (1.0 - stalk.off(point) * 0.8) } else { f32::NEG_INFINITY };
    let nearest = veins.iter().map(|vein| vein.off(point)).fold(f32::INFINITY, f32::min);
    let vein = if blade > 0.0 { (-nearest * nearest).exp() } else { f32::from(u8::from(on_stalk > 0.0)) };
    Place { inside: blade.max(on_stalk), vein, slope: Vec2::ZERO }
}

fn height(leaf: &Leaf, point: Vec2, place: &Place) -> f32 {
    if leaf.shape.is_needle() {
        // Round as a needle is.
        let off = (2.0 * point.y / leaf.width).clamp(-1.0, 1.0);
        return -0.3 * leaf.width * off * off;
    }
    KEEL * point.y.abs() - VEIN_DEPTH * place.vein + 0.3 * place.inside.clamp(0.0, 0.05)
}
