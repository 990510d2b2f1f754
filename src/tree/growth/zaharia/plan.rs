//! What Zaharia's oak and fir share: their lifetime, and how one level of branches after the other grows.

use rand::{Rng, RngExt};

use crate::{
    setting::{SettingError, require},
    tree::{
        growth::{
            age::Stage,
            envelope::{Envelope, EnvelopeShape},
            grower::{Branch, Grower, GrownBranches, SHORTEST_BEAM_M, lerp},
            habit::Habit,
            stems::stems,
            trunk::Trunk,
        },
        skeleton::SkeletonBeam,
    },
};

/// Largest height of a trunk, m.
const TALLEST_M: f32 = 120.0;

/// `no_branch`: how many branches, linear in age.
pub(super) fn no_branch(fewest: f32, most: f32, age_share: f32) -> f32 {
    lerp(fewest, most, age_share)
}

/// `l_branch`: how long a branch is; `random` is 0..1.
fn branch_length_m(father_m: f32, dist_m: f32, adjust_branch: f32, age_over_max: f32, random: f32) -> f32 {
    (father_m - dist_m) * (adjust_branch + age_over_max) * random
}

/// The lifetime over which a Zaharia tree grows.
#[derive(Clone, Copy)]
pub(super) struct Lifetime {
    /// `(age - min_age) / (max_age - min_age)`.
    pub share: f32,
    /// `age / max_age`.
    pub over_max: f32,
}

impl Lifetime {
    pub fn at(age_years: f32, min_years: f32, max_years: f32) -> Self {
        let age_years = age_years.clamp(min_years, max_years);
        Self { share: (age_years - min_years) / (max_years - min_years), over_max: age_years / max_years }
    }
}

/// One level of branches, as both trees grow it.
pub(super) struct Level {
    pub adjust_branch: f32,
    /// Nodes on a father, and branches at each.
    pub nodes: f32,
    pub per_node: u32,
    /// Whether nodes are spread evenly (the floors of a fir) or at random.
    pub floors: bool,
    pub first_at: f32,
    pub first_angle_deg: f32,
    pub last_angle_deg: f32,
    pub angle_spread_deg: f32,
    /// Whether branches lie left and right of their father rather than all around.
    pub flat: bool,
    pub sag: f32,
    pub crook_deg: f32,
}

/// The settings that both trees have.
pub(super) struct Plan<'a> {
    pub trunk: &'a Trunk,
    pub delta_m: f32,
    pub shortest: f32,
    pub lifetime: Lifetime,
    pub shape: EnvelopeShape,
    pub levels: Vec<Level>,
}

impl Plan<'_> {
    pub fn grow(&self, random: &mut impl Rng) -> GrownBranches {
        let age = self.lifetime.over_max;
        let mut grower = Grower::new(None, random);
        let trunk_m = self.trunk_length_m(&mut grower);
        let trunk = Trunk { height_m: trunk_m, ..self.trunk.scaled(1.0, age) };
        let stage = Stage { height: age, ..Stage::mature(0.0) };
        let mut fathers = stems(&mut grower, &trunk, &stage);
        for (order, level) in (1u8..).zip(&self.levels) {
            fathers = fathers.iter().flat_map(|father| self.branch_out(&mut grower, level, order, father)).collect();
        }
        let beams = grower.beams;
        let envelope = Envelope::around(self.shape, crown(&beams));
        GrownBranches { beams, envelope, trunk_radius_m: trunk.radius_m }
    }

    /// `l_trunk`, with `random(n)` a whole number below n and `(-1)^random(65)` a sign.
    fn trunk_length_m<R: Rng>(&self, grower: &mut Grower<R>) -> f32 {
        let grown_m = self.trunk.height_m * self.lifetime.over_max;
        let sign = if grower.random.random_range(0..65) % 2 == 0 { 1.0 } else { -1.0 };
        let nodes = self.levels.first().map_or(1.0, |level| level.nodes).round().max(1.0);
        let share = grower.random.random_range(0..nodes as u32) as f32 / nodes;
        (grown_m + sign * self.delta_m * share).clamp(0.5 * grown_m, 1.5 * grown_m)
    }

    fn branch_out<R: Rng>(&self, grower: &mut Grower<R>, level: &Level, order: u8, father: &Branch) -> Vec<Branch> {
        let mut grown = Vec::new();
        let nodes = (level.nodes + grower.random.random::<f32>()) as u32;
        let heading = grower.turn();
        for node in 0..nodes {
            let place = if level.floors {
                (node as f32 + 0.5 + 0.25 * grower.signed()) / nodes as f32
            } else {
                grower.random.random()
            };
            let dist_m = father.length_m * lerp(level.first_at, 1.0, place);
            let turned = heading + node as f32 * std::f32::consts::PI / level.per_node as f32;
            for sibling in 0..level.per_node {
                if !grower.has_room() {
                    return grown;
                }
                let around = std::f32::consts::TAU * sibling as f32 / level.per_node as f32;
                let roll_rad = match (level.flat, level.floors) {
                    (true, _) => std::f32::consts::PI * f32::from(sibling % 2 == 1) + 0.3 * grower.signed(),
                    (false, true) => turned + around + 0.2 * grower.signed(),
                    (false, false) => grower.turn(),
                };
                let random = lerp(self.shortest, 1.0, grower.random.random());
                let own_m =
                    branch_length_m(father.length_m, dist_m, level.adjust_branch, self.lifetime.over_max, random);
                let angle_deg =
                    lerp(level.first_angle_deg, level.last_angle_deg, place) + level.angle_spread_deg * grower.signed();
                if own_m < SHORTEST_BEAM_M {
                    continue;
                }
                let bud = grower.bud(father, dist_m, angle_deg.to_radians(), roll_rad, order);
                let habit = Habit { segments: 1, crook_rad: level.crook_deg.to_radians(), rise: 0.0, sag: level.sag };
                grown.push(grower.run(bud, own_m, &habit));
            }
        }
        grown
    }
}

