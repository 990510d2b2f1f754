use super::*;
use approx::assert_relative_eq;

fn patch(first: [i32; 2], columns: u32, rows: u32, height: impl Fn(f64, f64) -> f64) -> SplinePatch {
    let of_index = |index: u32| {
        height(f64::from(first[0]) + f64::from(index % columns), f64::from(first[1]) + f64::from(index / columns))
    };
    let heights_m = (0..columns * rows).map(|index| of_index(index) as f32).collect();
    SplinePatch { first_column: first[0], first_row: first[1], columns, rows, heights_m }
}

fn ground(patches: Vec<SplinePatch>) -> SplineGround {
    let settings = SplineGroundSettings { cell_x_m: 10.0, cell_z_m: 20.0, base_m: 5.0, patches, ..Default::default() };
    SplineGround::new(&settings).unwrap()
}

fn rugged(column: f64, row: f64) -> f64 {
    (column * 2.3).sin() * 9.0 + (row * 1.7 + column).cos() * 4.0
}

/// The definition of the module's head.
fn b(u: f64) -> f64 {
    match u.abs() {
        u if u <= 0.5 => 0.75 - u * u,
        u if u <= 1.5 => 0.5 * (1.5 - u).powi(2),
        _ => 0.0,
    }
}

#[test]
fn the_surface_is_the_sum_over_all_control_points() {
    let ground = ground(vec![patch([-3, 2], 6, 5, rugged)]);
    for index in 0..200 {
        let place = DVec2::new(f64::from(index) * 0.73 - 60.0, f64::from(index) * 0.9 + 10.0);
        let mut sum = 5.0;
        for column in -3..3 {
            for row in 2..7 {
                let (column, row) = (f64::from(column), f64::from(row));
                let weight = b(place.x / 10.0 - column) * b(place.y / 20.0 - row);
                sum += weight * (rugged(column, row) - 5.0);
            }
        }
        assert_relative_eq!(ground.height_m(place), sum, epsilon = 1e-5);
    }
}

#[test]
fn planes_stay_planes() {
    let ground = ground(vec![patch([0, 0], 8, 8, |column, row| 3.0 * column - 2.0 * row)]);
    for (column, row) in [(2.0, 2.0), (3.7, 4.2), (5.5, 1.5)] {
        let place = DVec2::new(column * 10.0, row * 20.0);
        assert_relative_eq!(ground.height_m(place), 3.0 * column - 2.0 * row, epsilon = 1e-5);
        assert_relative_eq!(ground.gradient(place).x, 0.3, epsilon = 1e-7);
        assert_relative_eq!(ground.gradient(place).y, -0.1, epsilon = 1e-7);
    }
}

#[test]
fn adjacent_patches_form_the_surface_of_one() {
    let whole = ground(vec![patch([0, 0], 10, 5, rugged)]);
    let parts = ground((0..5).map(|index| patch([2 * index, 0], 2, 5, rugged)).collect());
    for index in 0..400 {
        let place = DVec2::new(f64::from(index) * 0.3 - 10.0, f64::from(index % 37) * 3.0);
        assert_eq!(whole.height_m(place), parts.height_m(place));
    }
}

#[test]
fn heights_and_gradients_are_continuous_across_patches_and_ends() {
    let ground = ground(vec![patch([0, 0], 3, 5, rugged), patch([3, 1], 4, 4, |_, _| 40.0)]);
    for half_cells in -6..20 {
        for z in [-31.0, 7.0, 55.0, 90.0] {
            let seam = f64::from(half_cells) * 5.0;
            let (before, after) = (DVec2::new(seam - 1e-9, z), DVec2::new(seam + 1e-9, z));
            assert_relative_eq!(ground.height_m(before), ground.height_m(after), epsilon = 1e-6);
            assert!((ground.gradient(before) - ground.gradient(after)).length() < 1e-6);
        }
    }
}

#[test]
fn the_base_lies_outside_all_patches() {
    let ground = ground(vec![patch([0, 0], 3, 3, rugged)]);
    for place in [DVec2::splat(1e4), DVec2::splat(-1e300), DVec2::new(f64::MAX, 0.0)] {
        assert_eq!((ground.height_m(place), ground.gradient(place)), (5.0, DVec2::ZERO));
    }
    assert_eq!(SplineGround::new(&SplineGroundSettings::default()).unwrap().height_m(DVec2::ONE), 0.0);
}

#[test]
fn a_bad_patch_is_named_by_its_path() {
    let error = |change: fn(&mut SplinePatch)| {
        let mut patches = vec![patch([0, 0], 3, 3, rugged); 2];
        change(&mut patches[1]);
        let settings = SplineGroundSettings { patches, ..Default::default() };
        SplineGround::new(&settings).unwrap_err().to_string()
    };
    assert_eq!(error(|patch| patch.columns = 0), "`patches[1].columns` is 0, but must be 1 to 4096");
    assert_eq!(error(|patch| patch.rows = 4), "`patches[1].heights_m` holds 9, but 3 x 4 need 12");
    assert!(error(|patch| patch.heights_m[2] = f32::NAN).starts_with("`patches[1].heights_m[2]` is NaN"));
    let far_away = error(|patch| (patch.first_column, patch.first_row) = (1_000_000, -1_000_000));
    assert!(far_away.contains("points of the rectangle around all"), "{far_away}");
}
