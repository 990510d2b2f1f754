//! The motion of a trunk's tip in a wind that is felt by every part of its crown.

use super::{
    bands::Bands,
    crown::Crown,
    wind::{Component, CrownWind, respond},
};
use bevy_windwood::wind::FieldSettings;
use nalgebra::DVector;
use rustfft::{FftPlanner, num_complex::Complex};
use std::ops::Range;

/// Steps of the integration in a period: 1/32 s, which leaves 2% of the power of a load at 2.5 Hz out.
const STEPS: usize = 4096;

/// What the trunk is, beside its crown.
#[derive(Clone, Copy)]
pub struct Trunk {
    /// It moves as the sum of two oscillators; the second may have no share of the deflection.
    pub oscillators: [Oscillator; 2],
    /// The product's deflection of the tip in a steady wind, over that of the trunk by finite elements.
    pub static_factor: f64,
}

#[derive(Clone, Copy)]
pub struct Oscillator {
    pub frequency_hz: f64,
    pub damping_ratio: f64,
    /// Of the deflection.
    pub share: f64,
}

impl Trunk {
    fn present(&self) -> impl Iterator<Item = &Oscillator> {
        self.oscillators.iter().filter(|oscillator| oscillator.share > 0.0)
    }

    /// The motion under a load.
    fn respond(&self, load: &[f64], step_s: f64) -> Vec<f64> {
        let mut motion = vec![0.0; load.len()];
        for Oscillator { frequency_hz, damping_ratio, share } in self.present() {
            let of_one = respond(load, *frequency_hz, *damping_ratio, step_s);
            motion.iter_mut().zip(of_one).for_each(|(sum, value)| *sum += share * value);
        }
        motion
    }

    /// Power of the motion at a frequency by that of its load.
    fn transfer(&self, frequency_hz: f64) -> f64 {
        let of_one = |oscillator: &Oscillator| {
            let ratio = frequency_hz / oscillator.frequency_hz;
            Complex::new(1.0 - ratio * ratio, 2.0 * oscillator.damping_ratio * ratio).inv() * oscillator.share
        };
        self.present().map(of_one).sum::<Complex<f64>>().norm_sqr()
    }
}

/// Power of the tip's motion over the realisations of `seeds`, and its mean along the wind, m.
pub fn simulate(crown: &Crown, trunk: &Trunk, settings: &FieldSettings, seeds: Range<u64>) -> (Bands, f64) {
    let wind = CrownWind::new(settings, crown);
    let [along, across] =
        [Component::Along, Component::Across].map(|component| wind.amplitudes(component, seeds.clone()));
    let fft = FftPlanner::new().plan_fft_inverse(STEPS);
    let step_s = settings.resolution.period_s() / STEPS as f64;
    let (mut bands, mut mean_m) = (Bands::default(), 0.0);
    for (along, across) in along.iter().zip(&across) {
        let mut loads = [vec![0.0; STEPS], vec![0.0; STEPS]];
        for (cell, mean_m_s) in wind.means_m_s.iter().enumerate() {
            // Two real series in one transform, as its real and its imaginary part.
            let mut series = vec![Complex::default(); STEPS];
            for bin in 1..=wind.bins() {
                let (u, v) = (along[cell][bin] / 2.0, across[cell][bin] / 2.0 * Complex::i());
                series[bin] = u + v;
                series[STEPS - bin] = u.conj() + (across[cell][bin] / 2.0).conj() * Complex::i();
            }
            fft.process(&mut series);
            let weight = trunk.static_factor * crown.cells[cell].weight;
            for (step, turbulence) in series.iter().enumerate() {
                let velocity = Complex::new(mean_m_s + turbulence.re, turbulence.im);
                let drag = weight * velocity.norm() * velocity;
                loads[0][step] += drag.re;
                loads[1][step] += drag.im;
            }
        }
        let [x, z] = loads.map(|load| trunk.respond(&load, step_s));
        mean_m += x.iter().sum::<f64>() / STEPS as f64;
        bands.add(x.iter().zip(&z).map(|(x, z)| Complex::new(*x, *z)).collect());
    }
    (bands, mean_m / (seeds.end - seeds.start) as f64)
}

/// The same from the linear theory of buffeting, exact for weak turbulence: variance of the tip's motion, m^2. And that in
/// a wind which is one over the whole crown.
pub fn linear_variances(crown: &Crown, trunk: &Trunk, settings: &FieldSettings) -> [f64; 2] {
    let wind = CrownWind::new(settings, crown);
    let cells = crown.cells.len();
    let mut variances = [0.0; 2];
    for (component, slope) in [(Component::Along, 2.0), (Component::Across, 1.0)] {
        let weights =
            (0..cells).map(|cell| slope * trunk.static_factor * crown.cells[cell].weight * wind.means_m_s[cell]);
        let weights = DVector::from_iterator(cells, weights);
        wind.for_each_factor(component, |bin, factor| {
            let pulls = wind.deviations_m_s(component, bin).component_mul(&weights);
            let part = |of: fn(Complex<f64>) -> f64| {
                let delayed = DVector::from_fn(cells, |cell, _| pulls[cell] * of(wind.delay(cell, bin)));
                factor.tr_mul(&delayed).norm_squared()
            };
            let transfer = trunk.transfer(wind.frequency_hz(bin));
            variances[0] += transfer * (part(|delay| delay.re) + part(|delay| delay.im));
            variances[1] += transfer * pulls.sum().powi(2);
        });
    }
    variances
}
