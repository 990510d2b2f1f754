//! The veins of a leaf: a midrib and pairs of side veins that leave it at the species' angle and bow towards the tip;
//! in a palmate leaf one main vein for each lobe, in a digitate one for each leaflet, with side veins of its own.

use bevy::math::Vec2;

use super::{
    outline::{DIGITATE_CENTRE, LEAFLETS, PALMATE_CENTRE, PALMATE_LOBES},
    settings::{Leaf, LeafShape},
};

/// A straight piece of vein.
#[derive(Clone, Copy, Debug)]
pub(in crate::tree) struct Vein {
    pub from: Vec2,
    pub to: Vec2,
    /// Half width, in blade lengths.
    pub radius: f32,
}

impl Vein {
    /// Distance from the vein's middle, in radii.
    pub(super) fn off(&self, point: Vec2) -> f32 {
        let (axis, from) = (self.to - self.from, point - self.from);
        let share = (from.dot(axis) / axis.length_squared().max(1e-12)).clamp(0.0, 1.0);
        let radius = self.radius * (1.0 - 0.6 * share);
        (from - axis * share).length() / radius.max(1e-4)
    }
}

/// Half width of a midrib, in blade lengths.
const MIDRIB_RADIUS: f32 = 0.014;

/// All veins of a leaf, midrib first.
pub(super) fn veins(leaf: &Leaf) -> Vec<Vein> {
    if leaf.shape.is_needle() {
        // The keel of a needle.
        return vec![Vein { from: Vec2::ZERO, to: Vec2::X, radius: 0.12 * leaf.width }];
    }
    let mut veins = vec![Vein { from: Vec2::ZERO, to: Vec2::new(0.98, 0.0), radius: MIDRIB_RADIUS }];
    match leaf.shape {
        LeafShape::Palmate => palmate_veins(leaf, &mut veins),
        LeafShape::Digitate => digitate_veins(leaf, &mut veins),
        _ => simple_veins(leaf, &mut veins),
    }
    veins
}

fn simple_veins(leaf: &Leaf, veins: &mut Vec<Vein>) {
    for pair in 0..leaf.vein_pairs {
        let share = (pair as f32 + 0.5) / leaf.vein_pairs as f32;
        let root = Vec2::new(0.04 + 0.82 * share, 0.0);
        let length = 0.75 * leaf.width * (1.0 - 0.5 * share);
        side_veins(root, Vec2::X, length, leaf.vein_angle_deg.to_radians(), veins);
    }
}

fn digitate_veins(leaf: &Leaf, veins: &mut Vec<Vein>) {
    let centre = Vec2::new(DIGITATE_CENTRE, 0.0);
    for (towards, length) in LEAFLETS {
        let direction = Vec2::new(towards.cos(), leaf.width * towards.sin());
        let reach = 0.95 * length * (1.0 - DIGITATE_CENTRE);
        veins.push(Vein { from: centre, to: centre + direction * reach, radius: 0.7 * MIDRIB_RADIUS });
        let axis = direction.normalize_or(Vec2::X);
        for pair in 0..leaf.vein_pairs {
            let root = centre + direction * (reach * (pair as f32 + 1.5) / (leaf.vein_pairs as f32 + 2.0));
            side_veins(root, axis, 0.17 * length, leaf.vein_angle_deg.to_radians(), veins);
        }
    }
}

/// A pair of veins in three pieces each, bowing towards `axis`.
fn side_veins(root: Vec2, axis: Vec2, length: f32, angle_rad: f32, veins: &mut Vec<Vein>) {
    for side in [1.0, -1.0] {
        let mut from = root;
        for (piece, turn) in [1.1, 0.95, 0.7].into_iter().enumerate() {
            let to = from + axis.rotate(Vec2::from_angle(side * angle_rad * turn)) * (length / 3.0);
            veins.push(Vein { from, to, radius: MIDRIB_RADIUS * (0.6 - 0.12 * piece as f32) });
            from = to;
        }
    }
}

fn palmate_veins(leaf: &Leaf, veins: &mut Vec<Vein>) {
    let centre = Vec2::new(PALMATE_CENTRE, 0.0);
    for (towards, length, _) in PALMATE_LOBES {
        for side in if towards == 0.0 { &[1.0][..] } else { &[1.0, -1.0] } {
            let direction = Vec2::new(towards.cos(), side * leaf.width * towards.sin());
            let reach = 0.95 * length * (1.0 - PALMATE_CENTRE);
            veins.push(Vein { from: centre, to: centre + direction * reach, radius: 0.8 * MIDRIB_RADIUS });
            for pair in 0..leaf.vein_pairs.div_ceil(2) {
                let share = (pair as f32 + 1.0) / (leaf.vein_pairs.div_ceil(2) as f32 + 1.0);
                let root = centre + direction * (reach * share);
                let axis = direction.normalize_or(Vec2::X);
                side_veins(root, axis, 0.22 * length, leaf.vein_angle_deg.to_radians(), veins);
            }
        }
    }
}
