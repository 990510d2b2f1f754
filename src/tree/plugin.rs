//! Registers trees: the species asset, the baked models, the components.

use super::{
    components::{Articulated, Beam, Leaf, Tree},
    ecs::{
        grow_trees::{grow_trees, is_time_to_search, regrow_trees},
        missing_species::{MissingSpecies, ReportedSpecies, report_missing_species},
        places::{TreePlaces, forget_tree, track_trees},
        season::Season,
        species_models::{SpeciesBaked, SpeciesModels, store_baked_models, update_species},
    },
    model::TreeModel,
    species::Species,
};
use crate::{
    plugin_checks::require_assets,
    ron_loader::RonLoader,
    schedule::{WindwoodSystems, configure_sets},
    timing::timed,
};
use bevy::prelude::*;

/// Loads and bakes species and gives [`Tree`] entities their models. Trees do not move and are not rendered by it.
pub struct TreePlugin;

impl Plugin for TreePlugin {
    fn build(&self, app: &mut App) {
        require_assets::<Self>(app);
        configure_sets(app);
        app.init_asset::<Species>()
            .init_asset::<TreeModel>()
            .init_asset_loader::<RonLoader<Species>>()
            .register_asset_reflect::<Species>()
            .register_type::<Tree>()
            .register_type::<Articulated>()
            .register_type::<Beam>()
            .register_type::<Leaf>()
            .register_type::<Season>()
            .init_resource::<Season>()
            .init_resource::<SpeciesModels>()
            .init_resource::<ReportedSpecies>()
            .init_resource::<TreePlaces>()
            .add_message::<SpeciesBaked>()
            .add_message::<MissingSpecies>()
            .add_observer(forget_tree);
        let grow = timed!(app, update_species, store_baked_models, grow_trees, report_missing_species);
        let regrow = timed!(app, regrow_trees).run_if(is_time_to_search);
        let track = timed!(app, track_trees);
        app.add_systems(Update, (grow.chain(), regrow).chain().in_set(WindwoodSystems::Bake))
            .add_systems(PostUpdate, track.in_set(WindwoodSystems::Query));
    }
}
