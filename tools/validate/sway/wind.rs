//! Wind in all cells of a crown at once, synthesised apart from the crate's own.
//!
//! The spectra are those of Kaimal as Simiu & Scanlan give them, the coherence is Davenport's, both for the height and the
//! mean speed of each place; along the wind turbulence is frozen and arrives later (Taylor). For each frequency the
//! coherence of the cells, each the mean over its places, is factorised (Cholesky), and random phases give amplitudes (Shinozuka &
//! Jan 1972).

use super::crown::{Cell, Crown};
use bevy_windwood::wind::FieldSettings;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rustfft::num_complex::Complex;
use std::f64::consts::{PI, TAU};

/// Frequencies above this move no trunk, Hz.
const HIGHEST_HZ: f64 = 4.0;
const VON_KARMAN: f64 = 0.4;
const REFERENCE_HEIGHT_M: f64 = 10.0;
/// Added to the diagonal of a coherence: in the slowest frequencies all cells are nearly one.
const JITTER: f64 = 1e-7;

/// Along the wind, and level across it.
#[derive(Clone, Copy)]
pub enum Component {
    Along,
    Across,
}

/// A wind over a crown.
pub struct CrownWind<'a> {
    settings: &'a FieldSettings,
    crown: &'a Crown,
    /// Mean speed at each cell, m/s.
    pub means_m_s: Vec<f64>,
    period_s: f64,
}

impl<'a> CrownWind<'a> {
    pub fn new(settings: &'a FieldSettings, crown: &'a Crown) -> Self {
        let means_m_s = crown.cells.iter().map(|cell| mean_speed_m_s(settings, cell.at.y)).collect();
        Self { settings, crown, means_m_s, period_s: settings.resolution.period_s() }
    }

    /// Number of frequencies, the first of which is one cycle in a period. Those of the product's period: what is slower
    /// is in neither.
    pub fn bins(&self) -> usize {
        (HIGHEST_HZ * self.period_s) as usize
    }

    pub fn frequency_hz(&self, bin: usize) -> f64 {
        bin as f64 / self.period_s
    }

    /// Standard deviation of a component at each cell in the band of a bin, m/s.
    pub fn deviations_m_s(&self, component: Component, bin: usize) -> DVector<f64> {
        let frequency_hz = self.frequency_hz(bin);
        let friction_m_s = VON_KARMAN * f64::from(self.settings.speed) / self.log_of(REFERENCE_HEIGHT_M);
        let of_cell = |cell: &Cell| {
            let height_m = turbulence_height_m(self.settings, cell.at.y);
            let eddy_time_s = height_m / (friction_m_s / VON_KARMAN * self.log_of(height_m + self.displacement_m()));
            let reduced = frequency_hz * eddy_time_s;
            let shape = match component {
                Component::Along => 200.0 / (1.0 + 50.0 * reduced).powf(5.0 / 3.0),
                Component::Across => 15.0 / (1.0 + 9.5 * reduced).powf(5.0 / 3.0),
            };
            (friction_m_s.powi(2) * eddy_time_s * shape / self.period_s).sqrt()
        };
        f64::from(self.settings.gustiness)
            * DVector::from_iterator(self.crown.cells.len(), self.crown.cells.iter().map(of_cell))
    }

    /// The delay of a cell by frozen turbulence, as a factor.
    pub fn delay(&self, cell: usize, bin: usize) -> Complex<f64> {
        let delay_s = self.crown.cells[cell].at.x / self.drift_m_s();
        Complex::cis(-TAU * self.frequency_hz(bin) * delay_s)
    }

    fn drift_m_s(&self) -> f64 {
        f64::from(self.settings.speed)
    }

    fn displacement_m(&self) -> f64 {
        f64::from(self.settings.displacement_m)
    }

    fn log_of(&self, height_m: f64) -> f64 {
        ((height_m - self.displacement_m()) / f64::from(self.settings.roughness_m)).ln()
    }

    /// Calls `with` for each frequency with a factor of the coherence of all cells.
    pub fn for_each_factor(&self, component: Component, mut with: impl FnMut(usize, &DMatrix<f64>)) {
        let mut pairs = self.pairs(component);
        let cells = self.crown.cells.len();
        for bin in 1..=self.bins() {
            let mut coherence = DMatrix::zeros(cells, cells);
            let frequency_hz = self.frequency_hz(bin);
            for pair in &mut pairs {
                let mut sum = 0.0;
                for place in &mut pair.places {
                    place.coherence *= place.step;
                    sum += place.coherence
                        * if place.delay_s == 0.0 { 1.0 } else { (TAU * frequency_hz * place.delay_s).cos() };
                }
                coherence[(pair.a, pair.b)] = sum / pair.places.len() as f64;
                coherence[(pair.b, pair.a)] = coherence[(pair.a, pair.b)];
            }
            with(bin, &factor(coherence));
        }
    }

