use super::*;
use crate::lod::{Lens, LevelDistances};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

const LENS: Lens = Lens { fov_rad: 0.785, picture_px: 1080.0 };

fn switches() -> LevelSwitches {
    LevelDistances::default().switches(25.0, LENS)
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
