//! Registers trees: the species asset and its loader, the baked models, the components.

use super::{
    components::{Articulated, Beam, Leaf, Tree},
    grove::{Grove, SpeciesBaked, adopt_species, receive_models},
    grow::{grow_trees, is_time_to_look, regrow_trees},
    loader::SpeciesLoader,
    model::TreeModel,
    season::Season,
    species::Species,
};
use crate::{schedule::WindwoodSystems, timing::timed};
use bevy::prelude::*;

/// Trees without drawing and without motion: loads and bakes species, gives [`Tree`] entities their models.
pub struct TreePlugin;

impl Plugin for TreePlugin {
    fn build(&self, app: &mut App) {
        app.init_asset::<Species>()
            .init_asset::<TreeModel>()
            .init_asset_loader::<SpeciesLoader>()
            .register_asset_reflect::<Species>()
            .register_type::<Tree>()
            .register_type::<Articulated>()
            .register_type::<Beam>()
            .register_type::<Leaf>()
            .register_type::<Season>()
            .init_resource::<Season>()
            .init_resource::<Grove>()
            .add_message::<SpeciesBaked>();
        let grow = timed!(app, adopt_species, receive_models, grow_trees);
        let regrow = timed!(app, regrow_trees).run_if(is_time_to_look);
        app.add_systems(Update, (grow.chain(), regrow).chain().in_set(WindwoodSystems::Grow));
    }
}
