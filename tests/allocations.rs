//! Once a forest stands, our systems allocate nothing from frame to frame while its trees sway. Needs a Vulkan driver. Mesa's software one
//! will do.
//!
//! The clock of [`SystemTimes`] counts allocations in place of time: a system runs on one thread from beginning to end. What others do there
//! while a system waits for tasks counts, too, so each system has several frames, and the least of them counts.

mod support;

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{SystemTimes, prelude::*};
use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
    collections::BTreeMap,
    time::Duration,
};
use support::forest::TestForest;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

/// The system's allocator, which counts.
struct Counting;

/// What a thread allocates while it ends is not counted.
fn count() {
    let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
}

// SAFETY: everything is left to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps to the contract of this function.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps to the contract of this function.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller keeps to the contract of this function.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

fn allocations() -> Duration {
    Duration::from_nanos(ALLOCATIONS.with(Cell::get))
}

const FRAMES: usize = 12;
const FRAME: Duration = Duration::from_millis(16);

/// The least that each system allocates in one of some frames; a `walk` moves the camera by so much in each.
fn least_allocations(forest: &mut TestForest, walk: Vec3) -> BTreeMap<&'static str, u64> {
    let mut least = BTreeMap::new();
    for frame in 0..FRAMES {
        forest.look(Vec3::Y * 12.0 + walk * frame as f32, Vec3::NEG_Z);
        support::capture::step(&mut forest.app);
        for (name, count) in forest.app.world().resource::<SystemTimes>().iter() {
            let count = count.as_nanos() as u64;
            least.entry(name).and_modify(|least: &mut u64| *least = count.min(*least)).or_insert(count);
        }
    }
    least
}

#[test]
fn our_systems_allocate_nothing_while_trees_sway() {
    let settings = ForestSettings { trees_to_m: 100.0, far_to_m: 300.0, ..default() };
    let mut forest = TestForest::new(settings, None);
    let species = forest.app.world().resource::<AssetServer>().load("species/birch.species.ron");
    // A tree of the game's own that is posed on the CPU, and something that pushes it.
    forest.app.world_mut().spawn((Tree::new(species), Articulated::default(), Transform::from_xyz(0.0, 0.0, -15.0)));
    forest.app.world_mut().spawn((Pusher::sphere(0.5), Transform::from_xyz(0.3, 1.0, -15.0)));
    forest.app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
    (0..60).for_each(|_| support::capture::step(&mut forest.app));
    forest.app.world().resource::<SystemTimes>().use_clock(allocations);
    support::capture::step(&mut forest.app);
    for walk in [Vec3::ZERO, Vec3::new(0.05, 0.0, 0.0)] {
        let least = least_allocations(&mut forest, walk);
        let some: Vec<_> = least.iter().filter(|(_, count)| **count > 0).collect();
        println!("{} systems; with {walk} m a frame these allocate: {some:?}", least.len());
        assert!(least.len() > 30, "{} systems are watched", least.len());
        assert!(some.is_empty(), "with {walk} m a frame these allocate: {some:?}");
    }
}

/// The counter counts.
#[test]
fn an_allocation_is_counted() {
    let before = allocations();
    let held = std::hint::black_box(vec![1, 2, 3]);
    assert_eq!(allocations() - before, Duration::from_nanos(1));
    drop(held);
}
