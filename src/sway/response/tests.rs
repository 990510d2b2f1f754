use super::*;
use crate::wind::{CoherenceDecay, DecayCoefficients, FieldResolution, FieldSettings};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

fn response(settings: &FieldSettings) -> WindResponse {
    let field = WindField::synthesise(settings).unwrap();
    WindResponse::new(Arc::new(field), &SwaySettings::default())
}

/// The signals of a beam at a place: of its natural frequency as a coordinate, with its damping ratio, and of no size.
fn signals(response: &WindResponse, class: f32, damping_ratio: f32, place: &TablePlace) -> Vec4 {
    let read = response.table.grid.weights(class, 0.0, damping_ratio);
    let rows = read.rows.into_iter().zip(read.weights).filter(|(_, weight)| *weight != 0.0);
    rows.map(|(row, weight)| weight * response.table.response(row as usize, place)).sum()
}

#[test]
fn no_beam_is_pressed_harder_than_the_strongest_pressure() {
    let response = response(&FieldSettings::default());
    let grid = response.table.grid;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    let mut greatest = 0.0_f32;
    for _ in 0..300_000 {
        let mut odd = || random.random_range(-1.0..1.0_f32);
        let direction = Vec3::new(odd(), odd(), odd()).normalize_or(Vec3::Y);
        let class = random.random_range(0..grid.classes.count) as f32;
        let time_s = random.random_range(0.0..response.table.period_s());
        let across = Vec3::Z * random.random_range(-500.0..500.0_f32);
        // The least damping: the oscillators themselves, without a mix.
        let signals = signals(&response, class, grid.damping_ratios[0], &response.place(across, time_s));
        greatest = greatest.max(response.basis.map().coefficients(direction).load(signals).length());
    }
    let strongest = response.strongest_pressure;
    println!("{greatest} of {strongest} m^2/s^2");
    assert!(greatest <= strongest, "{greatest} of {strongest}");
    // Chance finds the worst sample seldom, but not by far.
    assert!(greatest > 0.5 * strongest, "{greatest} of {strongest}");
}

const SPEED_M_S: f64 = 8.0;
const GUSTINESS: f32 = 0.25;
const DAMPING_RATIO: f64 = 0.08;
const SEEDS: u64 = 8;

/// So weak gusts that the load is linear in them (turbulence of 0.05 of the mean speed), and so coherent that bodies do not average them.
fn weak_gusts(seed: u64) -> FieldSettings {
    let full = DecayCoefficients { lateral: 0.0, vertical: 0.0 };
    FieldSettings {
        gustiness: GUSTINESS,
        seed,
        resolution: FieldResolution { columns: 1, levels: 4, ..Default::default() },
        coherence: CoherenceDecay { along: full, across: full, up: full },
        ..Default::default()
    }
}

/// Variances of the motion of an upright beam at 10 m, by the static deflection for a pressure of 1 m^2/s^2, from gusts below the
/// crossover and above it: the sum over the closed-form spectra (9), of which a gust along the wind adds `2 U u'` to the load and one
/// across it `U v'`, through the oscillator (21).
fn variances(natural_hz: f64) -> [f64; 2] {
    let friction_m_s = 0.4 * SPEED_M_S / (10.0_f64 / 0.1).ln();
    let eddy_s = 10.0 / SPEED_M_S;
    let load = |frequency_hz: f64| {
        let nu = frequency_hz * eddy_s;
        let along = 200.0 / (1.0 + 50.0 * nu).powf(5.0 / 3.0);
        let across = 15.0 / (1.0 + 9.5 * nu).powf(5.0 / 3.0);
        (f64::from(GUSTINESS) * friction_m_s * SPEED_M_S).powi(2) * eddy_s * (4.0 * along + across)
    };
    let motion = |frequency_hz: f64| {
        let ratio = frequency_hz / natural_hz;
        load(frequency_hz) / ((1.0 - ratio * ratio).powi(2) + (2.0 * DAMPING_RATIO * ratio).powi(2))
    };
    // Slow gusts have the frequencies of the field, and fast ones lie so close together that their sum is the integral.
    let sum = |steps: std::ops::Range<u32>, from_hz: f64, step_hz: f64| {
        steps.map(|step| motion(from_hz + f64::from(step) * step_hz)).sum::<f64>() * step_hz
    };
    [sum(1..265, 0.0, 1.0 / 128.0), sum(0..22_000, 2.0625 + 5e-4, 1e-3)]
}

/// Rms of the motion of the same beam by the table, whole and above the crossover.
fn rms_by_table(response: &WindResponse, natural_hz: f64) -> [f64; 2] {
    const STEPS: usize = 1 << 14;
    let table = &response.table;
    let read = table.grid.weights(table.grid.classes.coordinate(natural_hz as f32), 0.0, DAMPING_RATIO as f32);
    let mut upright = response.basis.map().coefficients(Vec3::Y);
    upright.mean = Vec3::ZERO;
    let mut squares = [0.0; 2];
    for step in 0..STEPS {
        let place = TablePlace::on_column(0, step as f64 * 128.0 / STEPS as f64);
        let of = |index: usize| read.weights[index] * table.response(read.rows[index] as usize, &place);
        let high = of(2) + of(3);
        for (square, signals) in squares.iter_mut().zip([of(0) + of(1) + high, high]) {
            *square += f64::from(upright.load(signals).length_squared()) / STEPS as f64;
        }
    }
    squares.map(f64::sqrt)
}

