//! The identity of a stem.

use crate::setting::SettingError;
use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;

/// In place of the bits of x: the stem was planted by the game. As a number it is none.
const PLANTED: u32 = u32::MAX;

/// Which stem of a forest it is: the same on every run, thread and machine, whatever way the viewers came, and after saving.
///
/// A stem of the plan is known by its place on the map alone, which follows from the plan's seed and the number of its area. So it keeps its
/// id when other areas are edited, what is kept free, the size of the cells, the ground, or its own area's species and ages; and it is the
/// same stem again when it comes back. Of two stems at exactly the same place, which a `least_distance_m` of 0 does not rule out, both have
/// one id. A stem that the game has planted is known by its number: it has the same on two runs where the same is planted in the same order.
///
/// Every near tree of a forest has it as a component. It takes 8 bytes.
#[derive(Component, Reflect, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[component(immutable)]
#[reflect(Component)]
#[serde(try_from = "u64", into = "u64")]
pub struct StemId(u64);

impl StemId {
    pub(super) const LEAST: Self = Self(0);
    pub(super) const GREATEST: Self = Self(u64::MAX);

    /// Of the plan's stem at a place (x, z), m.
    pub(super) fn at(place_m: Vec2) -> Self {
        // -0 and 0 are one place.
        let [x, z] = (place_m + 0.0).to_array().map(|value| u64::from(value.to_bits()));
        Self(x << 32 | z)
    }

    /// Of the stem that the game has planted as that one of all.
    pub(super) fn planted(number: u32) -> Self {
        Self(u64::from(PLANTED) << 32 | u64::from(number))
    }

    /// Whether the game has planted it.
    #[must_use]
    pub fn is_planted(self) -> bool {
        (self.0 >> 32) as u32 == PLANTED
    }

    /// Where (x, z) it stands in the forest's own frame, m, if it is a stem of the plan.
    #[must_use]
    pub fn place_m(self) -> Option<Vec2> {
        let place = Vec2::new(f32::from_bits((self.0 >> 32) as u32), f32::from_bits(self.0 as u32));
        (!self.is_planted()).then_some(place)
    }

    /// The id as a number.
    #[must_use]
    pub fn to_bits(self) -> u64 {
        self.0
    }
}

impl From<StemId> for u64 {
    fn from(id: StemId) -> Self {
        id.0
    }
}

impl TryFrom<u64> for StemId {
    type Error = SettingError;

    /// # Errors
    /// Where no stem can have that number.
    fn try_from(bits: u64) -> Result<Self, SettingError> {
        let id = Self(bits);
        let is_id = id.place_m().is_none_or(|place| place.is_finite() && Self::at(place) == id);
        is_id.then_some(id).ok_or_else(|| SettingError::new("id", bits, "the number of a stem"))
    }
}

impl fmt::Display for StemId {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.place_m() {
            Some(place) => write!(f, "the stem at {}, {}", place.x, place.y),
            None => write!(f, "planted stem {}", self.0 as u32),
        }
    }
}

impl fmt::Debug for StemId {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stem_of_the_plan_is_known_by_its_place_and_others_by_their_number() {
        let place = Vec2::new(-12.3456, 70_000.1);
        assert_eq!(StemId::at(place).place_m(), Some(place));
        assert_ne!(StemId::at(place), StemId::at(Vec2::new(place.x.next_up(), place.y)));
        assert_eq!(StemId::at(Vec2::new(-0.0, 1.0)), StemId::at(Vec2::new(0.0, 1.0)));
        let planted = StemId::planted(7);
        assert!(planted.is_planted() && planted.place_m().is_none() && !StemId::at(place).is_planted());
        assert_eq!(
            (StemId::at(Vec2::new(1.5, -2.0)).to_string(), planted.to_string().as_str()),
            ("the stem at 1.5, -2".into(), "planted stem 7")
        );
    }

    #[test]
    fn numbers_come_back_and_those_of_no_stem_are_refused() {
        for id in [StemId::at(Vec2::new(3.25, -9.0)), StemId::planted(0), StemId::planted(u32::MAX)] {
            assert_eq!(StemId::try_from(id.to_bits()), Ok(id));
            let text = ron::to_string(&id).unwrap();
            assert_eq!((text.clone(), ron::from_str(&text)), (id.to_bits().to_string(), Ok(id)));
        }
        let infinite = u64::from(f32::INFINITY.to_bits()) << 32;
        let minus_zero = u64::from((-0.0_f32).to_bits());
        for bits in [infinite, minus_zero, u64::from(f32::NAN.to_bits())] {
            assert!(StemId::try_from(bits).unwrap_err().to_string().starts_with("`id` is "), "{bits}");
        }
    }
}
