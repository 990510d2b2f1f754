//! Structural trees after Aono & Kunii, "Botanical Tree Image Generation" (IEEE Computer Graphics and Applications 4(5),
//! 1984), in the formulation of Prusinkiewicz & Lindenmayer (The Algorithmic Beauty of Plants, 1990, section 2.1): the
//! paper itself was not at hand.
//!
//! The same branching is repeated: a piece of stem of length `l` and diameter `d` ends in a node; from it shoots leave at
//! their angles, the `i`-th with length `r_i l` and diameter `w_i d`. One of them carries the axis on. Aono & Kunii's
//! branchings are
//! - monopodial: the axis goes straight on, laterals leave it in the arrangement of its leaves;
//! - dichotomous: two shoots, at angles of their own, in a plane that turns from node to node;
//! - ternary: three shoots around the axis.
//!
//! Every shoot is then bent by what attracts it, `direction + sum of strength * towards`, by the wind in the same manner,
//! and by chance (their deviation). Age: the number of generations grows with the share of the mature height, and a stem
//! with `g` generations and the ratio `r` of its axis is `l (1 - r^g) / (1 - r)` long, which fixes `l`. A sapling so has the
//! few branchings that it has had time for.

use std::f32::consts::PI;

use bevy::{math::Vec3, reflect::Reflect};
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use super::{
    age::Stage,
    envelope::{Envelope, EnvelopeShape},
    grower::{BEAMS_LIMIT, Bud, Grower, GrownBranches, SHORTEST_BEAM_M, leave, lerp},
    habit::Habit,
    phyllotaxis::Phyllotaxis,
    trunk::Trunk,
};
use crate::setting::{SettingError, require};

/// Most branchings one after the other.
pub const GENERATIONS_LIMIT: u32 = 12;
/// A shoot's root beside its parent's: pipes.rs gives the reason.
const CHILD_TO_PARENT_LIMIT: f32 = 0.85;
/// Thinnest wood, m.
const THINNEST_M: f32 = 0.001;

/// Parameters of a structural tree.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AonoKunii {
    /// The mature trunk: its `height_m` is the length of the whole main axis. It has one stem, and `segments` is not used.
    pub trunk: Trunk,
    /// What is repeated.
    pub branching: Branching,
    /// Branchings one after the other in the mature tree, 1 to 12.
    pub generations: u32,
    /// Share of the mature axis' first piece that stays free of branches, as lengthening of that piece, 0 to 3.
    pub bole: f32,
    /// Random part of every angle, degrees: 0 to 60.
    pub deviation_deg: f32,
    /// Random part of every length, 0 to 0.9.
    pub length_deviation: f32,
    /// Gravity's pull on each shoot (negative: shoots rise), -1 to 1.
    pub gravity: f32,
    /// Where the sunlight draws each shoot.
    pub sunlight: Attraction,
    /// Where the prevailing wind has bent each shoot.
    pub wind: Attraction,
    /// Sag of each piece's middle as a share of its length, -0.3 to 0.3.
    pub sag: f32,
}

/// A pull on every shoot.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Attraction {
    /// Direction of the pull; of any length but zero.
    pub towards: [f32; 3],
    /// How strongly, 0 to 1; negative drives shoots away (their inhibitor), down to -1.
    pub strength: f32,
}

/// One branching.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Branching {
    /// The axis goes on, and bears laterals.
    Monopodial {
        /// How the axis goes on; its angle is how far it strays, degrees: 0 to 90.
        axis: Shoot,
        /// What leaves it.
        lateral: Shoot,
        /// How laterals are arranged along the axis.
        arrangement: Phyllotaxis,
    },
    /// Two shoots on either side.
    Dichotomous {
        /// The one that carries the axis on, and the other.
        shoots: [Shoot; 2],
        /// Turn of their plane from node to node, degrees: -360 to 360.
        turn_deg: f32,
    },
    /// Three shoots around the axis.
    Ternary {
        /// Each of them.
        shoot: Shoot,
        /// Turns about the axis from the first to the second and to the third, degrees: -360 to 360.
        turns_deg: [f32; 2],
    },
}

/// How a shoot differs from the piece of stem that bears it.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Shoot {
    /// Angle from the stem, degrees: 0 to 150.
    pub angle_deg: f32,
    /// Ratio of lengths, 0.1 to 1.2.
    pub length: f32,
    /// Ratio of diameters, 0.1 to 1.
    pub diameter: f32,
}

impl Default for AonoKunii {
    fn default() -> Self {
        Self {
            trunk: Trunk { height_m: 14.0, radius_m: 0.3, crook_deg: 4.0, ..Trunk::default() },
            branching: Branching::default(),
            generations: 10,
            bole: 0.4,
            deviation_deg: 8.0,
            length_deviation: 0.15,
            gravity: 0.0,
            sunlight: Attraction::default(),
            wind: Attraction { towards: [1.0, 0.0, 0.0], strength: 0.0 },
            sag: 0.02,
        }
    }
}

