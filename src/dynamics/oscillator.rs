//! One mode in time: the damped oscillator, solved in three ways.
//!
//! The amplitude of a mode obeys (21), with `p = P_n / M_n` the load by mass:
//!
//! ```text
//! Y'' + 2 xi w_n Y' + w_n^2 Y = p(t)
//! ```
//!
//! - [`Oscillator::duhamel`] is the paper's integral (24), `Y(t) = int_0^t p(tau) h(t - tau) dtau` with
//!   `h(x) = e^(-xi w_n x) sin(w_D x) / w_D` and `w_D = w_n sqrt(1 - xi^2)`: all the past for each time. Slow, the oracle.
//! - [`ExactStep`] carries displacement and velocity over one step, without error for a load linear in it: for live use.
//! - [`Oscillator::periodic_response`] is the steady state under a periodic load, exact in each bin of its spectrum:
//!   `Y^ = p^ / (w_n^2 - w^2 + 2 i xi w_n w)`.
//!
//! A load sampled in time is linear between the samples for the first two and band-limited for the third; they differ by
//! the second order of the step.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;
use std::ops::{Add, Mul};

/// A damped oscillator, below critical damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillator {
    omega_rad_s: f64,
    damping_ratio: f64,
}

/// Why an oscillator cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidOscillator {
    /// The natural frequency is not a positive number.
    #[error("omega_rad_s is {0}, but must be positive and finite")]
    Omega(f64),
    /// The damping ratio is outside 0..1.
    #[error("damping_ratio is {0}, but must be at least 0 and below 1")]
    DampingRatio(f64),
}

impl Oscillator {
    /// An oscillator of the natural angular frequency `omega_rad_s` (above 0) and the damping ratio `damping_ratio` (from
    /// 0 to below 1).
    pub fn new(omega_rad_s: f64, damping_ratio: f64) -> Result<Self, InvalidOscillator> {
        if !(omega_rad_s > 0.0 && omega_rad_s.is_finite()) {
            Err(InvalidOscillator::Omega(omega_rad_s))
        } else if !(0.0..1.0).contains(&damping_ratio) {
            Err(InvalidOscillator::DampingRatio(damping_ratio))
        } else {
            Ok(Self { omega_rad_s, damping_ratio })
        }
    }

    /// Natural angular frequency without damping, in rad/s.
    pub fn omega_rad_s(&self) -> f64 {
        self.omega_rad_s
    }

    /// Damping as a share of the critical one.
    pub fn damping_ratio(&self) -> f64 {
        self.damping_ratio
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
    pub fn receptance(&self, omega_rad_s: f64) -> Complex<f64> {
        let natural = self.omega_rad_s;
        let damping = 2.0 * self.damping_ratio * natural * omega_rad_s;
        Complex::new(natural * natural - omega_rad_s * omega_rad_s, damping).inv()
    }

    fn eigenvalue(&self) -> Complex<f64> {
        let decay = self.damping_ratio * self.omega_rad_s;
        Complex::new(-decay, self.omega_rad_s * (1.0 - self.damping_ratio.powi(2)).sqrt())
    }
}

/// Displacement and velocity of an oscillator, or of several side by side in a vector `T`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OscillatorState<T> {
    /// Displacement; in m, if the load by mass is in m/s^2.
    pub displacement: T,
    /// Velocity; in m/s, if the load by mass is in m/s^2.
    pub velocity: T,
}

/// The state after one step of fixed length as a linear function of the state and the load before and after: exact for a
/// load by mass that is linear within the step, and stable for any step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactStep {
    /// New displacement by old displacement, old velocity, load before, load after.
    displacement: [f32; 4],
    /// New velocity likewise.
    velocity: [f32; 4],
}

impl ExactStep {
    /// The transition of `oscillator` over `time_step_s` (above 0).
    pub fn new(oscillator: Oscillator, time_step_s: f64) -> Self {
        let lambda = oscillator.eigenvalue();
        let end = (lambda * time_step_s).exp();
        // The impulse response h, its derivative, and the integrals of h and of x h over the step: the imaginary parts of
        // the same of e^(lambda x), by w_D.
        let area = (end - 1.0) / lambda;
        let moment = (end * time_step_s - area) / lambda;
        let [impulse, rate, area, moment] = [end, lambda * end, area, moment].map(|z| z.im / lambda.im);
        let damping = 2.0 * oscillator.damping_ratio * oscillator.omega_rad_s;
        // The load before acts at the lag x = dt, the load after at the lag 0. Displacement is int p h, and velocity
        // int p h', by parts.
        let before = moment / time_step_s;
        let slope_before = impulse - area / time_step_s;
        let row = |values: [f64; 4]| values.map(|value| value as f32);
        Self {
            displacement: row([rate + damping * impulse, impulse, before, area - before]),
            velocity: row([-oscillator.omega_rad_s.powi(2) * impulse, rate, slope_before, impulse - slope_before]),
        }
    }

