//! Stochastic trees after Reeves & Blau, "Approximate and Probabilistic Algorithms for Shading and Rendering
//! Structured Particle Systems" (SIGGRAPH 1985), section 3.1.
//!
//! A tree is its trunk, then order upon order of branches. Along a branch of length `l` buds sit every `spacing_m`
//! from `first_at l` to `last_at l`, a whorl of `per_node` each; a bud grows with a probability that falls with the
//! depth in the crown that its tip would have, where light is scarce. A grown bud leaves its parent at an angle that runs from `first_angle`
//! to `last_angle` along the parent, turned about it by `roll` from node to node (the golden angle of phyllotaxis by
//! default). Its length is a share of its parent's or reaches for the envelope, and never passes the envelope.
//! A branch is a chain of `segments` beams, each turned a little at random and by its tropism.

use std::ops::Range;

use bevy::{
    math::{Quat, Vec3},
    reflect::Reflect,
};
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use super::envelope::Envelope;
use crate::tree::{
    skeleton::SkeletonBeam,
    species::{SpeciesError, require},
};

/// Most beams of one tree: growth ends there, lower orders first.
pub const BEAMS_LIMIT: usize = 4096;
/// Most orders of branches.
pub const ORDERS_LIMIT: usize = 5;
/// A shorter piece of wood is no beam.
const SHORTEST_BEAM_M: f32 = 0.08;
/// A branch that would keep less than this share of a segment before it meets the envelope ends where it is.
const SHORTEST_SEGMENT_SHARE: f32 = 0.3;

/// Parameters of a stochastic tree.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ReevesBlau {
    /// What bounds the crown of the largest individual.
    pub envelope: Envelope,
    /// The trunk of the largest individual.
    pub trunk: Trunk,
    /// Branches of the trunk, their branches and so on: at most 5.
    pub orders: Vec<BranchOrder>,
    /// Individuals are smaller than the largest by up to this share of it, 0 to 0.8.
    pub size_spread: f32,
    /// How much of the buds in the middle of the crown dies for want of light, 0 to 1.
    pub shade_pruning: f32,
    /// Exponent of the pipe model, 1.5 to 4; 2 keeps the sum of cross-sections (Leonardo's rule).
    pub pipe_exponent: f32,
}

/// The first branch of all.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Trunk {
    /// Length from the ground to where it ends or dissolves into limbs, m: 0.5 to the envelope's top.
    pub height_m: f32,
    /// Radius at the ground without the root flare, m: 0.01 to 5.
    pub radius_m: f32,
    /// Beams it is made of, 1 to 6.
    pub segments: u32,
    /// Largest lean from the vertical, degrees: 0 to 30.
    pub lean_deg: f32,
    /// How much each segment turns at random, degrees: 0 to 45.
    pub crook_deg: f32,
    /// How much wider than the trunk the roots start, as a share of the radius, 0 to 2.
    pub flare: f32,
    /// Height over which the flare falls to 1/e, m: 0.05 to 5.
    pub flare_height_m: f32,
    /// Number of buttresses, 0 to 9.
    pub buttresses: u32,
}

/// One order of branches.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BranchOrder {
    /// Where on the parent branch the first bud sits, as a share of its length: 0 to 1.
    pub first_at: f32,
    /// Where the last sits, `first_at` to 1.
    pub last_at: f32,
    /// Mean distance between nodes, m: 0.05 to 20.
    pub spacing_m: f32,
    /// Random part of that distance, 0 to 1.
    pub spacing_spread: f32,
    /// Buds at a node, 1 to 12. Pairs start level, left and right; others start anywhere around the parent.
    pub per_node: u32,
    /// Probability that a bud in full light grows, 0 to 1.
    pub probability: f32,
    /// Angle from the parent's direction at `first_at`, degrees: 0 to 150.
    pub first_angle_deg: f32,
    /// The same at `last_at`, degrees: 0 to 150.
    pub last_angle_deg: f32,
    /// Random part of the angle, degrees: 0 to 60.
    pub angle_spread_deg: f32,
    /// Turn about the parent from one node to the next, degrees: -360 to 360. Turn 0 is level, 90 is up.
    pub roll_deg: f32,
    /// Random part of the turn, degrees: 0 to 180.
    pub roll_spread_deg: f32,
    /// Length at `first_at`: as a share of the parent's branch, 0.02 to 3, bounded by the envelope.
    pub length: f32,
    /// How much shorter branches at the parent's tip are, as a share: 0 to 1.
    pub taper: f32,
    /// Random part of the length, 0 to 1.
    pub length_spread: f32,
    /// How far towards the envelope a branch may grow, 0.05 to 1.
    pub reach: f32,
    /// Pull of the light: how much the way out of the crown mixes into the first direction, 0 to 3.
    pub light_seeking: f32,
    /// Beams per branch, 1 to 6.
    pub segments: u32,
    /// How much each segment turns at random, degrees: 0 to 60.
    pub crook_deg: f32,
    /// Upward pull over the whole branch (negative: gravity's), -2 to 2.
    pub rise: f32,
    /// Sag of each beam's middle as a share of its length, -0.3 to 0.3.
    pub sag: f32,
}

