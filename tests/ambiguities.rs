//! Systems that touch the same data run in an order that somebody has chosen, where one of them is ours: among ourselves, and beside the
//! systems of Bevy's default plugins.
//!
//! What is still without an order stands in [`KNOWN`]; anything else is an error. Bevy keeps names of systems only with its feature
//! `debug`. Ours are told by [`SystemTimes`]; one that is not watched, be it ours or Bevy's, is `another`.

#[path = "support/mod.rs"]
mod support;

use bevy::{
    ecs::schedule::{InternedScheduleLabel, Schedule, ScheduleLabel, SystemKey},
    prelude::*,
};
use bevy_windwood::SystemTimes;
use std::{collections::BTreeSet, time::Duration};

/// Pairs of systems whose order is still to be chosen.
const KNOWN: [&str; 9] = [
    "PostUpdate: another, cull_cells",
    "PostUpdate: another, measure_species",
    "PostUpdate: another, update_posed_trees",
    "PostUpdate: another, upload_frame",
    "PostUpdate: another, upload_live_trees",
    "PostUpdate: another, write_tree_rows",
    "Update: another, bake_impostor_species",
    "Update: another, finish_preparing_species",
    "Update: another, update_lod_viewers",
];

const ANOTHER: &str = "another";

fn name(world: &World, schedule: &Schedule, key: SystemKey) -> &'static str {
    let system = schedule.systems().ok().and_then(|mut systems| systems.find(|(other, _)| *other == key));
    let name = system.and_then(|(_, system)| world.resource::<SystemTimes>().name_of(system.system_type()));
    name.unwrap_or(ANOTHER)
}

/// Pairs of systems of a schedule that touch the same data without an order, where one is ours.
fn ambiguities(world: &mut World, label: InternedScheduleLabel) -> BTreeSet<String> {
    world.schedule_scope(label, |world, schedule| {
        schedule.initialize(world).expect("a schedule that can be built");
        let pairs = schedule.graph().conflicting_systems().iter().map(|(one, other, _)| {
            let mut names = [name(world, schedule, *one), name(world, schedule, *other)];
            names.sort_unstable();
            names
        });
        let ours = pairs.filter(|names| *names != [ANOTHER; 2]);
        ours.map(|[one, other]| format!("{label:?}: {one}, {other}")).collect()
    })
}

#[test]
fn no_system_of_ours_is_ambiguous_with_another_but_those_that_are_known() {
    let mut app = support::headless_app(Duration::ZERO, None);
    support::capture::begin(&mut app).expect("a graphics device");
    app.update();
    let labels = [First.intern(), PreUpdate.intern(), Update.intern(), PostUpdate.intern(), Last.intern()];
    let found: BTreeSet<String> = labels.into_iter().flat_map(|label| ambiguities(app.world_mut(), label)).collect();
    let known: BTreeSet<String> = KNOWN.into_iter().map(str::to_string).collect();
    let new: Vec<_> = found.difference(&known).collect();
    assert!(new.is_empty(), "systems in no order: {new:#?}");
    let gone: Vec<_> = known.difference(&found).collect();
    assert!(gone.is_empty(), "these have an order now, and are known no longer: {gone:#?}");
}
