//! Power of a motion in octaves.

use rustfft::{FftPlanner, num_complex::Complex};

/// First bins of the octaves. The slowest three bins are one: alone they would scatter too much. The last ends at 4 Hz.
const STARTS: [usize; 9] = [1, 4, 8, 16, 32, 64, 128, 256, 512];
pub const OCTAVES: usize = STARTS.len() - 1;

/// Power in octaves, summed over series of a whole period, m^2.
#[derive(Clone, Copy, Default)]
pub struct Bands {
    octaves: [f64; OCTAVES],
    series: f64,
}

impl Bands {
    /// Adds a series of a period, (along, across) as a complex number.
    pub fn add(&mut self, mut series: Vec<Complex<f64>>) {
        let samples = series.len();
        FftPlanner::new().plan_fft_forward(samples).process(&mut series);
        for (octave, power) in self.octaves.iter_mut().enumerate() {
            let bins = STARTS[octave]..STARTS[octave + 1];
            let both_signs = bins.map(|bin| series[bin].norm_sqr() + series[samples - bin].norm_sqr());
            *power += both_signs.sum::<f64>() / (samples as f64).powi(2);
        }
        self.series += 1.0;
    }

    pub fn merge(&mut self, other: &Self) {
        self.octaves.iter_mut().zip(other.octaves).for_each(|(sum, power)| *sum += power);
        self.series += other.series;
    }

    /// Mean power of each octave, m^2.
    pub fn powers(&self) -> [f64; OCTAVES] {
        self.octaves.map(|power| power / self.series)
    }

    pub fn variance(&self) -> f64 {
        self.powers().iter().sum()
    }
}
