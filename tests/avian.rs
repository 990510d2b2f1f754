//! Trees as static bodies of `avian3d`.

use avian3d::prelude::*;
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{
    query::{TreeAvianPlugin, TreeColliders},
    tree::body::TreeCapsule,
};
use std::time::Duration;

/// A ball is thrown at a trunk: it does not come through while there is one.
#[test]
fn a_ball_is_stopped_by_a_trunk() {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        TransformPlugin,
        AssetPlugin::default(),
        PhysicsPlugins::default(),
        TreeAvianPlugin,
    ));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(1.0 / 60.0)));
    app.finish();
    app.cleanup();
    let trunk = TreeCapsule { a: Vec3::ZERO, b: Vec3::Y * 4.0, radius_m: 0.3, beam: 0 };
    let colliders = TreeColliders { capsules: vec![trunk] };
    let tree = app.world_mut().spawn((colliders, Transform::from_xyz(5.0, 0.0, 0.0))).id();
    let throw = |app: &mut App| {
        let ball = (RigidBody::Dynamic, Collider::sphere(0.2), LinearVelocity(Vec3::X * 6.0), GravityScale(0.0));
        let ball = app.world_mut().spawn((ball, Transform::from_xyz(0.0, 2.0, 0.0))).id();
        (0..120).for_each(|_| app.update());
        let x_m = app.world().get::<Transform>(ball).expect("it is there").translation.x;
        // Else it would be in the way of the next.
        app.world_mut().despawn(ball);
        x_m
    };
    let x_m = throw(&mut app);
    assert!(x_m < 4.6, "the trunk stops the ball, which is at {x_m} m");
    app.world_mut().entity_mut(tree).remove::<TreeColliders>();
    assert!(app.world().get::<Collider>(tree).is_none());
    let x_m = throw(&mut app);
    assert!(x_m > 10.0, "nothing stops the ball, which is at {x_m} m");
}