impl Default for Attraction {
    fn default() -> Self {
        Self { towards: [0.0, 1.0, 0.0], strength: 0.05 }
    }
}

impl Default for Branching {
    /// The monopodial tree "a" of ABOP's table 2.1 (after Honda 1971), whose laterals leave at 45 degrees and are
    /// arranged in a spiral; diameters after Leonardo's rule for two equal shoots, 1/sqrt(2).
    fn default() -> Self {
        Self::Monopodial {
            axis: Shoot { angle_deg: 0.0, length: 0.9, diameter: 0.85 },
            lateral: Shoot::default(),
            arrangement: Phyllotaxis::Spiral,
        }
    }
}

impl Default for Shoot {
    fn default() -> Self {
        Self { angle_deg: 45.0, length: 0.6, diameter: 0.707 }
    }
}

impl AonoKunii {
    pub(in crate::tree) fn validate(&self) -> Result<(), SettingError> {
        self.trunk.validate(120.0).map_err(|error| error.inside("trunk"))?;
        require("trunk.stems", self.trunk.stems as f32, 1.0..=1.0)?;
        self.branching.validate().map_err(|error| error.inside("branching"))?;
        require("generations", self.generations as f32, 1.0..=GENERATIONS_LIMIT as f32)?;
        require("bole", self.bole, 0.0..=3.0)?;
        require("deviation_deg", self.deviation_deg, 0.0..=60.0)?;
        require("length_deviation", self.length_deviation, 0.0..=0.9)?;
        require("gravity", self.gravity, -1.0..=1.0)?;
        self.sunlight.validate().map_err(|error| error.inside("sunlight"))?;
        self.wind.validate().map_err(|error| error.inside("wind"))?;
        require("sag", self.sag, -0.3..=0.3)
    }

    /// Branchings that a tree has had time for.
    fn generations_at(&self, stage: &Stage) -> u32 {
        lerp(1.0, self.generations as f32, stage.height.min(1.0)).round() as u32
    }

    /// Pull on every shoot.
    fn pull(&self) -> Vec3 {
        self.sunlight.vector() + self.wind.vector() - Vec3::Y * self.gravity
    }

    pub(in crate::tree) fn grow(&self, stage: &Stage, random: &mut impl Rng) -> GrownBranches {
        let generations = self.generations_at(stage);
        let trunk = self.trunk.scaled(stage.height, stage.girth);
        let ratio = self.branching.axis_length();
        let pieces: f32 = self.bole + (0..generations).map(|generation| ratio.powi(generation as i32)).sum::<f32>();
        let first_m = trunk.height_m / pieces;

        let mut structure = Structure { parameters: self, grower: Grower::new(None, random) };
        let mut stems = vec![structure.seedling(&trunk, first_m)];
        for _ in 1..generations {
            stems = stems.iter().flat_map(|stem| structure.branch(stem)).collect();
        }
        let beams = structure.grower.beams;
        let tips = beams.iter().skip(1).map(|beam| beam.path(1.0));
        let own = beams.iter().take(1).map(|beam| beam.path(1.0));
        let envelope = Envelope::around(EnvelopeShape::Ellipsoid, own.chain(tips));
        GrownBranches { beams, envelope, trunk_radius_m: trunk.radius_m }
    }
}

impl Attraction {
    fn validate(&self) -> Result<(), SettingError> {
        require("strength", self.strength, -1.0..=1.0)?;
        let length = Vec3::from_array(self.towards).length();
        require("towards", length, 1e-3..=1e3).map_err(|_| {
            SettingError::new("towards", format!("{:?}", self.towards), "a direction of length 0.001 to 1000")
        })
    }

    fn vector(&self) -> Vec3 {
        Vec3::from_array(self.towards).normalize_or_zero() * self.strength
    }
}

impl Branching {
    fn validate(&self) -> Result<(), SettingError> {
        match self {
            Self::Monopodial { axis, lateral, arrangement } => {
                axis.validate().map_err(|error| error.inside("axis"))?;
                lateral.validate().map_err(|error| error.inside("lateral"))?;
                arrangement.validate().map_err(|error| error.inside("arrangement"))
            }
            Self::Dichotomous { shoots, turn_deg } => {
                for (index, shoot) in shoots.iter().enumerate() {
                    shoot.validate().map_err(|error| error.inside(&format!("shoots[{index}]")))?;
                }
                require("turn_deg", *turn_deg, -360.0..=360.0)
            }
            Self::Ternary { shoot, turns_deg } => {
                shoot.validate().map_err(|error| error.inside("shoot"))?;
                turns_deg.iter().try_for_each(|&turn| require("turns_deg", turn, -360.0..=360.0))
            }
        }
    }

