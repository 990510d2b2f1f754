//! Stochastic trees after Reeves & Blau, "Approximate and Probabilistic Algorithms for Shading and Rendering
//! Structured Particle Systems" (SIGGRAPH 1985), section 3.1.
//!
//! A tree is its trunk (a shrub several stems), then order upon order of branches. Along a branch of length `l` buds
//! sit every `spacing_m` from `first_at l` to `last_at l`, a whorl of `per_node` each; a bud grows with a probability
//! that falls with the depth in the crown that its tip would have, where light is scarce. A grown bud leaves its
//! parent at an angle that runs from `first_angle` to `last_angle` along the parent, turned about it by `roll` from
//! node to node (the golden angle of phyllotaxis by default). Its length is a share of its parent's or reaches for
//! the envelope, and never passes the envelope. A branch is a chain of `segments` beams, each turned a little at
//! random and by its tropism.
//!
//! Age (Zaharia: it "influences the values of all the geometric attributes"): envelope and trunk follow the
//! [`Stage`]'s shares. A young tree is no small old one: with `h` the share of its mature height its nodes are `sqrt h`
//! times as far apart, so that there are fewer of them, and of `n` orders of branches about `2 h n` have begun.

use bevy::math::Vec3;
use rand::{Rng, RngExt};

pub use self::settings::{BranchOrder, ORDERS_LIMIT, ReevesBlau};
use super::{
    age::Stage,
    grower::{Branch, Grower, GrownBranches, SHORTEST_BEAM_M, lerp},
    stems::stems,
};

mod settings;

/// Share of its mature height at which a tree has all its orders of branches.
const ALL_ORDERS_AT: f32 = 0.5;

/// Grows the beams of one individual.
pub(in crate::tree) fn grow(parameters: &ReevesBlau, stage: &Stage, random: &mut impl Rng) -> GrownBranches {
    let size = 1.0 - parameters.size_spread * random.random::<f32>();
    let envelope = parameters.envelope.scaled(size * stage.height, size * stage.crown);
    let trunk = parameters.trunk.scaled(size * stage.height, size * stage.girth);
    let begun = parameters.orders.len() as f32 * stage.height / ALL_ORDERS_AT;
    let mut grower = Stochastic {
        grower: Grower::new(Some(envelope), random),
        spacing_scale: size * stage.height.min(1.0).sqrt(),
        shade_pruning: parameters.shade_pruning,
    };
    let mut branches = stems(&mut grower.grower, &trunk, stage);
    for (order, habit) in (1u8..).zip(&parameters.orders) {
        let share_begun = (begun - f32::from(order - 1)).clamp(0.0, 1.0);
        let habit = BranchOrder { probability: habit.probability * share_begun, ..*habit };
        branches = branches.iter().flat_map(|parent| grower.branch_out(&habit, order, parent)).collect();
    }
    GrownBranches { beams: grower.grower.beams, envelope, trunk_radius_m: trunk.radius_m }
}

struct Stochastic<'a, R> {
    grower: Grower<'a, R>,
    spacing_scale: f32,
    shade_pruning: f32,
}

impl<R: Rng> Stochastic<'_, R> {
    /// All branches of one order on one parent branch.
    fn branch_out(&mut self, order: &BranchOrder, level: u8, parent: &Branch) -> Vec<Branch> {
        let mut grown = Vec::new();
        let spacing_m = order.spacing_m * self.spacing_scale;
        let end_m = order.last_at * parent.length_m;
        let mut along_m = order.first_at * parent.length_m;
        let anywhere_rad = self.grower.turn();
        let mut roll_rad = if order.per_node == 2 { 0.0 } else { anywhere_rad };
        while along_m <= end_m + 1e-4 && self.grower.has_room() {
            for sibling in 0..order.per_node {
                let roll_rad = roll_rad + std::f32::consts::TAU * sibling as f32 / order.per_node as f32;
                grown.extend(self.bud(order, level, parent, along_m, roll_rad));
            }
            roll_rad += order.roll_deg.to_radians();
            along_m += spacing_m * (1.0 + order.spacing_spread * self.grower.signed()).max(0.1);
        }
        grown
    }

    /// Lets one bud grow, or not.
    fn bud(&mut self, order: &BranchOrder, level: u8, parent: &Branch, along_m: f32, roll_rad: f32) -> Option<Branch> {
        let chance = self.grower.random.random::<f32>();
        let share = along_m / parent.length_m.max(1e-3);
        let position = ((share - order.first_at) / (order.last_at - order.first_at).max(1e-3)).clamp(0.0, 1.0);
        let angle_deg =
            lerp(order.first_angle_deg, order.last_angle_deg, position) + order.angle_spread_deg * self.grower.signed();
        let roll_rad = roll_rad + order.roll_spread_deg.to_radians() * self.grower.signed();

        let mut bud = self.grower.bud(parent, along_m, angle_deg.to_radians(), roll_rad, level);
        let envelope = self.grower.envelope.unwrap_or_default();
        let towards_light = bud.direction + envelope.outward(bud.base) * order.light_seeking;
        bud.direction = towards_light.try_normalize().unwrap_or(Vec3::Y);
        let onward = mean_direction(bud.direction, order.rise);
        let own_m = order.length * parent.length_m * (1.0 - order.taper * position);
        let room_m = order.reach * envelope.exit_distance_m(bud.base, onward);
        let length_m = own_m.min(room_m) * (1.0 - order.length_spread * self.grower.random.random::<f32>());
        let light = 1.0 - self.shade_pruning * envelope.depth(bud.base + onward * length_m);
        if chance >= order.probability * light || length_m < SHORTEST_BEAM_M {
            return None;
        }
        Some(self.grower.run(bud, length_m, &order.habit()))
    }
}

/// The direction in which the room of a branch is measured: for one that droops that of its middle, else its first.
fn mean_direction(direction: Vec3, rise: f32) -> Vec3 {
    (direction + Vec3::Y * (0.5 * rise.min(0.0))).try_normalize().unwrap_or(direction)
}
