use super::*;
use crate::cells::store::tests::{CELL_M, cell_of, contents};
use bevy::math::DVec2;
use bevy::math::Vec3;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

const BOUNDS: [IVec2; 2] = [IVec2::splat(-40), IVec2::splat(40)];

fn settings() -> StreamSettings {
    StreamSettings { load_m: 600.0, keep_m: 800.0, plants_per_step: 8, most_ordered: 20, drops_per_step: 10 }
}

fn stream(settings: StreamSettings) -> CellStream {
    CellStream::new(settings, CELL_M, Some(BOUNDS)).unwrap()
}

fn at(x_m: f32, z_m: f32) -> ViewerPose {
    ViewerPose { eye_m: Vec3::new(x_m, 2.0, z_m), forward: Vec3::X }
}

fn planted(cell: IVec2) -> Cell {
    cell_of(cell, 2, 1.0, 5)
}

/// From a viewer to the nearest point of a cell, m.
fn distance(cell: IVec2, viewer: &ViewerPose) -> f64 {
    let (place, corner) = (viewer.eye_m.xz().as_dvec2(), cell.as_dvec2() * f64::from(CELL_M));
    place.clamp(corner, corner + f64::from(CELL_M)).distance(place)
}

fn all_cells() -> impl Iterator<Item = IVec2> {
    (BOUNDS[0].y..=BOUNDS[1].y).flat_map(|y| (BOUNDS[0].x..=BOUNDS[1].x).map(move |x| IVec2::new(x, y)))
}

fn drop_ordered(orders: &Orders, store: &mut CellStore) {
    for cell in &orders.drop {
        store.remove(*cell).unwrap();
    }
}

/// Steps until nothing is left to do.
fn settle(stream: &mut CellStream, viewers: &[ViewerPose], store: &mut CellStore) {
    let mut orders = Orders::default();
    for _ in 0..10_000 {
        stream.step(viewers, store, &mut orders);
        drop_ordered(&orders, store);
        for cell in &orders.plant {
            stream.deliver(*cell, planted(*cell), store);
        }
        if orders == Orders::default() && stream.waiting.is_empty() && stream.leaving.is_empty() {
            return;
        }
    }
    panic!("it never comes to rest");
}

fn assert_complete(store: &CellStore, viewers: &[ViewerPose]) {
    for cell in all_cells() {
        let nearest_m = viewers.iter().map(|viewer| distance(cell, viewer)).fold(f64::INFINITY, f64::min);
        assert!(nearest_m > 600.0 || store.contains(cell), "a hole at {cell}, {nearest_m} m away");
        assert!(nearest_m < 800.0 + 32.0 || !store.contains(cell), "{cell} is left {nearest_m} m away");
    }
}

#[test]
fn settings_out_of_range_are_named() {
    StreamSettings::default().validate(CELL_M).unwrap();
    let written = ron::to_string(&settings()).unwrap();
    assert_eq!(ron::from_str::<StreamSettings>(&written).unwrap(), settings());
    let error = |settings: StreamSettings| settings.validate(CELL_M).unwrap_err().field;
    assert_eq!(error(StreamSettings { keep_m: 650.0, ..settings() }), "load_m");
    assert_eq!(error(StreamSettings { keep_m: f32::NAN, ..settings() }), "keep_m");
    assert_eq!(error(StreamSettings { plants_per_step: 0, ..settings() }), "plants_per_step");
}

#[test]
fn near_cells_are_ordered_first_and_those_ahead_before_those_behind() {
    let (mut stream, store) = (stream(settings()), CellStore::new(CELL_M).unwrap());
    let mut orders = Orders::default();
    stream.step(&[at(10.0, 10.0)], &store, &mut orders);
    assert_eq!(orders.plant.len(), 8, "the budget");
    assert_eq!(orders.plant[0], IVec2::ZERO);
    let mut all = orders.plant.clone();
    stream.step(&[at(10.0, 10.0)], &store, &mut orders);
    all.extend(&orders.plant);
    stream.step(&[at(10.0, 10.0)], &store, &mut orders);
    all.extend(&orders.plant);
    assert_eq!((all.len(), stream.ordered()), (20, 20), "no more than may be on their way");
    let ahead = all.iter().filter(|cell| cell.x > 1).count();
    let behind = all.iter().filter(|cell| cell.x < -1).count();
    assert!(ahead > behind, "{ahead} ahead, {behind} behind");
    stream.give_back(all[3]);
    stream.step(&[at(10.0, 10.0)], &store, &mut orders);
    assert_eq!(orders.plant, [all[3]]);
}

