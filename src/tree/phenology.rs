//! Phenology: what the leaves of a species do over the year.
//!
//! Time `t` runs from 0 at midwinter to 1 at the next. Every cluster of leaves has a lag `l`, alike within a branch, and a
//! rank `r`, its own; both make a crown change in patches. With `S` the smoothstep
//!
//! ```text
//! size   = S(flush -+ flush_length/2)(t + l) (1 - S(d, d + DROP)(t)),    d = fall + fall_length (r - 1/2)
//! youth  = 1 - S(flush, flush + YOUTH)(t + l)
//! autumn = S(turn -+ turn_length/2)(t + l)
//! ```
//!
//! An evergreen keeps its size and its colour; its new shoots are young for a while. The twin for drawing is
//! `render/shaders/season.wesl`.

use crate::setting::{SettingError, require, require_colour};
use bevy::{math::FloatExt, reflect::Reflect};
use serde::{Deserialize, Serialize};

/// The year of a species. Times are shares of the year from midwinter on.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Phenology {
    /// Whether leaves stay over winter.
    pub evergreen: bool,
    /// When half of the leaves are out, 0.05 to 0.6.
    pub flush: f32,
    /// How long they take to unfold, 0.01 to 0.3.
    pub flush_length: f32,
    /// When half of the leaves have turned, `flush` to 0.95.
    pub turn: f32,
    /// How long they take to turn, 0.01 to 0.4.
    pub turn_length: f32,
    /// When half of the leaves have fallen, `turn` to 0.97.
    pub fall: f32,
    /// How long it takes until all have fallen, 0.01 to 0.4.
    pub fall_length: f32,
    /// How far branches and trees are apart in time, 0 to 0.2.
    pub patchiness: f32,
    /// Colour of unfolding leaves, sRGB 0 to 1.
    pub spring_colour: [f32; 3],
    /// The two ends of the colours in autumn, sRGB 0 to 1; each cluster has one between.
    pub autumn_colours: [[f32; 3]; 2],
}

impl Default for Phenology {
    /// A pedunculate oak in central Europe: leaves out by the end of April, brown by the end of October.
    fn default() -> Self {
        Self {
            evergreen: false,
            flush: 0.32,
            flush_length: 0.06,
            turn: 0.80,
            turn_length: 0.10,
            fall: 0.86,
            fall_length: 0.10,
            patchiness: 0.05,
            spring_colour: [0.48, 0.60, 0.16],
            autumn_colours: [[0.62, 0.45, 0.12], [0.55, 0.28, 0.10]],
        }
    }
}

/// What a cluster of leaves looks like at a moment of the year, each 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeafState {
    /// How much of the leaves is there; 0 before they unfold and after they have fallen. The twigs of a spray stay.
    pub size: f32,
    /// How much of the colour is that of spring.
    pub youth: f32,
    /// How much of it is that of autumn.
    pub autumn: f32,
    /// Whether it has fallen so lately that its leaves are still seen drifting down now and then.
    pub drifting: bool,
}

/// How long a cluster takes to fall, as a share of the year: five days.
pub(super) const DROP: f32 = 0.014;
/// How long after that some of its leaves are still in the air, as a share of the year: two weeks.
const DRIFT: f32 = 0.04;
/// So much earlier than its species does a tree lose its leaves at most: five weeks.
const EARLIEST: f32 = 0.1;
/// How far a leaf in the air may get, m.
const FARTHEST_M: f32 = 5.0;
/// How long leaves stay light after they have unfolded, as a share of the year: seven weeks.
const YOUTH: f32 = 0.13;

impl Phenology {
    /// How far a leaf that has fallen may drift to either side, m.
    pub const DRIFT_M: f32 = FARTHEST_M;

    /// Whether a tree may have leaves in the air at that time of the year, be it up to five weeks early or late itself.
    #[must_use]
    pub fn may_shed(&self, year: f32) -> bool {
        !self.evergreen && year >= self.fall - 0.5 * self.fall_length - EARLIEST
    }

    /// Whether a tree has neither leaves nor any in the air.
    #[must_use]
    pub fn is_bare(&self, year: f32) -> bool {
        let is_gone = |leaf: LeafState| leaf.size < 1e-3 && !leaf.drifting;
        // Leaves unfold first where they are early, and the last to fall is that of the highest rank.
        [-1.0, 1.0].into_iter().all(|lag| [0.0, 1.0].into_iter().all(|rank| is_gone(self.leaves(year, lag, rank))))
    }

    pub(super) fn validate(&self) -> Result<(), SettingError> {
        require("flush", self.flush, 0.05..=0.6)?;
        require("flush_length", self.flush_length, 0.01..=0.3)?;
        require("turn", self.turn, self.flush..=0.95)?;
        require("turn_length", self.turn_length, 0.01..=0.4)?;
        require("fall", self.fall, self.turn..=0.97)?;
        require("fall_length", self.fall_length, 0.01..=0.4)?;
        require("patchiness", self.patchiness, 0.0..=0.2)?;
        require_colour("spring_colour", self.spring_colour)?;
        let autumn = self.autumn_colours.into_iter().enumerate();
        autumn.into_iter().try_for_each(|(index, colour)| require_colour(&format!("autumn_colours[{index}]"), colour))
    }

