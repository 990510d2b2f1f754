//! From a wind field to the tables that every tree reads.

use crate::{
    dynamics::{
        beam::{BeamWind, most_pressure_share},
        direction_map::LoadCoefficients,
        frequency_classes::FrequencyClasses,
        load_basis::{LoadBasis, LoadBasisKind},
        mean_wind::MeanWind,
        oscillator_grid::{OscillatorGrid, SIZES},
        response::ResponseTable,
        stand_wind::StandWind,
        table_place::TablePlace,
    },
    wind::{Canopy, REFERENCE_HEIGHT_M, WindField, cross_flow_pressure},
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
        let fast_gusts = field.fast_gusts(settings.reference_height_m);
        let table = ResponseTable::new(&columns, resolution.time_step_s, &fast_gusts, &basis, grid);
        let strongest_pressure = most_pressure_share(&mean_wind) * strongest_pressure(&basis, &table);
        Self { field, basis, table, mean_wind, strongest_pressure }
    }

    /// The wind as beams of a tree in the open feel it.
    pub fn beam_wind(&self) -> BeamWind {
        self.beam_wind_in(&Canopy::default())
    }

    /// The wind as beams of a tree feel it that stands among others.
    pub fn beam_wind_in(&self, canopy: &Canopy) -> BeamWind {
        BeamWind { stand: self.stand_wind(canopy), grid: self.table.grid }
    }

    /// The wind at a tree that stands among others.
    pub fn stand_wind(&self, canopy: &Canopy) -> StandWind {
        StandWind::new(self.mean_wind, canopy.pack(), self.field.frame().along.xz())
    }

    /// The wind at a height above ground of a place, m/s in world coordinates, without fast gusts: at the top of a tree for
    /// [`TreePoser::pose`](crate::dynamics::TreePoser::pose), there turned into the tree's own coordinates.
    pub fn wind_at(&self, stand: &StandWind, place: &TablePlace, height_m: f32) -> Vec3 {
        self.field.frame().to_world(stand.velocity(height_m, self.table.velocity(place)))
    }

    /// Where a tree at `position` stands in the periodic tables at a time: it reads the same wind there as
    /// [`WindField::sample`] gives at the height of the tables.
    ///
    /// Fast gusts drift along the wind as the others do. Across it they lose their coherence within a metre: so they pass each
    /// place across at quite another time.
    pub fn place(&self, position: Vec3, time_s: f64) -> TablePlace {
        let position = self.field.frame().to_wind(position);
        let taps = self.field.lateral().taps(position.z);
        let tau_s = time_s - self.field.delay_s(position.x, position.z);
        let delay_s = f64::from(position.x) / f64::from(self.field.convective_speed_m_s());
        let fast_tau_s =
            time_s - delay_s - self.table.bands.short_period_s * FAST_PERIODS_A_METRE * f64::from(position.z);
        TablePlace { columns: taps.indices, weights: taps.weights, tau_s, fast_tau_s }
    }
}

/// By how many short periods fast gusts are later one metre farther across the wind: the golden section, so that places a whole
/// number of metres apart never have them at nearly one time. `render/shaders/wind.wesl` has the same constant.
const FAST_PERIODS_A_METRE: f64 = 0.618034;

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
    let gusts: Vec<LoadCoefficients> =
        loads.iter().map(|load| LoadCoefficients { mean: Vec3::ZERO, ..*load }).collect();
    let (low, high) = (table.grid.low_row(0), table.grid.low_row(SIZES));
    let slow = strongest_load(&loads, table.values_of(0..low));
    // Fast beams feel both bands, of the high one at most the whole.
    let fast = strongest_load(&loads, table.values_of(low..high))
        + strongest_load(&gusts, table.values_of(high..table.rows.len()));
    BETWEEN * slow.max(fast)
}

/// The strongest of these loads for any of these signals.
fn strongest_load(loads: &[LoadCoefficients], responses: &[Vec4]) -> f32 {
    let mean = loads.iter().map(|load| load.mean.length()).fold(0.0, f32::max);
    let moving = |k: usize| loads.iter().map(|load| load.moving[k].length()).fold(0.0, f32::max);
    let moving = Vec4::from_array(std::array::from_fn(moving));
    let mut strongest = mean;
    for signals in responses {
        // Few samples can be stronger than the strongest so far, and only those are looked at in every direction.
        if mean + signals.abs().dot(moving) > strongest {
            strongest = loads.iter().map(|load| load.load(*signals).length()).fold(strongest, f32::max);
        }
    }
    strongest
}

#[cfg(test)]
mod tests;
