//! From a wind field to the tables that every tree reads.

use crate::{
    dynamics::{
        beam::{BeamWind, most_pressure_share},
        direction_map::LoadCoefficients,
        frequency_classes::FrequencyClasses,
        load_basis::{LoadBasis, LoadBasisKind},
        mean_wind::MeanWind,
        oscillator_grid::OscillatorGrid,
        response::{ResponseTable, TablePlace},
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
    /// Damping ratio of the wood and the roots, of critical; range 0.01..=1. What drag adds follows from each beam's load and
    /// the wind. Bare trunks have 0.01 to 0.08, and whole trees in leaf more (Moore & Maguire 2004, 2005).
    pub damping_ratio: f32,
    /// Height above ground at which the table's wind is taken, m; 1..=100. Loads at other heights follow the mean profile.
    pub reference_height_m: f32,
}

impl Default for SwaySettings {
    fn default() -> Self {
        Self { basis: LoadBasisKind::default(), damping_ratio: 0.05, reference_height_m: REFERENCE_HEIGHT_M }
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
    /// The responses of unit oscillators over frequency class, size, damping, column and time.
    pub table: ResponseTable,
    /// The mean wind over height.
    pub mean_wind: MeanWind,
    /// No beam is pressed harder at any place and time, m²/s²: for [`TreeModel::bounds_under`](crate::tree::TreeModel::bounds_under).
    pub strongest_pressure: f32,
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
        let mean_wind = MeanWind::new(field.profile(), settings.reference_height_m);
        let decay = field.settings().coherence.along.lateral;
        let grid = OscillatorGrid::new(FrequencyClasses::default(), settings.damping_ratio, mean_wind.speed_m_s, decay);
        let table = ResponseTable::new(&columns, resolution.time_step_s, &basis, grid);
        let strongest_pressure = most_pressure_share(&mean_wind) * strongest_pressure(&basis, &table);
        Self { field, basis, table, mean_wind, strongest_pressure }
    }

    /// The wind as beams feel it.
    pub fn beam_wind(&self) -> BeamWind {
        BeamWind { mean: self.mean_wind, grid: self.table.grid }
    }

    /// Where a tree at `position` stands in the periodic tables at a time: it reads the same wind there as
    /// [`WindField::sample`] gives at the height of the tables.
    pub fn place(&self, position: Vec3, time_s: f64) -> TablePlace {
        let position = self.field.frame().to_wind(position);
        let taps = self.field.lateral().taps(position.z);
        let tau_s = time_s - self.field.delay_s(position.x, position.z);
        TablePlace { columns: taps.indices, weights: taps.weights, tau_s }
    }
}

/// Directions that are looked at: every so many texels of the map each way.
const DIRECTION_STRIDE: usize = 8;
/// Between these directions, and between samples, where a spline may go beyond them, loads may be greater by this factor.
const BETWEEN: f32 = 1.1;

fn strongest_pressure(basis: &LoadBasis, table: &ResponseTable) -> f32 {
    let size = basis.map().size();
    let coordinates = || (0..size).step_by(DIRECTION_STRIDE);
    let loads: Vec<LoadCoefficients> = coordinates()
        .flat_map(|row| coordinates().map(move |column| row * size + column))
        .map(|texel| LoadCoefficients::from_texel(&basis.map().texels()[texel]))
        .collect();
    let mean = loads.iter().map(|load| load.mean.length()).fold(0.0, f32::max);
    let moving = |k: usize| loads.iter().map(|load| load.moving[k].length()).fold(0.0, f32::max);
    let moving = Vec4::from_array(std::array::from_fn(moving));
    let mut strongest = mean;
    for signals in &table.values {
        // Few samples can be stronger than the strongest so far, and only those are looked at in every direction.
        if mean + signals.abs().dot(moving) > strongest {
            strongest = loads.iter().map(|load| load.load(*signals).length()).fold(strongest, f32::max);
        }
    }
    BETWEEN * strongest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wind::FieldSettings;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    #[test]
    fn no_beam_is_pressed_harder_than_the_strongest_pressure() {
        let field = WindField::synthesise(&FieldSettings::default()).unwrap();
        let response = WindResponse::new(Arc::new(field), &SwaySettings::default());
        let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
        let mut greatest = 0.0_f32;
        for _ in 0..300_000 {
            let mut odd = || random.random_range(-1.0..1.0_f32);
            let direction = Vec3::new(odd(), odd(), odd()).normalize_or(Vec3::Y);
            let row = random.random_range(0..response.table.grid.rows());
            let time_s = random.random_range(0.0..response.table.period_s());
            let across = Vec3::Z * random.random_range(-500.0..500.0_f32);
            let signals = response.table.response(row, &response.place(across, time_s));
            greatest = greatest.max(response.basis.map().coefficients(direction).load(signals).length());
        }
        let strongest = response.strongest_pressure;
        println!("{greatest} of {strongest} m^2/s^2");
        assert!(greatest <= strongest, "{greatest} of {strongest}");
        // Chance finds the worst sample seldom, but not by far.
        assert!(greatest > 0.5 * strongest, "{greatest} of {strongest}");
    }
}
