//! How loud leaves rustle, and levels for a mixer.
//!
//! Needles sing as thin cylinders do: aeolian tones, dipoles whose power grows with the sixth power of the wind's speed (Curle 1955;
//! Fégeant 1999, "Wind-induced vegetation noise", Acustica 85; Bolin 2009, Acta Acustica united with Acustica 95). Broad leaves
//! flutter and knock against one another; measured levels in woods grow a little more slowly. These works are cited from memory, and
//! the fifth power of broad leaves is chosen.
//!
//! Leaves are sources that do not know of one another: powers add up, and fall with the square of the distance. What one square metre
//! of leaves is heard at in 1 m distance is fitted so that in the middle of a broad-leaved wood with a leaf area index of 5, whose crowns
//! begin 10 m above the listener, 5 m/s in the crowns are heard at 45 dB(A): a wood in a gentle breeze.

use bevy::math::Vec3;

/// What leaves are heard as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeafSound {
    /// They flutter.
    Broad,
    /// They sing.
    Needles,
}

/// Speed at which levels are given, m/s.
const LEVEL_SPEED_M_S: f32 = 5.0;
/// A square metre of leaves in 1 m distance, dB(A).
const BROAD_LEVEL_DB: f32 = 39.0 - 11.0;
const NEEDLE_LEVEL_DB: f32 = 36.0 - 11.0;
/// No leaf is nearer to an ear than this, m.
const NEAREST_M: f32 = 1.0;

/// The level that is 0: leaves that are hardly heard. And the one that is 1: a storm in a wood.
pub const SILENCE_DB: f32 = 20.0;
/// See [`SILENCE_DB`].
pub const STORM_DB: f32 = 70.0;

impl LeafSound {
    /// Intensity of the sound of some leaves, by that of 0 dB: their area, m², their distance, m, and the wind's speed there, m/s.
    #[must_use]
    pub fn intensity(self, area_m2: f32, distance_m: f32, speed_m_s: f32) -> f32 {
        let (level_db, exponent) = match self {
            Self::Broad => (BROAD_LEVEL_DB, 5),
            Self::Needles => (NEEDLE_LEVEL_DB, 6),
        };
        let distance_m = distance_m.max(NEAREST_M);
        let by_speed = (speed_m_s.clamp(0.0, 100.0) / LEVEL_SPEED_M_S).powi(exponent);
        let intensity = 10.0_f32.powf(0.1 * level_db) * area_m2 * by_speed / (distance_m * distance_m);
        if intensity.is_finite() { intensity.max(0.0) } else { 0.0 }
    }
}

/// The level of an intensity, dB(A), not below [`SILENCE_DB`].
#[must_use]
pub fn level_db(intensity: f32) -> f32 {
    (10.0 * intensity.log10()).max(SILENCE_DB)
}

/// A level in decibels as a share, 0 to 1.
#[must_use]
pub fn share_of_level(level_db: f32) -> f32 {
    ((level_db - SILENCE_DB) / (STORM_DB - SILENCE_DB)).clamp(0.0, 1.0)
}

/// A gust is at its full strength when it is faster than the mean wind by so many standard deviations.
const FULL_GUST: f32 = 3.0;

/// How strong a gust is, 0 to 1: by how much the wind is faster than its mean, both m/s, against the standard deviation of gusts, m/s.
#[must_use]
pub fn gust_share(excess_m_s: f32, deviation_m_s: f32) -> f32 {
    if deviation_m_s > 0.0 { (excess_m_s / (FULL_GUST * deviation_m_s)).clamp(0.0, 1.0) } else { 0.0 }
}

/// How fast a level follows: up, and down, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// Time to rise to 63% of a step.
    pub rise_s: f32,
    /// Time to fall to 37%.
    pub fall_s: f32,
}

/// After a jump of the clock by more than this, s, or backwards, a level begins anew.
const LONGEST_STEP_S: f64 = 1.0;

