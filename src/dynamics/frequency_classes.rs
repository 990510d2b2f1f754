//! Natural frequencies, rounded to a few classes, so that one table of responses serves all beams.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// Natural frequencies in steps of equal ratio, rounded to the nearest.
///
/// Class `i` has the frequency `lowest_hz * ratio^i`; the last of the `count` classes stands for all higher frequencies
/// and is quasi-static. The `fast` classes before it are too fast for samples of a whole wind: they answer slow gusts without
/// inertia, and fast ones as oscillators (see [`OscillatorGrid`](super::OscillatorGrid)).
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
pub struct FrequencyClasses {
    /// Frequency of class 0, in Hz. Slower beams count as of this class.
    pub lowest_hz: f32,
    /// Ratio of neighbouring classes, above 1. 1.22 keeps the rounding within 10%, less than the natural spread of
    /// wood's stiffness.
    pub ratio: f32,
    /// Number of classes, the fast ones and the quasi-static one included. At least 1.
    pub count: usize,
    /// Number of fast classes.
    pub fast: usize,
}

impl Default for FrequencyClasses {
    /// 0.05 Hz (a great tree) to 3.6 Hz, about the most that samples of 1/16 s can show, in steps of +-10%; from there to 14.4 Hz
    /// (twigs have 5 to 12 Hz) seven fast classes; and the quasi-static one.
    fn default() -> Self {
        Self { lowest_hz: 0.05, ratio: 1.22, count: 30, fast: 7 }
    }
}

impl FrequencyClasses {
    /// Index of the last class, the quasi-static one.
    pub fn quasi_static(&self) -> usize {
        self.count.max(1) - 1
    }

    /// Index of the first class that is not slow: fast, or quasi-static where no class is fast.
    pub fn first_fast(&self) -> usize {
        self.quasi_static() - self.fast.min(self.quasi_static())
    }

    /// Place of a natural frequency on the scale of classes, not rounded. A frequency that is not a positive number
    /// counts as quasi-static.
    pub fn coordinate(&self, frequency_hz: f32) -> f32 {
        let coordinate = (frequency_hz / self.lowest_hz).ln() / self.ratio.ln();
        if coordinate.is_finite() { coordinate } else { self.quasi_static() as f32 }
    }

    /// Natural frequency at a place on the scale of classes, Hz: the inverse of [`coordinate`](Self::coordinate).
    #[must_use]
    pub fn frequency_at_hz(&self, coordinate: f32) -> f32 {
        self.lowest_hz * self.ratio.powf(coordinate)
    }

    /// What an instance's scale adds to its beams' coordinates: a tree `scale` times as large sways as many times more
    /// slowly. A scale that is not a positive number adds nothing.
    pub(crate) fn shift(&self, scale: f32) -> f32 {
        let shift = -scale.ln() / self.ratio.ln();
        if shift.is_finite() { shift } else { 0.0 }
    }

    /// The class nearest to a coordinate. NaN counts as quasi-static.
    pub fn nearest(&self, coordinate: f32) -> usize {
        let last = self.quasi_static();
        if coordinate < last as f32 { ((coordinate + 0.5).max(0.0) as usize).min(last) } else { last }
    }

    /// Natural frequency of a class in Hz; infinite for the quasi-static one.
    pub fn frequency_hz(&self, class: usize) -> f32 {
        if class < self.quasi_static() { self.lowest_hz * self.ratio.powi(class as i32) } else { f32::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_of_equal_ratio() {
        let classes = FrequencyClasses::default();
        for class in 0..classes.quasi_static() {
            assert_eq!(classes.nearest(classes.coordinate(classes.frequency_hz(class))), class);
        }
        let rounded = |frequency_hz: f32| classes.frequency_hz(classes.nearest(classes.coordinate(frequency_hz)));
        // Half a step is 1.22^(1/2) = 1.105.
        for frequency_hz in [0.06, 0.1, 0.77, 3.0, 5.9, 12.0] {
            assert!((rounded(frequency_hz) / frequency_hz).ln().abs() < 0.1);
        }
        assert_eq!(rounded(15.0), f32::INFINITY);
        let first_fast_hz = classes.frequency_hz(classes.first_fast());
        assert!((first_fast_hz - 3.97).abs() < 0.01, "{first_fast_hz}");
        assert_eq!(classes.nearest(classes.coordinate(1e-3)), 0);
        assert!((classes.coordinate(1.0) + classes.shift(2.0) - classes.coordinate(0.5)).abs() < 1e-4);
    }

    #[test]
    fn any_number_has_a_class() {
        let classes = FrequencyClasses::default();
        for frequency_hz in [f32::NAN, 0.0, -1.0, f32::INFINITY] {
            assert_eq!(classes.nearest(classes.coordinate(frequency_hz)), 29);
        }
        assert_eq!(classes.nearest(f32::NAN), 29);
        assert_eq!(classes.shift(0.0), 0.0);
        let none = FrequencyClasses { count: 0, ..classes };
        assert_eq!((none.nearest(3.0), none.first_fast()), (0, 0));
    }
}
