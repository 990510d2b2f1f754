//! Zaharia's oak: branches "placed around the trunk at positions and rotation angles randomly distributed".

use bevy::reflect::Reflect;
use rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use serde::{Deserialize, Serialize};

use super::plan::{self, Level, Lifetime, Plan, no_branch};
use crate::{
    setting::{SettingError, require},
    tree::growth::{
        age::Stage, envelope::EnvelopeShape, grower::GrownBranches, reeves_blau::ORDERS_LIMIT, trunk::Trunk,
    },
};

/// Parameters of Zaharia's oak, in his words where he has any.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Oak {
    /// The trunk at `max_age_years`; its `height_m` is his `length`.
    pub trunk: Trunk,
    /// His `delta`: how far the trunk's length may be off, m: 0 to the trunk's height.
    pub delta_m: f32,
    /// Sub-branches of each branch at `min_age_years`, 0 to 40.
    pub min_branch: f32,
    /// Sub-branches of each branch at `max_age_years`, `min_branch` to 40.
    pub max_branch: f32,
    /// Age at which growth begins, years: 0 to 1000.
    pub min_age_years: f32,
    /// Age at which it ends, years: at least a year more, up to 5000.
    pub max_age_years: f32,
    /// His `adjust_branch` for each level of branches, -1 to 2, rising with the level: at most 5 levels.
    pub adjust_branch: Vec<f32>,
    /// Lowest place of a branch on its father, 0 to 0.95.
    pub first_at: f32,
    /// Least value of his `random()`, 0 to 1.
    pub shortest: f32,
    /// Angle from the father at the lowest branch, degrees: 0 to 150.
    pub first_angle_deg: f32,
    /// The same at the highest, degrees: 0 to 150.
    pub last_angle_deg: f32,
    /// Random part of the angle, degrees: 0 to 60.
    pub angle_spread_deg: f32,
    /// How crooked branches are, degrees: 0 to 60.
    pub crook_deg: f32,
    /// Exponent of the pipe model, 1.5 to 4.
    pub pipe_exponent: f32,
    /// Leaves for each metre of a terminal branch, 0 to 100.
    pub leaves_per_m: f32,
    /// Most leaves on a terminal branch, 0 to 100: his 10.
    pub most_leaves: u32,
}

/// How many branches and leaves a tree has, as table 2 counts them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Branches, the trunk not among them.
    pub branches: usize,
    /// Leaves on terminal branches.
    pub leaves: usize,
}

impl Default for Oak {
    /// Chosen so that [`counts`](Self::counts) meets his table 2 between 100 and 200 years.
    fn default() -> Self {
        Self {
            trunk: Trunk {
                height_m: 15.0,
                radius_m: 0.55,
                segments: 4,
                flare: 0.7,
                crook_deg: 7.0,
                ..Trunk::default()
            },
            delta_m: 1.5,
            min_branch: 13.4,
            max_branch: 13.8,
            min_age_years: 0.0,
            max_age_years: 200.0,
            adjust_branch: vec![0.0, 0.5, 1.2],
            first_at: 0.25,
            shortest: 0.7,
            first_angle_deg: 70.0,
            last_angle_deg: 35.0,
            angle_spread_deg: 12.0,
            crook_deg: 25.0,
            pipe_exponent: 2.2,
            leaves_per_m: 10.0,
            most_leaves: 10,
        }
    }
}

impl Oak {
    pub(in crate::tree) fn validate(&self) -> Result<(), SettingError> {
        let ages_years = [self.min_age_years, self.max_age_years];
        plan::validate(&self.trunk, self.delta_m, self.shortest, ages_years, self.pipe_exponent)?;
        require("min_branch", self.min_branch, 0.0..=40.0)?;
        require("max_branch", self.max_branch, self.min_branch..=40.0)?;
        if self.adjust_branch.len() > ORDERS_LIMIT {
            return Err(SettingError::new("adjust_branch", self.adjust_branch.len(), "at most 5 levels"));
        }
        for (level, &adjust) in self.adjust_branch.iter().enumerate() {
            require(&format!("adjust_branch[{level}]"), adjust, -1.0..=2.0)?;
        }
        require("first_at", self.first_at, 0.0..=0.95)?;
        require("first_angle_deg", self.first_angle_deg, 0.0..=150.0)?;
        require("last_angle_deg", self.last_angle_deg, 0.0..=150.0)?;
        require("angle_spread_deg", self.angle_spread_deg, 0.0..=60.0)?;
        require("crook_deg", self.crook_deg, 0.0..=60.0)?;
        require("leaves_per_m", self.leaves_per_m, 0.0..=100.0)?;
        require("most_leaves", self.most_leaves as f32, 0.0..=100.0)
    }

