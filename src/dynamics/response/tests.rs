use super::super::{
    admittance::admittance,
    beam::{BeamSway, BeamWind},
    beam_pose::BeamPose,
    bend::SLOPE_TIP,
    frequency_classes::FrequencyClasses,
    load_basis::LoadBasisKind,
    mean_wind::MeanWind,
    oracle::oscillator::Oscillator,
    pose::{TreeInWind, TreePoser},
    second_mode::SecondMode,
    stand_wind::StandWind,
    test_beams::upright,
};
use super::*;
use bevy::math::Mat3;
use std::f64::consts::TAU;

fn grid() -> OscillatorGrid {
    OscillatorGrid::new(FrequencyClasses::default(), 0.1, 6.0, 10.0)
}

/// A wind of a few harmonics of a period of 8 s, in steps of 1/16 s.
fn column(shift_s: f32) -> Vec<Vec3> {
    let velocity = |step: usize| {
        let angle = std::f32::consts::TAU * (step as f32 / 128.0 + shift_s / 8.0);
        Vec3::new(6.0 + angle.sin() + 0.7 * (5.0 * angle).cos(), 0.5 * (3.0 * angle).sin(), (2.0 * angle).cos())
    };
    (0..128).map(velocity).collect()
}

fn drag(velocity: Vec3, direction: Vec3) -> Vec3 {
    let normal = velocity - velocity.dot(direction) * direction;
    normal.length() * normal
}

fn table(columns: &[Vec<Vec3>]) -> (LoadBasis, ResponseTable) {
    let basis = LoadBasis::new(LoadBasisKind::Principal, &columns.concat(), drag);
    let table = ResponseTable::new(columns, 1.0 / 16.0, &[], &basis, grid());
    (basis, table)
}

/// Some harmonics of a series of a period, one by one, by the definition.
fn harmonics(series: &[f64], range: std::ops::RangeInclusive<usize>) -> Vec<f64> {
    let count = series.len();
    let turn = |harmonic: usize, step: usize| TAU * (harmonic * step % count) as f64 / count as f64;
    let mut sum = vec![0.0; count];
    for harmonic in range {
        let share = if harmonic == 0 || 2 * harmonic == count { 1.0 } else { 2.0 } / count as f64;
        let part = |part: fn(f64) -> f64| {
            series.iter().enumerate().map(|(step, q)| q * part(turn(harmonic, step))).sum::<f64>() * share
        };
        let (cosine, sine) = (part(f64::cos), part(f64::sin));
        for (step, value) in sum.iter_mut().enumerate() {
            *value += cosine * turn(harmonic, step).cos() + sine * turn(harmonic, step).sin();
        }
    }
    sum
}

/// The load of a column of the wind as a body of some size feels it, up to a harmonic.
fn felt(load: &[f64], size_m: f64, last: usize) -> Vec<f64> {
    let mut felt = harmonics(load, 0..=0);
    for harmonic in 1..=last {
        let share = admittance(harmonic as f64 / 8.0 * size_m / 6.0, 10.0);
        for (felt, value) in felt.iter_mut().zip(harmonics(load, harmonic..=harmonic)) {
            *felt += share * value;
        }
    }
    felt
}

fn on(column: usize, tau_s: f64) -> TablePlace {
    TablePlace::on_column(column, tau_s)
}

#[test]
fn rows_match_the_periodic_response_of_the_oracle() {
    let columns = [column(0.0), column(1.0)];
    let (basis, table) = table(&columns);
    for (class, size, damping) in [(6, 0, 0), (10, 1, 1), (16, 2, 0), (21, 0, 1)] {
        let frequency_hz = f64::from(table.grid.classes.frequency_hz(class));
        let omega = TAU * frequency_hz;
        let size_m = 0.006 * 7f64.powi(size as i32) * 6.0 / frequency_hz;
        let oscillator = Oscillator::new(omega, f64::from(table.grid.damping_ratios[damping]));
        let row = table.grid.row(class, size, damping);
        let samples = table.rows[row].samples;
        let stride = table.samples / samples;
        // The samples of a row show harmonics below half their number.
        let last = if stride == 1 { samples / 2 } else { samples / 2 - 1 };
        for (index, column) in columns.iter().enumerate() {
            for k in 0..4 {
                let signal: Vec<f64> = column.iter().map(|&v| f64::from(basis.signals(v)[k])).collect();
                let load: Vec<f64> = felt(&signal, size_m, last).iter().map(|q| q * omega * omega).collect();
                let response = oscillator.periodic_response(&load, 1.0 / 16.0);
                for time in (0..table.samples).step_by(stride) {
                    let value = f64::from(table.response(row, &on(index, time as f64 / 16.0))[k]);
                    // Rounding in f32, of signals of variance 1 amplified up to five times.
                    assert!((value - response[time]).abs() < 2e-4, "{class}: {value} is not {}", response[time]);
                }
            }
        }
    }
}