#[test]
fn orders_follow_the_priority_of_all_waiting_cells() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    for count in [1, 1, 1, 1, 2, 3] {
        let viewers: Vec<ViewerPose> = (0..count)
            .map(|_| ViewerPose {
                forward: Vec3::new(random.random_range(-1.0..1.0), 0.1, random.random_range(-1.0..1.0)),
                ..at(random.random_range(-400.0..400.0), random.random_range(-400.0..400.0))
            })
            .collect();
        let settings = StreamSettings { load_m: 1200.0, keep_m: 1400.0, most_ordered: 100_000, ..settings() };
        let (mut stream, store) = (stream(settings), CellStore::new(CELL_M).unwrap());
        let mut priority = Priority::default();
        priority.follow(&viewers, CELL_M);
        let (mut orders, mut ordered) = (Orders::default(), Vec::new());
        loop {
            stream.step(&viewers, &store, &mut orders);
            if orders.plant.is_empty() {
                break;
            }
            ordered.extend(orders.plant.iter().map(|cell| (priority.delay(*cell), *cell)));
        }
        assert!(ordered.len() > 1000, "{} cells", ordered.len());
        let late = ordered.windows(2).filter(|two| by_delay(&two[0], &two[1]).is_gt());
        assert_eq!(late.collect::<Vec<_>>(), Vec::<&[(f32, IVec2)]>::new(), "{viewers:?}");
    }
}

#[test]
fn cells_are_complete_wherever_viewers_go() {
    let (mut stream, mut store) = (stream(settings()), CellStore::new(CELL_M).unwrap());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut viewers = vec![at(0.0, 0.0)];
    for _ in 0..60 {
        if random.random_bool(0.2) {
            let count = random.random_range(1..4);
            viewers.resize(count, at(0.0, 0.0));
        }
        for viewer in &mut viewers {
            let leap_m = if random.random_bool(0.2) { 4000.0 } else { 60.0 };
            let step = Vec3::new(random.random_range(-leap_m..leap_m), 0.0, random.random_range(-leap_m..leap_m));
            viewer.eye_m = (viewer.eye_m + step).clamp(Vec3::splat(-2900.0), Vec3::splat(2900.0));
        }
        settle(&mut stream, &viewers, &mut store);
        assert_complete(&store, &viewers);
    }
}

#[test]
fn no_cell_is_dropped_within_the_keep_radius_or_planted_twice() {
    let (mut stream, mut store) = (stream(settings()), CellStore::new(CELL_M).unwrap());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let (mut orders, mut late, mut viewer) = (Orders::default(), Vec::new(), at(0.0, 0.0));
    for step in 0..3000 {
        let leap_m = if step % 500 == 499 { 2000.0 } else { 25.0 };
        let to = Vec3::new(random.random_range(-leap_m..leap_m), 0.0, random.random_range(-leap_m..leap_m));
        viewer.eye_m = (viewer.eye_m + to).clamp(Vec3::splat(-2500.0), Vec3::splat(2500.0));
        stream.step(&[viewer], &store, &mut orders);
        assert!(orders.drop.iter().all(|cell| distance(*cell, &viewer) > 800.0));
        assert!(orders.plant.iter().all(|cell| !store.contains(*cell) && !late.contains(cell)));
        drop_ordered(&orders, &mut store);
        late.extend(&orders.plant);
        // Tasks end in any order, and some never.
        while late.len() > 12 {
            let cell = late.swap_remove(random.random_range(0..late.len()));
            if random.random_bool(0.1) {
                stream.give_back(cell);
            } else {
                stream.deliver(cell, planted(cell), &mut store);
            }
        }
    }
    for cell in late {
        stream.deliver(cell, planted(cell), &mut store);
    }
    settle(&mut stream, &[viewer], &mut store);
    assert_complete(&store, &[viewer]);
}

