//! What a wind is like, measured from its field, beside what its settings ask for.

use bevy::math::Vec3;

use super::spectrum::{Band, Transform, root_coherence, spectrum};
use crate::wind::WindField;

/// Distances across the wind of the coherence, in columns of the field.
const COLUMNS_APART: [usize; 2] = [1, 2];
/// The length of the series that is shown, s.
const SHOWN_S: f64 = 64.0;

/// A component of the turbulence: its place in wind coordinates (along, up, across), and its name.
pub const COMPONENTS: [(usize, &str); 3] = [(0, "along"), (2, "across"), (1, "up")];

/// What is measured of a field.
#[derive(Clone, Debug)]
pub struct WindMeasures {
    /// Height above ground, m.
    pub height_m: f32,
    pub mean_m_s: f64,
    /// Standard deviation of the speed along the wind over its mean.
    pub intensity: f64,
    /// Speed along the wind at one place: time, s, and speed, m/s.
    pub series: Vec<[f64; 2]>,
    /// In the order of [`COMPONENTS`].
    pub spectra: Vec<Comparison>,
    /// Of the component along the wind.
    pub coherence: Vec<(f64, Comparison)>,
}

/// A curve as it is and as it is to be.
#[derive(Clone, Debug)]
pub struct Comparison {
    pub measured: Vec<Band>,
    pub target: Vec<Band>,
}

impl Comparison {
    fn new(measured: Vec<Band>, target: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        let frequencies_hz: Vec<f64> = measured.iter().map(|band| band.frequency_hz).collect();
        let with_value = |(frequency_hz, value)| Band { frequency_hz, value };
        let target = frequencies_hz.iter().copied().zip(target(&frequencies_hz)).map(with_value).collect();
        Self { measured, target }
    }
}

impl WindMeasures {
    /// Measures a field at a height above ground. It takes some 10 ms: meant for the background.
    pub fn of(field: &WindField, height_m: f32) -> Self {
        let columns = field.settings().resolution.columns as usize;
        let mut samples: Vec<Vec3> = Vec::new();
        let mut series = Vec::new();
        let mut transforms: [Vec<Transform>; 3] = Default::default();
        for column in 0..columns {
            field.column_velocities(column, height_m, &mut samples);
            if column == 0 {
                series.clone_from(&samples);
            }
            for (axis, transforms) in transforms.iter_mut().enumerate() {
                transforms.push(Transform::new(samples.iter().map(|sample| f64::from(sample[axis])), field.period_s()));
            }
        }
        let spectra = COMPONENTS
            .iter()
            .map(|(axis, _)| {
                let target = |hz: &[f64]| field.target_densities(*axis, height_m, hz);
                Comparison::new(spectrum(&transforms[*axis]), target)
            })
            .collect();
        let apart = COLUMNS_APART.iter().filter(|apart| 2 * **apart < columns);
        let coherence = apart.map(|apart| coherence(field, &transforms[0], *apart, height_m)).collect();
        let mean_m_s = f64::from(field.profile().speed_at(height_m));
        let squares: f64 = series.iter().map(|sample| (f64::from(sample.x) - mean_m_s).powi(2)).sum();
        let deviation = (squares / series.len().max(1) as f64).sqrt();
        let step_s = f64::from(field.settings().resolution.time_step_s);
        let shown = (SHOWN_S / step_s) as usize;
        let timed = |(index, sample): (usize, &Vec3)| [index as f64 * step_s, f64::from(sample.x)];
        Self {
            height_m,
            mean_m_s,
            intensity: if mean_m_s > 0.0 { deviation / mean_m_s } else { 0.0 },
            series: series.iter().take(shown).enumerate().map(timed).collect(),
            spectra,
            coherence,
        }
    }
}

fn coherence(field: &WindField, along: &[Transform], apart: usize, height_m: f32) -> (f64, Comparison) {
    let lateral_m = apart as f64 * f64::from(field.settings().resolution.column_spacing_m);
    let pairs: Vec<_> = (0..along.len()).map(|one| (&along[one], &along[(one + apart) % along.len()])).collect();
    let target = |frequencies_hz: &[f64]| {
        frequencies_hz.iter().map(|hz| field.target_coherence(0, height_m, lateral_m, *hz)).collect()
    };
    (lateral_m, Comparison::new(root_coherence(&pairs), target))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wind::FieldSettings;

    fn measures(settings: &FieldSettings) -> WindMeasures {
        WindMeasures::of(&WindField::synthesise(settings).unwrap(), 10.0)
    }

    /// 16 columns, 3 bands an octave: where a band has 30 lines or more, 1 in 20 is the scatter.
    #[test]
    fn the_shipped_wind_has_its_spectra() {
        let measures = measures(&FieldSettings::default());
        for spectrum in &measures.spectra {
            for (measured, target) in spectrum.measured.iter().zip(&spectrum.target) {
                if (0.5..6.0).contains(&measured.frequency_hz) {
                    let ratio = measured.value / target.value;
                    assert!((0.75..1.33).contains(&ratio), "{ratio} at {} Hz", measured.frequency_hz);
                }
            }
        }
        assert!((0.12..0.3).contains(&measures.intensity), "{}", measures.intensity);
        assert!((measures.mean_m_s - 8.0).abs() < 1e-3);
        assert_eq!(measures.series.len(), 1024);
    }

    #[test]
    fn the_shipped_wind_has_its_coherence() {
        let (lateral_m, coherence) = &measures(&FieldSettings::default()).coherence[0];
        assert_eq!(*lateral_m, 8.0);
        for (measured, target) in coherence.measured.iter().zip(&coherence.target) {
            if (0.03..2.0).contains(&measured.frequency_hz) {
                let hz = measured.frequency_hz;
                assert!((measured.value - target.value).abs() < 0.3, "{measured:?} {target:?} at {hz} Hz");
            }
        }
    }

    #[test]
    fn a_calm_has_numbers_too() {
        let measures = measures(&FieldSettings { speed: 0.0, ..FieldSettings::default() });
        assert_eq!((measures.mean_m_s, measures.intensity), (0.0, 0.0));
        let values = measures.spectra.iter().flat_map(|spectrum| spectrum.measured.iter().chain(&spectrum.target));
        assert!(values.into_iter().all(|band| band.value == 0.0));
    }
}
