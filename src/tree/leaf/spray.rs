//! Where the leaves of a spray sit: a main shoot, side shoots left and right by turns, perhaps side shoots of these, leaves along them.
//!
//! Coordinates are (along, across): along is 0 at the twig's root and 1 at its tip, across in the same unit, so
//! that the texture holds the region `|across| <= min(along, 1 - along)`.

use bevy::math::Vec2;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

use super::settings::{Leaf, LeafArrangement, LeafShape};

/// A stretch of twig.
#[derive(Clone, Copy)]
pub(super) struct Shoot {
    pub root: Vec2,
    pub tip: Vec2,
    pub radius: f32,
}

impl Shoot {
    pub fn length(&self) -> f32 {
        self.root.distance(self.tip)
    }
}

/// A leaf of a spray.
pub(super) struct PlacedLeaf {
    pub root: Vec2,
    pub direction: Vec2,
    pub length: f32,
    /// What is left of its length and width in projection from above, 0.3 to 1.
    pub projected: Vec2,
    /// Sideways bend of the midrib, in blade lengths.
    pub bend: f32,
    /// 0 lowest to 1 topmost.
    pub level: f32,
    /// 0 grown to 1 young.
    pub youth: f32,
    /// Random tone, 0 to 1.
    pub tone: f32,
    /// Whether its underside is up.
    pub turned: bool,
}

/// Angle of the side shoots to the twig, radians.
const SHOOT_ANGLE_RAD: f32 = 0.85;
/// Length of the first side shoot of a side shoot, by that shoot's.
const SECOND_SHOOT_LENGTH: f32 = 0.7;
const SECOND_SHOOT_RADIUS: f32 = 0.0025;
/// Share of the leaves that show their underside where leaves curl fully.
const TURNED_SHARE: f32 = 0.3;
/// Angles of the leaves at a broad-leaved shoot's tip, radians.
const TIP_LEAVES_RAD: [f32; 3] = [0.0, 0.75, -0.7];
/// Needles of a tuft.
const TUFT: u32 = 16;
/// Angle between the two needles of a pair, radians.
const PAIR_RAD: f32 = 0.22;
/// Margin of the square that stays empty, so that no leaf is cut straight.
const MARGIN: f32 = 0.02;

/// The shoots of the spray of that seed, and the leaves on them.
pub(super) fn spray(leaf: &Leaf, seed: u64) -> (Vec<Shoot>, Vec<PlacedLeaf>) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let shoots = shoots(leaf, &mut random);
    let mut leaves = Vec::new();
    shoots.iter().for_each(|shoot| shoot.place_leaves(leaf, &mut leaves, &mut random));
    (shoots, leaves)
}

/// The main shoot, its side shoots, left and right by turns, as long as the square allows, and theirs.
fn shoots(leaf: &Leaf, random: &mut Xoshiro256PlusPlus) -> Vec<Shoot> {
    let reach = 0.96 - 0.85 * leaf.length * (1.0 + leaf.stalk);
    let mut shoots = vec![Shoot { root: Vec2::ZERO, tip: Vec2::new(reach, 0.0), radius: 0.006 }];
    for index in 0..leaf.shoots {
        let share = (index as f32 + random.random_range(0.3..0.7)) / leaf.shoots as f32;
        let root = Vec2::new(0.06 + 0.78 * share, 0.0);
        let side = if index % 2 == 0 { 1.0 } else { -1.0 };
        let angle = SHOOT_ANGLE_RAD * random.random_range(0.75..1.2);
        let direction = Vec2::new(angle.cos(), side * angle.sin());
        let room = (room(root, direction) - 0.85 * leaf.length).max(0.25 * leaf.length);
        // So unequal that what a spray ends in are its shoots, not the straight edges of its card.
        let length = room * random.random_range(0.6..1.0);
        shoots.push(Shoot { root, tip: root + direction * length, radius: 0.0035 });
    }
    let seconds: Vec<Shoot> = shoots[1..].iter().flat_map(|shoot| second_shoots(shoot, leaf, random)).collect();
    shoots.extend(seconds);
    shoots
}

/// The side shoots of a side shoot, shorter towards its tip.
fn second_shoots(parent: &Shoot, leaf: &Leaf, random: &mut Xoshiro256PlusPlus) -> Vec<Shoot> {
    let axis = (parent.tip - parent.root).normalize_or(Vec2::X);
    let shoot = |index: u32, random: &mut Xoshiro256PlusPlus| {
        let share = (index as f32 + random.random_range(0.2..0.8)) / leaf.second_shoots as f32;
        let root = parent.root + axis * (parent.length() * (0.15 + 0.75 * share));
        let side = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
        let direction = axis.rotate(Vec2::from_angle(side * SHOOT_ANGLE_RAD * random.random_range(0.65..1.1)));
        let own = SECOND_SHOOT_LENGTH * parent.length() * (1.0 - 0.6 * share) * random.random_range(0.5..1.0);
        let length = own.min(room(root, direction) - 0.85 * leaf.length);
        (length > leaf.length).then(|| Shoot { root, tip: root + direction * length, radius: SECOND_SHOOT_RADIUS })
    };
    (0..leaf.second_shoots).filter_map(|index| shoot(index, random)).collect()
}

/// Distance from `root` along `direction` to the outline of the spray, to within a step.
fn room(root: Vec2, direction: Vec2) -> f32 {
    const STEP: f32 = 0.01;
    (1..100).map(|step| STEP * step as f32).take_while(|&far| inside(root + direction * far)).last().unwrap_or(0.0)
}