impl Follow {
    /// A level after a time, s, in which it follows a target: exact for any length of the step.
    #[must_use]
    pub fn step(self, level: f32, target: f32, delta_s: f64) -> f32 {
        if !(0.0..=LONGEST_STEP_S).contains(&delta_s) || !level.is_finite() {
            return target;
        }
        let time_s = if target > level { self.rise_s } else { self.fall_s };
        target + (level - target) * (-delta_s as f32 / time_s).exp()
    }
}

/// How near a tree of that distance on the map, m, is to count for the wind at a place: 1 there, 0 at `reach_m`, and continuous.
#[must_use]
pub fn nearness(distance_m: f32, reach_m: f32) -> f32 {
    (1.0 - distance_m / reach_m).clamp(0.0, 1.0).powi(2)
}

/// A speed, m/s, that is never no number.
#[must_use]
pub fn speed_m_s(velocity: Vec3) -> f32 {
    let speed_m_s = velocity.length();
    if speed_m_s.is_finite() { speed_m_s } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integral over a wood, 50 m around, by rings.
    #[test]
    fn a_wood_in_a_gentle_breeze_is_heard_at_45_db() {
        let (area_index, height_m) = (5.0, 10.0_f32);
        let ring = |metre: u16| {
            let radius_m = f32::from(metre) + 0.5;
            let area_m2 = area_index * std::f32::consts::TAU * radius_m;
            LeafSound::Broad.intensity(area_m2, radius_m.hypot(height_m), 5.0)
        };
        let level_db = level_db((0..50).map(ring).sum());
        assert!((level_db - 45.0).abs() < 0.5, "{level_db} dB");
    }

    #[test]
    fn levels_grow_with_the_powers_of_the_speed_and_fall_with_the_distance() {
        let level = |sound: LeafSound, speed_m_s| 10.0 * sound.intensity(100.0, 10.0, speed_m_s).log10();
        for (sound, exponent) in [(LeafSound::Broad, 5.0), (LeafSound::Needles, 6.0)] {
            let doubled_db = level(sound, 12.0) - level(sound, 6.0);
            assert!((doubled_db - 10.0 * exponent * 2.0_f32.log10()).abs() < 1e-3, "{doubled_db}");
        }
        let far = LeafSound::Broad.intensity(100.0, 20.0, 8.0) / LeafSound::Broad.intensity(100.0, 10.0, 8.0);
        assert!((far - 0.25).abs() < 1e-6);
        assert_eq!(level_db(0.0), SILENCE_DB);
        assert_eq!([0.0, 20.0, 45.0, 70.0, 200.0].map(share_of_level), [0.0, 0.0, 0.5, 1.0, 1.0]);
    }

    #[test]
    fn levels_follow_alike_in_few_and_in_many_steps() {
        let follow = Follow { rise_s: 0.2, fall_s: 2.0 };
        let after = |steps: u32, from, target| {
            (0..steps).fold(from, |level, _| follow.step(level, target, 0.6 / f64::from(steps)))
        };
        for (from, target, time_s) in [(0.0, 1.0, 0.2_f32), (1.0, 0.25, 2.0)] {
            let exact = target + (from - target) * (-0.6 / time_s).exp();
            for steps in [1, 7, 60] {
                assert!((after(steps, from, target) - exact).abs() < 1e-5);
            }
        }
        assert_eq!(follow.step(0.3, 0.9, 0.0), 0.3, "a pause");
        for jump_s in [-3.0, 86_400.0, f64::NAN] {
            assert_eq!(follow.step(0.3, 0.9, jump_s), 0.9);
        }
    }

    #[test]
    fn odd_winds_are_silent() {
        for odd in [f32::NAN, f32::NEG_INFINITY, -1.0] {
            assert_eq!(level_db(LeafSound::Broad.intensity(10.0, 3.0, odd)), SILENCE_DB);
            assert_eq!(level_db(LeafSound::Needles.intensity(odd, 3.0, 5.0)), SILENCE_DB);
            assert_eq!(gust_share(1.0, odd), 0.0);
        }
        assert_eq!(speed_m_s(Vec3::NAN), 0.0);
        assert_eq!([nearness(0.0, 16.0), nearness(8.0, 16.0), nearness(16.0, 16.0)], [1.0, 0.25, 0.0]);
    }
}
