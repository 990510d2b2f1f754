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

/// The shipped surface with as many patches and points as Zaharia's.
fn five_patches() -> SplineGroundSettings {
    SplineGroundSettings::from_ron(include_str!("../../../assets/terrain/five_patches.ground.ron")).unwrap()
}

#[test]
fn the_shipped_surface_has_five_adjacent_patches_and_fifty_points() {
    let patches = five_patches().patches;
    assert_eq!(patches.len(), 5);
    assert_eq!(patches.iter().map(|patch| patch.heights_m.len()).sum::<usize>(), 50);
    for pair in patches.windows(2) {
        assert_eq!(pair[0].first_column + pair[0].columns as i32, pair[1].first_column);
        assert_eq!((pair[0].first_row, pair[0].rows), (pair[1].first_row, pair[1].rows));
    }
}

/// Value, slope and second derivative along x at the end of a piece of second degree, from three places inside it: for
/// such a piece these finite differences are exact.
fn one_sided(ground: &SplineGround, border: DVec2, step_m: f64) -> [f64; 3] {
    let [f0, f1, f2] = [0.0, 1.0, 2.0].map(|steps| ground.height_m(border + DVec2::X * (steps * step_m)));
    [f0, (4.0 * f1 - 3.0 * f0 - f2) / (2.0 * step_m), (f0 - 2.0 * f1 + f2) / (step_m * step_m)]
}

/// Across the borders of the patches height and slope are continuous; the second derivative jumps from one second
/// difference of the control points to the next, as that of any quadratic spline.
#[test]
fn the_shipped_surface_is_once_differentiable_across_the_borders_of_its_patches() {
    let settings = five_patches();
    let ground = SplineGround::new(&settings).unwrap();
    let point_m = |column: i32, row: i32| -> f64 {
        let own = settings.patches.iter().find(|p| (0..p.columns as i32).contains(&(column - p.first_column)));
        own.filter(|p| (0..p.rows as i32).contains(&row))
            .map_or(0.0, |p| f64::from(p.heights_m[(row * p.columns as i32 + column - p.first_column) as usize]))
    };
    let mut greatest_jump: f64 = 0.0;
    for last_column in settings.patches[..4].iter().map(|patch| patch.first_column + patch.columns as i32 - 1) {
        let x = settings.west_m + settings.cell_x_m * (f64::from(last_column) + 0.5);
        for index in 0..61 {
            let border = DVec2::new(x, settings.north_m + 5.0 * f64::from(index) - 30.0);
            let [before, after] = [-7.0, 7.0].map(|step_m| one_sided(&ground, border, step_m));
            assert_relative_eq!(before[0], after[0], epsilon = 1e-9);
            // The derivative by a negative step has its own sign already.
            assert_relative_eq!(before[1], after[1], epsilon = 1e-9);
            assert_relative_eq!(before[1], ground.gradient(border).x, epsilon = 1e-9);
            let expected = [last_column, last_column + 1].map(|column| -> f64 {
                let along_z = |row: i32| b((border.y - settings.north_m) / settings.cell_z_m - f64::from(row));
                let bend = |row| point_m(column - 1, row) - 2.0 * point_m(column, row) + point_m(column + 1, row);
                (0..5).map(|row| along_z(row) * bend(row)).sum::<f64>() / settings.cell_x_m.powi(2)
            });
            assert_relative_eq!(before[2], expected[0], epsilon = 1e-9);
            assert_relative_eq!(after[2], expected[1], epsilon = 1e-9);
            greatest_jump = greatest_jump.max((after[2] - before[2]).abs());
        }
    }
    assert!(greatest_jump > 1e-3, "a quadratic spline is not twice differentiable: {greatest_jump}");
}

#[test]
fn a_slip_in_a_file_is_named_with_its_line_or_its_path() {
    let error = |text: &str| SplineGroundSettings::from_ron(text).unwrap_err().to_string();
    assert!(error("(\n  cell_m: 3.0,\n)").starts_with("line 2, column"), "{}", error("(\n  cell_m: 3.0,\n)"));
    assert_eq!(error("(cell_x_m: 0.0)"), "`cell_x_m` is 0, but must be 0.01 to 1000000");
}
