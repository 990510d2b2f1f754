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

/// Where the low band ends for a wind of 128 s.
const CROSSOVER_HZ: f64 = 2.0625;

/// The transfer function of a row at so many bins.
fn of_row(grid: &OscillatorGrid, row: u32, bin_hz: f64, bins: usize) -> Vec<Complex<f64>> {
    let row = row as usize;
    let (low, high, first_fast) = (grid.low_row(0), grid.low_row(SIZES), grid.classes.first_fast());
    let is_below = |bin: usize| (bin as f64) * bin_hz < CROSSOVER_HZ;
    if row < low {
        let (class, size, damping) = (row / (SIZES * DAMPINGS), row / DAMPINGS % SIZES, row % DAMPINGS);
        let felt = grid.admittances(class, size, bin_hz);
        grid.transfer(class, damping, bin_hz).zip(felt).map(|(response, felt)| response * felt).take(bins).collect()
    } else if row < high {
        let felt = grid.admittances(first_fast, row - low, bin_hz).map(Complex::from);
        felt.enumerate().map(|(bin, felt)| if is_below(bin) { felt } else { Complex::ZERO }).take(bins).collect()
    } else {
        let oscillator = grid.transfer(first_fast + (row - high) / DAMPINGS, (row - high) % DAMPINGS, bin_hz);
        oscillator.enumerate().map(|(bin, o)| if is_below(bin) { Complex::ZERO } else { o }).take(bins).collect()
    }
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

/// The same of a beam of two modes of these classes, of which the second has that share.
fn variances_of_two(classes: [usize; 2], share: f64, size_m: f64, damping: f64) -> [f64; 2] {
    const BINS: usize = 1500;
    let grid = grid();
    let naturals_hz = classes.map(|class| grid.class_hz(class));
    let mode = |which: usize| GridMode {
        class: classes[which] as f32,
        averaging_speed_m_s: (naturals_hz[which] * size_m) as f32,
        damping_ratio: damping as f32,
    };
    let read = grid.weights_of_two([mode(0), mode(1)], share as f32);
    let bin_hz = naturals_hz[1] / 500.0;
    let rows = read.rows.map(|row| of_row(&grid, row, bin_hz, BINS));
    let mut powers = [0.0; 2];
    for bin in 1..BINS {
        let hz = bin as f64 * bin_hz;
        let mixed: Complex<f64> = rows.iter().zip(read.weights).map(|(row, weight)| row[bin] * f64::from(weight)).sum();
        let [first, second] = naturals_hz.map(|natural_hz| exact(hz, natural_hz, size_m, damping));
        let both = first * (1.0 - share) + second * share;
        powers[0] += gusts(hz) * mixed.norm_sqr();
        powers[1] += gusts(hz) * both.norm_sqr();
    }
    powers
}

/// Each with two rows, of one size and one damping ratio or two.
#[test]
fn beams_of_two_modes_sway_about_as_far_as_both_oscillators() {
    let (mut worst, mut square, mut count) = (0.0_f64, 0.0, 0.0);
    for classes in [[6, 10], [10, 13], [10, 16], [14, 20], [18, 21], [17, 24], [23, 26]] {
        for share in [0.3, 0.5, 0.6] {
            for reduced_size in [0.006, 0.015, 0.04, 0.07, 0.1, 0.2] {
                for damping in [0.05, 0.08, 0.12, 0.2, 0.3] {
                    let size_m = reduced_size * SPEED_M_S / grid().class_hz(classes[0]);
                    let [mixed, exact] = variances_of_two(classes, share, size_m, damping);
                    let error = (mixed / exact).sqrt() - 1.0;
                    (worst, square, count) = (worst.max(error.abs()), square + error * error, count + 1.0);
                    assert!(error.abs() < 0.15, "{classes:?}, {share}, {reduced_size}, {damping}: {error}");
                }
            }
        }
    }
    println!("rms error of two modes {}, worst {worst}", (square / count).sqrt());
}

#[test]
fn two_modes_read_finite_weights_of_rows_that_there_are() {
    let grid = grid();
    for class in [f32::NAN, -5.0, 3.3, 21.4, 25.0, 40.0, f32::INFINITY] {
        for averaging_speed_m_s in [f32::NAN, -1.0, 0.0, 0.5, 30.0, f32::INFINITY] {
            for damping_ratio in [f32::NAN, -1.0, 0.0, 0.1, 5.0, f32::INFINITY] {
                let modes = [class, 11.0].map(|class| GridMode { class, averaging_speed_m_s, damping_ratio });
                for share in [0.0, 0.4, 1.0, f32::INFINITY] {
                    let RowWeights { rows, weights } = grid.weights_of_two(modes, share);
                    let told = format!("{modes:?} {share}");
                    assert!(weights.iter().all(|weight| *weight >= 0.0 && *weight <= 1.0), "{told}: {weights:?}");
                    assert!(rows.iter().all(|row| (*row as usize) < grid.rows()), "{told}");
                    let low = |(row, _): &(&u32, f32)| (**row as usize) < grid.low_row(SIZES);
                    let sum: f32 = rows.iter().zip(weights).filter(low).map(|(_, weight)| weight).sum();
                    assert!((sum - 1.0).abs() < 1e-5, "{told}: {sum}");
                }
            }
        }
    }
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

/// The low band has no inertia, and the high band one admittance for all frequencies.
#[test]
fn fast_beams_sway_as_far_as_beams_of_any_size_and_damping() {
    let mut worst = 0.0_f64;
    for class in [22, 24, 26, 28] {
        for reduced_size in [0.005, 0.01, 0.015, 0.04, 0.1, 0.2, 0.3] {
            for damping in [0.05, 0.08, 0.12, 0.2, 0.3] {
                let size_m = reduced_size * SPEED_M_S / grid().class_hz(class);
                let [mixed, exact] = variances(class, size_m, damping);
                let error = (mixed / exact).sqrt() - 1.0;
                worst = worst.max(error.abs());
                assert!(error.abs() < 0.05, "class {class}, {reduced_size}, {damping}: {error}");
            }
        }
    }
    println!("worst rms error of fast beams {worst}");
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
fn weights_of_each_band_add_up_for_any_beam() {
    let grid = grid();
    for class in [f32::NAN, -5.0, 3.3, 21.4, 21.6, 25.0, 28.7, 40.0, f32::INFINITY] {
        for averaging_m_s in [f32::NAN, -1.0, 0.0, 0.5, 30.0, f32::INFINITY] {
            for damping in [f32::NAN, -1.0, 0.0, 0.1, 5.0] {
                let RowWeights { rows, weights } = grid.weights(class, averaging_m_s, damping);
                let told = format!("{class} {averaging_m_s} {damping}");
                assert!(weights.iter().all(|weight| *weight >= 0.0), "{told}");
                assert!(rows.iter().all(|row| (*row as usize) < grid.rows()), "{told}");
                let of_row = |is_of: &dyn Fn(usize) -> bool| {
                    let pairs = rows.iter().zip(weights);
                    pairs.filter(|(row, _)| is_of(**row as usize)).map(|(_, weight)| weight).sum::<f32>()
                };
                let slow_and_low = of_row(&|row| row < grid.low_row(SIZES));
                assert!((slow_and_low - 1.0).abs() < 1e-5, "{told}");
                let high = of_row(&|row| row >= grid.low_row(SIZES));
                let expected = if class < 21.5 { 0.0 } else { grid.natural_admittance(averaging_m_s) };
                assert!((high - expected).abs() < 1e-5, "{told}");
            }
        }
    }
}

/// Interpolated between three sizes against the closed form.
#[test]
fn fast_beams_feel_fast_gusts_with_the_admittance_of_their_natural_frequency() {
    for reduced_size in [0.006, 0.015, 0.042, 0.1, 0.2, 0.294] {
        let found = f64::from(grid().natural_admittance((reduced_size * SPEED_M_S) as f32));
        let expected = admittance(reduced_size, DECAY);
        assert!((found - expected).abs() < 0.05, "{reduced_size}: {found} is not {expected}");
    }
}

#[test]
fn slow_classes_have_fewer_samples() {
    let grid = grid();
    let slow: Vec<usize> = (0..22).map(|class| grid.samples(class, 128.0, 2048)).collect();
    let fast: Vec<usize> = (22..30).map(|class| grid.samples(class, 8.0, 1024)).collect();
    for samples in [&slow, &fast] {
        assert!(samples.windows(2).all(|pair| pair[0] <= pair[1]), "{samples:?}");
    }
    assert_eq!((slow[0], slow[21], fast[0], fast[7]), (64, 2048, 256, 1024));
    assert_eq!(grid.low_samples(128.0, 2048), 1024);
    assert_eq!(grid.samples(0, 100.0, 1000), 1000);
}
