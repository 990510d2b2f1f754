//! Zaharia's fir: branches in floors along the trunk, needles on the last levels.

use bevy::reflect::Reflect;
use rand::Rng;
use serde::{Deserialize, Serialize};

use super::plan::{self, Level, Lifetime, Plan, no_branch};
use crate::{
    setting::{SettingError, require},
    tree::growth::{age::Stage, envelope::EnvelopeShape, grower::GrownBranches, trunk::Trunk},
};

/// Parameters of Zaharia's fir. That branches shorten towards the top, into a cone, comes from his `l_branch` itself. So does
/// that an old fir is broader for its height than a young one.
///
/// His trunk grows by the same length each year. For one of 28 m at 150 years and branches that are not as long as the
/// trunk, `max_age_years` is far beyond any age that is grown: the sizes there are where the lines lead, and no fir's.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Fir {
    /// The trunk at `max_age_years`; its `height_m` is his `length`.
    pub trunk: Trunk,
    /// His `delta`: how far the trunk's length may be off, m: 0 to the trunk's height.
    pub delta_m: f32,
    /// Floors at `min_age_years`, 0 to 300.
    pub min_floors: f32,
    /// Floors at `max_age_years`, `min_floors` to 300.
    pub max_floors: f32,
    /// His branching factor: branches of a floor, 1 to 12.
    pub branching_factor: u32,
    /// Age at which growth begins, years: 0 to 1000.
    pub min_age_years: f32,
    /// Age at which it ends, years: at least a year more, up to 5000.
    pub max_age_years: f32,
    /// His `adjust_branch` of the floors, and of the side branches left and right of them, -1 to 2.
    pub adjust_branch: [f32; 2],
    /// Pairs of side branches on a floor's branch at `max_age_years`, 0 to 40; none at `min_age_years`.
    pub side_pairs: f32,
    /// Lowest floor, as a share of the trunk, 0 to 0.95.
    pub first_at: f32,
    /// Least value of his `random()`, 0 to 1.
    pub shortest: f32,
    /// Angle of the lowest floor's branches from the trunk, degrees: 0 to 150.
    pub first_angle_deg: f32,
    /// The same of the highest, degrees: 0 to 150.
    pub last_angle_deg: f32,
    /// Angle of a side branch from its floor's branch, degrees: 0 to 150.
    pub side_angle_deg: f32,
    /// Sag of the branches' middles as a share of their length, -0.3 to 0.3.
    pub sag: f32,
    /// Exponent of the pipe model, 1.5 to 4.
    pub pipe_exponent: f32,
}

impl Default for Fir {
    /// A silver fir that is 28 m high at 150 years, with his branching factor of 8.
    fn default() -> Self {
        Self {
            trunk: Trunk {
                height_m: 112.0,
                radius_m: 1.28,
                segments: 6,
                lean_deg: 1.0,
                crook_deg: 1.0,
                flare_height_m: 2.0,
                ..Trunk::default()
            },
            delta_m: 2.0,
            min_floors: 2.0,
            max_floors: 130.0,
            branching_factor: 8,
            min_age_years: 1.0,
            max_age_years: 600.0,
            adjust_branch: [0.05, 0.28],
            side_pairs: 16.0,
            first_at: 0.06,
            shortest: 0.65,
            first_angle_deg: 105.0,
            last_angle_deg: 50.0,
            side_angle_deg: 52.0,
            sag: 0.07,
            pipe_exponent: 2.0,
        }
    }
}

impl Fir {
    pub(in crate::tree) fn validate(&self) -> Result<(), SettingError> {
        let ages_years = [self.min_age_years, self.max_age_years];
        plan::validate(&self.trunk, self.delta_m, self.shortest, ages_years, self.pipe_exponent)?;
        require("min_floors", self.min_floors, 0.0..=300.0)?;
        require("max_floors", self.max_floors, self.min_floors..=300.0)?;
        require("branching_factor", self.branching_factor as f32, 1.0..=12.0)?;
        require("adjust_branch[0]", self.adjust_branch[0], -1.0..=2.0)?;
        require("adjust_branch[1]", self.adjust_branch[1], -1.0..=2.0)?;
        require("side_pairs", self.side_pairs, 0.0..=40.0)?;
        require("first_at", self.first_at, 0.0..=0.95)?;
        require("first_angle_deg", self.first_angle_deg, 0.0..=150.0)?;
        require("last_angle_deg", self.last_angle_deg, 0.0..=150.0)?;
        require("side_angle_deg", self.side_angle_deg, 0.0..=150.0)?;
        require("sag", self.sag, -0.3..=0.3)
    }

