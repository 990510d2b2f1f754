//! Fits covariance models to a variogram by the Levenberg-Marquardt method (Setas et al., section 2.1), and ranks them.
//!
//! ```text
//! minimise sum over classes of w(h) ln^2 ((s^2 (1 - rho(|A h| / scale)) + e) / (gamma(h) + e))   e = variance / 1000
//! ```
//!
//! Logarithms, because ground is seen from near by: what a plain difference calls a good fit follows the long lags
//! alone, and gives mountains the texture of gravel. Below e a map shows its rounding rather than ground.
//!
//! The unknowns are free of units, and cannot leave their domains: the logarithms of the sill over the variance and of
//! the scale over the longest lag, the logit of a fractal's dimension, and, where the variogram has directions, the
//! logarithm of the anisotropy and its azimuth. (A fit in metres and square metres stops at the wrong scale.) Several
//! starts are tried, because the sum has other minima. A class weighs as much as its width in ln h, so that every
//! octave of lags weighs the same.

use super::{
    covariance::{CovarianceModel, FRACTAL_DIMENSION},
    settings::{Anisotropy, TurningBandsSettings},
    variogram::{LagClass, Variogram},
};
use crate::setting::SettingError;
use bevy::math::DVec2;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, storage::Owned};
use std::f64::consts::{FRAC_PI_2, PI};

/// Scales over the longest lag, and dimensions, to start from.
const START_SCALES: [f64; 4] = [0.02, 0.08, 0.25, 0.8];
const START_DIMENSIONS: [f64; 2] = [2.2, 2.6];
/// Anisotropies and azimuths to start from where there are directions.
const START_RATIO: f64 = 1.5;
const START_AZIMUTHS: [f64; 2] = [0.0, FRAC_PI_2];
/// Logarithm of the greatest factor between an unknown and its unit.
const FARTHEST: f64 = 9.0;
/// Scales over the longest lag beyond which a variogram cannot tell them, nor the sill.
const LONGEST_SCALE: f64 = 2.0;
/// Of the anisotropy, either way; what [`TurningBandsSettings`] allow.
const MOST_RATIO: f64 = 100.0;
/// Cells of a map per wave of the shortest wave that it shows.
pub const SHORTEST_WAVE_CELLS: f64 = 2.0;
/// Lines of random ground that is like a map.
const LINES_LIKE_MAPS: u32 = 64;
/// e of the module's head, over the variance.
const NOISE: f64 = 1e-3;

/// A model with the parameters that fit a variogram best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The model, a fractal with its fitted dimension.
    pub model: CovarianceModel,
    /// Scale, along the longer axis, m; at most twice the longest lag (across it): ground that varies at all scales of
    /// the map shows no more.
    pub scale_m: f64,
    /// Standard deviation, the root of the sill, m.
    pub deviation_m: f64,
    /// Isotropic where the variogram has fewer than 3 directions.
    pub anisotropy: Anisotropy,
    /// Weighted root mean square over the classes of the logarithm of fitted over measured semivariance: the relative
    /// error, where it is small.
    pub residual: f64,
}

impl Fit {
    /// Settings for new ground of the fitted kind.
    ///
    /// `finest_wavelength_m` as in [`TurningBandsSettings`]; the mean elevation is left at 0.
    pub fn settings(&self, finest_wavelength_m: f64, seed: u64) -> TurningBandsSettings {
        TurningBandsSettings {
            model: self.model,
            scale_m: self.scale_m,
            deviation_m: self.deviation_m,
            anisotropy: self.anisotropy,
            finest_wavelength_m,
            seed,
            ..Default::default()
        }
    }

    /// Settings for more ground of the kind of the map whose variogram was fitted: its mean elevation, waves as short as cells of
    /// `cell_m` can show, and so many lines that hill shading shows no streaks.
    pub fn settings_like(&self, variogram: &Variogram, cell_m: f64, seed: u64) -> TurningBandsSettings {
        let finest_m = (SHORTEST_WAVE_CELLS * cell_m).min(self.scale_m);
        let mean_m = variogram.drift().mean_m;
        TurningBandsSettings { mean_m, lines: LINES_LIKE_MAPS, ..self.settings(finest_m, seed) }
    }