impl Default for ReevesBlau {
    fn default() -> Self {
        Self {
            envelope: Envelope::default(),
            trunk: Trunk::default(),
            orders: vec![BranchOrder::default(); 2],
            size_spread: 0.15,
            shade_pruning: 0.5,
            pipe_exponent: 2.2,
        }
    }
}

impl Default for Trunk {
    fn default() -> Self {
        Self {
            height_m: 8.0,
            radius_m: 0.4,
            segments: 2,
            lean_deg: 4.0,
            crook_deg: 6.0,
            flare: 0.5,
            flare_height_m: 0.5,
            buttresses: 5,
        }
    }
}

impl Default for BranchOrder {
    fn default() -> Self {
        Self {
            first_at: 0.3,
            last_at: 1.0,
            spacing_m: 0.6,
            spacing_spread: 0.4,
            per_node: 1,
            probability: 1.0,
            first_angle_deg: 70.0,
            last_angle_deg: 30.0,
            angle_spread_deg: 10.0,
            roll_deg: 137.5,
            roll_spread_deg: 20.0,
            length: 0.6,
            taper: 0.4,
            length_spread: 0.2,
            reach: 1.0,
            light_seeking: 0.2,
            segments: 2,
            crook_deg: 12.0,
            rise: 0.2,
            sag: 0.03,
        }
    }
}

impl ReevesBlau {
    pub(super) fn validate(&self) -> Result<(), SpeciesError> {
        self.envelope.validate().map_err(|error| error.inside("envelope"))?;
        self.trunk.validate(self.envelope.top_m).map_err(|error| error.inside("trunk"))?;
        require("size_spread", self.size_spread, 0.0..=0.8)?;
        require("shade_pruning", self.shade_pruning, 0.0..=1.0)?;
        require("pipe_exponent", self.pipe_exponent, 1.5..=4.0)?;
        if self.orders.len() > ORDERS_LIMIT {
            return Err(SpeciesError::out_of_range("orders", self.orders.len(), "at most 5 orders"));
        }
        self.orders
            .iter()
            .enumerate()
            .try_for_each(|(index, order)| order.validate().map_err(|error| error.inside(&format!("orders[{index}]"))))
    }
}

impl Trunk {
    fn validate(&self, top_m: f32) -> Result<(), SpeciesError> {
        require("height_m", self.height_m, 0.5..=top_m)?;
        require("radius_m", self.radius_m, 0.01..=5.0)?;
        require("segments", self.segments as f32, 1.0..=6.0)?;
        require("lean_deg", self.lean_deg, 0.0..=30.0)?;
        require("crook_deg", self.crook_deg, 0.0..=45.0)?;
        require("flare", self.flare, 0.0..=2.0)?;
        require("flare_height_m", self.flare_height_m, 0.05..=5.0)?;
        require("buttresses", self.buttresses as f32, 0.0..=9.0)
    }

    fn habit(&self) -> Habit {
        Habit { segments: self.segments, crook_rad: self.crook_deg.to_radians(), rise: 0.0, sag: 0.0 }
    }
}

impl BranchOrder {
    fn validate(&self) -> Result<(), SpeciesError> {
        require("first_at", self.first_at, 0.0..=1.0)?;
        require("last_at", self.last_at, self.first_at..=1.0)?;
        require("spacing_m", self.spacing_m, 0.05..=20.0)?;
        require("spacing_spread", self.spacing_spread, 0.0..=1.0)?;
        require("per_node", self.per_node as f32, 1.0..=12.0)?;
        require("probability", self.probability, 0.0..=1.0)?;
        require("first_angle_deg", self.first_angle_deg, 0.0..=150.0)?;
        require("last_angle_deg", self.last_angle_deg, 0.0..=150.0)?;
        require("angle_spread_deg", self.angle_spread_deg, 0.0..=60.0)?;
        require("roll_deg", self.roll_deg, -360.0..=360.0)?;
        require("roll_spread_deg", self.roll_spread_deg, 0.0..=180.0)?;
        require("length", self.length, 0.02..=3.0)?;
        require("taper", self.taper, 0.0..=1.0)?;
        require("length_spread", self.length_spread, 0.0..=1.0)?;
        require("reach", self.reach, 0.05..=1.0)?;
        require("light_seeking", self.light_seeking, 0.0..=3.0)?;
        require("segments", self.segments as f32, 1.0..=6.0)?;
        require("crook_deg", self.crook_deg, 0.0..=60.0)?;
        require("rise", self.rise, -2.0..=2.0)?;
        require("sag", self.sag, -0.3..=0.3)
    }