    /// The leaves of a cluster at `year` (0 to 1). `lag` is -1 (late) to 1 (early), `rank` 0 (falls first) to 1.
    #[must_use]
    pub fn leaves(&self, year: f32, lag: f32, rank: f32) -> LeafState {
        let own = year + self.patchiness * lag;
        let youth = 1.0 - own.smoothstep(self.flush, self.flush + YOUTH);
        if self.evergreen {
            let unfolding = own.smoothstep(self.flush - 0.5 * self.flush_length, self.flush);
            return LeafState { size: 1.0, youth: youth * unfolding, autumn: 0.0, drifting: false };
        }
        let half = 0.5 * self.flush_length;
        let unfolded = own.smoothstep(self.flush - half, self.flush + half);
        // The last leaf is down by the year's end, so that no leaf jumps on to the new year's bare twig.
        let falls = (self.fall + self.fall_length * (rank - 0.5)).min(1.0 - DROP);
        let half = 0.5 * self.turn_length;
        LeafState {
            size: unfolded * (1.0 - year.smoothstep(falls, falls + DROP)),
            youth,
            autumn: own.smoothstep(self.turn - half, self.turn + half),
            drifting: (falls + DROP..falls + DROP + DRIFT).contains(&year),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean_size(phenology: &Phenology, year: f32) -> f32 {
        let clusters = (0..400).map(|k| (-1.0 + 2.0 * (k % 20) as f32 / 19.0, (k / 20) as f32 / 19.0));
        clusters.map(|(lag, rank)| phenology.leaves(year, lag, rank).size).sum::<f32>() / 400.0
    }

    #[test]
    fn a_deciduous_tree_flushes_turns_and_sheds() {
        let oak = Phenology::default();
        assert_eq!(mean_size(&oak, 0.0), 0.0);
        assert_eq!(mean_size(&oak, 0.99999), 0.0);
        assert_eq!(mean_size(&oak, 0.6), 1.0);
        assert!((mean_size(&oak, oak.flush) - 0.5).abs() < 0.05);
        assert!((mean_size(&oak, oak.fall) - 0.5).abs() < 0.1);
        let summer = oak.leaves(0.6, 0.0, 0.5);
        assert_eq!((summer.youth, summer.autumn), (0.0, 0.0));
        assert!((oak.leaves(oak.turn, 0.0, 0.5).autumn - 0.5).abs() < 1e-3);
    }

    #[test]
    fn leaves_are_in_the_air_only_in_autumn() {
        let oak = Phenology::default();
        let share = |year: f32| {
            let clusters = (0..200).map(|rank| oak.leaves(year, 0.0, rank as f32 / 199.0));
            clusters.filter(|leaves| leaves.drifting).inspect(|leaves| assert_eq!(leaves.size, 0.0)).count()
        };
        assert!(share(oak.fall) > 50);
        for year in [0.0, 0.3, 0.6, 0.999] {
            assert_eq!(share(year), 0, "at {year}");
        }
    }

    #[test]
    fn an_evergreen_keeps_its_leaves_and_its_colour() {
        let fir = Phenology { evergreen: true, ..Phenology::default() };
        for year in 0..100 {
            let leaves = fir.leaves(year as f32 / 100.0, 0.3, 0.2);
            assert_eq!((leaves.size, leaves.autumn), (1.0, 0.0));
        }
        assert_eq!(fir.leaves(0.1, 0.0, 0.5).youth, 0.0);
        assert!(fir.leaves(fir.flush + 0.02, 0.0, 0.5).youth > 0.8);
        assert_eq!(fir.leaves(0.7, 0.0, 0.5).youth, 0.0);
    }

    #[test]
    fn a_tree_is_bare_while_no_cluster_has_a_leaf() {
        let oak = Phenology::default();
        let clusters = || (0..21).flat_map(|lag| (0..21).map(move |rank| (0.1 * lag as f32 - 1.0, 0.05 * rank as f32)));
        let mut bare = 0;
        for step in 0..400 {
            let year = step as f32 / 400.0;
            let mut leaves = clusters().map(|(lag, rank)| oak.leaves(year, lag, rank));
            let is_bare = leaves.all(|leaf| leaf.size < 1e-3 && !leaf.drifting);
            assert_eq!(oak.is_bare(year), is_bare, "at {year}");
            bare += usize::from(is_bare);
        }
        assert!((80..200).contains(&bare), "{bare} of 400: some months of winter");
        assert!(!Phenology { evergreen: true, ..oak }.is_bare(0.0));
    }

    /// The year is a circle: what the last moment shows the first one shows as well.
    #[test]
    fn leaves_change_continuously_over_the_year_and_across_its_end() {
        for evergreen in [false, true] {
            let species = Phenology { evergreen, fall: 0.97, fall_length: 0.4, ..Phenology::default() };
            let mut before = species.leaves(1.0, 0.4, 0.9);
            for step in 0..=4000 {
                let now = species.leaves(step as f32 / 4000.0, 0.4, 0.9);
                let jump = (now.size - before.size).abs().max((now.youth - before.youth).abs() * now.size);
                assert!(jump < 0.06, "{before:?} to {now:?} at step {step}");
                before = now;
            }
        }
    }

    #[test]
    fn extremes_are_finite() {
        let odd = Phenology { flush: 0.6, turn: 0.6, fall: 0.6, flush_length: 0.01, ..Phenology::default() };
        odd.validate().unwrap();
        for year in [f32::MIN_POSITIVE, 0.6, 1.0] {
            let leaves = odd.leaves(year, 1.0, 1.0);
            assert!((0.0..=1.0).contains(&leaves.size) && leaves.youth.is_finite() && leaves.autumn.is_finite());
        }
    }
}
