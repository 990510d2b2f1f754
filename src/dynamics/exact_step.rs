//! One step of a damped oscillator, without error: for oscillators that run live.
//!
//! The motion of whole trees is periodic and comes from the table of `response`. What is not periodic (gusts that a game
//! makes, pushes, impacts) takes live oscillators, for the few trees that are touched (`live`). They obey (21), with `p` the load by
//! mass:
//!
//! ```text
//! Y'' + 2 xi w_n Y' + w_n^2 Y = p(t)
//! ```

use crate::setting::SettingError;
use rustfft::num_complex::Complex;
use std::ops::{Add, Mul};

/// Displacement and velocity of an oscillator, or of several side by side in a vector `T`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OscillatorState<T> {
    /// Displacement; in m, if the load by mass is in m/s^2.
    pub displacement: T,
    /// Velocity; in m/s, if the load by mass is in m/s^2.
    pub velocity: T,
}

/// The state after one step of fixed length, as a linear function of the state and of the loads before and after. It is
/// exact for a load by mass that is linear within the step, and stable for any step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactStep {
    /// New displacement by old displacement, old velocity, load before, load after.
    displacement: [f32; 4],
    /// New velocity likewise.
    velocity: [f32; 4],
}

impl ExactStep {
    /// The transition over `time_step_s` (above 0) of an oscillator of the natural angular frequency `omega_rad_s` (above 0)
    /// and the damping ratio `damping_ratio` (from 0 to below 1).
    ///
    /// # Errors
    /// The first argument outside its domain.
    pub fn new(omega_rad_s: f64, damping_ratio: f64, time_step_s: f64) -> Result<Self, SettingError> {
        require_positive("omega_rad_s", omega_rad_s)?;
        if !(0.0..1.0).contains(&damping_ratio) {
            return Err(SettingError::new("damping_ratio", damping_ratio, "at least 0 and below 1"));
        }
        require_positive("time_step_s", time_step_s)?;
        let damped_omega_rad_s = omega_rad_s * (1.0 - damping_ratio.powi(2)).sqrt();
        let lambda = Complex::new(-damping_ratio * omega_rad_s, damped_omega_rad_s);
        let end = (lambda * time_step_s).exp();
        // The impulse response h, its derivative, and the integrals of h and of x h over the step: the imaginary parts of
        // the same of e^(lambda x), by w_D.
        let area = (end - 1.0) / lambda;
        let moment = (end * time_step_s - area) / lambda;
        let [impulse, rate, area, moment] = [end, lambda * end, area, moment].map(|z| z.im / lambda.im);
        let damping = 2.0 * damping_ratio * omega_rad_s;
        // The load before acts at the lag x = dt, the load after at the lag 0. Displacement is int p h, and velocity
        // int p h', by parts.
        let before = moment / time_step_s;
        let slope_before = impulse - area / time_step_s;
        let row = |values: [f64; 4]| values.map(|value| value as f32);
        Ok(Self {
            displacement: row([rate + damping * impulse, impulse, before, area - before]),
            velocity: row([-omega_rad_s.powi(2) * impulse, rate, slope_before, impulse - slope_before]),
        })
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

fn require_positive(field: &str, value: f64) -> Result<(), SettingError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(SettingError::new(field, value, "positive and finite")) }
}

#[cfg(test)]
mod tests {
    use super::{
        super::oracle::{
            oscillator::Oscillator,
            series::{load, relative_rms},
        },
        *,
    };

    #[test]
    fn exact_step_follows_the_duhamel_integral() {
        for (omega, xi) in [(0.6, 0.05), (7.0, 0.1), (40.0, 0.9)] {
            let loads = load(64, 4);
            let oracle = Oscillator::new(omega, xi).duhamel(&loads, 1.0 / 64.0);
            let step = ExactStep::new(omega, xi, 1.0 / 64.0).unwrap();
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
    fn arguments_outside_their_domain_are_named() {
        let error = |omega, xi| ExactStep::new(omega, xi, 0.1).unwrap_err().to_string();
        assert_eq!(error(0.0, 0.1), "`omega_rad_s` is 0, but must be positive and finite");
        assert!(error(f64::NAN, 0.1).starts_with("`omega_rad_s` is NaN"));
        assert!(error(1.0, f64::NAN).starts_with("`damping_ratio` is NaN"));
        assert_eq!(error(1.0, 1.0), "`damping_ratio` is 1, but must be at least 0 and below 1");
        assert!(ExactStep::new(1.0, 0.1, 0.0).is_err());
    }
}
