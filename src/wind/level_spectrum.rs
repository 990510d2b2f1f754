//! The spectrum of a field's turbulence at one height, with the factors that its settings put on it.

use super::{
    profile::LogProfile,
    settings::{FieldSettings, TurbulenceBand},
    spectrum::TurbulenceComponent,
};

/// The spectrum of one component at one height.
pub(super) struct LevelSpectrum {
    component: TurbulenceComponent,
    height_m: f64,
    mean_speed_m_s: f64,
    friction_velocity_m_s: f64,
    /// On all amplitudes.
    factor: f64,
    /// How much of the variance lies in the band of frequencies that the field's samples resolve.
    pub resolved_fraction: f64,
}

impl LevelSpectrum {
    /// At `height_m` above ground, in a field of some settings. The wind must not be calm.
    pub fn new(component: TurbulenceComponent, settings: &FieldSettings, profile: &LogProfile, height_m: f32) -> Self {
        let (height_m, mean_speed_m_s) = profile.turbulence_scales(height_m);
        let mut spectrum = Self {
            component,
            height_m: f64::from(height_m),
            mean_speed_m_s: f64::from(mean_speed_m_s),
            friction_velocity_m_s: f64::from(profile.friction_velocity_m_s),
            factor: 1.0,
            resolved_fraction: 0.0,
        };
        let step_hz = settings.resolution.period_s().recip();
        let bins = 1..settings.resolution.time_samples / 2;
        let resolved: f64 = bins.map(|bin| spectrum.variance(f64::from(bin) * step_hz, step_hz)).sum();
        spectrum.resolved_fraction = resolved / (component.variance_factor() * spectrum.friction_velocity_m_s.powi(2));
        spectrum.factor = f64::from(settings.gustiness) * band_factor(settings.band, spectrum.resolved_fraction);
        spectrum
    }

    /// The amplitude of the wave that stands for a band of frequencies, sqrt(2 S df), m/s.
    pub fn amplitude_m_s(&self, frequency_hz: f64, band_hz: f64) -> f64 {
        self.factor * (2.0 * self.variance(frequency_hz, band_hz)).sqrt()
    }

    /// Of a band, without the factor, m^2/s^2.
    fn variance(&self, frequency_hz: f64, band_hz: f64) -> f64 {
        let Self { height_m, mean_speed_m_s, friction_velocity_m_s, .. } = *self;
        let density =
            self.component.power_spectral_density(frequency_hz, height_m, mean_speed_m_s, friction_velocity_m_s);
        density * band_hz
    }
}

/// The factor on all amplitudes of a level whose band holds `fraction` > 0 of the variance.
fn band_factor(band: TurbulenceBand, fraction: f64) -> f64 {
    match band {
        TurbulenceBand::TrueSpectrum => 1.0,
        TurbulenceBand::TrueVariance => fraction.sqrt().recip(),
    }
}
