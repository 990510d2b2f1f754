//! Shows the species as it is edited: the asset is changed, and trees are grown anew in the background.

use super::{
    turntable::{StageTree, with_variants},
    workbench::Workbench,
};
use crate::{
    editor::file_session::FileSession,
    render::{TreeMeshOf, TreeMeshes},
    tree::{Grown, Species, SpeciesModels, TreeModel},
};
use bevy::prelude::*;
use std::time::Instant;

/// What was last given to the assets.
#[derive(Resource, Default)]
pub(super) struct Applied {
    shown: Option<Species>,
    saved: Option<Species>,
    /// Since when a change is on its way to the picture.
    since: Option<Instant>,
    /// Whether the asset is not yet what it is to be.
    is_behind: bool,
    /// The species of the picture: what a cancelled change goes back to.
    good: Option<Species>,
}

/// Gives the assets the species, once no other is being grown: one that is dragged through many values is grown as often as it can
/// be, and the last value in any case.
pub(super) fn apply_species(
    mut workbench: ResMut<Workbench>,
    mut applied: ResMut<Applied>,
    mut assets: ResMut<Assets<Species>>,
    server: Res<AssetServer>,
    models: Res<SpeciesModels>,
) {
    let workbench = workbench.bypass_change_detection();
    choose_assets(workbench, &assets, &server);
    if std::mem::take(&mut workbench.is_cancelled)
        && let Some(good) = applied.good.clone()
    {
        workbench.change(good, "Cancel");
    }
    let variants = if workbench.has_turntable { workbench.stage.variants() } else { workbench.species().variants };
    let wanted = with_variants(workbench.species(), variants);
    if applied.shown.as_ref() != Some(&wanted) {
        applied.since.get_or_insert_with(Instant::now);
        if !models.is_baking() && wanted.validate().is_ok() {
            set(&mut assets, &workbench.shown, wanted.clone());
            applied.shown = Some(wanted);
        }
    }
    applied.is_behind = applied.shown.as_ref() != Some(&with_variants(workbench.species(), variants));
    let saved = with_variants(workbench.session.saved(), variants);
    if workbench.stage.compares && applied.saved.as_ref() != Some(&saved) {
        set(&mut assets, &workbench.saved, saved.clone());
        applied.saved = Some(saved);
    }
}

/// Whether there is anything to show: nothing is compared while the workbench is closed and its last change is shown.
pub(super) fn has_species_to_show(workbench: Res<Workbench>, applied: Res<Applied>) -> bool {
    workbench.is_open || (applied.is_behind && workbench.species().validate().is_ok())
}

fn set(assets: &mut Assets<Species>, handle: &Handle<Species>, species: Species) {
    if let Err(error) = assets.insert(handle, species) {
        warn!("workbench: the species cannot be shown: {error}");
    }
}

/// In a game, the asset of the game that was loaded from the file; else two of our own.
fn choose_assets(workbench: &mut Workbench, assets: &Assets<Species>, server: &AssetServer) {
    if workbench.saved == Handle::default() {
        workbench.saved = assets.reserve_handle();
    }
    if workbench.has_turntable {
        if workbench.shown == Handle::default() {
            workbench.shown = assets.reserve_handle();
        }
        return;
    }
    let name = workbench.session.path().file_name();
    let is_of_file = |id: &AssetId<Species>| {
        server.get_path(*id).is_some_and(|path| path.path().file_name() == name && name.is_some())
    };
    if workbench.shown == Handle::default() || !is_of_file(&workbench.shown.id()) {
        let loaded = assets.ids().find(is_of_file).and_then(|id| server.get_id_handle(id));
        workbench.shown = loaded.unwrap_or_else(|| assets.reserve_handle());
    }
}

/// Notes what the tree of the picture is like, and how long it took.
pub(super) fn note_tree(
    mut workbench: ResMut<Workbench>,
    mut applied: ResMut<Applied>,
    models: Res<Assets<TreeModel>>,
    baked: Res<SpeciesModels>,
    trees: Query<(&StageTree, Option<&Grown>, Option<&TreeMeshes>)>,
    meshes: Query<Ref<Mesh3d>, With<TreeMeshOf>>,
) {
    let workbench = workbench.bypass_change_detection();
    let edited = || trees.iter().filter(|(staged, ..)| !staged.stand.is_saved);
    let has_new = |of: &TreeMeshes| of.iter().any(|mesh| meshes.get(mesh).is_ok_and(|mesh| mesh.is_changed()));
    let is_new = edited().any(|(_, _, of)| of.is_some_and(has_new));
    let variants = if workbench.has_turntable { workbench.stage.variants() } else { workbench.species().variants };
    let is_applied = applied.shown.as_ref() == Some(&with_variants(workbench.species(), variants));
    if is_new
        && is_applied
        && let Some(since) = applied.since.take()
    {
        workbench.tree.grown_in_ms = Some(1e3 * since.elapsed().as_secs_f64());
        applied.good = Some(workbench.species().clone());
    }
    workbench.tree.is_growing = baked.is_baking()
        || (applied.since.is_some() && workbench.has_turntable && workbench.species().validate().is_ok())
        || edited().any(|(_, _, of)| of.is_none());
    let model = edited().find_map(|(_, grown, _)| models.get(&grown?.model));
    if let Some(model) = model {
        workbench.tree.height_m = model.height_m();
        workbench.tree.beams = model.beams.len();
        workbench.tree.triangles = (model.wood.indices.len() + model.leaves.indices.len()) / 3;
    }
}

#[cfg(test)]
mod tests;
