//! The variogram of random ground as it was made, beside that of its model.

use bevy::math::DVec2;

use crate::terrain::{ElevationGrid, TurningBands, Variogram, VariogramSettings};

/// Samples along a side of a window.
const SIDE: u32 = 192;
/// Samples in a scale: the longest lag, a third of a window, is four scales.
const SAMPLES_IN_SCALE: f64 = 16.0;
/// Windows along a side, and how far each is from the next, in scales: they share no ground, and the field repeats after 128.
const WINDOWS: u32 = 4;
const APART_SCALES: f64 = 30.0;
/// Directions over which the model is averaged, as the measured variogram is.
const DIRECTIONS: u32 = 24;

/// Semivariances by lag.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundVariogram {
    /// Lag, m, and semivariance, m^2, of the ground.
    pub measured: Vec<[f64; 2]>,
    /// The same of the model, at the same lags.
    pub model: Vec<[f64; 2]>,
    /// m^2.
    pub sill_m2: f64,
}

impl GroundVariogram {
    /// Measures a field: the mean of some windows. None of level ground.
    pub fn of(field: &TurningBands) -> Option<Self> {
        let settings = field.settings();
        let cell_m = settings.scale_m / SAMPLES_IN_SCALE;
        let windows: Vec<Variogram> = (0..WINDOWS * WINDOWS)
            .map(|number| {
                let window = DVec2::new(f64::from(number % WINDOWS), f64::from(number / WINDOWS));
                let first = window * APART_SCALES * settings.scale_m;
                let grid = ElevationGrid::sample(field, first, SIDE, SIDE, DVec2::splat(cell_m)).ok()?;
                Variogram::estimate(&grid, &VariogramSettings::default()).ok()
            })
            .collect::<Option<_>>()?;
        let classes = windows.first()?.classes();
        let mean = |class: usize| {
            let sum: f64 =
                windows.iter().filter_map(|window| window.classes().get(class)).map(|c| c.semivariance_m2).sum();
            sum / windows.len() as f64
        };
        let measured = classes.iter().enumerate().map(|(number, class)| [class.distance_m, mean(number)]).collect();
        let sill_m2 = settings.deviation_m.powi(2);
        let model = classes.iter().map(|class| [class.distance_m, sill_m2 - covariance_m2(field, class.distance_m)]);
        Some(Self { model: model.collect(), measured, sill_m2 })
    }
}

/// The model's covariance at a distance, m^2: the mean over all directions.
fn covariance_m2(field: &TurningBands, distance_m: f64) -> f64 {
    let direction = |number: u32| DVec2::from_angle(std::f64::consts::PI * f64::from(number) / f64::from(DIRECTIONS));
    (0..DIRECTIONS).map(|number| field.model_covariance_m2(distance_m * direction(number))).sum::<f64>()
        / f64::from(DIRECTIONS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::{Anisotropy, CovarianceModel, TurningBandsSettings};

    /// Over seeds, the ground has the variogram of its model, drawn out or not.
    #[test]
    fn made_ground_has_the_variogram_of_its_model() {
        for ratio in [1.0, 2.5] {
            let anisotropy = Anisotropy { ratio, azimuth_deg: 20.0 };
            let (mut measured, mut model) = (0.0, 0.0);
            for seed in 0..3 {
                let settings = TurningBandsSettings {
                    model: CovarianceModel::Exponential,
                    anisotropy,
                    seed,
                    ..TurningBandsSettings::default()
                };
                let variogram = GroundVariogram::of(&TurningBands::new(&settings).unwrap()).unwrap();
                assert_eq!((variogram.measured.len(), variogram.sill_m2), (variogram.model.len(), 400.0));
                let near = variogram.measured.iter().zip(&variogram.model).filter(|(of, _)| of[0] < 300.0);
                for (of_ground, of_model) in near {
                    measured += of_ground[1];
                    model += of_model[1];
                }
            }
            assert!((measured / model - 1.0).abs() < 0.1, "ratio {ratio}: {measured} for {model}");
        }
    }

    #[test]
    fn level_ground_has_none() {
        let settings = TurningBandsSettings { deviation_m: 0.0, ..Default::default() };
        assert_eq!(GroundVariogram::of(&TurningBands::new(&settings).unwrap()), None);
    }
}