    fn pairs(&self, component: Component) -> Vec<Pair> {
        let decay = match component {
            Component::Along => self.settings.coherence.along,
            Component::Across => self.settings.coherence.across,
        };
        let (lateral, vertical) = (f64::from(decay.lateral), f64::from(decay.vertical));
        let cells = &self.crown.cells;
        let mut pairs = Vec::new();
        for a in 0..cells.len() {
            for b in a..cells.len() {
                let mut places = Vec::with_capacity(cells[a].places.len() * cells[b].places.len());
                for p in &cells[a].places {
                    for q in &cells[b].places {
                        let speed_m_s = (mean_speed_m_s(self.settings, p.y) + mean_speed_m_s(self.settings, q.y)) / 2.0;
                        let decay_s = (lateral * (p.z - q.z)).hypot(vertical * (p.y - q.y)) / speed_m_s.max(0.1);
                        // Between cells the delay is that of their centres.
                        let delay_s = if a == b { (p.x - q.x) / self.drift_m_s() } else { 0.0 };
                        places.push(PlacePair { coherence: 1.0, step: (-decay_s / self.period_s).exp(), delay_s });
                    }
                }
                pairs.push(Pair { a, b, places });
            }
        }
        pairs
    }

    /// Amplitudes of a component for each seed: \[seed\]\[cell\]\[bin\].
    pub fn amplitudes(&self, component: Component, seeds: std::ops::Range<u64>) -> Vec<Vec<Vec<Complex<f64>>>> {
        let cells = self.crown.cells.len();
        let salt = component as u64;
        let mut randoms: Vec<_> =
            seeds.map(|seed| Xoshiro256PlusPlus::seed_from_u64(1_000_003 * seed + 17 * salt + 5)).collect();
        let mut amplitudes = vec![vec![vec![Complex::default(); self.bins() + 1]; cells]; randoms.len()];
        self.for_each_factor(component, |bin, factor| {
            let deviations = self.deviations_m_s(component, bin);
            let delays: Vec<_> = (0..cells).map(|cell| self.delay(cell, bin)).collect();
            for (random, amplitudes) in randoms.iter_mut().zip(&mut amplitudes) {
                let phases: Vec<f64> = (0..cells).map(|_| random.random_range(0.0..TAU)).collect();
                let real = factor * DVector::from_iterator(cells, phases.iter().map(|phase| phase.cos()));
                let imaginary = factor * DVector::from_iterator(cells, phases.iter().map(|phase| phase.sin()));
                for cell in 0..cells {
                    let amplitude = Complex::new(real[cell], imaginary[cell]) * delays[cell];
                    amplitudes[cell][bin] = amplitude * (2f64.sqrt() * deviations[cell]);
                }
            }
        });
        amplitudes
    }
}

/// Two cells, and all pairs of their places.
struct Pair {
    a: usize,
    b: usize,
    places: Vec<PlacePair>,
}

struct PlacePair {
    coherence: f64,
    /// By what the coherence falls from one frequency to the next.
    step: f64,
    delay_s: f64,
}

/// A factor `L` with `L L^T` the coherence.
fn factor(mut coherence: DMatrix<f64>) -> DMatrix<f64> {
    let to_next = coherence.nrows() + 1;
    coherence.iter_mut().step_by(to_next).for_each(|value| *value += JITTER);
    if let Some(factor) = Cholesky::<f64, Dyn>::new(coherence.clone()) {
        return factor.l();
    }
    // Davenport's coherence at unequal mean speeds need not be quite definite.
    let eigen = coherence.symmetric_eigen();
    let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    eigen.eigenvectors * DMatrix::from_diagonal(&roots)
}

/// The logarithmic law. Nothing blows below the roughness length.
pub fn mean_speed_m_s(settings: &FieldSettings, height_m: f64) -> f64 {
    let lengths = |height_m: f64| (height_m - f64::from(settings.displacement_m)) / f64::from(settings.roughness_m);
    f64::from(settings.speed) * lengths(height_m).max(1.0).ln() / lengths(REFERENCE_HEIGHT_M).ln()
}

/// Height above the displacement plane that scales turbulence, no lower than e roughness lengths.
fn turbulence_height_m(settings: &FieldSettings, height_m: f64) -> f64 {
    (height_m - f64::from(settings.displacement_m)).max(std::f64::consts::E * f64::from(settings.roughness_m))
}

/// The motion of an oscillator of this frequency and damping under a periodic load, in the load's unit: it tends to a
/// steady load. Two periods are stepped through, and the second is taken; steps are exact for loads in straight lines.
pub fn respond(load: &[f64], frequency_hz: f64, damping_ratio: f64, step_s: f64) -> Vec<f64> {
    let omega = 2.0 * PI * frequency_hz;
    let damped_omega = omega * (1.0 - damping_ratio.powi(2)).sqrt();
    let pole = Complex::new(-damping_ratio * omega, damped_omega);
    let end = (pole * step_s).exp();
    let after = (end - 1.0 - pole * step_s) / (pole * pole * step_s);
    let before = (end - 1.0) / pole - after;
    let mut state = Complex::<f64>::default();
    let mut motion = Vec::with_capacity(2 * load.len());
    for index in 0..2 * load.len() {
        motion.push(state.im * omega * omega / damped_omega);
        state = end * state + before * load[index % load.len()] + after * load[(index + 1) % load.len()];
    }
    motion.split_off(load.len())
}
