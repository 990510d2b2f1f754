//! Finds the trees that something touches.

use super::{
    components::LiveSway,
    impulse::TreeImpulse,
    pusher::{Pushers, PushingBody},
    settings::LiveSettings,
};
use crate::{
    dynamics::{Capsule, Contacts},
    setting::valid_or_last,
    sway::{
        articulated::TreePose,
        stands::{stands_at, uniform_scale},
    },
    tree::{Grown, TreeModel, TreePlaces},
    wind::WindSources,
};
use bevy::prelude::*;

/// Branches within this distance of a pusher's body are looked at, m, since they sway.
const MARGIN_M: f32 = 0.5;

/// What a tree is woken by.
enum Cause {
    Wind,
    Push,
    Blow([Vec3; 2]),
}

/// A tree that is touched.
pub(in crate::sway) struct Touched {
    tree: Entity,
    cause: Cause,
    /// Which of the blows of the frame it is.
    number: usize,
}

/// Whether anything blows, pushes or strikes.
pub(in crate::sway) fn has_cause(
    sources: Res<WindSources>,
    pushers: Res<Pushers>,
    impulses: Res<Messages<TreeImpulse>>,
) -> bool {
    !(sources.is_empty() && pushers.now().is_empty() && impulses.is_empty())
}

/// A tree that may be touched.
type Touchable<'a> =
    (&'a Grown, &'a Transform, &'a GlobalTransform, Has<ChildOf>, Option<&'a TreePose>, Option<&'a mut LiveSway>);

/// Wakes the trees that are touched: so many at most as the settings allow, in the order of their entities.
pub(in crate::sway) fn wake_trees(
    mut commands: Commands,
    settings: Res<LiveSettings>,
    mut valid: Local<Option<LiveSettings>>,
    places: Res<TreePlaces>,
    (sources, pushers): (Res<WindSources>, Res<Pushers>),
    mut impulses: MessageReader<TreeImpulse>,
    models: Res<Assets<TreeModel>>,
    mut trees: Query<Touchable>,
    awake: Query<(), With<LiveSway>>,
    (mut touched, mut woken): (Local<Vec<Touched>>, Local<Vec<(Entity, LiveSway)>>),
) {
    if settings.is_changed() || valid.is_none() {
        *valid = Some(valid_or_last("live trees", &*settings, LiveSettings::validate, valid.as_ref()));
    }
    let Some(settings) = &*valid else { return };
    let mut left = (settings.most_trees as usize).saturating_sub(awake.iter().count());
    let least_m_s = settings.wake_speed_m_s;
    find_touched(&mut touched, (&places, &models, &trees), least_m_s, (&sources, &pushers), &mut impulses);
    for Touched { tree: entity, cause, .. } in touched.drain(..) {
        let Ok((.., pose, live)) = trees.get_mut(entity) else { continue };
        let pushes = matches!(cause, Cause::Push);
        match (live, woken.last_mut().filter(|(last, _)| *last == entity)) {
            (Some(mut live), _) => touch(&mut live, cause),
            (None, Some((_, live))) => touch(live, cause),
            (None, None) if left > 0 => {
                left -= 1;
                let live = if let Cause::Blow(blow) = cause { LiveSway::struck(blow) } else { LiveSway::touched() };
                woken.push((entity, live));
            }
            (None, None) => continue,
        }
        // To meet a body its branches have to be known.
        if pushes && pose.is_none() {
            commands.entity(entity).try_insert(TreePose::default());
        }
    }
    for (entity, live) in woken.drain(..) {
        commands.entity(entity).try_insert(live);
    }
}

fn touch(live: &mut LiveSway, cause: Cause) {
    live.is_touched = true;
    if let Cause::Blow(blow) = cause {
        live.blows.push(blow);
    }
}

/// Finds every tree that is touched, and by what, in the order of the entities. The blows on one tree stay in their order.
fn find_touched(
    touched: &mut Vec<Touched>,
    (places, models, trees): (&TreePlaces, &Assets<TreeModel>, &Query<Touchable>),
    least_m_s: f32,
    (sources, pushers): (&WindSources, &Pushers),
    impulses: &mut MessageReader<TreeImpulse>,
) {
    touched.clear();
    let wind = |(tree, ..): (Entity, Vec3, f32)| Touched { tree, cause: Cause::Wind, number: 0 };
    for flow in sources.now() {
        let near = places.near(flow.place, flow.reach_m);
        touched.extend(near.filter(|(_, centre, radius_m)| flow.touches(*centre, *radius_m, least_m_s)).map(wind));
    }
    let push = |(tree, ..): (Entity, Vec3, f32)| Touched { tree, cause: Cause::Push, number: 0 };
    for body in pushers.now() {
        let Capsule { ends: [a, b], radius_m } = body.capsule;
        let near = places.near(a.midpoint(b), 0.5 * a.distance(b) + radius_m + MARGIN_M);
        touched.extend(near.filter(|(tree, ..)| is_pushed(body, *tree, models, trees)).map(push));
    }
    for (number, blow) in (1..).zip(impulses.read()) {
        touched.push(Touched { tree: blow.tree, cause: Cause::Blow([blow.place, blow.impulse_n_s]), number });
    }
    touched.sort_unstable_by_key(|it| (it.tree, it.number));
}

fn is_pushed(body: &PushingBody, entity: Entity, models: &Assets<TreeModel>, trees: &Query<Touchable>) -> bool {
    let Ok((grown, transform, global, is_child, pose, _)) = trees.get(entity) else { return false };
    let Some(model) = models.get(&grown.model) else { return false };
    let stands = stands_at(transform, global, is_child);
    let scale = uniform_scale(&stands);
    let capsule = to_local(&body.capsule, &stands);
    let poses = pose.map_or(&[][..], TreePose::beams);
    Contacts { beams: &model.beams, poses, scale }.is_near(&capsule, MARGIN_M / scale)
}

/// A body in the coordinates of a tree, at the tree's own scale of 1.
pub(super) fn to_local(body: &Capsule, stands: &GlobalTransform) -> Capsule {
    let local_from_world = stands.affine().inverse();
    Capsule {
        ends: body.ends.map(|end| local_from_world.transform_point3(end)),
        radius_m: body.radius_m / uniform_scale(stands),
    }
}
