use super::*;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

const LENS: Lens = Lens { fov_rad: 0.785, picture_px: 1080.0 };

fn switches() -> LevelSwitches {
    LevelDistances::default().switches(25.0, LENS)
}

#[test]
fn the_defaults_are_valid_and_survive_writing() {
    let distances = LevelDistances::default();
    distances.validate().unwrap();
    assert_eq!(ron::from_str::<LevelDistances>(&ron::to_string(&distances).unwrap()).unwrap(), distances);
    let error = LevelDistances { medium_px: 500.0, ..distances }.validate().unwrap_err();
    assert_eq!(error.to_string(), "`high_px` is 400, but must be 500 to 100000");
    assert!(LevelDistances { margin: f32::NAN, ..distances }.validate().is_err());
}

#[test]
fn a_tree_has_its_size_on_screen_where_its_level_changes() {
    let [high_m, medium_m, low_m] = switches().at_m();
    let pixels = |distance_m: f32| 25.0 / (2.0 * distance_m * (0.5 * LENS.fov_rad).tan()) * LENS.picture_px;
    for (at_m, px) in [(high_m, 400.0), (medium_m, 60.0), (low_m, 3.0)] {
        assert!((pixels(at_m) / px - 1.0).abs() < 1e-4);
    }
    let twice = LevelDistances { quality: 2.0, ..Default::default() }.switches(25.0, LENS);
    assert!((twice.at_m()[0] / high_m - 2.0).abs() < 1e-4);
}

proptest! {
    #[test]
    fn within_the_margin_a_level_changes_once_at_most(
        border in 0..3_usize, seed in 0..1000_u64, start in 0.0..12_000.0_f32,
    ) {
        let switches = switches();
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut level = switches.choose(start, None);
        let mut changes = 0;
        for _ in 0..200 {
            let share = 1.0 + 0.079 * random.random_range(-1.0..=1.0_f32);
            let next = switches.choose(switches.at_m()[border] * share, Some(level));
            changes += usize::from(next != level);
            level = next;
        }
        prop_assert!(changes <= 1);
    }

    #[test]
    fn beyond_the_margins_a_level_follows_from_the_distance_alone(distance_m in 1.0..20_000.0_f32) {
        let switches = switches();
        let near_a_border = switches.at_m().iter().any(|at_m| (distance_m / at_m - 1.0).abs() < 0.081);
        for before in LEVELS {
            prop_assert!(near_a_border || switches.choose(distance_m, Some(before)) == switches.choose(distance_m, None));
        }
    }
}

#[test]
fn what_is_no_number_is_harmless() {
    assert_eq!(switches().choose(f32::NAN, Some(Level::Medium)), Level::Medium);
    assert_eq!(switches().choose(f32::NAN, None), Level::Ground);
    assert_eq!(switches().choose(f32::INFINITY, Some(Level::High)), Level::Ground);
    for lens in [Lens { fov_rad: f32::NAN, ..LENS }, Lens { picture_px: 0.0, ..LENS }] {
        assert_eq!(LevelDistances::default().switches(25.0, lens).choose(10.0, Some(Level::High)), Level::Ground);
    }
}

fn at(distance_m: f32, cell: IVec2) -> Seen {
    Seen { cell, distance_m, in_view: true }
}

#[test]
fn cells_keep_their_levels_also_when_they_are_out_of_view_for_a_while() {
    let (switches, mut known, mut levels) = (switches(), CellLevels::default(), Vec::new());
    let border_m = switches.at_m()[1];
    let cells = [IVec2::new(20, 3), IVec2::new(-1, 5)];
    let mut choose = |seen: &[Seen], levels: &mut Vec<Level>| known.choose(seen, &switches, levels);
    choose(&[at(0.5 * border_m, cells[1]), at(2.0 * border_m, cells[0])], &mut levels);
    assert_eq!(levels, [Level::Medium, Level::Low]);
    let at_the_border = [at(border_m * 1.01, cells[1]), at(border_m * 0.99, cells[0])];
    for _ in 0..REMEMBERED_FRAMES {
        choose(&at_the_border[..0], &mut levels);
    }
    choose(&at_the_border, &mut levels);
    assert_eq!(levels, [Level::Medium, Level::Low], "as before");
    for _ in 0..=REMEMBERED_FRAMES {
        choose(&at_the_border[..0], &mut levels);
    }
    choose(&at_the_border, &mut levels);
    assert_eq!(levels, [Level::Low, Level::Medium], "by the distance alone");
    assert_eq!(known.len(), 2);
}

#[test]
fn levels_are_those_of_a_search_in_a_table() {
    let (switches, mut known, mut levels) = (switches(), CellLevels::default(), Vec::new());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    let mut table = std::collections::HashMap::new();
    for _ in 0..50 {
        let mut cells: Vec<IVec2> = (-20..20).flat_map(|y| (-20..20).map(move |x| IVec2::new(x, y))).collect();
        cells.retain(|_| random.random_bool(0.3));
        cells.sort_by_key(|&cell| order(cell));
        let seen: Vec<Seen> = cells.iter().map(|&cell| at(random.random_range(10.0..1000.0), cell)).collect();
        known.choose(&seen, &switches, &mut levels);
        for (seen, &level) in seen.iter().zip(&levels) {
            assert_eq!(level, switches.choose(seen.distance_m, table.get(&seen.cell).copied()));
            table.insert(seen.cell, level);
        }
    }
}
