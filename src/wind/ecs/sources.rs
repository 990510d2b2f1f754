//! Entities that blow, and what blows in this frame, for all who feel it.

use crate::{
    setting::{SettingError, require},
    wind::source::{SourceFlow, SourceKind, SourceMoment},
};
use bevy::prelude::*;

/// Blows from this entity's place: a blast, the downwash of a rotor, a jet, a vortex. Trees, grass, fires and [`WindCell`](crate::wind::WindCell)s feel it as they
/// feel the [`Wind`](crate::wind::Wind), to which it is added.
///
/// It goes on for `duration_s`, and is left on its entity then. Set `age_s` to 0 to have it blow again.
///
/// A source with a value out of range does not blow, and is told of once.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(Transform)]
pub struct WindSource {
    /// What it blows.
    pub kind: SourceKind,
    /// Factor on its speeds; 0 to 10.
    pub strength: f32,
    /// Nothing is felt farther from it, m; 0.1 to 2000. It fades out over the last fifth.
    pub reach_m: f32,
    /// How long it blows, s; 0 or more, infinite for ever. It begins and ends within 0.3 s. A blast ends by itself.
    pub duration_s: f32,
    /// How long it has blown, s. It grows with virtual time.
    pub age_s: f32,
}

impl Default for WindSource {
    fn default() -> Self {
        Self { kind: SourceKind::default(), strength: 1.0, reach_m: 60.0, duration_s: f32::INFINITY, age_s: 0.0 }
    }
}

impl WindSource {
    /// A source of that kind, of its own strength, which goes on.
    pub fn new(kind: SourceKind) -> Self {
        let reach_m = if matches!(kind, SourceKind::Blast { .. }) { 200.0 } else { 60.0 };
        Self { kind, reach_m, ..Self::default() }
    }

    /// Sets how long it blows, s.
    pub fn with_duration(mut self, duration_s: f32) -> Self {
        self.duration_s = duration_s;
        self
    }

    /// Sets how far it is felt, m.
    pub fn with_reach(mut self, reach_m: f32) -> Self {
        self.reach_m = reach_m;
        self
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        self.kind.validate().map_err(|error| error.inside("kind"))?;
        require("strength", self.strength, 0.0..=10.0)?;
        require("reach_m", self.reach_m, 0.1..=2000.0)?;
        require("duration_s", self.duration_s, 0.0..=f32::INFINITY)?;
        require("age_s", self.age_s, 0.0..=f32::INFINITY)
    }
}

/// What all [`WindSource`]s blow, in a fixed order. Written in
/// [`WindwoodSystems::AdvanceWind`](crate::schedule::WindwoodSystems::AdvanceWind).
#[derive(Resource, Default)]
pub struct WindSources {
    now: Vec<SourceFlow>,
    before: Vec<SourceFlow>,
}

impl WindSources {
    /// Velocity of the air that all of them blow at a place in the world, m/s in world axes. To be added to that of the
    /// [`Wind`](crate::wind::Wind).
    pub fn velocity(&self, place: Vec3) -> Vec3 {
        self.now.iter().map(|flow| flow.velocity(place)).sum()
    }

    /// Those that blow now.
    pub(crate) fn now(&self) -> &[SourceFlow] {
        &self.now
    }

    /// Those that blew one frame ago.
    #[cfg(feature = "render")]
    pub(crate) fn before(&self) -> &[SourceFlow] {
        &self.before
    }

    /// Whether any blows, or did so one frame ago.
    pub(crate) fn is_empty(&self) -> bool {
        self.now.is_empty() && self.before.is_empty()
    }
}

/// A source begins, and ends, within this time, s: nothing jumps.
const RAMP_S: f32 = 0.3;

