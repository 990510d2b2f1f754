//! Finds the trees that something touches.

use super::{
    components::LiveSway,
    impulse::TreeImpulse,
    index::TreeIndex,
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
    tree::{Grown, TreeModel},
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
    index: Res<TreeIndex>,
    (sources, pushers): (Res<WindSources>, Res<Pushers>),
    mut impulses: MessageReader<TreeImpulse>,
    models: Res<Assets<TreeModel>>,
    mut trees: Query<Touchable>,
    awake: Query<(), With<LiveSway>>,
) {
    if settings.is_changed() || valid.is_none() {
        *valid = Some(valid_or_last("live trees", &*settings, LiveSettings::validate, valid.as_ref()));
    }
    let Some(settings) = &*valid else { return };
    let mut left = (settings.most_trees as usize).saturating_sub(awake.iter().count());
    let mut woken: Vec<(Entity, LiveSway)> = Vec::new();
    for (entity, cause) in causes(&index, settings, &sources, &pushers, &mut impulses, &models, &trees) {
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
    for (entity, live) in woken {
        commands.entity(entity).try_insert(live);
    }
}

fn touch(live: &mut LiveSway, cause: Cause) {
    live.is_touched = true;
    if let Cause::Blow(blow) = cause {
        live.blows.push(blow);
    }
}

/// Every tree that is touched, and by what, in the order of the entities.
fn causes(
    index: &TreeIndex,
    settings: &LiveSettings,
    sources: &WindSources,
    pushers: &Pushers,
    impulses: &mut MessageReader<TreeImpulse>,
    models: &Assets<TreeModel>,
    trees: &Query<Touchable>,
) -> Vec<(Entity, Cause)> {
    let mut causes: Vec<(Entity, Cause)> = Vec::new();
    for flow in sources.now() {
        let near = index.near(flow.place, flow.reach_m);
        let blown = near.filter(|(_, tree)| flow.touches(tree.centre, tree.radius_m, settings.wake_speed_m_s));
        causes.extend(blown.map(|(entity, _)| (entity, Cause::Wind)));
    }
    for body in pushers.now() {
        let Capsule { ends: [a, b], radius_m } = body.capsule;
        let near = index.near(a.midpoint(b), 0.5 * a.distance(b) + radius_m + MARGIN_M);
        let pushed = near.filter(|(entity, _)| is_pushed(body, *entity, models, trees));
        causes.extend(pushed.map(|(entity, _)| (entity, Cause::Push)));
    }
    causes.extend(impulses.read().map(|it| (it.tree, Cause::Blow([it.place, it.impulse_n_s]))));
    // Stable: the blows on one tree stay in their order.
    causes.sort_by_key(|(entity, _)| *entity);
    causes
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
