//! The load bases against direct integration of each beam's own load by its own oscillator.

use crate::report::Report;
use crate::test_wind::{MEAN_SPEED_M_S, TIME_STEP_S, TURBULENCE_INTENSITY, test_wind};
use crate::total_error;
use bevy::math::{Vec3, Vec4};
use bevy_windwood::dynamics::{
    ExactStep, FrequencyClasses, LoadBasis, LoadBasisKind, OscillatorGrid, OscillatorState, ResponseTable, TablePlace,
};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;

const SEED: u64 = 25;
pub const SAMPLES: usize = 4096;
const DAMPING_RATIO: f32 = 0.1;
const DAMPING: f64 = DAMPING_RATIO as f64;
const DIRECTIONS: usize = 250;
/// Steps of the direct integration per step of the table.
pub const OVERSAMPLING: usize = 8;
/// Frequency classes of 0.17, 0.54, 0.99 and 2.2 Hz.
const CLASSES: [usize; 4] = [6, 12, 15, 19];

pub fn run() -> Report {
    let fine = test_wind(SEED, SAMPLES, OVERSAMPLING, TURBULENCE_INTENSITY);
    let experiment = Experiment::new(&fine);
    let mut report = Report::default();

    let printed = experiment.errors(LoadBasisKind::OrthogonalBeams { halved: false }, OVERSAMPLING);
    report.record("orthogonal_as_printed_median", quantile(printed, 0.5), "eq. 25 as printed");
    let halved = experiment.errors(LoadBasisKind::OrthogonalBeams { halved: true }, OVERSAMPLING);
    report.record("orthogonal_halved_median", quantile(halved, 0.5), "eq. 25 halved");
    let principal = experiment.errors(LoadBasisKind::Principal, OVERSAMPLING);
    report.at_most("principal_median", quantile(principal.clone(), 0.5), 0.04, "rank 4, at the samples");
    report.at_most("principal_p95", quantile(principal, 0.95), 0.25, "rank 4, at the samples");

    let between = experiment.errors(LoadBasisKind::Principal, 1);
    report.record("principal_between_samples_median", quantile(between, 0.5), "with interpolation in time");
    for (key, class) in INTERPOLATION_KEYS {
        report.record(key, experiment.interpolation_error(class), "Catmull-Rom in time alone, steps of 1/16 s");
    }
    let rounding = experiment.rounding_errors();
    report.record("class_rounding_median", quantile(rounding.clone(), 0.5), "frequency to the nearest class alone");
    report.record("class_rounding_p95", quantile(rounding, 0.95), "frequency to the nearest class alone");
    total_error::run(&mut report);
    report
}

const INTERPOLATION_KEYS: [(&str, usize); 3] =
    [("interpolation_1_0_hz", 15), ("interpolation_2_2_hz", 19), ("interpolation_3_3_hz", 21)];

/// Beams and their motion by direct integration.
struct Experiment<'a> {
    fine: &'a [Vec3],
    coarse: Vec<Vec3>,
    directions: Vec<Vec3>,
    classes: FrequencyClasses,
    /// By class, then by direction.
    direct: Vec<Vec<Vec<Vec3>>>,
}

impl<'a> Experiment<'a> {
    fn new(fine: &'a [Vec3]) -> Self {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(SEED);
        let directions: Vec<Vec3> = (0..DIRECTIONS).map(|_| random_direction(&mut random)).collect();
        let classes = FrequencyClasses::default();
        let direct = CLASSES.map(|class| {
            let frequency_hz = f64::from(classes.frequency_hz(class));
            directions
                .iter()
                .map(|&direction| integrate(fine, OVERSAMPLING, direction, frequency_hz, DAMPING))
                .collect()
        });
        let coarse = fine.iter().step_by(OVERSAMPLING).copied().collect();
        Self { fine, coarse, directions, classes, direct: direct.into() }
    }

    /// Oscillators that feel the wind of one point: no coherence is lost between the places of a load.
    fn grid(&self) -> OscillatorGrid {
        OscillatorGrid::new(self.classes, DAMPING_RATIO, MEAN_SPEED_M_S as f32, 0.0)
    }

    /// The row of the smallest body of a class, with the damping of the direct integration.
    fn row(&self, class: usize) -> usize {
        self.grid().weights(class as f32, 0.0, DAMPING_RATIO).rows[0] as usize
    }

    fn table(&self, kind: LoadBasisKind) -> (LoadBasis, ResponseTable) {
        let basis = LoadBasis::new(kind, &self.coarse, drag);
        let columns = [self.coarse.clone()];
        let table = ResponseTable::new(&columns, TIME_STEP_S as f32, &[], &basis, self.grid());
        (basis, table)
    }