    fn axis_length(&self) -> f32 {
        match self {
            Self::Monopodial { axis, .. } => axis.length,
            Self::Dichotomous { shoots, .. } => shoots[0].length,
            Self::Ternary { shoot, .. } => shoot.length,
        }
    }

    /// The shoots of the `node`-th node of an axis, each with its turn about it; the first carries the axis on.
    fn shoots(&self, node: u32) -> Vec<(Shoot, f32)> {
        match *self {
            Self::Monopodial { axis, lateral, arrangement } => {
                let around = |sibling| arrangement.roll_deg(node, sibling).to_radians();
                let laterals = (0..arrangement.per_node()).map(|sibling| (lateral, around(sibling)));
                std::iter::once((axis, around(0) + PI)).chain(laterals).collect()
            }
            Self::Dichotomous { shoots, turn_deg } => {
                let turn = node as f32 * turn_deg.to_radians();
                vec![(shoots[0], turn), (shoots[1], turn + PI)]
            }
            Self::Ternary { shoot, turns_deg } => {
                let [second, third] = turns_deg.map(f32::to_radians);
                vec![(shoot, 0.0), (shoot, second), (shoot, second + third)]
            }
        }
    }
}

impl Shoot {
    fn validate(&self) -> Result<(), SettingError> {
        require("angle_deg", self.angle_deg, 0.0..=150.0)?;
        require("length", self.length, 0.1..=1.2)?;
        require("diameter", self.diameter, 0.1..=1.0)
    }
}

/// The piece of stem that ends in a node.
struct Stem {
    beam: u32,
    /// How long it is before the random part, m.
    length_m: f32,
    /// Its place along its axis.
    node: u32,
}

struct Structure<'a, R> {
    parameters: &'a AonoKunii,
    grower: Grower<'a, R>,
}

impl<R: Rng> Structure<'_, R> {
    fn seedling(&mut self, trunk: &Trunk, first_m: f32) -> Stem {
        let heading = self.grower.turn();
        let direction = leave(Vec3::Y, trunk.lean_deg.to_radians() * self.grower.random.random::<f32>(), heading);
        let bud = Bud { parent: None, attach: 0.0, base: Vec3::ZERO, direction, order: 0 };
        let length_m = first_m * (1.0 + self.parameters.bole);
        self.piece(bud, length_m, trunk.radius_m, self.parameters.branching.shoots(0)[0].0.diameter);
        Stem { beam: 0, length_m: first_m, node: 0 }
    }

    /// All shoots of the node at the end of a stem.
    fn branch(&mut self, stem: &Stem) -> Vec<Stem> {
        let parent = self.grower.beams[stem.beam as usize];
        let mut grown = Vec::new();
        for (index, (shoot, turn)) in self.parameters.branching.shoots(stem.node).into_iter().enumerate() {
            let deviation_rad = self.parameters.deviation_deg.to_radians();
            let angle = shoot.angle_deg.to_radians() + deviation_rad * self.grower.signed();
            let direction = leave(parent.tangent(1.0), angle, turn + deviation_rad * self.grower.signed());
            let direction = (direction + self.parameters.pull()).try_normalize().unwrap_or(direction);
            let length_m = stem.length_m * shoot.length;
            let shorter = 1.0 - self.parameters.length_deviation * self.grower.random.random::<f32>();
            if length_m * shorter < SHORTEST_BEAM_M || self.grower.beams.len() >= BEAMS_LIMIT {
                continue;
            }
            let carries_on = index == 0;
            let order = if carries_on { parent.order } else { parent.order.saturating_add(1) };
            let bud = Bud { parent: Some(stem.beam), attach: 1.0, base: parent.path(1.0), direction, order };
            let beam = self.grower.beams.len() as u32;
            let widest = if carries_on { 1.0 } else { CHILD_TO_PARENT_LIMIT };
            let radius_m = (parent.base_radius_m * shoot.diameter).min(parent.tip_radius_m * widest);
            self.piece(bud, length_m * shorter, radius_m, shoot.diameter);
            grown.push(Stem { beam, length_m, node: if carries_on { stem.node + 1 } else { 0 } });
        }
        grown
    }

    /// One beam, which tapers to the diameter of what carries it on.
    fn piece(&mut self, bud: Bud, length_m: f32, radius_m: f32, taper: f32) {
        let habit = Habit {
            segments: 1,
            crook_rad: self.parameters.trunk.crook_deg.to_radians(),
            rise: 0.0,
            sag: if bud.order == 0 { 0.0 } else { self.parameters.sag },
        };
        let first = self.grower.run(bud, length_m, &habit).beams.start;
        let beam = &mut self.grower.beams[first];
        beam.base_radius_m = radius_m.max(THINNEST_M);
        beam.tip_radius_m = (radius_m * taper).max(THINNEST_M).min(beam.base_radius_m);
    }
}
