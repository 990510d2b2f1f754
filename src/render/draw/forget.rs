//! Forgets what was prepared of all species, when it lay on a graphics device that was lost. They are prepared again, and trees are drawn
//! as new ones.

use super::removal::remove_all_drawn;
use crate::{
    render::{
        instances::components::TreeInstance,
        new_device::remove_lost_mesh,
        species::{
            library::{SpeciesLibrary, VariantRemoved},
            load_parts::PartLoads,
            prepare::PreparationQueue,
        },
    },
    tree::SpeciesModels,
};
use bevy::prelude::*;

pub(crate) fn forget_prepared_species(
    mut commands: Commands,
    species_models: Res<SpeciesModels>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut library: ResMut<SpeciesLibrary>,
    mut queue: ResMut<PreparationQueue>,
    mut loads: ResMut<PartLoads>,
    mut removed: MessageWriter<VariantRemoved>,
    drawn: Query<Entity, With<TreeInstance>>,
) {
    for (model, variant) in library.take_all() {
        variant.meshes().for_each(|mesh| remove_lost_mesh(mesh, &mut meshes));
        removed.write(VariantRemoved(model));
    }
    *loads = PartLoads::default();
    queue.start_again(&species_models);
    for tree in &drawn {
        commands.entity(tree).queue_silenced(remove_all_drawn);
    }
}