    pub(in crate::tree) fn grow(&self, stage: &Stage, random: &mut impl Rng) -> GrownBranches {
        let lifetime = Lifetime::at(stage.years, self.min_age_years, self.max_age_years);
        let level = |&adjust_branch: &f32| Level {
            adjust_branch,
            nodes: no_branch(self.min_branch, self.max_branch, lifetime.share),
            per_node: 1,
            floors: false,
            first_at: self.first_at,
            first_angle_deg: self.first_angle_deg,
            last_angle_deg: self.last_angle_deg,
            angle_spread_deg: self.angle_spread_deg,
            flat: false,
            sag: 0.02,
            crook_deg: self.crook_deg,
        };
        let plan = Plan {
            trunk: &self.trunk,
            delta_m: self.delta_m,
            shortest: self.shortest,
            lifetime,
            shape: EnvelopeShape::Ellipsoid,
            levels: self.adjust_branch.iter().map(level).collect(),
        };
        plan.grow(random)
    }

    /// Branches and leaves of the oak of this age and seed, to be compared with his table 2: a terminal branch carries
    /// `leaves_per_m` leaves for each metre, at least one and at most `most_leaves`.
    #[must_use]
    pub fn counts(&self, age_years: f32, seed: u64) -> Counts {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let wood = self.grow(&Stage::mature(age_years), &mut random);
        let last_level = self.adjust_branch.len() as u8;
        let on_branch = |length_m: f32| (length_m * self.leaves_per_m).ceil().min(self.most_leaves as f32) as usize;
        let terminal = wood.beams.iter().filter(|beam| beam.order == last_level && last_level > 0);
        Counts {
            branches: wood.beams.iter().filter(|beam| beam.order > 0).count(),
            leaves: terminal.map(|beam| on_branch(beam.length_m)).sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Age, leaves, branches of table 2, each of one random tree.
    const TABLE_2: [(f32, f64, f64); 6] = [
        (100.0, 7673.0, 1755.0),
        (120.0, 6727.0, 1707.0),
        (140.0, 8521.0, 1856.0),
        (160.0, 15497.0, 2561.0),
        (180.0, 13467.0, 2731.0),
        (200.0, 13318.0, 2522.0),
    ];

    fn mean_counts(age_years: f32) -> (f64, f64) {
        let seeds = 12;
        let counts = (0..seeds).map(|seed| Oak::default().counts(age_years, seed));
        let sum = counts.fold((0, 0), |sum, one| (sum.0 + one.leaves, sum.1 + one.branches));
        (sum.0 as f64 / seeds as f64, sum.1 as f64 / seeds as f64)
    }

    #[test]
    fn counts_meet_table_2() {
        for (age_years, leaves, branches) in TABLE_2 {
            let mean = mean_counts(age_years);
            // His own neighbours differ by up to 1.4 in branches and 1.8 in leaves.
            assert!((0.75..1.33).contains(&(mean.1 / branches)), "{age_years}: {} branches", mean.1);
            assert!((0.67..1.5).contains(&(mean.0 / leaves)), "{age_years}: {} leaves", mean.0);
        }
    }

    #[test]
    fn counts_rise_with_age_and_a_sapling_has_few() {
        let branches: Vec<f64> = [20.0, 40.0, 100.0, 200.0].map(|age| mean_counts(age).1).into();
        assert!(branches.windows(2).all(|pair| pair[0] < pair[1]), "{branches:?}");
        assert!(branches[0] < 20.0 && branches[1] < 0.15 * branches[3], "{branches:?}");
    }

    #[test]
    fn the_number_of_branches_is_linear_in_age() {
        let half = Lifetime::at(105.0, 10.0, 200.0);
        assert!((no_branch(4.0, 12.0, half.share) - 8.0).abs() < 1e-4);
        assert_eq!(Lifetime::at(900.0, 10.0, 200.0).share, 1.0);
    }

    #[test]
    fn no_setting_grows_beyond_the_limit() {
        let oak = Oak { min_branch: 40.0, max_branch: 40.0, adjust_branch: vec![1.0; 5], ..Oak::default() };
        oak.validate().unwrap();
        assert!(oak.counts(200.0, 1).branches <= crate::tree::growth::grower::BEAMS_LIMIT);
    }

    #[test]
    fn a_level_out_of_range_is_named() {
        let oak = Oak { adjust_branch: vec![0.0, f32::NAN], ..Oak::default() };
        assert_eq!(oak.validate().unwrap_err().to_string(), "`adjust_branch[1]` is NaN, but must be -1 to 2");
    }
}
