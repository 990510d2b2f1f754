//! Real signals of a period, four at once, filtered in the frequency domain.
//!
//! A transfer function maps real signals to real responses. So two signals go through one complex transform, as its real and
//! imaginary parts.

use bevy::math::Vec4;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Spectra of a column's four signals: the first two as real and imaginary part, and the last two.
pub(super) type SignalSpectra = [Vec<Complex<f32>>; 2];

/// Filters four real signals of a period by a transfer function.
pub(super) struct PeriodicFilter {
    planner: FftPlanner<f32>,
    /// Samples of the signals.
    samples: usize,
    /// To so many samples.
    inverse: Arc<dyn Fft<f32>>,
    work: [Vec<Complex<f32>>; 2],
    scratch: Vec<Complex<f32>>,
}

impl PeriodicFilter {
    pub fn new(samples: usize) -> Self {
        let mut planner = FftPlanner::new();
        let inverse = planner.plan_fft_inverse(samples);
        Self { planner, samples, inverse, work: [Vec::new(), Vec::new()], scratch: Vec::new() }
    }

    /// Samples of the responses.
    pub fn samples(&self) -> usize {
        self.inverse.len()
    }

    pub fn spectra(&mut self, signals: &[Vec4]) -> SignalSpectra {
        let mut spectra: SignalSpectra = [
            signals.iter().map(|signal| Complex::new(signal.x, signal.y)).collect(),
            signals.iter().map(|signal| Complex::new(signal.z, signal.w)).collect(),
        ];
        let forward = self.planner.plan_fft_forward(self.samples);
        for spectrum in &mut spectra {
            forward.process(spectrum);
        }
        spectra
    }

    /// Chooses how many samples responses have from now on, at most as many as the signals.
    pub fn resample(&mut self, samples: usize) {
        self.inverse = self.planner.plan_fft_inverse(samples);
        self.scratch.resize(self.inverse.get_inplace_scratch_len(), Complex::ZERO);
        for work in &mut self.work {
            work.clear();
            work.resize(samples, Complex::ZERO);
        }
    }

    /// Appends the response to one column's signals. `transfer` has the bins from 0 to the middle.
    pub fn respond(&mut self, spectra: &SignalSpectra, transfer: &[Complex<f32>], out: &mut Vec<Vec4>) {
        // The transforms do not divide by the number of samples.
        let share = 1.0 / self.samples as f32;
        for (work, spectrum) in self.work.iter_mut().zip(spectra) {
            let count = work.len();
            work[0] = spectrum[0] * transfer[0] * share;
            for bin in 1..count.div_ceil(2) {
                let factor = transfer[bin] * share;
                work[bin] = spectrum[bin] * factor;
                work[count - bin] = spectrum[self.samples - bin] * factor.conj();
            }
            // The bin in the middle stands for both signs at once: it stays real, and of a longer series nothing is known of it.
            if count.is_multiple_of(2) {
                let is_whole = count == self.samples;
                work[count / 2] =
                    if is_whole { spectrum[count / 2] * (transfer[count / 2].re * share) } else { Complex::ZERO };
            }
            self.inverse.process_with_scratch(work, &mut self.scratch);
        }
        let [xy, zw] = &self.work;
        out.extend(xy.iter().zip(zw).map(|(xy, zw)| Vec4::new(xy.re, xy.im, zw.re, zw.im)));
    }
}