/// A beam of two modes, posed, against both oscillators under the load that bends it.
#[test]
fn a_beam_of_two_modes_moves_as_the_sum_of_both_oscillators() {
    let columns = [column(0.0)];
    let (basis, table) = table(&columns);
    let second = SecondMode { class_offset: 5.0, share: 0.4 };
    let sway = BeamSway { gain: 1e-5, class: 9.0, load_height_m: 10.0, second, ..BeamSway::default() };
    let wind = BeamWind { stand: StandWind::open(MeanWind::open_country(6.0)), grid: table.grid };
    let tree = TreeInWind { map: basis.map(), wind, to_wind: Mat3::IDENTITY, scale: 1.0, leaf_share: 1.0 };
    let poser = TreePoser::new(&[upright(sway, 4.0)], &tree);

    let modes = [(9, 0.6), (14, 0.4)].map(|(class, share)| {
        let frequency_hz = f64::from(table.grid.classes.frequency_hz(class));
        let omega = TAU * frequency_hz;
        let oscillator = Oscillator::new(omega, f64::from(table.grid.damping_ratios[0]));
        let last = table.rows[table.grid.row(class, 0, 0)].samples / 2 - 1;
        let of_signal = |k: usize| {
            let signal: Vec<f64> = columns[0].iter().map(|&v| f64::from(basis.signals(v)[k])).collect();
            let load: Vec<f64> =
                felt(&signal, 0.006 * 6.0 / frequency_hz, last).iter().map(|q| q * omega * omega).collect();
            oscillator.periodic_response(&load, 1.0 / 16.0)
        };
        (share, [0, 1, 2, 3].map(of_signal))
    });
    let load = basis.map().coefficients(Vec3::Y);
    let answer = sway.answer(&wind, 1.0);
    let (mut responses, mut poses) = (Vec::new(), [BeamPose::REST]);
    let (mut error, mut size) = (0.0, 0.0);
    // Samples that the rows of both have.
    for time in (0..table.samples).step_by(4) {
        table.responses(&on(0, time as f64 / 16.0), poser.rows(), &mut responses);
        poser.pose(&responses, Vec3::ZERO, &mut poses);
        let moving = (0..4).map(|k| load.moving[k] * modes.iter().map(|(s, of)| s * of[k][time]).sum::<f64>() as f32);
        let moving = moving.sum::<Vec3>() * (SLOPE_TIP * answer.gust_gain);
        let expected = load.mean * (SLOPE_TIP * answer.mean_gain) + moving;
        error += Vec3::from(poses[0].tip_angle).distance_squared(expected);
        size += moving.length_squared();
    }
    assert!((error / size).sqrt() < 2e-3, "{}", (error / size).sqrt());
}

/// The gusts of [`column`] are slow: the smallest body feels nearly all of them, without inertia.
#[test]
fn the_low_band_follows_slow_gusts() {
    let columns = [column(0.0)];
    let (basis, table) = table(&columns);
    for (time, &velocity) in columns[0].iter().enumerate() {
        let response = table.response(table.grid.low_row(0), &on(0, time as f64 / 16.0));
        assert!((response - basis.signals(velocity)).abs().max_element() < 0.05);
    }
    let highest = table.grid.low_row(SIZES)..table.grid.rows();
    assert!(table.values_of(highest).iter().all(|value| *value == Vec4::ZERO), "there are no fast gusts");
}

/// Harmonics of 3 to 9.5 Hz of the period of 8 s, in steps of 1/128 s.
fn fast_gusts() -> Vec<Vec3> {
    let gust = |step: usize| {
        let angle = std::f32::consts::TAU * step as f32 / 1024.0;
        0.4 * Vec3::new((40.0 * angle).sin() + (76.0 * angle).cos(), (24.0 * angle).sin(), (57.0 * angle).cos())
    };
    (0..1024).map(gust).collect()
}