/// The points that the crown's envelope must hold: tips and middles of the branches.
fn crown(beams: &[SkeletonBeam]) -> impl Iterator<Item = bevy::math::Vec3> {
    let any_branch = beams.iter().any(|beam| beam.order > 0);
    let crown = beams.iter().filter(move |beam| beam.order > 0 || !any_branch);
    crown.flat_map(|beam| [beam.path(0.5), beam.path(1.0)])
}

/// Checks what both trees have in common.
pub(super) fn validate(
    trunk: &Trunk,
    delta_m: f32,
    shortest: f32,
    ages_years: [f32; 2],
    exponent: f32,
) -> Result<(), SettingError> {
    trunk.validate(TALLEST_M).map_err(|error| error.inside("trunk"))?;
    require("delta_m", delta_m, 0.0..=trunk.height_m)?;
    require("shortest", shortest, 0.0..=1.0)?;
    require("min_age_years", ages_years[0], 0.0..=1000.0)?;
    require("max_age_years", ages_years[1], ages_years[0] + 1.0..=5000.0)?;
    require("pipe_exponent", exponent, 1.5..=4.0)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use rand::SeedableRng;

    /// How many beams each beam of an order bears that are of the next.
    pub(in crate::tree::growth::zaharia) fn children_per_beam(beams: &[SkeletonBeam], order: u8) -> Vec<usize> {
        let mut numbers = vec![0; beams.len()];
        for beam in beams.iter().filter(|beam| beam.order == order + 1) {
            numbers[beam.parent.unwrap() as usize] += 1;
        }
        numbers.into_iter().zip(beams).filter(|(_, beam)| beam.order == order).map(|(number, _)| number).collect()
    }

    /// `l_branch / (length_father - dist)` of all branches of an order, measured on the beams. Those that sit closest to
    /// their father's tip, where the quotient of two small lengths is inexact, are left out.
    pub(in crate::tree::growth::zaharia) fn length_ratios(beams: &[SkeletonBeam], order: u8) -> Vec<f32> {
        let mut left_m = vec![0.0; beams.len()];
        // From tip to root: what is left of a branch beyond the end of each of its beams.
        for index in (0..beams.len()).rev() {
            let beam = &beams[index];
            let continued =
                beam.parent.filter(|&parent| beam.attach >= 1.0 && beams[parent as usize].order == beam.order);
            if let Some(parent) = continued {
                left_m[parent as usize] = left_m[index] + beam.length_m;
            }
        }
        let ratio = |beam: &SkeletonBeam| {
            let parent = beam.parent? as usize;
            let room_m = left_m[parent] + (1.0 - beam.attach) * beams[parent].length_m;
            (room_m > 0.05 * beams[parent].length_m).then(|| beam.length_m / room_m)
        };
        beams.iter().filter(|beam| beam.order == order).filter_map(ratio).collect()
    }

    #[test]
    fn ages_are_clamped_to_the_lifetime() {
        let half = Lifetime::at(105.0, 10.0, 200.0);
        assert!((no_branch(4.0, 12.0, half.share) - 8.0).abs() < 1e-4 && half.over_max == 0.525);
        assert_eq!((Lifetime::at(900.0, 10.0, 200.0).share, Lifetime::at(-3.0, 10.0, 200.0).share), (1.0, 0.0));
    }

    /// The trunk is `length age / max_age` and `delta` off at most.
    #[test]
    fn the_trunk_grows_linearly_with_age() {
        let trunk = Trunk { height_m: 20.0, segments: 1, ..Trunk::default() };
        for (age_years, grown_m) in [(25.0, 5.0), (50.0, 10.0), (100.0, 20.0)] {
            let plan = |nodes: f32| Plan {
                trunk: &trunk,
                delta_m: 1.5,
                shortest: 1.0,
                lifetime: Lifetime::at(age_years, 0.0, 100.0),
                shape: EnvelopeShape::Cone,
                levels: vec![level(nodes)],
            };
            let length_m = |seed: u64, nodes: f32| {
                let mut random = rand::rngs::Xoshiro256PlusPlus::seed_from_u64(seed);
                plan(nodes).grow(&mut random).beams[0].length_m
            };
            assert!((length_m(1, 1.0) - grown_m).abs() < 1e-4, "random(1) is 0");
            let lengths: Vec<f32> = (0..60).map(|seed| length_m(seed, 10.0)).collect();
            assert!(
                lengths.iter().all(|m| (m - grown_m).abs() <= 1.35 + 1e-4),
                "delta random(10) / 10 is 1.35 at most"
            );
            let (least, greatest) = lengths.iter().fold((f32::MAX, 0.0_f32), |(l, g), &m| (l.min(m), g.max(m)));
            assert!(least < grown_m - 1.0 && greatest > grown_m + 1.0, "both signs: {least} to {greatest}");
        }
    }

    fn level(nodes: f32) -> Level {
        Level {
            adjust_branch: 0.0,
            nodes,
            per_node: 1,
            floors: false,
            first_at: 0.2,
            first_angle_deg: 60.0,
            last_angle_deg: 40.0,
            angle_spread_deg: 0.0,
            flat: false,
            sag: 0.0,
            crook_deg: 0.0,
        }
    }
}
