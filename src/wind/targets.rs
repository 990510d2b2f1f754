//! What a field's turbulence is to be like, for comparison with what it is.

use super::{field::WindField, level_spectrum::LevelSpectrum, spectrum::TurbulenceComponent};

impl WindField {
    /// The one-sided power spectral density that its settings ask for, m²/s² per Hz: at each frequency, Hz, for a component in wind
    /// coordinates (0 along, 1 up, 2 across), at a height above ground. 0 in a calm.
    pub(crate) fn target_densities(&self, axis: usize, height_m: f32, frequencies_hz: &[f64]) -> Vec<f64> {
        let Some(component) = self.component(axis) else { return vec![0.0; frequencies_hz.len()] };
        let spectrum = LevelSpectrum::new(component, self.settings(), self.profile(), height_m);
        // The amplitude of a wave that stands for 1 Hz is sqrt(2 S).
        frequencies_hz.iter().map(|frequency_hz| 0.5 * spectrum.amplitude_m_s(*frequency_hz, 1.0).powi(2)).collect()
    }

    /// The root coherence (equation 12) that its settings ask for between two places so far apart across the wind, m, at one height.
    pub(crate) fn target_coherence(&self, axis: usize, height_m: f32, lateral_m: f64, frequency_hz: f64) -> f64 {
        let Some(component) = self.component(axis) else { return 0.0 };
        let (_, speed_m_s) = self.profile().turbulence_scales(height_m);
        self.settings().coherence.of(component).root_coherence(frequency_hz, lateral_m, 0.0, f64::from(speed_m_s))
    }

    fn component(&self, axis: usize) -> Option<TurbulenceComponent> {
        let is_calm = self.settings().speed <= 0.0;
        TurbulenceComponent::ALL.into_iter().find(|component| component.axis() == axis && !is_calm)
    }
}