/// Lets the sources grow older, and finds out what they blow.
///
/// An entity without a parent is where its `Transform` says. For a child the best that is known is the place of the last
/// propagation.
pub(in crate::wind) fn advance_sources(
    time: Res<Time>,
    mut refused: Local<Vec<Entity>>,
    mut blowing: Local<Vec<(Entity, SourceFlow)>>,
    mut flows: ResMut<WindSources>,
    mut sources: Query<(Entity, &mut WindSource, &Transform, Option<&GlobalTransform>, Has<ChildOf>)>,
) {
    let flows = flows.bypass_change_detection();
    std::mem::swap(&mut flows.now, &mut flows.before);
    flows.now.clear();
    for (entity, mut source, transform, global, is_child) in &mut sources {
        let was_changed = source.is_changed();
        let source = source.bypass_change_detection();
        if let Err(error) = source.validate() {
            if !refused.contains(&entity) {
                warn!("wind source {entity}: {error}; it does not blow");
                refused.push(entity);
            }
            continue;
        }
        if was_changed {
            refused.retain(|other| *other != entity);
        }
        let at = match (is_child, global) {
            (true, Some(global)) => global.compute_transform(),
            _ => *transform,
        };
        let moment = advance(source, time.delta_secs());
        let flow = moment
            .and_then(|moment| SourceFlow::new(&source.kind, at.translation, at.rotation, source.reach_m, moment));
        blowing.extend(flow.map(|flow| (entity, flow)));
    }
    blowing.sort_unstable_by_key(|(entity, _)| *entity);
    flows.now.extend(blowing.drain(..).map(|(_, flow)| flow));
}

/// Lets a source grow older. None once it has ended.
fn advance(source: &mut WindSource, frame_s: f32) -> Option<SourceMoment> {
    let before_s = source.age_s;
    source.age_s += frame_s;
    let left_s = source.duration_s - source.age_s;
    if left_s <= 0.0 {
        return None;
    }
    // The short way of a blast has no ramp.
    let ramp = if source.kind.is_sudden() { 1.0 } else { (source.age_s.min(left_s) / RAMP_S).min(1.0) };
    Some(SourceMoment { age_s: source.age_s, before_s, strength: source.strength * ramp })
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::ecs::system::RunSystemOnce;
    use std::time::Duration;

    fn world(frame_s: f32) -> World {
        let mut world = World::new();
        let mut time = Time::<()>::default();
        time.advance_by(Duration::from_secs_f32(frame_s));
        world.insert_resource(time);
        world.init_resource::<WindSources>();
        world
    }

    fn blow(world: &mut World) -> usize {
        world.run_system_once(advance_sources).expect("it runs");
        world.resource::<WindSources>().now().len()
    }

    #[test]
    fn a_source_swells_and_ends_after_its_duration() {
        let mut world = world(0.1);
        world.spawn((WindSource::default().with_duration(1.05), Transform::default()));
        let ahead = Vec3::NEG_Z * 2.0;
        let mut speeds = Vec::new();
        while blow(&mut world) > 0 {
            speeds.push(world.resource::<WindSources>().velocity(ahead).length());
        }
        assert_eq!(speeds.len(), 10);
        let full = speeds[4];
        assert!(full > 10.0 && (speeds[0] / full - 1.0 / 3.0).abs() < 1e-3 && speeds[9] < 0.3 * full, "{speeds:?}");
        #[cfg(feature = "render")]
        assert_eq!(world.resource::<WindSources>().before().len(), 1, "motion vectors still need it");
    }

    #[test]
    fn sources_add_up_in_whatever_order_they_came() {
        let mut world = world(1.0);
        let first = world.spawn((WindSource::default(), Transform::default())).id();
        world.spawn((WindSource::default(), Transform::from_xyz(1.0, 0.0, 0.0)));
        assert_eq!(blow(&mut world), 2);
        let there = Vec3::new(0.5, 0.2, -3.0);
        let velocity = world.resource::<WindSources>().velocity(there);
        // Into another archetype, and so to the end of the query.
        world.entity_mut(first).insert(Name::new("first"));
        assert_eq!(blow(&mut world), 2);
        assert_eq!(world.resource::<WindSources>().velocity(there), velocity);
    }

    #[test]
    fn a_source_out_of_range_does_not_blow() {
        let mut world = world(0.1);
        let kind = SourceKind::Blast { charge_kg: f32::NAN };
        let source = world.spawn((WindSource::new(kind), Transform::default())).id();
        assert_eq!(blow(&mut world), 0);
        world.entity_mut(source).insert(WindSource::default());
        assert_eq!(blow(&mut world), 1);
    }
}