    fn habit(&self) -> Habit {
        Habit { segments: self.segments, crook_rad: self.crook_deg.to_radians(), rise: self.rise, sag: self.sag }
    }
}

/// What growth makes: beams without radii, and the envelope at this individual's size.
pub(in crate::tree) struct Wood {
    pub beams: Vec<SkeletonBeam>,
    pub envelope: Envelope,
}

/// Grows the beams of one individual.
pub(in crate::tree) fn grow(parameters: &ReevesBlau, random: &mut impl Rng) -> Wood {
    let scale = 1.0 - parameters.size_spread * random.random::<f32>();
    let envelope = parameters.envelope.scaled(scale);
    let mut grower = Grower { envelope, scale, shade_pruning: parameters.shade_pruning, beams: Vec::new(), random };
    let mut branches = vec![grower.trunk(&parameters.trunk)];
    for (order, habit) in (1u8..).zip(&parameters.orders) {
        branches = branches.iter().flat_map(|parent| grower.branch_out(habit, order, parent)).collect();
    }
    Wood { beams: grower.beams, envelope }
}

/// How a branch runs from its bud.
struct Habit {
    segments: u32,
    crook_rad: f32,
    rise: f32,
    sag: f32,
}

/// A grown branch: a run of beams, each continuing the one before.
struct Branch {
    beams: Range<usize>,
    length_m: f32,
}

/// Where a branch starts.
struct Bud {
    parent: Option<u32>,
    attach: f32,
    base: Vec3,
    direction: Vec3,
    order: u8,
}

struct Grower<'a, R> {
    envelope: Envelope,
    scale: f32,
    shade_pruning: f32,
    beams: Vec<SkeletonBeam>,
    random: &'a mut R,
}

