use super::*;
use approx::assert_relative_eq;

fn grid(columns: u32, rows: u32, cell_m: DVec2, height: impl Fn(u32, u32) -> f64) -> ElevationGrid {
    let heights_m = (0..columns * rows).map(|index| height(index % columns, index / columns) as f32).collect();
    ElevationGrid::new(columns, rows, cell_m, heights_m).unwrap()
}

fn rugged(column: u32, row: u32) -> f64 {
    300.0 + f64::from((column * 31 + row * row * 17) % 101)
}

#[test]
fn semivariances_are_those_over_all_pairs() {
    let cell_m = DVec2::new(2.0, 3.0);
    let grid = grid(14, 11, cell_m, rugged);
    let settings = VariogramSettings { longest_lag: 0.5, sectors: 3, ..Default::default() };
    let variogram = Variogram::estimate(&grid, &settings).unwrap();
    let edges_m = class_edges_m(2.0, 13.0);
    // Every pair once, by brute force, into the same classes.
    let mut sums = vec![(0.0, 0.0); 3 * edges_m.len()];
    for a in 0..14 * 11 {
        for b in 0..14 * 11 {
            let step = [b % 14 - a % 14, b / 14 - a / 14];
            let lag_m = cell_m * DVec2::new(f64::from(step[0]), f64::from(step[1]));
            let once = step[1] > 0 || (step[1] == 0 && step[0] > 0);
            if !once || lag_m.length() > 13.0 {
                continue;
            }
            let class = edges_m.iter().filter(|&&edge_m| edge_m <= lag_m.length()).count();
            let sector = (lag_m.y.atan2(lag_m.x).to_degrees() / 60.0).round() as usize % 3;
            let difference = f64::from(grid.heights_m()[a as usize]) - f64::from(grid.heights_m()[b as usize]);
            let sum = &mut sums[sector * edges_m.len() + class];
            *sum = (sum.0 + 0.5 * difference * difference, sum.1 + 1.0);
        }
    }
    sums.retain(|sum| sum.1 > 0.0);
    assert_eq!(variogram.classes().len(), sums.len());
    for (class, (half_squares, pairs)) in variogram.classes().iter().zip(sums) {
        assert_eq!(class.pairs, pairs);
        assert_relative_eq!(class.semivariance_m2, half_squares / pairs, max_relative = 1e-9);
    }
}

#[test]
fn a_ridge_varies_across_and_not_along() {
    let grid = grid(40, 40, DVec2::ONE, |column, _| f64::from(column * 37 % 11));
    let settings = VariogramSettings { sectors: 4, ..Default::default() };
    let variogram = Variogram::estimate(&grid, &settings).unwrap();
    let of_neighbours = |azimuth: f64| {
        let is_first = |class: &&LagClass| (class.azimuth - azimuth).abs() < 1e-9 && class.distance_m < 1.1;
        variogram.classes().iter().find(is_first).map(|class| class.semivariance_m2)
    };
    let mut squares = 0.0;
    for column in 0..39 {
        let height = |column: u32| f64::from(column * 37 % 11);
        squares += (height(column + 1) - height(column)).powi(2);
    }
    assert_relative_eq!(of_neighbours(0.0).unwrap(), 0.5 * squares / 39.0, max_relative = 1e-9);
    assert_relative_eq!(of_neighbours(PI / 2.0).unwrap(), 0.0, epsilon = 1e-9);
}

#[test]
fn estimates_do_not_depend_on_drift() {
    let tilted =
        |tilt: f64| grid(30, 20, DVec2::ONE, |column, row| rugged(column, row) + tilt * f64::from(column + row));
    let settings = VariogramSettings { drift: Drift::Plane, ..Default::default() };
    let estimate = |tilt| Variogram::estimate(&tilted(tilt), &settings).unwrap();
    for (level, slope) in estimate(0.0).classes().iter().zip(estimate(8.0).classes()) {
        assert_relative_eq!(level.semivariance_m2, slope.semivariance_m2, max_relative = 1e-5);
    }
    assert_relative_eq!(estimate(8.0).drift().gradient.x - estimate(0.0).drift().gradient.x, 8.0, epsilon = 1e-5);
}

#[test]
fn covariance_and_semivariance_add_up_to_the_variance() {
    let variogram = Variogram::estimate(&grid(20, 20, DVec2::ONE, rugged), &VariogramSettings::default()).unwrap();
    let class = variogram.classes()[2];
    assert_relative_eq!(variogram.covariance_m2(&class) + class.semivariance_m2, variogram.variance_m2());
}

#[test]
fn level_ground_and_bad_settings_are_refused() {
    let estimate = |grid: &ElevationGrid, settings| Variogram::estimate(grid, &settings).unwrap_err();
    let level = grid(5, 5, DVec2::ONE, |_, _| 2000.1);
    assert_eq!(estimate(&level, VariogramSettings::default()), TerrainError::Level);
    let plane = grid(50, 50, DVec2::ONE, |column, row| 0.1 * f64::from(column) + 0.7 * f64::from(row));
    let drift = VariogramSettings { drift: Drift::Plane, ..Default::default() };
    assert_eq!(estimate(&plane, drift), TerrainError::Level);
    let settings = VariogramSettings { longest_lag: f64::NAN, ..Default::default() };
    assert_eq!(estimate(&plane, settings).to_string(), "`longest_lag` is NaN, but must be 0.01 to 0.5");
    let smallest = grid(2, 2, DVec2::new(1.0, 500.0), rugged);
    assert!(Variogram::estimate(&smallest, &VariogramSettings::default()).is_ok());
}
