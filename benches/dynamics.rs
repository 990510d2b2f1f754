//! The cost of posing a branch each frame, of a branch with oscillators of its own for comparison, and of a new wind.

#[path = "../src/dynamics/oracle/oscillator.rs"]
#[expect(dead_code, reason = "a part of it is for the unit tests")]
mod oscillator;

use bevy::math::{Mat3, Vec2, Vec3};
use bevy_windwood::{
    dynamics::{
        BeamDynamics, BeamPose, BeamSway, BeamWind, ExactStep, FrequencyClasses, LoadBasis, LoadBasisKind, MeanWind,
        NO_PARENT, OscillatorGrid, OscillatorState, ResponseTable, SecondMode, StandWind, TIP_ANGLE_LIMIT, TablePlace,
        TreeInWind, TreePoser,
    },
    wind::{LogProfile, cross_flow_pressure},
};
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use oscillator::Oscillator;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use std::hint::black_box;

const BRANCHES: usize = 500;
const SAMPLES: usize = 2048;
const COLUMNS: usize = 16;
const TIME_STEP_S: f32 = 1.0 / 16.0;

criterion_group!(benches, pose, tables);
criterion_main!(benches);

fn pose(criterion: &mut Criterion) {
    let columns = wind();
    let basis = basis(&columns);
    let wind = beam_wind();
    let table = ResponseTable::new(&columns, TIME_STEP_S, &fast_gusts(), &basis, wind.grid);
    let tree_in_wind = TreeInWind { map: basis.map(), wind, to_wind: Mat3::IDENTITY, scale: 1.0, leaf_share: 1.0 };
    let beams = tree();
    let mut group = criterion.benchmark_group("pose");

    group.throughput(Throughput::Elements(BRANCHES as u64));
    group.bench_function("tree_500", |bencher| {
        let poser = TreePoser::new(&beams, &tree_in_wind);
        let mut poses = vec![BeamPose::REST; BRANCHES];
        let mut responses = Vec::new();
        let mut tau_s = 0.0;
        bencher.iter(|| {
            tau_s += 1.0 / 60.0;
            table.responses(&place(tau_s), poser.rows(), &mut responses);
            poser.pose(&responses, Vec3::X, &mut poses);
            black_box(&mut poses);
        });
    });
    group.bench_function("prepare_500", |bencher| {
        let mut poser = TreePoser::default();
        bencher.iter(|| poser.prepare(black_box(&beams), &tree_in_wind));
    });
    group.bench_function("own_oscillators_500", |bencher| {
        let mut branches: Vec<OwnOscillators> = beams.iter().map(OwnOscillators::new).collect();
        let mut tau_s = 0.0;
        bencher.iter(|| {
            tau_s += 1.0 / 60.0;
            for branch in &mut branches {
                branch.step(&table, tau_s);
            }
            black_box(&mut branches);
        });
    });

    group.throughput(Throughput::Elements(1));
    group.bench_function("own_oscillators", |bencher| {
        let mut branch = OwnOscillators::new(&beams[100]);
        let mut tau_s = 0.0;
        bencher.iter(|| {
            tau_s += 1.0 / 60.0;
            branch.step(&table, tau_s);
            black_box(&mut branch);
        });
    });
    group.bench_function("duhamel_branch", |bencher| {
        let oscillator = Oscillator::new(7.0, 0.1);
        let load: Vec<f64> = columns[0].iter().map(|v| f64::from(v.length() * v.x)).collect();
        bencher.iter(|| oscillator.duhamel_at(black_box(&load), f64::from(TIME_STEP_S), SAMPLES - 1));
    });
    group.finish();
}

fn tables(criterion: &mut Criterion) {
    let columns = wind();
    let velocities = columns.concat();
    let basis = basis(&columns);
    let grid = beam_wind().grid;
    criterion.bench_function("load_basis/default", |bencher| {
        bencher.iter(|| LoadBasis::new(LoadBasisKind::Principal, black_box(&velocities), cross_flow_pressure));
    });
    criterion.bench_function("response_table/default", |bencher| {
        let fast_gusts = fast_gusts();
        let build = |()| ResponseTable::new(black_box(&columns), TIME_STEP_S, &fast_gusts, &basis, grid);
        bencher.iter_batched(|| (), build, BatchSize::PerIteration);
    });
}

/// Between two columns.
fn place(tau_s: f64) -> TablePlace {
    TablePlace { columns: [2, 3, 4, 5], weights: [-0.1, 0.8, 0.4, -0.1], tau_s, fast_tau_s: tau_s + 3.3 }
}

/// The mean wind of [`wind`], and the oscillators of its table.
fn beam_wind() -> BeamWind {
    let mean = MeanWind::new(&LogProfile::from_reference(8.0, 0.1, 0.0), 10.0);
    let grid = OscillatorGrid::new(FrequencyClasses::default(), 0.05, 8.0, 10.0);
    BeamWind { stand: StandWind::open(mean), grid }
}

