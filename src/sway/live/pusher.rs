//! Bodies that push branches and grass aside.

use super::trail::Trails;
use crate::{
    dynamics::{Capsule, SweptCapsule},
    setting::{SettingError, require},
    wind::WindClock,
};
use bevy::prelude::*;

/// Pushes grass, shrubs and low branches out of the way of this entity: a walker, a ball, a wheel. What it leaves swings back.
///
/// Branches are bent so far that they lie beside the body, but not farther than its force bends them. A pusher with a value out of range
/// pushes nothing, and is told of once.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(Transform)]
pub struct Pusher {
    /// Its shape, about the entity's place. The scale of the entity does not change it.
    pub shape: PusherShape,
    /// The force with which it presses at most, N; 0 to 1,000,000. A walker leans on a branch with 150, a car pushes with 5000.
    pub force_n: f32,
}

/// The shape of a pusher.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
pub enum PusherShape {
    /// A ball.
    Sphere {
        /// m; 0.01 to 20.
        radius_m: f32,
    },
    /// A ball that is moved along the entity's y axis.
    Capsule {
        /// Radius of the ball, m; 0.01 to 20.
        radius_m: f32,
        /// Length of its way, to both sides of the entity together, m; 0 to 50. The capsule is two radii longer.
        length_m: f32,
    },
}

/// A walker who stands on the entity's place plus 0.9 m.
impl Default for Pusher {
    fn default() -> Self {
        Self { shape: PusherShape::Capsule { radius_m: 0.3, length_m: 1.2 }, force_n: 150.0 }
    }
}

impl Pusher {
    /// A ball that presses with a walker's force.
    pub fn sphere(radius_m: f32) -> Self {
        Self { shape: PusherShape::Sphere { radius_m }, ..Self::default() }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        let (PusherShape::Sphere { radius_m } | PusherShape::Capsule { radius_m, .. }) = self.shape;
        require("shape.radius_m", radius_m, 0.01..=20.0)?;
        if let PusherShape::Capsule { length_m, .. } = self.shape {
            require("shape.length_m", length_m, 0.0..=50.0)?;
        }
        require("force_n", self.force_n, 0.0..=1e6)
    }

    fn capsule(&self, at: &Transform) -> Capsule {
        match self.shape {
            PusherShape::Sphere { radius_m } => Capsule { ends: [at.translation; 2], radius_m },
            PusherShape::Capsule { radius_m, length_m } => {
                let half = at.rotation * Vec3::Y * (0.5 * length_m);
                Capsule { ends: [at.translation - half, at.translation + half], radius_m }
            }
        }
    }
}

/// The bodies that push in this frame, in the world, in a fixed order.
#[derive(Resource, Default)]
pub struct Pushers {
    now: Vec<PushingBody>,
    before: Vec<PushingBody>,
    trail: Vec<SweptCapsule>,
    trail_before: Vec<SweptCapsule>,
}

/// A body that pushes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PushingBody {
    pub capsule: Capsule,
    pub force_n: f32,
}

impl Pushers {
    /// Those of now.
    pub(crate) fn now(&self) -> &[PushingBody] {
        &self.now
    }

    /// Those of one frame ago.
    #[cfg(feature = "render")]
    pub(crate) fn before(&self) -> &[PushingBody] {
        &self.before
    }

    /// Where they were in the last moments, up to where they are.
    #[cfg(feature = "render")]
    pub(crate) fn trail(&self) -> &[SweptCapsule] {
        &self.trail
    }

    /// The same one frame ago.
    #[cfg(feature = "render")]
    pub(crate) fn trail_before(&self) -> &[SweptCapsule] {
        &self.trail_before
    }
}

/// Finds out where the pushers are.
pub(in crate::sway) fn gather_pushers(
    mut refused: Local<Vec<Entity>>,
    (mut pushing, mut trails): (Local<Vec<(Entity, PushingBody)>>, Local<Trails>),
    clock: Res<WindClock>,
    mut bodies: ResMut<Pushers>,
    pushers: Query<(Entity, Ref<Pusher>, &Transform, Option<&GlobalTransform>, Has<ChildOf>)>,
) {
    let bodies = bodies.bypass_change_detection();
    std::mem::swap(&mut bodies.now, &mut bodies.before);
    std::mem::swap(&mut bodies.trail, &mut bodies.trail_before);
    bodies.now.clear();
    for (entity, pusher, transform, global, is_child) in &pushers {
        if pusher.is_changed() {
            refused.retain(|other| *other != entity);
        }
        if let Err(error) = pusher.validate() {
            if !refused.contains(&entity) {
                warn!("pusher {entity}: {error}; it pushes nothing");
                refused.push(entity);
            }
            continue;
        }
        let at = match (is_child, global) {
            (true, Some(global)) => global.compute_transform(),
            _ => *transform,
        };
        if at.translation.is_finite() && at.rotation.is_finite() {
            pushing.push((entity, PushingBody { capsule: pusher.capsule(&at), force_n: pusher.force_n }));
        }
    }
    pushing.sort_unstable_by_key(|(entity, _)| *entity);
    let frame_s = (clock.time_s - clock.previous_s) as f32;
    trails.follow(pushing.iter().map(|(entity, body)| (*entity, body.capsule)), frame_s, &mut bodies.trail);
    bodies.now.extend(pushing.drain(..).map(|(_, body)| body));
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::ecs::system::RunSystemOnce;

    #[test]
    fn bodies_are_where_their_entities_are_and_odd_ones_are_left_out() {
        let mut world = World::new();
        world.init_resource::<Pushers>();
        world.init_resource::<WindClock>();
        let lying =
            Transform::from_xyz(1.0, 2.0, 3.0).with_rotation(Quat::from_rotation_z(-std::f32::consts::FRAC_PI_2));
        world.spawn((Pusher::default(), lying));
        world.spawn((Pusher::sphere(f32::NAN), Transform::default()));
        world.spawn((Pusher::sphere(0.5), Transform::from_xyz(f32::NAN, 0.0, 0.0)));
        world.run_system_once(gather_pushers).expect("it runs");
        let [body] = world.resource::<Pushers>().now() else { panic!("there is one") };
        let [a, b] = body.capsule.ends;
        assert!(a.distance(Vec3::new(0.4, 2.0, 3.0)) < 1e-6 && b.distance(Vec3::new(1.6, 2.0, 3.0)) < 1e-6);
        let error = Pusher { force_n: -1.0, ..Pusher::default() }.validate().unwrap_err();
        assert_eq!(error.to_string(), "`force_n` is -1, but must be 0 to 1000000");
    }
}
