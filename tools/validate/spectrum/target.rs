//! Spectra, coherence and mean speed of the literature.

use bevy_windwood::wind::WindField;
use std::ops::Range;

/// The formulas for a field (Setas et al., equations 9 to 12, corrected).
pub struct Target {
    pub samples: usize,
    pub time_step_s: f64,
    pub columns: usize,
    column_spacing_m: f64,
    pub heights_m: Vec<f64>,
    friction_velocity_m_s: f64,
    roughness_length_m: f64,
    displacement_m: f64,
    /// Cy = Cz of u, v, w.
    decay: [f64; 3],
}

impl Target {
    pub fn new(field: &WindField) -> Self {
        let settings = field.settings();
        let resolution = &settings.resolution;
        let roughness_length_m = f64::from(settings.roughness_m);
        let displacement_m = f64::from(settings.displacement_m);
        let spacing_m = f64::from(resolution.level_spacing_m);
        Self {
            samples: resolution.time_samples as usize,
            time_step_s: f64::from(resolution.time_step_s),
            columns: resolution.columns as usize,
            column_spacing_m: f64::from(resolution.column_spacing_m),
            heights_m: (1..=resolution.levels).map(|level| f64::from(level) * spacing_m).collect(),
            friction_velocity_m_s: 0.4 * f64::from(settings.speed)
                / ((10.0 - displacement_m) / roughness_length_m).ln(),
            roughness_length_m,
            displacement_m,
            decay: [10.0, 7.0, 8.0],
        }
    }

    pub fn bins(&self) -> usize {
        self.samples / 2
    }

    pub fn frequency_hz(&self, bin: usize) -> f64 {
        bin as f64 / (self.samples as f64 * self.time_step_s)
    }

    /// Equation 10.
    pub fn mean_speed_m_s(&self, height_m: f64) -> f64 {
        self.friction_velocity_m_s / 0.4 * ((height_m - self.displacement_m) / self.roughness_length_m).ln()
    }

    /// Equations 9, at a level.
    pub fn psd(&self, component: usize, frequency_hz: f64, level: usize) -> f64 {
        self.psd_at(component, frequency_hz, self.heights_m[level])
    }

    /// Equations 9. Lower than e roughness lengths above the displacement plane the scales are those of there, as the field documents.
    pub fn psd_at(&self, component: usize, frequency_hz: f64, height_m: f64) -> f64 {
        let above_m = (height_m - self.displacement_m).max(std::f64::consts::E * self.roughness_length_m);
        let nu = frequency_hz * above_m / self.mean_speed_m_s(self.displacement_m + above_m);
        let reduced = match component {
            0 => 200.0 * nu / (1.0 + 50.0 * nu).powf(5.0 / 3.0),
            1 => 15.0 * nu / (1.0 + 9.5 * nu).powf(5.0 / 3.0),
            _ => 3.36 * nu / (1.0 + 10.0 * nu.powf(5.0 / 3.0)),
        };
        self.friction_velocity_m_s.powi(2) * reduced / frequency_hz
    }

    /// Equations 11 and 12.
    pub fn root_coherence(&self, component: usize, frequency_hz: f64, (low, high, lag): (usize, usize, usize)) -> f64 {
        let (low_m, high_m) = (self.heights_m[low], self.heights_m[high]);
        let mean_speed_m_s = 0.5 * (self.mean_speed_m_s(low_m) + self.mean_speed_m_s(high_m));
        let distance_m = (high_m - low_m).hypot(lag as f64 * self.column_spacing_m);
        (-frequency_hz * self.decay[component] * distance_m / mean_speed_m_s).exp()
    }

    /// Equations 11 and 12 for two places 10 m above ground and so far apart across the wind.
    pub fn lateral_root_coherence(&self, component: usize, frequency_hz: f64, distance_m: f64) -> f64 {
        (-frequency_hz * self.decay[component] * distance_m / self.mean_speed_m_s(10.0)).exp()
    }

    /// The integral of the spectrum over the resolved band at a level, one strip for each bin.
    pub fn resolved_variance(&self, component: usize, level: usize) -> f64 {
        self.resolved_variance_at(component, self.heights_m[level])
    }

    /// The same at any height.
    pub fn resolved_variance_at(&self, component: usize, height_m: f64) -> f64 {
        let strip_hz = self.frequency_hz(1);
        (1..self.bins()).map(|bin| self.psd_at(component, self.frequency_hz(bin), height_m) * strip_hz).sum()
    }
}

/// The octave of a frequency bin: 1 to 7, 8 to 15, 16 to 31 and so on.
pub fn band(bin: usize) -> usize {
    bin.ilog2().saturating_sub(2) as usize
}

/// The bins of an octave.
pub fn bins_of_band(band: usize) -> Range<usize> {
    if band == 0 { 1..8 } else { 4 << band..8 << band }
}
