//! Covariance models of the turning bands method, after Mantoglou & Wilson (1982) and Setas et al. (section 2.1).
//!
//! With x = r / scale and t = (w scale)^2, where f is the radial spectral density and F its integral:
//!
//! ```text
//! model                 C / s^2                          F
//! exponential           e^-x                             1 - (1+t)^(-1/2)
//! double exponential    e^(-x^2)                         1 - e^(-t/4)
//! Bessel (Whittle)      x K1                             t/(1+t)
//! Whittle A             x K1 - x^2 K0 / 2                (t/(1+t))^2
//! Whittle B             x K1 + x^3 K1 / 8 - x^2 K0       (t/(1+t))^3
//! hole exponential      (1 - x/2) e^-x                   1 - (1 + 1.5 t)(1+t)^(-3/2)
//! spherical             1 - 1.5 x + 0.5 x^3, x <= 1      1 - 1.5 int_0^1 (1 - s^2) J0(s w scale) ds
//! fractal               int f J0                         1 - (w scale)^-(6-2D), w scale >= 1
//! ```
//!
//! The covariance of the plane field is C(r) = s^2 int f(w) J0(w r) dw, that of a line process C1(z) = s^2 int f(w)
//! cos(w z) dw (equation 4: S1 = s^2 f / 2). The fractal is equation 5, f ~ w^-(7-2D). Its upper limit is the finest
//! wavelength of a field, which all models have; its lower limit is 1 / scale.
//!
//! The paper's names Simple Exponential, Double Exponential and Spherical are clear. Its Bessel 1, Bessel 2 and Telis
//! are taken to be Whittle A, Whittle B and the hole exponential; the table of Mantoglou & Wilson was not available to
//! confirm this.

use super::bessel_integrals::{SERIES_LIMIT, j0_integral, j0_power_tail, j0_series, power_law_constant};
use crate::setting::{SettingError, require};
use bevy::reflect::Reflect;
use puruspe::{Jn, Kn};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Nearer to 2 and 3 the power law's integrals diverge.
pub(super) const FRACTAL_DIMENSION: RangeInclusive<f64> = 2.02..=2.98;

/// How the covariance of a field falls with distance. Lengths are in units of the scale throughout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum CovarianceModel {
    /// Rough at every distance, as a fractal of dimension 2.5 up close. The paper's Simple Exponential.
    #[default]
    Exponential,
    /// Smooth without limit: rounded hills. The paper's Double Exponential; Gaussian elsewhere.
    DoubleExponential,
    /// Whittle's model: just not smooth, with correlation x K1(x).
    Bessel,
    /// The paper's Bessel 1 (unconfirmed): a field with a hollow in its spectrum at the longest waves.
    WhittleA,
    /// The paper's Bessel 2 (unconfirmed): as [`WhittleA`](Self::WhittleA), with a deeper hollow.
    WhittleB,
    /// The paper's Telis (unconfirmed): rough, with negative correlation around 3 scales.
    HoleExponential,
    /// Rough, and without any correlation from one scale up; the scale is its range.
    Spherical,
    /// A power-law spectrum for wavelengths below 2 pi scales: a fractal surface.
    Fractal {
        /// D, the dimension of the surface: 2.15 for the paper's real terrain. domain: \[2.02, 2.98\].
        dimension: f64,
    },
}

impl CovarianceModel {
    /// One of each, the fractal with the dimension of the paper's figure 2.
    pub const ALL: [Self; 8] = [
        Self::Exponential,
        Self::DoubleExponential,
        Self::Bessel,
        Self::WhittleA,
        Self::WhittleB,
        Self::HoleExponential,
        Self::Spherical,
        Self::Fractal { dimension: 2.15 },
    ];

    /// What the model is called.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Exponential => "exponential",
            Self::DoubleExponential => "double exponential",
            Self::Bessel => "Bessel",
            Self::WhittleA => "Whittle A",
            Self::WhittleB => "Whittle B",
            Self::HoleExponential => "hole exponential",
            Self::Spherical => "spherical",
            Self::Fractal { .. } => "fractal",
        }
    }

    /// C / s^2 at a distance of `x` >= 0 scales.
    pub fn correlation(&self, x: f64) -> f64 {
        if x < 1e-9 {
            return 1.0;
        }
        match *self {
            Self::Exponential => (-x).exp(),
            Self::DoubleExponential => (-x * x).exp(),
            Self::HoleExponential => (1.0 - x / 2.0) * (-x).exp(),
            Self::Spherical => {
                let x = x.min(1.0);
                1.0 - 1.5 * x + 0.5 * x.powi(3)
            }
            Self::Fractal { dimension } => fractal_correlation(6.0 - 2.0 * dimension, x),
            // K underflows there.
            _ if x > 600.0 => 0.0,
            Self::Bessel => x * Kn(1, x),
            Self::WhittleA => x * Kn(1, x) - x * x * Kn(0, x) / 2.0,
            Self::WhittleB => (x + x.powi(3) / 8.0) * Kn(1, x) - x * x * Kn(0, x),
        }
    }

    /// F, the share of the variance at angular wavenumbers up to `w` >= 0, in radians per scale.
    pub fn variance_below(&self, w: f64) -> f64 {
        let t = w * w;
        match *self {
            Self::Exponential => 1.0 - (1.0 + t).sqrt().recip(),
            Self::DoubleExponential => -(-t / 4.0).exp_m1(),
            Self::Bessel => t / (1.0 + t),
            Self::WhittleA => (t / (1.0 + t)).powi(2),
            Self::WhittleB => (t / (1.0 + t)).powi(3),
            Self::HoleExponential => 1.0 - (1.0 + 1.5 * t) / (1.0 + t).powf(1.5),
            Self::Spherical => spherical_variance_below(w),
            Self::Fractal { dimension } => 1.0 - w.max(1.0).powf(2.0 * dimension - 6.0),
        }
    }

    /// The wavenumber up to which the share `share` of the variance lies, in radians per scale; at most `limit`.
    pub(super) fn wavenumber_of(&self, share: f64, limit: f64) -> f64 {
        bisect(|w| self.variance_below(w) < share, 0.0, limit)
    }

    /// The distance at which the correlation first falls to 5%, in scales.
    pub fn practical_range(&self) -> f64 {
        const STEP: f64 = 0.05;
        const CORRELATION: f64 = 0.05;
        let above = |x: f64| self.correlation(x) > CORRELATION;
        let after = (1..400).map(|step| f64::from(step) * STEP).find(|&x| !above(x)).unwrap_or(400.0 * STEP);
        bisect(above, after - STEP, after)
    }

    /// Checks the dimension of a fractal; all other models have nothing to check.
    ///
    /// # Errors
    /// [`SettingError`] for a dimension outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        match *self {
            Self::Fractal { dimension } => require("dimension", dimension, FRACTAL_DIMENSION),
            _ => Ok(()),
        }
    }
}

