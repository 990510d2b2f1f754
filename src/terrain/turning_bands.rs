//! Random fields by the turning bands method (Setas et al., algorithm 1).
//!
//! ```text
//! z(x) = 1/sqrt(L) sum_i z_i(x . u_i)                                   equation 1
//! C(h) = mean over directions of C1(h . u)                              equation 2
//! ```
//!
//! The L lines are spread evenly over the half circle (a line and its opposite are one) and turned together by a random
//! angle. The mean over evenly spread directions equals that over the circle for all waves up to about 2 L radians per
//! lag, and the random turn makes it right for all on average over seeds. Anisotropic ground is isotropic ground seen
//! in coordinates that are stretched across its axis.

use super::{
    line_process::{Harmonic, LineProcess},
    place::finite,
    settings::{PERIOD_SCALES, SAMPLES_PER_WAVELENGTH, TurningBandsSettings},
    spectral_sampling::{SpectralInterval, spectral_intervals},
};
use crate::{ground::Ground, setting::SettingError};
use bevy::math::DVec2;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rustfft::FftPlanner;
use std::f64::consts::{PI, TAU};

/// A stationary random field: ground without end, at any place, without a grid.
pub struct TurningBands {
    settings: TurningBandsSettings,
    lines: Vec<Line>,
    resolved_fraction: f64,
}

struct Line {
    /// Samples of the line's table per metre along x and z.
    step: DVec2,
    process: LineProcess,
}

impl TurningBands {
    /// Draws the field that `settings` describe.
    ///
    /// Takes some 10 ms for the default settings.
    ///
    /// # Errors
    /// [`SettingError`] for the first setting outside its domain.
    pub fn new(settings: &TurningBandsSettings) -> Result<Self, SettingError> {
        settings.validate()?;
        let lattice = Lattice::new(settings);
        let intervals = spectral_intervals(&settings.model, lattice.highest_wavenumber, settings.harmonics as usize);
        let stretch = settings.anisotropy.stretch();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(settings.seed);
        let mut planner = FftPlanner::new();
        let spacing = PI / f64::from(settings.lines);
        let turn = spacing * rng.random::<f64>();
        let line = |index: u32| {
            let direction = DVec2::from_angle(turn + spacing * f64::from(index));
            let harmonics = draw_harmonics(settings, &intervals, &lattice, &mut rng);
            Line {
                // (A x) . u = x . (A^T u)
                step: stretch.transpose() * direction / lattice.spacing_m,
                process: LineProcess::new(harmonics, lattice.samples, &mut planner),
            }
        };
        let lines = (0..settings.lines).map(line).collect();
        let resolved_fraction = intervals.iter().map(|interval| interval.share).sum();
        Ok(Self { settings: settings.clone(), lines, resolved_fraction })
    }

    /// Elevation at a place by the sums of equation 3 themselves, m: the slow oracle of
    /// [`height_m`](Ground::height_m).
    pub fn exact_height_m(&self, place: DVec2) -> f64 {
        let place = finite(place);
        let value = |line: &Line| line.process.exact(place.dot(line.step)).value;
        self.settings.mean_m + self.lines.iter().map(value).sum::<f64>()
    }

    /// Gradient at a place by the sums themselves: the slow oracle of [`gradient`](Ground::gradient).
    pub fn exact_gradient(&self, place: DVec2) -> DVec2 {
        let place = finite(place);
        self.lines.iter().map(|line| line.step * line.process.exact(place.dot(line.step)).derivative).sum()
    }

    /// Root mean square of what the lookup adds to the elevation, m, by the theory of the spline.
    pub fn lookup_error_m(&self) -> f64 {
        self.lines.iter().map(|line| line.process.lookup_error_m2()).sum::<f64>().sqrt()
    }

    /// The share of the model's variance in waves longer than the finest wavelength, which is the field's.
    pub fn resolved_fraction(&self) -> f64 {
        self.resolved_fraction
    }

    /// The covariance that the model asks for between places `lag` apart, m^2, the unresolved waves included.
    pub fn model_covariance_m2(&self, lag: DVec2) -> f64 {
        let lag_m = (self.settings.anisotropy.stretch() * lag).length();
        self.settings.deviation_m.powi(2) * self.settings.model.correlation(lag_m / self.settings.scale_m)
    }

    /// What the field was made from.
    pub fn settings(&self) -> &TurningBandsSettings {
        &self.settings
    }
}

impl Ground for TurningBands {
    fn height_m(&self, place: DVec2) -> f64 {
        let place = finite(place);
        let sum: f32 = self.lines.iter().map(|line| line.process.value(place.dot(line.step))).sum();
        self.settings.mean_m + f64::from(sum)
    }

    fn gradient(&self, place: DVec2) -> DVec2 {
        let place = finite(place);
        let of_line = |line: &Line| line.step * f64::from(line.process.derivative(place.dot(line.step)));
        self.lines.iter().map(of_line).sum()
    }
}

/// The frequencies that the line processes may have, and the samples of their tables.
struct Lattice {
    /// In a period; a power of two.
    samples: usize,
    /// Between samples, in stretched coordinates, m.
    spacing_m: f64,
    /// Of one wave in a period, radians per scale.
    wavenumber_step: f64,
    /// Of the finest wavelength, radians per scale.
    highest_wavenumber: f64,
}

impl Lattice {
    fn new(settings: &TurningBandsSettings) -> Self {
        let spacing_m = settings.finest_wavelength_m / SAMPLES_PER_WAVELENGTH;
        let needed = (PERIOD_SCALES * settings.scale_m / spacing_m).ceil();
        let samples = (needed as usize).next_power_of_two();
        let period_m = samples as f64 * spacing_m;
        Self {
            samples,
            spacing_m,
            wavenumber_step: TAU * settings.scale_m / period_m,
            highest_wavenumber: TAU * settings.scale_m / settings.finest_wavelength_m,
        }
    }
}

fn draw_harmonics(
    settings: &TurningBandsSettings,
    intervals: &[SpectralInterval],
    lattice: &Lattice,
    rng: &mut Xoshiro256PlusPlus,
) -> Vec<Harmonic> {
    let line_deviation_m = settings.deviation_m / f64::from(settings.lines).sqrt();
    let harmonic = |interval: &SpectralInterval| {
        let wavenumber = interval.wavenumber(&settings.model, rng.random());
        Harmonic {
            waves: (wavenumber / lattice.wavenumber_step).round() as u32,
            amplitude_m: line_deviation_m * (2.0 * interval.share).sqrt(),
            phase: TAU * rng.random::<f64>(),
        }
    };
    intervals.iter().map(harmonic).collect()
}

#[cfg(test)]
mod tests;