impl<R: Rng> Grower<'_, R> {
    fn trunk(&mut self, trunk: &Trunk) -> Branch {
        let lean = Quat::from_rotation_z(trunk.lean_deg.to_radians() * self.random.random::<f32>());
        let heading = Quat::from_rotation_y(self.random.random_range(0.0..std::f32::consts::TAU));
        let direction = heading * lean * Vec3::Y;
        let bud = Bud { parent: None, attach: 0.0, base: Vec3::ZERO, direction, order: 0 };
        self.run(bud, trunk.height_m * self.scale, &trunk.habit())
    }

    /// All branches of one order on one parent branch.
    fn branch_out(&mut self, order: &BranchOrder, level: u8, parent: &Branch) -> Vec<Branch> {
        let mut grown = Vec::new();
        let spacing_m = order.spacing_m * self.scale;
        let end_m = order.last_at * parent.length_m;
        let mut along_m = order.first_at * parent.length_m;
        let anywhere_rad = self.random.random_range(0.0..std::f32::consts::TAU);
        let mut roll_rad = if order.per_node == 2 { 0.0 } else { anywhere_rad };
        while along_m <= end_m + 1e-4 && self.beams.len() < BEAMS_LIMIT {
            for sibling in 0..order.per_node {
                let roll_rad = roll_rad + std::f32::consts::TAU * sibling as f32 / order.per_node as f32;
                grown.extend(self.bud(order, level, parent, along_m, roll_rad));
            }
            roll_rad += order.roll_deg.to_radians();
            along_m += spacing_m * (1.0 + order.spacing_spread * self.signed()).max(0.1);
        }
        grown
    }

    /// Lets one bud grow, or not.
    fn bud(&mut self, order: &BranchOrder, level: u8, parent: &Branch, along_m: f32, roll_rad: f32) -> Option<Branch> {
        let (carrier, attach) = self.find(parent, along_m);
        let beam = self.beams[carrier];
        let base = beam.path(attach);
        let chance = self.random.random::<f32>();
        let share = along_m / parent.length_m.max(1e-3);
        let position = ((share - order.first_at) / (order.last_at - order.first_at).max(1e-3)).clamp(0.0, 1.0);

        let angle =
            lerp(order.first_angle_deg, order.last_angle_deg, position) + order.angle_spread_deg * self.signed();
        let roll = roll_rad + order.roll_spread_deg.to_radians() * self.signed();
        let direction =
            leave(beam.tangent(attach), angle.to_radians(), roll) + self.envelope.outward(base) * order.light_seeking;
        let direction = direction.try_normalize().unwrap_or(Vec3::Y);
        let own_m = order.length * parent.length_m * (1.0 - order.taper * position);
        let room_m = order.reach * self.envelope.exit_distance_m(base, direction);
        let length_m = own_m.min(room_m) * (1.0 - order.length_spread * self.random.random::<f32>());
        let light = 1.0 - self.shade_pruning * self.envelope.depth(base + direction * length_m);
        if chance >= order.probability * light || length_m < SHORTEST_BEAM_M {
            return None;
        }
        let bud = Bud { parent: Some(carrier as u32), attach, base, direction, order: level };
        Some(self.run(bud, length_m, &order.habit()))
    }

    /// Beam and place on it at a distance along a branch.
    fn find(&self, branch: &Branch, along_m: f32) -> (usize, f32) {
        let mut left_m = along_m;
        for index in branch.beams.clone() {
            let length_m = self.beams[index].length_m;
            if left_m < length_m {
                return (index, left_m / length_m);
            }
            left_m -= length_m;
        }
        (branch.beams.end - 1, 1.0)
    }

    /// Grows the beams of a branch, one after the other, until its length is used up or the envelope is met.
    fn run(&mut self, mut bud: Bud, length_m: f32, habit: &Habit) -> Branch {
        let first = self.beams.len();
        let mut grown_m = 0.0;
        let segment_m = length_m / habit.segments as f32;
        let turns = habit.segments.saturating_sub(1).max(1) as f32;
        for segment in 0..habit.segments {
            let room_m =
                if bud.order == 0 { segment_m } else { self.envelope.exit_distance_m(bud.base, bud.direction) };
            if segment > 0 && room_m < SHORTEST_SEGMENT_SHARE * segment_m {
                break;
            }
            let beam = self.beam(&bud, segment_m.min(room_m), habit);
            grown_m += beam.length_m;
            let turned = self.wander(beam.direction, habit.crook_rad) + Vec3::Y * (habit.rise / turns);
            bud = Bud {
                parent: Some(self.beams.len() as u32),
                attach: 1.0,
                base: beam.path(1.0),
                direction: turned.try_normalize().unwrap_or(beam.direction),
                order: bud.order,
            };
            self.beams.push(beam);
        }
        Branch { beams: first..self.beams.len(), length_m: grown_m }
    }

    fn beam(&mut self, bud: &Bud, length_m: f32, habit: &Habit) -> SkeletonBeam {
        let length_m = length_m.max(SHORTEST_BEAM_M);
        let sideways = self.wander(bud.direction, 0.15 * habit.crook_rad) - bud.direction;
        let down = bud.direction * bud.direction.y - Vec3::Y;
        let mut bow = (down * habit.sag + sideways.reject_from(bud.direction)) * length_m;
        let tip = bud.base + bud.direction * length_m;
        bow.y = bow.y.min((self.envelope.top_m - bud.base.y.max(tip.y)).max(0.0));
        SkeletonBeam {
            parent: bud.parent,
            attach: bud.attach,
            base: bud.base,
            direction: bud.direction,
            length_m,
            base_radius_m: 0.0,
            tip_radius_m: 0.0,
            bow,
            order: bud.order,
        }
    }

    /// A unit vector up to `angle_rad` away.
    fn wander(&mut self, direction: Vec3, angle_rad: f32) -> Vec3 {
        let roll = self.random.random_range(0.0..std::f32::consts::TAU);
        let angle = angle_rad * self.random.random::<f32>().sqrt();
        leave(direction, angle, roll)
    }

    /// Uniform in -1..1.
    fn signed(&mut self) -> f32 {
        self.random.random_range(-1.0..1.0)
    }
}

/// The unit vector at `angle_rad` from `direction`, turned about it by `roll_rad`: 0 is level, a quarter turn is up.
pub(in crate::tree) fn leave(direction: Vec3, angle_rad: f32, roll_rad: f32) -> Vec3 {
    let side = direction.cross(Vec3::Y).try_normalize().unwrap_or(Vec3::X);
    let up = side.cross(direction);
    let across = side * roll_rad.cos() + up * roll_rad.sin();
    direction * angle_rad.cos() + across * angle_rad.sin()
}

fn lerp(from: f32, to: f32, share: f32) -> f32 {
    from + (to - from) * share
}