    pub(in crate::tree) fn grow(&self, stage: &Stage, random: &mut impl Rng) -> GrownBranches {
        let lifetime = Lifetime::at(stage.years, self.min_age_years, self.max_age_years);
        let floors = Level {
            adjust_branch: self.adjust_branch[0],
            nodes: no_branch(self.min_floors, self.max_floors, lifetime.share),
            per_node: self.branching_factor,
            floors: true,
            first_at: self.first_at,
            first_angle_deg: self.first_angle_deg,
            last_angle_deg: self.last_angle_deg,
            angle_spread_deg: 6.0,
            flat: false,
            sag: self.sag,
            crook_deg: 8.0,
        };
        let sides = Level {
            adjust_branch: self.adjust_branch[1],
            nodes: no_branch(0.0, self.side_pairs, lifetime.share),
            per_node: 2,
            first_at: 0.2,
            first_angle_deg: self.side_angle_deg,
            last_angle_deg: self.side_angle_deg,
            flat: true,
            ..floors
        };
        let plan = Plan {
            trunk: &self.trunk,
            delta_m: self.delta_m,
            shortest: self.shortest,
            lifetime,
            shape: EnvelopeShape::Cone,
            levels: vec![floors, sides],
        };
        plan.grow(random)
    }
}

#[cfg(test)]
mod tests {
    use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};

    use super::*;
    use crate::tree::growth::zaharia::plan::tests::length_ratios;

    fn grown(age_years: f32) -> GrownBranches {
        Fir::default().grow(&Stage::mature(age_years), &mut Xoshiro256PlusPlus::seed_from_u64(4))
    }

    /// The branches of a floor hold on at one height, all around the trunk.
    #[test]
    fn branches_grow_in_floors() {
        let wood = grown(120.0);
        let floors: Vec<f32> = wood.beams.iter().filter(|beam| beam.order == 1).map(|beam| beam.base.y).collect();
        let mut heights = floors.clone();
        heights.dedup_by(|one, other| (*one - *other).abs() < 1e-3);
        assert!(floors.len() > 150 && floors.len() <= heights.len() * 8, "{} in {}", floors.len(), heights.len());
        assert!(floors.len() >= heights.len() * 7, "{} in {} floors", floors.len(), heights.len());
    }

    #[test]
    fn the_crown_narrows_towards_the_top() {
        let wood = grown(120.0);
        let top_m = wood.envelope.top_m;
        let reach_m = |from: f32, to: f32| {
            let between = |beam: &&crate::tree::skeleton::SkeletonBeam| {
                beam.order == 1 && (from..to).contains(&(beam.base.y / top_m))
            };
            let reaches = wood.beams.iter().filter(between).map(|beam| beam.path(1.0).with_y(0.0).length());
            reaches.fold(0.0, f32::max)
        };
        // `length_father - dist` at the bands' lower ends is as 0.94 : 0.7 : 0.4; chance and the angles are on top.
        let reaches_m = [reach_m(0.0, 0.3), reach_m(0.3, 0.6), reach_m(0.6, 0.9)];
        assert!(reaches_m[0] > 1.15 * reaches_m[1] && reaches_m[1] > 1.4 * reaches_m[2], "{reaches_m:?}");
    }

    /// `l_branch` on grown trees: nothing cancels the age in it.
    #[test]
    fn lengths_grow_with_age_as_the_formula_says() {
        let fir = Fir::default();
        for age_years in [60.0, 100.0, 150.0] {
            for (order, adjust_branch) in (1..).zip(fir.adjust_branch) {
                let ratios = length_ratios(&grown(age_years).beams, order);
                let longest = adjust_branch + age_years / fir.max_age_years;
                let (least, greatest) = ratios.iter().fold((f32::MAX, 0.0_f32), |(l, g), &r| (l.min(r), g.max(r)));
                let mean = ratios.iter().sum::<f32>() / ratios.len() as f32 / longest;
                assert!(ratios.len() > 100 && (0.80..0.90).contains(&mean), "order {order} at {age_years}: {mean}");
                assert!(
                    least > 0.64 * longest && greatest < 1.01 * longest,
                    "{order} at {age_years}: {least} {greatest}"
                );
            }
        }
    }

    /// Floors are linear in age, and a floor bears as many branches as the factor says.
    #[test]
    fn the_number_of_floors_is_linear_in_age() {
        let fir = Fir { min_floors: 4.0, max_floors: 64.0, side_pairs: 0.0, first_at: 0.0, ..Fir::default() };
        let fir = Fir { min_age_years: 100.0, adjust_branch: [1.0, 0.0], ..fir };
        for (age_years, floors) in [(100.0, 4.0), (225.0, 19.0), (350.0, 34.0), (600.0, 64.0)] {
            let branches = |seed| {
                let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
                fir.grow(&Stage::mature(age_years), &mut random).beams.iter().filter(|beam| beam.order == 1).count()
            };
            let mean = (0..8).map(branches).sum::<usize>() as f32 / 8.0 / fir.branching_factor as f32;
            assert!((mean - floors).abs() < 0.02 * floors, "{mean} floors at {age_years}");
        }
    }

    #[test]
    fn an_older_fir_has_more_floors_and_more_branches() {
        let beams = [5.0, 20.0, 60.0, 150.0].map(|age| grown(age).beams.len());
        assert!(beams.windows(2).all(|pair| pair[0] < pair[1]), "{beams:?}");
    }
}
