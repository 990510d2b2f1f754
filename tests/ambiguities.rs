//! Systems that touch the same data run in an order that somebody has chosen, where one of them is ours: among ourselves, and beside the
//! systems of Bevy's default plugins.

#[path = "support/mod.rs"]
mod support;

use bevy::{
    ecs::schedule::{InternedScheduleLabel, Schedule, ScheduleLabel, SystemKey},
    prelude::*,
};
use std::{collections::BTreeSet, time::Duration};

/// With this begin the names of our systems. Bevy keeps names with its feature `debug`, which the tests have.
const OURS: &str = "bevy_windwood::";

fn name(schedule: &Schedule, key: SystemKey) -> Option<String> {
    let (_, system) = schedule.systems().ok()?.find(|(other, _)| *other == key)?;
    Some(system.name().to_string())
}

/// Pairs of systems of a schedule that touch the same data without an order, where one is ours.
fn ambiguities(world: &mut World, label: InternedScheduleLabel) -> BTreeSet<String> {
    world.schedule_scope(label, |world, schedule| {
        schedule.initialize(world).expect("a schedule that can be built");
        let pairs = schedule.graph().conflicting_systems().iter().map(|(one, other, _)| {
            let mut names = [*one, *other].map(|key| name(schedule, key).expect("a system of this schedule"));
            names.sort_unstable();
            names
        });
        let ours = pairs.filter(|names| names.iter().any(|name| is_of_ours(name)));
        ours.map(|[one, other]| format!("{label:?}: {one}, {other}")).collect()
    })
}

/// How many systems of a schedule are known to be ours, once it has been built.
fn known(world: &mut World, label: InternedScheduleLabel) -> usize {
    world.schedule_scope(label, |_, schedule| {
        let systems = schedule.systems().expect("it has been built");
        systems.filter(|(_, system)| is_of_ours(&system.name().to_string())).count()
    })
}

fn is_of_ours(system: &str) -> bool {
    system.contains(OURS)
}

#[test]
fn no_system_of_ours_is_ambiguous_with_another() {
    let mut app = support::headless_app(Duration::ZERO, None);
    support::capture::begin(&mut app).expect("a graphics device");
    app.update();
    let labels = [First.intern(), PreUpdate.intern(), Update.intern(), PostUpdate.intern(), Last.intern()];
    let found: BTreeSet<String> = labels.into_iter().flat_map(|label| ambiguities(app.world_mut(), label)).collect();
    assert!(found.is_empty(), "systems in no order: {found:#?}");
    // By their names.
    let known: usize = labels.into_iter().map(|label| known(app.world_mut(), label)).sum();
    assert!(known > 50, "{known} systems of ours are known by their names");
}
