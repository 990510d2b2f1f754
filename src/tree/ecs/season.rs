//! The time of the year.

use bevy::prelude::*;

/// The time of the year, the same for all trees: change it as fast or as slowly as your game's calendar runs.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct Season {
    /// 0 and 1 are midwinter (north of the equator: the turn of the year), 0.25 spring, 0.5 midsummer, 0.75 autumn. Other
    /// values wrap around; what is not a number is midsummer.
    pub year: f32,
}

impl Season {
    /// The year's start.
    pub const WINTER: Self = Self { year: 0.0 };
    /// When most leaves unfold.
    pub const SPRING: Self = Self { year: 0.34 };
    /// The longest day and a little later.
    pub const SUMMER: Self = Self { year: 0.55 };
    /// When most leaves have turned.
    pub const AUTUMN: Self = Self { year: 0.81 };

    /// The time of the year in 0..1.
    #[must_use]
    pub fn wrapped(self) -> f32 {
        let year = self.year.rem_euclid(1.0);
        if year.is_finite() { year.min(1.0 - f32::EPSILON) } else { Self::SUMMER.year }
    }
}

impl Default for Season {
    fn default() -> Self {
        Self::SUMMER
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn years_wrap_around() {
        for (year, wrapped) in [(0.25, 0.25), (1.25, 0.25), (-0.75, 0.25), (f32::NAN, 0.55), (f32::INFINITY, 0.55)] {
            assert_eq!(Season { year }.wrapped(), wrapped);
        }
        assert!(Season { year: -1e-9 }.wrapped() < 1.0);
    }
}