    /// Distance, along the longer axis, at which the correlation falls to 5%, m.
    pub fn practical_range_m(&self) -> f64 {
        self.scale_m * self.model.practical_range()
    }

    /// The semivariance of the fitted model at a lag, m^2.
    pub fn semivariance_m2(&self, lag_m: DVec2) -> f64 {
        let distance_m = (self.anisotropy.stretch() * lag_m).length();
        self.deviation_m.powi(2) * (1.0 - self.model.correlation(distance_m / self.scale_m))
    }
}

/// Fits every one of `models` to a variogram; the best comes first. A fractal's dimension is fitted too, whatever it
/// is.
///
/// # Errors
/// [`SettingError`] where the variogram has fewer classes than a model has unknowns.
pub fn fit_models(variogram: &Variogram, models: &[CovarianceModel]) -> Result<Vec<Fit>, SettingError> {
    let mut fits = models.iter().map(|&model| fit_model(variogram, model)).collect::<Result<Vec<_>, _>>()?;
    best_first(&mut fits);
    Ok(fits)
}

/// Puts fits into the order of what they miss.
pub(crate) fn best_first(fits: &mut [Fit]) {
    fits.sort_by(|a, b| a.residual.total_cmp(&b.residual));
}

/// Fits one model to a variogram.
///
/// # Errors
/// As [`fit_models`].
pub fn fit_model(variogram: &Variogram, model: CovarianceModel) -> Result<Fit, SettingError> {
    let data = Data::new(variogram, model);
    let starts = data.starts();
    let unknowns = starts.first().map_or(0, DVector::len);
    if data.classes.len() < unknowns {
        let allowed = format!("at least {unknowns}, the unknowns of the {} model", model.name());
        return Err(SettingError::new("classes of the variogram", data.classes.len(), allowed));
    }
    let fits = starts.into_iter().map(|unknowns| {
        let (problem, _) = LevenbergMarquardt::new().with_patience(60).minimize(Problem { data: &data, unknowns });
        data.fit(&problem.unknowns)
    });
    let best = fits.min_by(|a, b| a.residual.total_cmp(&b.residual));
    best.ok_or_else(|| SettingError::new("starts of the fit", 0, "at least 1"))
}

/// A variogram to fit, and its units.
struct Data<'a> {
    classes: &'a [LagClass],
    model: CovarianceModel,
    directed: bool,
    variance_m2: f64,
    longest_m: f64,
    /// Square roots of the weights, whose sum is 1.
    weights: Vec<f64>,
}

impl<'a> Data<'a> {
    fn new(variogram: &'a Variogram, model: CovarianceModel) -> Self {
        let classes = variogram.classes();
        let longest_m = classes.iter().map(|class| class.distance_m).fold(0.0, f64::max);
        let mut azimuths: Vec<f64> = classes.iter().map(|class| class.azimuth).collect();
        azimuths.dedup();
        // Two directions cannot tell the azimuth.
        let (directed, variance_m2) = (azimuths.len() > 2, variogram.variance_m2());
        Self { classes, model, directed, variance_m2, longest_m, weights: weights(classes) }
    }

    fn starts(&self) -> Vec<DVector<f64>> {
        let dimensions: &[Option<f64>] = match self.model {
            CovarianceModel::Fractal { .. } => &START_DIMENSIONS.map(Some),
            _ => &[None],
        };
        let azimuths: &[Option<f64>] = if self.directed { &START_AZIMUTHS.map(Some) } else { &[None] };
        let mut starts = Vec::new();
        for scale in START_SCALES {
            for &dimension in dimensions {
                for &azimuth in azimuths {
                    let shape = dimension.map(logit_of_dimension);
                    let direction = azimuth.map(|azimuth| [START_RATIO.ln(), azimuth]);
                    let unknowns = [0.0, scale.ln()].into_iter().chain(shape).chain(direction.into_iter().flatten());
                    starts.push(DVector::from_iterator(
                        2 + usize::from(shape.is_some()) + 2 * usize::from(direction.is_some()),
                        unknowns,
                    ));
                }
            }
        }
        starts
    }

