//! Registers forests.

use super::{
    apply_changes::apply_changes,
    begin::begin_forests,
    cells::{ForestCells, plant_cells},
    changes::ForestChanges,
    components::{Forest, ForestCell, ForestSettings},
    falling::{FallenTree, FallingTree, Stump, advance_falls, begin_falls},
    give_canopies::give_canopies,
    messages::{TreeEntered, TreeFelled, TreeLeft},
    missing_species::{MissingPlanSpecies, report_missing_plan_species},
    near_services::{articulate_near_trees, spawn_wind_cells},
    renew_stands::renew_stands,
    share_stands::share_stands,
    stand_species::{StandSpeciesLibrary, prepare_stands},
    stem_id::StemId,
    stream_trees::stream_trees,
};
use crate::{
    plugin_checks::{require_assets, require_plugin},
    removal::remove_made,
    ron_loader::RonLoader,
    scatter::ForestPlan,
    schedule::{WindwoodSystems, configure_sets},
    timing::timed,
    tree::TreePlugin,
    viewpoint::give_cameras_viewpoints,
};
use bevy::prelude::*;

/// Forests that grow from plans, with or without drawing. Needs [`TreePlugin`].
pub struct ForestPlugin;

impl Plugin for ForestPlugin {
    fn build(&self, app: &mut App) {
        require_assets::<Self>(app);
        require_plugin::<Self, TreePlugin>(app);
        configure_sets(app);
        give_cameras_viewpoints(app);
        app.init_asset::<ForestPlan>()
            .init_asset_loader::<RonLoader<ForestPlan>>()
            .register_asset_reflect::<ForestPlan>()
            .init_resource::<StandSpeciesLibrary>()
            .add_message::<MissingPlanSpecies>()
            .add_message::<TreeEntered>()
            .add_message::<TreeLeft>()
            .add_message::<TreeFelled>()
            .register_type::<Forest>()
            .register_type::<ForestSettings>()
            .register_type::<ForestChanges>()
            .register_type::<StemId>()
            .register_type::<FallingTree>()
            .register_type::<FallenTree>()
            .register_type::<Stump>()
            .add_observer(remove_made::<Forest, ForestCell, ForestCells>);
        let stream = timed!(
            app,
            begin_falls,
            advance_falls,
            begin_forests,
            report_missing_plan_species,
            prepare_stands,
            apply_changes,
            renew_stands,
            share_stands,
            plant_cells,
            stream_trees,
            give_canopies,
            spawn_wind_cells,
            articulate_near_trees
        );
        app.add_systems(Update, stream.chain().in_set(WindwoodSystems::Stream));
    }
}