#[test]
fn fast_beams_move_as_far_as_the_spectrum_says() {
    let winds: Vec<WindResponse> = (0..SEEDS).map(|seed| response(&weak_gusts(seed))).collect();
    for natural_hz in [5.0, 8.0, 11.0] {
        let [low, high] = variances(natural_hz);
        let ratios: Vec<[f64; 2]> = winds
            .iter()
            .map(|wind| {
                let [whole, above] = rms_by_table(wind, natural_hz);
                [whole / (low + high).sqrt(), above / high.sqrt()]
            })
            .collect();
        let [whole, above] = [0, 1].map(|part| Statistics::of(ratios.iter().map(|ratio| ratio[part])));
        println!(
            "{natural_hz} Hz: whole {whole:?}, above the crossover {above:?}, share {}",
            (high / (low + high)).sqrt()
        );
        // Rounded to a class: at most 10%, of which the rms of a resonance in this spectrum has a third.
        assert!((above.mean - 1.0).abs() < 3.0 * above.error + 0.035, "{natural_hz} Hz: {above:?}");
        assert!((whole.mean - 1.0).abs() < 3.0 * whole.error, "{natural_hz} Hz: {whole:?}");
    }
}

/// Mean and its standard error.
#[derive(Debug)]
struct Statistics {
    mean: f64,
    error: f64,
}

impl Statistics {
    fn of(values: impl ExactSizeIterator<Item = f64> + Clone) -> Self {
        let count = values.len() as f64;
        let mean = values.clone().sum::<f64>() / count;
        let variance = values.map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
        Self { mean, error: (variance / count).sqrt() }
    }
}

/// Over one short period, for one signal.
fn high_band(response: &WindResponse, position: Vec3, natural_hz: f32, signal: usize) -> Vec<f64> {
    let grid = &response.table.grid;
    let read = grid.weights(grid.classes.coordinate(natural_hz), 0.0, DAMPING_RATIO as f32);
    let at = |step: i32| {
        let place = response.place(position, f64::from(step) * 8.0 / 2000.0);
        let of = |index: usize| read.weights[index] * response.table.response(read.rows[index] as usize, &place);
        f64::from((of(2) + of(3))[signal])
    };
    (0..2000).map(at).collect()
}

#[test]
fn trees_some_metres_apart_ring_apart() {
    let wind = response(&weak_gusts(0));
    let mut worst = 0.0_f64;
    for (natural_hz, signal) in [(5.0, 0), (8.0, 1), (11.0, 0)] {
        let at = |across_m: f32| high_band(&wind, Vec3::new(3.0, 0.0, across_m), natural_hz, signal);
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let here = at(7.0);
        for metres in 1..=7 {
            let there = at(7.0 + metres as f32);
            assert!((product(&there, &there) / product(&here, &here) - 1.0).abs() < 0.01, "they read one series");
            let correlation = product(&here, &there) / product(&here, &here);
            worst = worst.max(correlation.abs());
            assert!(correlation.abs() < 0.3, "{natural_hz} Hz, {metres} m: {correlation}");
        }
    }
    println!("worst correlation of the high band 1 to 7 m apart: {worst}");
}

#[test]
fn motion_goes_on_across_the_ends_of_both_periods() {
    let wind = response(&weak_gusts(0));
    let position = Vec3::new(3.0, 0.0, 7.3);
    let class = wind.table.grid.classes.coordinate(8.0);
    let at = |time_s: f64| signals(&wind, class, DAMPING_RATIO as f32, &wind.place(position, time_s));
    let place = wind.place(position, 0.0);
    let step_s = 1e-3;
    let greatest = (0..16_000).map(|step| f64::from(step) * step_s);
    let greatest = greatest.map(|time_s| at(time_s + step_s).distance(at(time_s))).fold(0.0, f32::max);
    // Where the short period ends at this place, where the wind's does, and where the clock's does.
    for end_s in [8.0 - place.fast_tau_s.rem_euclid(8.0), 128.0 - place.tau_s.rem_euclid(128.0), 128.0] {
        for step in -20..20 {
            let time_s = end_s + (f64::from(step) + 0.5) * step_s;
            let distance = at(time_s + step_s).distance(at(time_s));
            assert!(distance <= 1.2 * greatest, "{distance} at {time_s} s, {greatest} elsewhere");
        }
    }
    for time_s in [0.0, 3.21, 77.7] {
        assert!(at(time_s + 128.0).abs_diff_eq(at(time_s), 1e-5), "the period of both is the wind's");
    }
    assert!(greatest > 1e-4, "it moves");
}
