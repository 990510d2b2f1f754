//! Integrals of the Bessel function J0 against powers, which spherical and fractal covariances are made of.
//!
//! ```text
//! int_x^inf t^-p J0(t) dt = -x^-p J1(x) + (p+1) x^-(p+1) J0(x) - (p+1)^2 int_x^inf t^-(p+2) J0(t) dt
//! int_0^inf t^-(q+1) (1 - J0(t)) dt = -Gamma(-q/2) / (2^(q+1) Gamma(1 + q/2))            0 < q < 2
//! ```
//!
//! The first is two integrations by parts, with (t J1)' = t J0 and J0' = -J1; repeated, it is an asymptotic series. Up
//! to [`SERIES_LIMIT`] the power series of J0 is integrated instead, term by term. Where they meet, both are right to
//! 1e-8.

use puruspe::{Jn, gamma};

/// Where the power series hands over to the asymptotic one: beyond, cancellation costs the former more than 10 digits.
pub(super) const SERIES_LIMIT: f64 = 18.0;

/// The sum over k of `(-1)^k (x/2)^(2k) / (k!)^2 factor(k)`, from k = `first`; `factor` = 1 gives J0. For x up to
/// [`SERIES_LIMIT`].
pub(super) fn j0_series(x: f64, first: i32, factor: impl Fn(f64) -> f64) -> f64 {
    const TERMS: i32 = 60;
    let quarter = x * x / 4.0;
    let (mut term, mut sum) = (1.0, 0.0);
    for k in 0..TERMS {
        let order = f64::from(k);
        if k > 0 {
            term *= -quarter / (order * order);
        }
        if k >= first {
            sum += term * factor(order);
        }
    }
    sum
}

/// `int_x^inf t^-p J0(t) dt` for x from [`SERIES_LIMIT`] up and p >= 0.
pub(super) fn j0_power_tail(x: f64, p: f64) -> f64 {
    let (j0, j1) = (Jn(0, x), Jn(1, x));
    let (mut power, mut factor, mut sum, mut least) = (p, x.powf(-p), 0.0, f64::INFINITY);
    loop {
        let term = factor * (-j1 + (power + 1.0) / x * j0);
        // An asymptotic series is best cut where its terms begin to grow.
        if factor.abs() >= least || factor.abs() < 1e-17 {
            return sum;
        }
        (least, sum) = (factor.abs(), sum + term);
        factor *= -((power + 1.0) / x).powi(2);
        power += 2.0;
    }
}

/// `int_0^x J0(t) dt` for x >= 0.
pub(super) fn j0_integral(x: f64) -> f64 {
    if x < SERIES_LIMIT { x * j0_series(x, 0, |k| 1.0 / (2.0 * k + 1.0)) } else { 1.0 - j0_power_tail(x, 0.0) }
}

/// `int_0^inf t^-(q+1) (1 - J0(t)) dt` for 0 < q < 2.
pub(super) fn power_law_constant(q: f64) -> f64 {
    // Gamma(-q/2) from the arguments that the library covers: Gamma(z) = Gamma(z + 1) / z.
    let half = q / 2.0;
    gamma(1.0 - half) / half / (2f64.powf(q + 1.0) * gamma(1.0 + half))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Simpson's rule, as an oracle.
    fn integral(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
        let steps = 40_000;
        let step = (to - from) / f64::from(steps);
        let weight = |index| match index {
            0 => 1.0,
            index if index == steps => 1.0,
            index if index % 2 == 1 => 4.0,
            _ => 2.0,
        };
        (0..=steps).map(|index| weight(index) * f(from + f64::from(index) * step)).sum::<f64>() * step / 3.0
    }

    #[test]
    fn the_integral_of_j0_agrees_with_quadrature_on_both_sides_of_the_limit() {
        for x in [0.0, 0.5, 7.3, 17.99, 18.01, 40.0, 300.0] {
            assert_relative_eq!(j0_integral(x), integral(0.0, x, |t| Jn(0, t)), epsilon = 1e-8);
        }
    }

    #[test]
    fn power_tails_differ_by_the_integral_between() {
        for p in [0.0, 1.02, 2.0, 2.9] {
            let between = integral(20.0, 50.0, |t| t.powf(-p) * Jn(0, t));
            assert_relative_eq!(j0_power_tail(20.0, p) - j0_power_tail(50.0, p), between, epsilon = 1e-9);
        }
    }

    #[test]
    fn the_power_law_constant_agrees_with_quadrature() {
        for q in [0.1, 0.6, 1.0, 1.7, 1.9] {
            let x = 30.0;
            // Up to 1 in t = u^(1/(2-q)), where the integrand is smooth; then plainly; then the tail.
            let root = 1.0 / (2.0 - q);
            let near = integral(1e-9, 1.0, |u: f64| {
                let t = u.powf(root);
                -j0_series(t, 1, |_| 1.0) * t.powi(-2) * root
            });
            let middle = integral(1.0, x, |t| t.powf(-q - 1.0) * (1.0 - Jn(0, t)));
            let far = x.powf(-q) / q - j0_power_tail(x, q + 1.0);
            assert_relative_eq!(power_law_constant(q), near + middle + far, max_relative = 1e-6);
        }
    }
}