/// A branch without the shared table: its own modes 1 to 3 in both transverse directions, under the quadratic drag of the
/// wind at its own place.
struct OwnOscillators {
    column: usize,
    direction: Vec3,
    across: [Vec3; 2],
    steps: [ExactStep; 3],
    shares: [f32; 3],
    states: [OscillatorState<Vec2>; 3],
    load: Vec2,
}

impl OwnOscillators {
    fn new(beam: &BeamDynamics) -> Self {
        let omega = 4.0 + f64::from(beam.length_m);
        let first = beam.direction.any_orthonormal_vector();
        let step = |ratio: f64| ExactStep::new(omega * ratio, 0.1, 1.0 / 60.0).expect("a valid oscillator");
        Self {
            column: (beam.base.x.abs() * 100.0) as usize % COLUMNS,
            direction: beam.direction,
            across: [first, beam.direction.cross(first)],
            // Ratios of the cantilever's frequencies, and its loads by mass for a uniform load.
            steps: [1.0, 6.267, 17.547].map(step),
            shares: [1.566, -0.868, 0.509],
            states: Default::default(),
            load: Vec2::ZERO,
        }
    }

    fn step(&mut self, table: &ResponseTable, tau_s: f64) {
        let pressure = cross_flow_pressure(table.velocity(&TablePlace::on_column(self.column, tau_s)), self.direction);
        let load = Vec2::new(pressure.dot(self.across[0]), pressure.dot(self.across[1]));
        for ((state, step), share) in self.states.iter_mut().zip(&self.steps).zip(self.shares) {
            *state = step.advance(*state, share * self.load, share * load);
        }
        self.load = load;
    }
}

fn basis(columns: &[Vec<Vec3>]) -> LoadBasis {
    LoadBasis::new(LoadBasisKind::Principal, &columns.concat(), cross_flow_pressure)
}

/// A periodic wind of some harmonics of random phase.
fn wind() -> Vec<Vec<Vec3>> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut series = |rms: f32| -> Vec<f32> {
        let phases: Vec<f32> = (0..40).map(|_| random.random_range(0.0..std::f32::consts::TAU)).collect();
        let value = |time: usize| {
            let turn = std::f32::consts::TAU * time as f32 / SAMPLES as f32;
            let waves = phases.iter().enumerate().map(|(k, phase)| ((1 + 3 * k) as f32 * turn + phase).sin());
            rms * waves.sum::<f32>() / 20f32.sqrt()
        };
        (0..SAMPLES).map(value).collect()
    };
    let mut column = || -> Vec<Vec3> {
        let (along, up, across) = (series(1.6), series(0.8), series(1.0));
        (0..SAMPLES).map(|time| Vec3::new(8.0 + along[time], up[time], across[time])).collect()
    };
    (0..COLUMNS).map(|_| column()).collect()
}

/// A short period of gusts of 3 to 14 Hz.
fn fast_gusts() -> Vec<Vec3> {
    let gust = |step: u32| {
        let angle = std::f32::consts::TAU * step as f32 / 1024.0;
        0.3 * Vec3::new((24.0 * angle).sin() + (71.0 * angle).cos(), (43.0 * angle).sin(), (111.0 * angle).cos())
    };
    (0..1024).map(gust).collect()
}

/// A tree in which every beam but the first is attached to one of those before it.
fn tree() -> Vec<BeamDynamics> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let mut beams = vec![BeamDynamics {
        stiff_axis: Vec3::ZERO,
        base: Vec3::ZERO,
        length_m: 9.0,
        direction: Vec3::Y,
        attach: 0.0,
        parent: NO_PARENT,
        angle_limit_rad: TIP_ANGLE_LIMIT,
        compliance_rad_n_m: 1e-6,
        in_leaf: sway(0.001, 6.0),
        bare: sway(0.001, 6.0),
    }];
    while beams.len() < BRANCHES {
        let parent = random.random_range(0..beams.len().div_ceil(4));
        let attach = random.random_range(0.3..1.0f32);
        let azimuth = random.random_range(0.0..std::f32::consts::TAU);
        let on = &beams[parent];
        let class = random.random_range(8.0..30.0);
        beams.push(BeamDynamics {
            stiff_axis: Vec3::ZERO,
            base: on.base + on.length_m * attach * on.direction,
            length_m: 0.6 * on.length_m,
            direction: Vec3::new(azimuth.cos(), 0.8, azimuth.sin()).normalize(),
            attach,
            parent: parent as u32,
            angle_limit_rad: TIP_ANGLE_LIMIT,
            compliance_rad_n_m: 1e-3,
            in_leaf: sway(0.003, class),
            bare: sway(0.003, class),
        });
    }
    beams
}

fn sway(gain: f32, class: f32) -> BeamSway {
    BeamSway {
        gain,
        class,
        averaging_speed_m_s: 1.0,
        drag_damping_s_m: 0.01,
        load_height_m: 8.0,
        drag_exponent: -0.35,
        second: SecondMode::default(),
    }
}
