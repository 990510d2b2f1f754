//! Mixed responses against those of beams with exactly their own size and damping.

use super::*;

const SPEED_M_S: f64 = 8.0;
const DECAY: f64 = 10.0;
const STRUCTURE: f32 = 0.05;

fn grid() -> OscillatorGrid {
    OscillatorGrid::new(FrequencyClasses::default(), STRUCTURE, SPEED_M_S as f32, DECAY as f32)
}

/// Kaimal's spectrum of gusts at 10 m, up to a factor.
fn gusts(frequency_hz: f64) -> f64 {
    let reduced = frequency_hz * 10.0 / SPEED_M_S;
    1.0 / (1.0 + 50.0 * reduced).powf(5.0 / 3.0)
}

/// The beam's own response, from eq. 21 and the admittance.
fn exact(frequency_hz: f64, natural_hz: f64, size_m: f64, damping: f64) -> Complex<f64> {
    let ratio = frequency_hz / natural_hz;
    let felt = admittance(frequency_hz * size_m / SPEED_M_S, DECAY);
    Complex::new(1.0 - ratio * ratio, 2.0 * damping * ratio).inv() * felt
}

/// The transfer function of a row at so many bins.
fn of_row(grid: &OscillatorGrid, row: u32, bin_hz: f64, bins: usize) -> Vec<Complex<f64>> {
    let row = row as usize;
    let quasi_static = grid.classes.quasi_static();
    let (class, size, damping) = if row < quasi_static * SIZES * DAMPINGS {
        (row / (SIZES * DAMPINGS), row / DAMPINGS % SIZES, row % DAMPINGS)
    } else {
        (quasi_static, row - quasi_static * SIZES * DAMPINGS, 0)
    };
    let felt = grid.admittances(class, size, bin_hz);
    grid.transfer(class, damping, bin_hz).zip(felt).map(|(response, felt)| response * felt).take(bins).collect()
}

/// Variances of the response in the gusts: mixed and exact.
fn variances(class: usize, size_m: f64, damping: f64) -> [f64; 2] {
    const BINS: usize = 1500;
    let grid = grid();
    let natural_hz = grid.class_hz(class);
    let read = grid.weights(class as f32, (natural_hz * size_m) as f32, damping as f32);
    let bin_hz = natural_hz / 300.0;
    let mut mixed = vec![Complex::ZERO; BINS];
    for (row, weight) in read.rows.into_iter().zip(read.weights) {
        for (sum, value) in mixed.iter_mut().zip(of_row(&grid, row, bin_hz, BINS)) {
            *sum += value * f64::from(weight);
        }
    }
    let exact = |bin: usize| exact(bin as f64 * bin_hz, natural_hz, size_m, damping);
    let power = |response: &dyn Fn(usize) -> Complex<f64>| {
        (1..BINS).map(|bin| gusts(bin as f64 * bin_hz) * response(bin).norm_sqr()).sum::<f64>()
    };
    [power(&|bin| mixed[bin]), power(&exact)]
}

#[test]
fn mixes_sway_as_far_as_beams_of_any_size_and_damping() {
    let mut worst = 0.0_f64;
    for class in [6, 10, 14, 18] {
        for reduced_size in [0.006, 0.015, 0.04, 0.1, 0.2, 0.3] {
            for damping in [0.05, 0.08, 0.12, 0.2, 0.3] {
                let size_m = reduced_size * SPEED_M_S / grid().class_hz(class);
                let [mixed, exact] = variances(class, size_m, damping);
                let error = (mixed / exact).sqrt() - 1.0;
                worst = worst.max(error.abs());
                assert!(error.abs() < 0.1, "class {class}, {reduced_size}, {damping}: {error}");
            }
        }
    }
    println!("worst rms error {worst}");
}

#[test]
fn nodes_of_the_grid_are_exact() {
    let grid = grid();
    for class in [0, 9, 21] {
        for (size, damping) in [(0, 0), (1, 1), (2, 0)] {
            let averaging_m_s = LEAST_SIZE * SIZE_RATIO.powi(size as i32) * SPEED_M_S as f32;
            let read = grid.weights(class as f32, averaging_m_s, grid.damping_ratios[damping]);
            let whole: Vec<u32> =
                read.rows.iter().zip(read.weights).filter(|(_, w)| *w > 0.999).map(|(row, _)| *row).collect();
            assert_eq!(whole, [grid.row(class, size, damping) as u32], "{read:?}");
        }
    }
}

#[test]
fn weights_add_up_to_one_for_any_beam() {
    let grid = grid();
    for class in [f32::NAN, -5.0, 3.3, 21.8, 40.0, f32::INFINITY] {
        for averaging_m_s in [f32::NAN, -1.0, 0.0, 0.5, 30.0, f32::INFINITY] {
            for damping in [f32::NAN, -1.0, 0.0, 0.1, 5.0] {
                let RowWeights { rows, weights } = grid.weights(class, averaging_m_s, damping);
                assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{class} {averaging_m_s} {damping}");
                assert!(weights.iter().all(|weight| *weight >= 0.0));
                assert!(rows.iter().all(|row| (*row as usize) < grid.rows()));
            }
        }
    }
}

#[test]
fn slow_classes_have_fewer_samples() {
    let grid = grid();
    let samples: Vec<usize> = (0..=grid.classes.quasi_static()).map(|class| grid.samples(class, 128.0, 2048)).collect();
    assert!(samples.windows(2).all(|pair| pair[0] <= pair[1]), "{samples:?}");
    assert_eq!((samples[0], samples[22]), (64, 2048));
    assert_eq!(grid.samples(0, 100.0, 1000), 1000);
}
