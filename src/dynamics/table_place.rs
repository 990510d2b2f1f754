//! Where the responses of a table are read: a place in the wind, and a time between samples.

use crate::interpolation::catmull_rom;
use bevy::math::Vec4;

/// Where a tree stands in a [`ResponseTable`](super::ResponseTable): the columns of the wind about it with their weights, and a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TablePlace {
    /// Lateral columns.
    pub columns: [usize; 4],
    /// Their weights.
    pub weights: [f32; 4],
    /// Time in the wind's period, s.
    pub tau_s: f64,
    /// Time in the period of the fast gusts, s: they pass each place at a time of its own.
    pub fast_tau_s: f64,
}

impl TablePlace {
    /// On a column, where fast gusts pass as they do in the first one.
    pub fn on_column(column: usize, tau_s: f64) -> Self {
        Self { columns: [column; 4], weights: [1.0, 0.0, 0.0, 0.0], tau_s, fast_tau_s: tau_s }
    }

    /// The weighted sum over the columns. One without a weight is not read.
    pub(super) fn sum(&self, of_column: impl Fn(usize) -> Vec4) -> Vec4 {
        let weighted = self.columns.iter().zip(self.weights).filter(|(_, weight)| *weight != 0.0);
        weighted.map(|(&column, weight)| weight * of_column(column)).sum()
    }
}

/// The four samples around a time and their weights in the Catmull-Rom spline.
pub(super) struct SplinePlace {
    samples: [usize; 4],
    weights: Vec4,
}

impl SplinePlace {
    /// At `place` samples after the first of a period of `count`. A place that is not finite counts as 0.
    pub fn new(place: f64, count: usize) -> Self {
        let within = place.rem_euclid(count as f64);
        let within = if within.is_finite() { within } else { 0.0 };
        let first = (within as usize).min(count - 1);
        let t = (within - first as f64) as f32;
        let after = |steps: usize| (first + steps) % count;
        Self { samples: [after(count - 1), first, after(1), after(2)], weights: catmull_rom(t).into() }
    }

    pub fn of(&self, series: &[Vec4]) -> Vec4 {
        let [a, b, c, d] = self.samples.map(|sample| series[sample]);
        a * self.weights.x + b * self.weights.y + c * self.weights.z + d * self.weights.w
    }
}