    /// Carries a state over one step, for the load by mass at its beginning and its end.
    #[inline]
    pub fn advance<T>(&self, state: OscillatorState<T>, load_before: T, load_after: T) -> OscillatorState<T>
    where
        T: Copy + Add<Output = T> + Mul<f32, Output = T>,
    {
        let combine = |row: &[f32; 4]| {
            state.displacement * row[0] + state.velocity * row[1] + load_before * row[2] + load_after * row[3]
        };
        OscillatorState { displacement: combine(&self.displacement), velocity: combine(&self.velocity) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A load of a few harmonics of the period 1, sampled `count` times over `periods` periods.
    fn load(count: usize, periods: usize) -> Vec<f64> {
        let value = |t: f64| (TAU * t).sin() + 0.5 * (TAU * 3.0 * t + 1.0).cos() + 0.2 * (TAU * 5.0 * t).sin() + 0.3;
        (0..count * periods).map(|index| value(index as f64 / count as f64)).collect()
    }

    fn relative_rms(values: &[f64], reference: &[f64]) -> f64 {
        let square = |series: &mut dyn Iterator<Item = f64>| series.map(|value| value * value).sum::<f64>();
        let error = square(&mut values.iter().zip(reference).map(|(a, b)| a - b));
        (error / square(&mut reference.iter().copied())).sqrt()
    }

    #[test]
    fn duhamel_answers_a_step_as_the_textbook_does() {
        let (omega, xi, dt) = (7.0, 0.15, 0.01);
        let response = Oscillator::new(omega, xi).unwrap().duhamel(&[omega * omega; 300], dt);
        let damped = omega * (1.0f64 - xi * xi).sqrt();
        for (index, value) in response.iter().enumerate() {
            let t = index as f64 * dt;
            let decay = (-xi * omega * t).exp();
            let closed = 1.0 - decay * ((damped * t).cos() + xi * omega / damped * (damped * t).sin());
            // A constant load is integrated without error but for rounding.
            assert!((value - closed).abs() < 1e-11, "{value} is not {closed} at {t} s");
        }
    }

    #[test]
    fn exact_step_follows_the_duhamel_integral() {
        for (omega, xi) in [(0.6, 0.05), (7.0, 0.1), (40.0, 0.9)] {
            let oscillator = Oscillator::new(omega, xi).unwrap();
            let loads = load(64, 4);
            let oracle = oscillator.duhamel(&loads, 1.0 / 64.0);
            let step = ExactStep::new(oscillator, 1.0 / 64.0);
            let mut state = OscillatorState::default();
            let mut stepped = vec![0.0];
            for pair in loads.windows(2) {
                state = step.advance(state, pair[0] as f32, pair[1] as f32);
                stepped.push(f64::from(state.displacement));
            }
            // Both are exact for this load; the step is in f32, whose rounding adds up over 256 steps.
            assert!(relative_rms(&stepped, &oracle) < 1e-5);
        }
    }

    #[test]
    fn long_duhamel_integral_settles_into_the_periodic_response() {
        // With xi w = 1.5 / s what is left of the beginning after nine periods is e^-13.5 = 1.4e-6.
        let oscillator = Oscillator::new(15.0, 0.1).unwrap();
        let errors = [32, 64, 128].map(|count| {
            let steady = oscillator.periodic_response(&load(count, 1), 1.0 / count as f64);
            let long = oscillator.duhamel(&load(count, 10), 1.0 / count as f64);
            relative_rms(&long[9 * count..], &steady)
        });
        // A load linear between samples loses (w dt)^2 / 12 of each harmonic: 8% of the fifth at 32 samples.
        assert!(errors[0] < 0.08, "{errors:?}");
        // Second order: half the step, a quarter of the error.
        for pair in errors.windows(2) {
            assert!((pair[0] / pair[1] - 4.0).abs() < 0.2, "{errors:?}");
        }
    }

    #[test]
    fn stiff_oscillators_follow_the_load_itself() {
        let loads = load(64, 1);
        let response = Oscillator::new(1e4, 0.05).unwrap().periodic_response(&loads, 1.0 / 64.0);
        let scaled: Vec<f64> = response.iter().map(|value| value * 1e8).collect();
        // The fifth harmonic is at 31 rad/s: (31 / 1e4)^2 and 2 xi 31 / 1e4 are what is left.
        assert!(relative_rms(&scaled, &loads) < 1e-3);
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        assert_eq!(Oscillator::new(0.0, 0.1), Err(InvalidOscillator::Omega(0.0)));
        assert!(Oscillator::new(f64::NAN, 0.1).is_err());
        assert!(Oscillator::new(1.0, f64::NAN).is_err());
        let message = Oscillator::new(1.0, 1.0).unwrap_err().to_string();
        assert_eq!(message, "damping_ratio is 1, but must be at least 0 and below 1");
        let oscillator = Oscillator::new(1.0, 0.1).unwrap();
        assert!(oscillator.duhamel(&[], 0.1).is_empty() && oscillator.periodic_response(&[], 0.1).is_empty());
    }
}
