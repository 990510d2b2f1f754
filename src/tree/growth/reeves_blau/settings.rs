//! The settings of a stochastic tree.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use crate::{
    setting::{SettingError, require},
    tree::growth::{envelope::Envelope, habit::Habit, trunk::Trunk},
};

/// Most orders of branches.
pub const ORDERS_LIMIT: usize = 5;

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
    /// Upward pull over the whole branch (negative: gravity's), -4 to 4: with 4 segments, -3 lets a level twig hang
    /// straight down.
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
    pub(in crate::tree) fn validate(&self) -> Result<(), SettingError> {
        self.envelope.validate().map_err(|error| error.inside("envelope"))?;
        self.trunk.validate(self.envelope.top_m).map_err(|error| error.inside("trunk"))?;
        require("size_spread", self.size_spread, 0.0..=0.8)?;
        require("shade_pruning", self.shade_pruning, 0.0..=1.0)?;
        require("pipe_exponent", self.pipe_exponent, 1.5..=4.0)?;
        if self.orders.len() > ORDERS_LIMIT {
            return Err(SettingError::new("orders", self.orders.len(), "at most 5 orders"));
        }
        self.orders
            .iter()
            .enumerate()
            .try_for_each(|(index, order)| order.validate().map_err(|error| error.inside(&format!("orders[{index}]"))))
    }
}

impl BranchOrder {
    fn validate(&self) -> Result<(), SettingError> {
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
        require("rise", self.rise, -4.0..=4.0)?;
        require("sag", self.sag, -0.3..=0.3)
    }

    pub(super) fn habit(&self) -> Habit {
        Habit { segments: self.segments, crook_rad: self.crook_deg.to_radians(), rise: self.rise, sag: self.sag }
    }
}
