//! From a wind field to the tables that every tree reads.

use crate::{
    dynamics::{
        load_basis::{LoadBasis, LoadBasisKind},
        response::{FrequencyClasses, ResponseTable},
    },
    wind::{REFERENCE_HEIGHT_M, WindField, cross_flow_pressure},
};
use bevy::prelude::*;
use std::sync::Arc;

/// How trees answer the wind.
#[derive(Resource, Reflect, Clone, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct SwaySettings {
    /// From which loads the response of any beam is put together.
    pub basis: LoadBasisKind,
    /// Damping ratio of every oscillator, of critical; range 0.01..=1. Whole trees in leaf: 0.08 to nearly critical, most of
    /// it the drag of the foliage; bare trunks 0.01 to 0.08 (Moore & Maguire 2004, 2005).
    pub damping_ratio: f32,
    /// Height above ground at which the table's wind is taken, m; 1..=100. Loads at other heights follow the mean profile.
    pub reference_height_m: f32,
}

impl Default for SwaySettings {
    fn default() -> Self {
        Self { basis: LoadBasisKind::default(), damping_ratio: 0.15, reference_height_m: REFERENCE_HEIGHT_M }
    }
}

impl SwaySettings {
    /// The nearest settings that are allowed; what is not a number becomes the default.
    pub fn clamped(&self) -> Self {
        let fallback = Self::default();
        let tame = |value: f32, default: f32, low: f32, high: f32| {
            if value.is_finite() { value.clamp(low, high) } else { default }
        };
        Self {
            basis: self.basis,
            damping_ratio: tame(self.damping_ratio, fallback.damping_ratio, 0.01, 1.0),
            reference_height_m: tame(self.reference_height_m, fallback.reference_height_m, 1.0, 100.0),
        }
    }
}

/// A wind, and how unit beams answer it.
pub struct WindResponse {
    /// The wind itself.
    pub field: Arc<WindField>,
    /// What directions the loads have.
    pub basis: LoadBasis,
    /// The responses of unit oscillators over frequency class, column and time.
    pub table: ResponseTable,
}

impl WindResponse {
    /// Computes the tables; some 0.1 s of work, so not on the frame.
    pub fn new(field: Arc<WindField>, settings: &SwaySettings) -> Self {
        let resolution = &field.settings().resolution;
        let columns: Vec<Vec<Vec3>> = (0..resolution.columns)
            .map(|column| {
                let mut series = Vec::new();
                field.column_velocities(column as usize, settings.reference_height_m, &mut series);
                series
            })
            .collect();
        let basis = LoadBasis::new(settings.basis, &columns.concat(), cross_flow_pressure);
        let table = ResponseTable::new(
            &columns,
            resolution.time_step_s,
            &basis,
            FrequencyClasses::default(),
            settings.damping_ratio,
        );
        Self { field, basis, table }
    }

    /// Where a tree at `position` stands in the periodic tables: its lateral column, and the time of the field there, s.
    pub fn place(&self, position: Vec3, time_s: f64) -> (usize, f64) {
        let frame = self.field.frame();
        let columns = self.table.columns;
        let spacing = self.field.settings().resolution.column_spacing_m;
        let nearest = (position.dot(frame.across) / spacing).round();
        let column = nearest.rem_euclid(columns as f32) as usize;
        (column.min(columns - 1), time_s - self.field.delay_s(position.dot(frame.along)))
    }
}