#[test]
fn moves_between_the_radii_order_nothing() {
    let (mut stream, mut store) = (stream(settings()), CellStore::new(CELL_M).unwrap());
    let mut orders = Orders::default();
    settle(&mut stream, &[at(0.0, 0.0)], &mut store);
    settle(&mut stream, &[at(100.0, 0.0)], &mut store);
    for step in 0..40 {
        stream.step(&[at(100.0 * (step % 2) as f32, 0.0)], &store, &mut orders);
        assert_eq!(orders, Orders::default());
    }
}

proptest! {
    #[test]
    fn the_order_of_deliveries_does_not_show(seed in 0..1000_u64) {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let viewers = [at(random.random_range(-999.0..999.0), 0.0), at(0.0, random.random_range(-999.0..999.0))];
        let (mut in_order, mut stream) = (stream(settings()), stream(settings()));
        let mut store = CellStore::new(CELL_M).unwrap();
        let (mut orders, mut open) = (Orders::default(), Vec::new());
        loop {
            stream.step(&viewers, &store, &mut orders);
            open.extend_from_slice(&orders.plant);
            if open.is_empty() {
                break;
            }
            let cell = open.swap_remove(random.random_range(0..open.len()));
            prop_assert!(stream.deliver(cell, planted(cell), &mut store));
        }
        let mut sorted = CellStore::new(CELL_M).unwrap();
        settle(&mut in_order, &viewers, &mut sorted);
        prop_assert_eq!(contents(&store), contents(&sorted));
    }
}

#[test]
fn memory_stays_flat_over_ten_thousand_moves() {
    let (mut stream, mut store) = (stream(settings()), CellStore::new(CELL_M).unwrap());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let (mut orders, mut viewer) = (Orders::default(), at(0.0, 0.0));
    let mut most = [[0; 4]; 2];
    for step in 0..10_000 {
        let leap_m = if random.random_bool(0.01) { 5000.0 } else { 30.0 };
        let to = Vec3::new(random.random_range(-leap_m..leap_m), 0.0, random.random_range(-leap_m..leap_m));
        viewer.eye_m = (viewer.eye_m + to).clamp(Vec3::splat(-2500.0), Vec3::splat(2500.0));
        stream.step(&[viewer], &store, &mut orders);
        drop_ordered(&orders, &mut store);
        for cell in &orders.plant {
            stream.deliver(*cell, planted(*cell), &mut store);
        }
        let sizes = [store.bytes(), stream.waiting.capacity(), stream.leaving.capacity(), stream.ordered.len()];
        let half = &mut most[usize::from(step >= 5000)];
        *half = std::array::from_fn(|number| half[number].max(sizes[number]));
    }
    for (later, before) in most[1].iter().zip(most[0]) {
        assert!(*later <= before + before / 4, "{most:?}");
    }
    settle(&mut stream, &[at(0.0, 0.0)], &mut store);
    assert_complete(&store, &[at(0.0, 0.0)]);
}

#[test]
fn cells_that_are_there_before_are_kept_or_dropped() {
    let (mut stream, mut store) = (stream(settings()), CellStore::new(CELL_M).unwrap());
    for cell in all_cells() {
        store.insert(cell, Cell::pack(&[], DVec2::ZERO, CELL_M));
    }
    settle(&mut stream, &[at(-300.0, 77.0)], &mut store);
    assert_complete(&store, &[at(-300.0, 77.0)]);
}

#[test]
fn values_that_are_no_number_are_harmless() {
    let (mut stream, mut store) = (stream(settings()), CellStore::new(CELL_M).unwrap());
    settle(&mut stream, &[at(0.0, 0.0)], &mut store);
    let cells = store.len();
    for wrong in [f32::NAN, f32::INFINITY] {
        settle(&mut stream, &[at(wrong, 0.0)], &mut store);
        settle(&mut stream, &[ViewerPose { forward: Vec3::splat(wrong), ..at(0.0, 0.0) }], &mut store);
        settle(&mut stream, &[], &mut store);
        assert_eq!(store.len(), cells);
    }
    settle(&mut stream, &[at(-3e38, 3e38)], &mut store);
    assert!(store.is_empty());
    let mut nowhere = CellStream::new(settings(), CELL_M, None).unwrap();
    settle(&mut nowhere, &[at(0.0, 0.0)], &mut store);
    assert!(store.is_empty());
}