    /// Relative rms error of the moving part for every class and direction, at every `stride`-th fine step.
    fn errors(&self, kind: LoadBasisKind, stride: usize) -> Vec<f64> {
        let (basis, table) = self.table(kind);
        let mut errors = Vec::new();
        for (&class, direct) in CLASSES.iter().zip(&self.direct) {
            let responses: Vec<Vec4> = (0..self.fine.len())
                .step_by(stride)
                .map(|step| {
                    table.response(self.row(class), &on_column(step as f64 * TIME_STEP_S / OVERSAMPLING as f64))
                })
                .collect();
            errors.extend(self.directions.iter().zip(direct).map(|(&direction, direct)| {
                let coefficients = basis.coefficients(direction);
                let looked_up: Vec<Vec3> = responses.iter().map(|&response| coefficients.load(response)).collect();
                let direct: Vec<Vec3> = direct.iter().step_by(stride).copied().collect();
                relative_error(&looked_up, &direct)
            }));
        }
        errors
    }

    /// Error of the responses of a class between the samples, where they are interpolated.
    fn interpolation_error(&self, class: usize) -> f64 {
        let (_, table) = self.table(LoadBasisKind::Principal);
        let columns = [self.fine.to_vec()];
        let basis = LoadBasis::new(LoadBasisKind::Principal, &self.coarse, drag);
        let step_s = TIME_STEP_S / OVERSAMPLING as f64;
        let fine_table = ResponseTable::new(&columns, step_s as f32, &[], &basis, self.grid());
        let series = |table: &ResponseTable| -> Vec<Vec3> {
            (0..self.fine.len())
                .map(|step| table.response(self.row(class), &on_column(step as f64 * step_s)).truncate())
                .collect()
        };
        relative_error(&series(&table), &series(&fine_table))
    }

    /// Errors of beams of any frequency if that of the nearest class is integrated instead.
    fn rounding_errors(&self) -> Vec<f64> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(SEED + 1);
        let error = |&direction: &Vec3| {
            let frequency_hz = 0.1 * 30f32.powf(random.random::<f32>());
            let class = self.classes.nearest(self.classes.coordinate(frequency_hz));
            let rounded =
                integrate(self.fine, OVERSAMPLING, direction, f64::from(self.classes.frequency_hz(class)), DAMPING);
            relative_error(&rounded, &integrate(self.fine, OVERSAMPLING, direction, f64::from(frequency_hz), DAMPING))
        };
        self.directions.iter().map(error).collect()
    }
}

/// Quadratic drag, `|u_n| u_n`.
pub fn drag(velocity: Vec3, direction: Vec3) -> Vec3 {
    let normal = velocity - velocity.dot(direction) * direction;
    normal.length() * normal
}

/// The steady motion of one beam over a period: its own load on its own oscillator, stepped through two periods of the wind, which has
/// so many samples for each step of the table. Scaled by the square of the natural frequency, as the table is.
pub fn integrate(
    fine: &[Vec3],
    oversampling: usize,
    direction: Vec3,
    frequency_hz: f64,
    damping_ratio: f64,
) -> Vec<Vec3> {
    let omega = TAU * frequency_hz;
    let step_s = TIME_STEP_S / oversampling as f64;
    let step = ExactStep::new(omega, damping_ratio, step_s).expect("a frequency above zero");
    let stiffness = (omega * omega) as f32;
    let load: Vec<Vec3> = fine.iter().map(|&velocity| stiffness * drag(velocity, direction)).collect();
    let mut state = OscillatorState::default();
    let mut motion = Vec::with_capacity(2 * load.len());
    for index in 0..2 * load.len() {
        motion.push(state.displacement);
        state = step.advance(state, load[index % load.len()], load[(index + 1) % load.len()]);
    }
    motion.split_off(load.len())
}

fn on_column(tau_s: f64) -> TablePlace {
    TablePlace::on_column(0, tau_s)
}

/// Rms of the difference of the moving parts over the rms of the moving part of the reference.
pub fn relative_error(values: &[Vec3], reference: &[Vec3]) -> f64 {
    let mean = |series: &[Vec3]| series.iter().map(|v| v.as_dvec3()).sum::<bevy::math::DVec3>() / series.len() as f64;
    let (mean_value, mean_reference) = (mean(values), mean(reference));
    let (mut error, mut size) = (0.0, 0.0);
    for (value, reference) in values.iter().zip(reference) {
        let moving = reference.as_dvec3() - mean_reference;
        error += (value.as_dvec3() - mean_value - moving).length_squared();
        size += moving.length_squared();
    }
    (error / size).sqrt()
}

pub fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share).round() as usize]
}

pub fn random_direction(random: &mut Xoshiro256PlusPlus) -> Vec3 {
    let height = random.random_range(-1.0..1.0f32);
    let azimuth = random.random_range(0.0..std::f32::consts::TAU);
    let radius = (1.0 - height * height).sqrt();
    Vec3::new(radius * azimuth.cos(), height, radius * azimuth.sin())
}