#[test]
fn high_rows_are_oscillators_in_fast_gusts_on_a_steady_wind() {
    // A steady wind carries gusts at its own speed. The basis is that of another wind.
    let (basis, _) = table(&[column(0.0)]);
    let steady = vec![Vec3::new(6.0, 0.0, 0.0); 128];
    let gusts = fast_gusts();
    let table = ResponseTable::new(&[steady], 1.0 / 16.0, &gusts, &basis, grid());
    let at_rest = basis.signals(Vec3::new(6.0, 0.0, 0.0));
    for (class, damping) in [(22, 0), (25, 1), (28, 0)] {
        let row = table.grid.high_row(class, damping);
        let omega = TAU * f64::from(table.grid.classes.frequency_hz(class));
        let oscillator = Oscillator::new(omega, f64::from(table.grid.damping_ratios[damping]));
        let samples = table.rows[row].samples;
        for k in 0..4 {
            let signal: Vec<f64> =
                gusts.iter().map(|&gust| f64::from((basis.signals(steady_plus(gust)) - at_rest)[k])).collect();
            // What drag makes slow of it, up to two cycles a second, is not the high band's; nor what its samples cannot show.
            let load: Vec<f64> =
                harmonics(&signal, 17..=samples / 2 - 1).iter().map(|value| value * omega * omega).collect();
            let response = oscillator.periodic_response(&load, 1.0 / 128.0);
            for time in (0..1024).step_by(1024 / samples) {
                let value = f64::from(table.response(row, &on(0, time as f64 / 128.0))[k]);
                // Rounding in f32, of signals of some 0.5 amplified up to five times.
                assert!((value - response[time]).abs() < 1e-4, "{class}, {k}: {value} is not {}", response[time]);
            }
        }
    }
}

fn steady_plus(gust: Vec3) -> Vec3 {
    Vec3::new(6.0, 0.0, 0.0) + gust
}

#[test]
fn spline_passes_through_the_samples_and_is_periodic() {
    let columns = [column(0.0), column(3.0)];
    let (_, table) = table(&columns);
    assert_eq!(table.period_s(), 8.0);
    let fast = table.grid.row(21, 0, 0);
    assert_eq!(table.rows[fast].samples, 128);
    for time in [0, 1, 64, 127] {
        let tau_s = time as f64 / 16.0;
        assert_eq!(table.response(fast, &on(1, tau_s)), table.values[table.rows[fast].first + 128 + time]);
        assert_eq!(table.velocity(&on(1, tau_s)), columns[1][time]);
        for later in [tau_s + 8.0, tau_s - 16.0] {
            assert_eq!(table.response(fast, &on(1, later)), table.response(fast, &on(1, tau_s)));
        }
    }
    let rows = [0, 7, fast as u32, table.grid.rows() as u32 - 1];
    let mut some = vec![Vec4::NAN; 9];
    table.responses(&on(1, 1.23), &rows, &mut some);
    assert_eq!(some, rows.map(|row| table.response(row as usize, &on(1, 1.23))));
}

#[test]
fn columns_are_blended_by_their_weights() {
    let columns = [column(0.0), column(3.0)];
    let (_, table) = table(&columns);
    let place = TablePlace { columns: [0, 1, 0, 1], weights: [0.5, 0.25, 0.0, -0.75], tau_s: 1.23, fast_tau_s: 1.23 };
    let blended = 0.5 * table.response(90, &on(0, 1.23)) - 0.5 * table.response(90, &on(1, 1.23));
    assert!(table.response(90, &place).abs_diff_eq(blended, 1e-5));
    let velocity = 0.5 * table.velocity(&on(0, 1.23)) - 0.5 * table.velocity(&on(1, 1.23));
    assert!(table.velocity(&place).abs_diff_eq(velocity, 1e-5));
}

#[test]
fn winds_without_finite_velocities_count_as_calm() {
    for columns in [&[][..], &[vec![]][..], &[vec![Vec3::NAN; 5], vec![Vec3::ZERO; 3]][..]] {
        let (_, table) = table(columns);
        assert_eq!(table.response(40, &on(40, f64::NAN)), Vec4::ZERO);
        assert_eq!(table.velocity(&on(40, -1e300)), Vec3::ZERO);
        assert!(table.samples > 0 && table.columns > 0);
    }
    let basis = LoadBasis::new(LoadBasisKind::Principal, &column(0.0), drag);
    let odd = OscillatorGrid::new(FrequencyClasses::default(), f32::NAN, f32::NAN, 10.0);
    let table = ResponseTable::new(&[column(0.0)], f32::NAN, &[Vec3::NAN; 7], &basis, odd);
    assert!(table.values.iter().all(|value| value.is_finite()));
}
