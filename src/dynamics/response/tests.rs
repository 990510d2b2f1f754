use super::super::{load_basis::LoadBasisKind, oracle::oscillator::Oscillator};
use super::*;

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
    let table = ResponseTable::new(columns, 1.0 / 16.0, &basis, FrequencyClasses::default(), 0.1);
    (basis, table)
}

fn on(column: usize, tau_s: f64) -> TablePlace {
    TablePlace::on_column(column, tau_s)
}

#[test]
fn rows_match_the_periodic_response_of_the_oracle() {
    let columns = [column(0.0), column(1.0)];
    let (basis, table) = table(&columns);
    for class in [0, 10, 16, 21] {
        let omega = TAU * f64::from(table.classes.frequency_hz(class));
        let oscillator = Oscillator::new(omega, f64::from(0.1f32));
        for (index, column) in columns.iter().enumerate() {
            for k in 0..4 {
                let load: Vec<f64> = column.iter().map(|&v| f64::from(basis.signals(v)[k]) * omega * omega).collect();
                for (time, exact) in oscillator.periodic_response(&load, 1.0 / 16.0).iter().enumerate() {
                    let value = f64::from(table.values[table.index(class, index, time)][k]);
                    // Rounding in f32, of signals of variance 1 amplified up to five times.
                    assert!((value - exact).abs() < 2e-4, "{value} is not {exact}");
                }
            }
        }
    }
}

#[test]
fn last_class_is_the_signal() {
    let columns = [column(0.0)];
    let (basis, table) = table(&columns);
    for (time, &velocity) in columns[0].iter().enumerate() {
        assert_eq!(table.values[table.index(22, 0, time)], basis.signals(velocity));
    }
}

#[test]
fn spline_passes_through_the_samples_and_is_periodic() {
    let columns = [column(0.0), column(3.0)];
    let (_, table) = table(&columns);
    assert_eq!(table.period_s(), 8.0);
    for time in [0, 1, 64, 127] {
        let tau_s = time as f64 / 16.0;
        assert_eq!(table.response(12, &on(1, tau_s)), table.values[table.index(12, 1, time)]);
        assert_eq!(table.velocity(&on(1, tau_s)), columns[1][time]);
        for later in [tau_s + 8.0, tau_s - 16.0] {
            assert_eq!(table.response(12, &on(1, later)), table.response(12, &on(1, tau_s)));
        }
    }
    // Between samples of a slow class the spline of steps h is off by about (w h)^3 / 20 of each harmonic.
    let [before, between, after] = [0.0, 0.5, 1.0].map(|step| table.response(3, &on(0, 2.0 + step / 16.0)));
    assert!((between - 0.5 * (before + after)).abs().max_element() < 1e-2);
    let mut all = [Vec4::NAN; 23];
    table.responses(&on(1, 1.23), &mut all);
    assert_eq!(all[7], table.response(7, &on(1, 1.23)));
}

#[test]
fn columns_are_blended_by_their_weights() {
    let columns = [column(0.0), column(3.0)];
    let (_, table) = table(&columns);
    let place = TablePlace { columns: [0, 1, 0, 1], weights: [0.5, 0.25, 0.0, -0.75], tau_s: 1.23 };
    let blended = 0.5 * table.response(9, &on(0, 1.23)) - 0.5 * table.response(9, &on(1, 1.23));
    assert!(table.response(9, &place).abs_diff_eq(blended, 1e-5));
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
    let table = ResponseTable::new(&[column(0.0)], f32::NAN, &basis, FrequencyClasses::default(), f32::NAN);
    assert!(table.values.iter().all(|value| value.is_finite()));
}
