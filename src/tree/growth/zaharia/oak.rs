//! Zaharia's oak: branches "placed around the trunk at positions and rotation angles randomly distributed".

use bevy::reflect::Reflect;
use rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use serde::{Deserialize, Serialize};

use super::plan::{self, Level, Lifetime, Plan, no_branch};
use crate::{
    setting::{SettingError, require},
    tree::{
        growth::{age::Stage, envelope::EnvelopeShape, grower::GrownBranches, reeves_blau::ORDERS_LIMIT, trunk::Trunk},
        leaf::LeafEllipsoids,
        skeleton::is_terminal,
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
    /// Chosen so that [`counts`](Self::counts) is near his table 2 between 100 and 200 years. Its branches become 1.44 times as
    /// many from the first row to the last, which three levels do if each number of sub-branches grows by 1.13: between 100
    /// and 200 years it grows here from 12.4 to 13.8, by 1.11, and would be 11 at the very beginning.
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
            min_branch: 11.0,
            max_branch: 13.8,
            min_age_years: 0.0,
            max_age_years: 200.0,
            adjust_branch: vec![0.05, 0.8, 1.7],
            first_at: 0.25,
            shortest: 0.7,
            first_angle_deg: 70.0,
            last_angle_deg: 35.0,
            angle_spread_deg: 12.0,
            crook_deg: 25.0,
            pipe_exponent: 2.2,
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
        require("crook_deg", self.crook_deg, 0.0..=60.0)
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

    /// Branches of the oak of this age and seed, and the leaves on those that bear no others, to be compared with his table 2.
    #[must_use]
    pub fn counts(&self, leaves: &LeafEllipsoids, age_years: f32, seed: u64) -> Counts {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let beams = self.grow(&Stage::mature(age_years), &mut random).beams;
        let terminal = beams.iter().zip(is_terminal(&beams)).filter(|(_, is_terminal)| *is_terminal);
        Counts {
            branches: beams.iter().filter(|beam| beam.order > 0).count(),
            leaves: terminal.map(|(beam, _)| leaves.count_on(beam.length_m) as usize).sum(),
        }
    }
}

#[cfg(test)]
mod tests;
