//! Components for all cameras.

use bevy::{ecs::lifecycle::Add, prelude::*};

/// Gives components to every camera that is there or comes.
pub fn give(world: &mut World, components: impl Bundle + Clone) {
    let cameras: Vec<Entity> = world.query_filtered::<Entity, With<Camera3d>>().iter(world).collect();
    for camera in cameras {
        world.entity_mut(camera).insert(components.clone());
    }
    world.add_observer(move |camera: On<Add<Camera3d>>, mut commands: Commands| {
        commands.entity(camera.entity).insert(components.clone());
    });
}
