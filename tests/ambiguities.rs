//! No two systems that touch the same data run in an order that nobody has chosen, where one of them is ours: neither among ourselves,
//! nor beside the systems of Bevy's default plugins.

#[path = "support/mod.rs"]
mod support;

use bevy::{
    ecs::{
        component::ComponentId,
        schedule::{InternedScheduleLabel, NodeId, Schedule, ScheduleLabel, SystemKey},
    },
    prelude::*,
};
use bevy_windwood::SystemTimes;
use std::time::Duration;

/// Two systems, and what both touch.
struct Ambiguity {
    systems: [String; 2],
    on: Vec<String>,
}

/// The name of a system of ours.
fn own_name(world: &World, schedule: &Schedule, key: SystemKey) -> Option<&'static str> {
    let system = schedule.systems().ok()?.find(|(other, _)| *other == key)?.1;
    world.resource::<SystemTimes>().name_of(system.system_type())
}

/// What is known of a system of Bevy's: the sets that it is in.
fn sets_of(schedule: &Schedule, key: SystemKey) -> String {
    let graph = schedule.graph();
    let parents = graph
        .hierarchy()
        .graph()
        .neighbors_directed(NodeId::System(key), bevy::ecs::schedule::graph::Direction::Incoming);
    let sets = parents.filter_map(|node| Some(format!("{:?}", graph.system_sets.get(node.as_set()?)?)));
    format!("a system of Bevy's in {}", sets.collect::<Vec<_>>().join(", "))
}

fn type_name(world: &World, id: ComponentId) -> String {
    let of = world.components().get_info(id).and_then(|info| info.type_id());
    let known = world.resource::<AppTypeRegistry>().read();
    let name = of.and_then(|of| known.get_type_info(of)).map(|info| info.type_path().to_string());
    name.unwrap_or_else(|| format!("{:?}", world.components().get_name(id)))
}

fn ambiguities(world: &mut World, label: InternedScheduleLabel) -> Vec<Ambiguity> {
    world.schedule_scope(label, |world, schedule| {
        schedule.initialize(world).expect("a schedule that can be built");
        let conflicts = schedule.graph().conflicting_systems().clone();
        let ours = conflicts.iter().filter_map(|(one, other, on)| {
            let names = [*one, *other].map(|key| own_name(world, schedule, key));
            names.iter().any(Option::is_some).then(|| Ambiguity {
                systems: [(names[0], *one), (names[1], *other)]
                    .map(|(name, key)| name.map_or_else(|| sets_of(schedule, key), str::to_string)),
                on: on.iter().map(|id| type_name(world, *id)).collect(),
            })
        });
        ours.collect()
    })
}

#[test]
fn no_system_of_ours_is_ambiguous_with_another() {
    let mut app = support::headless_app(Duration::ZERO, None);
    support::capture::begin(&mut app).expect("a graphics device");
    app.update();
    let labels = [First.intern(), PreUpdate.intern(), Update.intern(), PostUpdate.intern(), Last.intern()];
    let mut found = String::new();
    for label in labels {
        for Ambiguity { systems: [one, other], on } in ambiguities(app.world_mut(), label) {
            found += &format!("\n{label:?}: {one} and {other} on {}", on.join(", "));
        }
    }
    assert!(found.is_empty(), "systems in no order:{found}");
}