    /// What the unknowns mean, with what they leave.
    fn fit(&self, unknowns: &DVector<f64>) -> Fit {
        let mut unknown = unknowns.iter().copied();
        let mut next = || unknown.next().unwrap_or(0.0);
        let factor = |logarithm: f64| logarithm.clamp(-FARTHEST, FARTHEST).exp();
        let deviation_m = (self.variance_m2 * factor(next())).sqrt();
        let scale_m = self.longest_m * factor(next()).min(LONGEST_SCALE);
        let model = match self.model {
            CovarianceModel::Fractal { .. } => CovarianceModel::Fractal { dimension: dimension_of_logit(next()) },
            other => other,
        };
        let (ratio, azimuth) =
            if self.directed { (factor(next()).clamp(MOST_RATIO.recip(), MOST_RATIO), next()) } else { (1.0, 0.0) };
        // A ratio below 1 is one above 1 about the other axis.
        let (scale_m, ratio, azimuth) =
            if ratio < 1.0 { (scale_m / ratio, ratio.recip(), azimuth + FRAC_PI_2) } else { (scale_m, ratio, azimuth) };
        let anisotropy = Anisotropy { ratio, azimuth_deg: azimuth.rem_euclid(PI).to_degrees() };
        let mut fit = Fit { model, scale_m, deviation_m, anisotropy, residual: 0.0 };
        fit.residual = self.residuals(&fit).map(|value| value * value).sum::<f64>().sqrt();
        fit
    }

    /// Logarithms of fitted over measured semivariance, weighted.
    fn residuals(&self, fit: &Fit) -> impl Iterator<Item = f64> {
        let stretch = fit.anisotropy.stretch();
        let sill = fit.deviation_m.powi(2) / self.variance_m2;
        let (model, scale_m) = (fit.model, fit.scale_m);
        self.classes.iter().zip(&self.weights).map(move |(class, weight)| {
            let distance = (stretch * class.lag_m()).length() / scale_m;
            let fitted = (sill * (1.0 - model.correlation(distance))).max(0.0);
            weight * ((fitted + NOISE) / (class.semivariance_m2 / self.variance_m2 + NOISE)).ln()
        })
    }

    fn residuals_at(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        DVector::from_iterator(self.classes.len(), self.residuals(&self.fit(unknowns)))
    }
}

/// The square root of each class's width in ln h, that from the class before it in its direction, over the sum of all.
fn weights(classes: &[LagClass]) -> Vec<f64> {
    let width = |index: usize| {
        let (before, class) = (classes.get(index.checked_sub(1)?)?, classes.get(index)?);
        (before.azimuth == class.azimuth).then(|| (class.distance_m / before.distance_m).ln())
    };
    // The first in a direction is as wide as the second.
    let widths: Vec<f64> = (0..classes.len()).map(|index| width(index).or(width(index + 1)).unwrap_or(1.0)).collect();
    let sum: f64 = widths.iter().sum();
    widths.iter().map(|width| (width / sum).sqrt()).collect()
}

/// The dimension at the share 1 / (1 + e^-logit) of its domain.
fn dimension_of_logit(logit: f64) -> f64 {
    let (low, high) = (FRACTAL_DIMENSION.start(), FRACTAL_DIMENSION.end());
    (low + (high - low) / (1.0 + (-logit).exp())).clamp(*low, *high)
}

fn logit_of_dimension(dimension: f64) -> f64 {
    let (low, high) = (FRACTAL_DIMENSION.start(), FRACTAL_DIMENSION.end());
    ((dimension - low) / (high - dimension)).ln()
}

struct Problem<'a> {
    data: &'a Data<'a>,
    unknowns: DVector<f64>,
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, unknowns: &DVector<f64>) {
        self.unknowns.copy_from(unknowns);
    }

    fn params(&self) -> DVector<f64> {
        self.unknowns.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.data.residuals_at(&self.unknowns))
    }

    /// By central differences: all unknowns are of order 1.
    fn jacobian(&self) -> Option<DMatrix<f64>> {
        const STEP: f64 = 1e-5;
        let column = |index: usize| {
            let shifted = |step: f64| {
                let mut unknowns = self.unknowns.clone();
                unknowns[index] += step;
                self.data.residuals_at(&unknowns)
            };
            (shifted(STEP) - shifted(-STEP)) / (2.0 * STEP)
        };
        Some(DMatrix::from_columns(&(0..self.unknowns.len()).map(column).collect::<Vec<_>>()))
    }
}

#[cfg(test)]
mod tests;
