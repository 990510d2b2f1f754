//! Forgets all impostors when they lay on a graphics device that was lost. Their atlases are baked again, and their tiles made again.

use super::{
    species::ImpostorSpeciesLibrary,
    tiles::{ForestImpostors, ImpostorTile},
};
use crate::render::{impostors::near_mask::NearMasks, new_device::remove_lost_mesh};
use bevy::prelude::*;

pub(super) fn forget_impostors(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut library: ResMut<ImpostorSpeciesLibrary>,
    mut masks: ResMut<NearMasks>,
    forests: Query<Entity, With<ForestImpostors>>,
    tiles: Query<(Entity, &Mesh3d), With<ImpostorTile>>,
) {
    for (tile, mesh) in &tiles {
        remove_lost_mesh(mesh, &mut meshes);
        commands.entity(tile).despawn();
    }
    for forest in &forests {
        commands.entity(forest).remove::<ForestImpostors>();
    }
    library.forget_all();
    masks.forget_buffer();
}
