//! One mode in time, by the Duhamel integral and as a periodic steady state. In f64, for checks.
//!
//! The amplitude of a mode obeys (21), with `p = P_n / M_n` the load by mass:
//!
//! ```text
//! Y'' + 2 xi w_n Y' + w_n^2 Y = p(t)
//! ```
//!
//! - [`Oscillator::duhamel`] is the paper's integral (24), `Y(t) = int_0^t p(tau) h(t - tau) dtau` with
//!   `h(x) = e^(-xi w_n x) sin(w_D x) / w_D` and `w_D = w_n sqrt(1 - xi^2)`. For each time it integrates over all the past.
//! - [`Oscillator::periodic_response`] is the steady state under a periodic load, exact in each bin of its spectrum:
//!   `Y^ = p^ / (w_n^2 - w^2 + 2 i xi w_n w)`.
//!
//! A load sampled in time is linear between the samples for the first and band-limited for the second. They differ by
//! the second order of the step.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;

/// A damped oscillator, below critical damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillator {
    omega_rad_s: f64,
    damping_ratio: f64,
}

impl Oscillator {
    /// An oscillator of the natural angular frequency `omega_rad_s` (above 0) and the damping ratio `damping_ratio` (from
    /// 0 to below 1).
    pub fn new(omega_rad_s: f64, damping_ratio: f64) -> Self {
        assert!(omega_rad_s > 0.0 && omega_rad_s.is_finite(), "omega_rad_s is {omega_rad_s}");
        assert!((0.0..1.0).contains(&damping_ratio), "damping_ratio is {damping_ratio}");
        Self { omega_rad_s, damping_ratio }
    }

    /// The response (eq. 24) from rest at the first sample, at every sample of a load in m/s^2 that is linear between
    /// samples `time_step_s` apart. The effort grows with the square of the number of samples.
    pub fn duhamel(&self, load_per_mass: &[f64], time_step_s: f64) -> Vec<f64> {
        (0..load_per_mass.len()).map(|end| self.duhamel_at(load_per_mass, time_step_s, end)).collect()
    }

    /// The Duhamel integral from sample 0 to sample `end`, which counts as the last if there is none.
    ///
    /// Within one interval the load is `p_1 + (p_0 - p_1) (x - a) / dt` at the lag `x` from `a` to `a + dt`, and the
    /// moments of `e^(lambda x)`, `lambda = -xi w_n + i w_D`, have closed forms.
    pub fn duhamel_at(&self, load_per_mass: &[f64], time_step_s: f64, end: usize) -> f64 {
        let lambda = self.eigenvalue();
        let inverse = lambda.inv();
        let series = &load_per_mass[..load_per_mass.len().min(end + 1)];
        let mut sum = Complex::<f64>::ZERO;
        let mut near = Complex::ONE;
        for (interval, pair) in series.windows(2).rev().enumerate() {
            let far = (lambda * (interval + 1) as f64 * time_step_s).exp();
            let area = (far - near) * inverse;
            let moment = (far * time_step_s - area) * inverse;
            sum += area * pair[1] + moment * ((pair[0] - pair[1]) / time_step_s);
            near = far;
        }
        sum.im / lambda.im
    }

    /// The steady response in m, at every sample, to a periodic load in m/s^2 given over one period.
    pub fn periodic_response(&self, load_per_mass: &[f64], time_step_s: f64) -> Vec<f64> {
        let count = load_per_mass.len();
        let mut planner = FftPlanner::new();
        let mut spectrum: Vec<Complex<f64>> = load_per_mass.iter().map(|&load| load.into()).collect();
        planner.plan_fft_forward(count).process(&mut spectrum);
        let omega_step = TAU / (count as f64 * time_step_s);
        for (bin, value) in spectrum.iter_mut().enumerate() {
            let signed = if 2 * bin > count { bin as f64 - count as f64 } else { bin as f64 };
            *value *= self.receptance(signed * omega_step) / count as f64;
        }
        planner.plan_fft_inverse(count).process(&mut spectrum);
        spectrum.iter().map(|value| value.re).collect()
    }

    /// Displacement by load by mass at the angular frequency `omega_rad_s`, in s^2.
    fn receptance(&self, omega_rad_s: f64) -> Complex<f64> {
        let natural = self.omega_rad_s;
        let damping = 2.0 * self.damping_ratio * natural * omega_rad_s;
        Complex::new(natural * natural - omega_rad_s * omega_rad_s, damping).inv()
    }

    fn eigenvalue(&self) -> Complex<f64> {
        let decay = self.damping_ratio * self.omega_rad_s;
        Complex::new(-decay, self.omega_rad_s * (1.0 - self.damping_ratio.powi(2)).sqrt())
    }
}