/// Whether a point lies in the spray's outline: the square, its far corners rounded off, for sprays are no diamonds.
pub(super) fn inside(point: Vec2) -> bool {
    let in_square = point.y.abs() < point.x.min(1.0 - point.x) - MARGIN;
    let rounded = (point - Vec2::new(0.5, 0.0)) / Vec2::new(0.47, 0.42);
    in_square && (point.x < 0.3 || rounded.length_squared() < 1.0)
}

impl Shoot {
    /// Leaves along the shoot and at its tip.
    pub(super) fn place_leaves(&self, leaf: &Leaf, out: &mut Vec<PlacedLeaf>, random: &mut Xoshiro256PlusPlus) {
        let length = self.root.distance(self.tip);
        let step = leaf.spacing * leaf.length;
        let mut along = leaf.bare * length + 0.3 * step * random.random::<f32>();
        let mut side = if random.random::<bool>() { 1.0 } else { -1.0 };
        while along < length {
            self.node(leaf, along, side, out, random);
            side = -side;
            along += step * random.random_range(0.75..1.25);
        }
        self.tip_node(leaf, out, random);
    }

    fn node(&self, leaf: &Leaf, along: f32, side: f32, out: &mut Vec<PlacedLeaf>, random: &mut Xoshiro256PlusPlus) {
        let youth = along / self.root.distance(self.tip).max(1e-3);
        match leaf.shape {
            LeafShape::NeedleRosette => self.tuft(leaf, along, youth, out, random),
            LeafShape::NeedlePair => {
                let angle = side * random.random_range(0.15..0.95);
                self.grow(leaf, along, angle - 0.5 * PAIR_RAD, youth, out, random);
                self.grow(leaf, along, angle + 0.5 * PAIR_RAD, youth, out, random);
            }
            LeafShape::Needle => {
                // Combed to both sides, some forward over the twig.
                for side in [side, -side] {
                    let angle = if random.random::<f32>() < 0.25 { 0.1..0.5 } else { 0.6..1.15 };
                    self.grow(leaf, along, side * random.random_range(angle), youth, out, random);
                }
            }
            _ => {
                let sides: &[f32] = match leaf.arrangement {
                    LeafArrangement::Alternate => &[1.0],
                    LeafArrangement::Opposite => &[1.0, -1.0],
                    LeafArrangement::Whorled => &[1.0, -1.0, 0.15],
                };
                for share in sides {
                    self.grow(leaf, along, side * share * random.random_range(0.65..1.2), youth, out, random);
                }
            }
        }
    }

    fn tip_node(&self, leaf: &Leaf, out: &mut Vec<PlacedLeaf>, random: &mut Xoshiro256PlusPlus) {
        let length = self.root.distance(self.tip);
        match leaf.shape {
            LeafShape::NeedleRosette => self.tuft(leaf, length, 1.0, out, random),
            shape if shape.is_needle() => {
                for _ in 0..5 {
                    self.grow(leaf, length, random.random_range(-0.7..0.7), 1.0, out, random);
                }
            }
            _ => {
                for angle in TIP_LEAVES_RAD {
                    self.grow(leaf, length, angle + random.random_range(-0.2..0.2), 1.0, out, random);
                }
            }
        }
    }

    /// Needles all around a short shoot.
    fn tuft(&self, leaf: &Leaf, along: f32, youth: f32, out: &mut Vec<PlacedLeaf>, random: &mut Xoshiro256PlusPlus) {
        for needle in 0..TUFT {
            let angle = std::f32::consts::TAU * (needle as f32 + random.random::<f32>()) / TUFT as f32;
            self.grow(leaf, along, angle, youth, out, random);
        }
    }

    /// One leaf at an angle to the shoot, unless it would leave the texture.
    fn grow(
        &self,
        leaf: &Leaf,
        along: f32,
        angle_rad: f32,
        youth: f32,
        out: &mut Vec<PlacedLeaf>,
        random: &mut Xoshiro256PlusPlus,
    ) {
        let axis = (self.tip - self.root).normalize_or(Vec2::X);
        let direction = axis.rotate(Vec2::from_angle(angle_rad));
        let length = leaf.length * (1.0 - 0.3 * youth * youth) * random.random_range(0.8..1.1);
        // A blade starts where its stalk ends.
        let root = self.root + axis * along + direction * (leaf.stalk * length);
        let turn = leaf.curl * random.random_range(-1.0..1.0_f32);
        let dip = leaf.curl * random.random_range(0.0..1.0_f32);
        let blade = PlacedLeaf {
            root,
            direction,
            length,
            projected: Vec2::new((0.9 * dip).cos(), (1.15 * turn).cos()),
            bend: 0.35 * leaf.curl * random.random_range(-1.0..1.0),
            level: random.random(),
            youth: youth * youth,
            tone: random.random(),
            turned: random.random::<f32>() < TURNED_SHARE * leaf.curl,
        };
        if blade.corners(leaf.width).into_iter().all(inside) {
            out.push(blade);
        }
    }
}

impl PlacedLeaf {
    /// Points that enclose the blade well enough.
    fn corners(&self, width: f32) -> [Vec2; 7] {
        let at = |x: f32, y: f32| {
            let bent = y * width * self.projected.y + self.bend * x * x;
            self.root + (self.direction * (x * self.projected.x) + self.direction.perp() * bent) * self.length
        };
        [at(1.0, 0.0), at(0.3, 0.5), at(0.3, -0.5), at(0.6, 0.5), at(0.6, -0.5), at(0.85, 0.3), at(0.85, -0.3)]
    }

    /// A point of the spray in the blade's own frame.
    pub(super) fn local(&self, point: Vec2) -> Vec2 {
        let from = (point - self.root) / self.length;
        let x = from.dot(self.direction) / self.projected.x;
        Vec2::new(x, (from.dot(self.direction.perp()) - self.bend * x * x.abs()) / self.projected.y)
    }
}