/// Where `below` turns from true to false between `low` and `high`.
pub(super) fn bisect(below: impl Fn(f64) -> bool, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..52 {
        let middle = 0.5 * (low + high);
        if below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// `q int_1^inf w^-(q+1) J0(w x) dw` with q = 6 - 2D.
fn fractal_correlation(q: f64, x: f64) -> f64 {
    if x > SERIES_LIMIT {
        return q * x.powf(q) * j0_power_tail(x, q + 1.0);
    }
    // 1 - C = q x^q (int_0^inf - int_0^x) t^-(q+1) (1 - J0(t)) dt, the latter from the series of J0.
    let inner = -j0_series(x, 1, |k| 1.0 / (2.0 * k - q));
    1.0 - q * (x.powf(q) * power_law_constant(q) - inner)
}

/// `1 - 1.5 int_0^1 (1 - s^2) J0(s y) ds`.
fn spherical_variance_below(y: f64) -> f64 {
    if y < SERIES_LIMIT {
        return -1.5 * j0_series(y, 1, |k| 2.0 / ((2.0 * k + 1.0) * (2.0 * k + 3.0)));
    }
    // int_0^y t^2 J0 = y^2 J1 + y J0 - int_0^y J0
    let integral = j0_integral(y);
    1.0 - 1.5 * (integral * (1.0 + y.powi(-2)) - Jn(1, y) - Jn(0, y) / y) / y
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// C / s^2 = int J0(w x) dF(w) by the midpoint rule over narrow intervals: nothing but F is known.
    fn correlation_from_spectrum(model: CovarianceModel, x: f64) -> f64 {
        let (step, limit) = (2e-4_f64, 3e4);
        let (mut low, mut below, mut sum) = (0.0, 0.0, 0.0);
        while low < limit {
            // Narrow against the waves of J0(w x) at small w and against w itself at great ones.
            let high: f64 = low + step * (1.0 + low);
            let share = model.variance_below(high);
            sum += Jn(0, 0.5 * (low + high) * x) * (share - below);
            (low, below) = (high, share);
        }
        sum
    }

    #[test]
    fn every_correlation_is_the_hankel_transform_of_its_spectrum() {
        for model in CovarianceModel::ALL.into_iter().chain([CovarianceModel::Fractal { dimension: 2.6 }]) {
            for x in [0.03, 0.2, 0.7, 1.0, 2.4, 5.0, 17.0, 19.0] {
                let expected = correlation_from_spectrum(model, x);
                assert_relative_eq!(model.correlation(x), expected, epsilon = 3e-5);
            }
        }
    }

    #[test]
    fn spectra_rise_from_nothing_to_the_whole_variance() {
        for model in CovarianceModel::ALL {
            assert_relative_eq!(model.variance_below(0.0), 0.0, epsilon = 1e-12);
            // The slowest is the spherical, by 1.5 / w.
            assert_relative_eq!(model.variance_below(1e6), 1.0, epsilon = 2e-6);
            let shares: Vec<f64> = (0..4000).map(|step| model.variance_below(f64::from(step) * 0.02)).collect();
            assert!(shares.is_sorted_by(|a, b| *b >= a - 2e-9), "{model:?}");
        }
    }

    #[test]
    fn quantiles_invert_the_distribution() {
        for model in CovarianceModel::ALL {
            let w = model.wavenumber_of(0.7, 1e3);
            assert_relative_eq!(model.variance_below(w), 0.7, epsilon = 1e-9);
        }
    }

    #[test]
    fn practical_ranges_are_the_known_ones() {
        assert_relative_eq!(CovarianceModel::Exponential.practical_range(), 20f64.ln(), max_relative = 1e-9);
        assert_relative_eq!(
            CovarianceModel::DoubleExponential.practical_range(),
            20f64.ln().sqrt(),
            max_relative = 1e-9
        );
        for model in CovarianceModel::ALL {
            assert_relative_eq!(model.correlation(model.practical_range()), 0.05, epsilon = 1e-9);
        }
    }

    #[test]
    fn a_dimension_outside_the_power_law_is_refused() {
        let error = CovarianceModel::Fractal { dimension: 3.0 }.validate().unwrap_err();
        assert_eq!(error.to_string(), "`dimension` is 3, but must be 2.02 to 2.98");
    }
}
