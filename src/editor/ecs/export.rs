//! Exports the tree that is edited, in the background.

use super::{turntable::StageTree, workbench::Workbench};
use crate::{
    background::{Work, spawn_work},
    editor::file_session::Message,
    export::{ExportError, ExportSettings, ExportedTree, tree_glb, write_atomically},
    sway::{ActiveSway, WindResponse},
    tree::{Grown, Season, Species, Tree, TreeModel, textures::species_textures},
};
use bevy::{
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

/// An export that is under way.
#[derive(Resource, Default)]
pub(super) struct Exporting {
    work: Option<Work<Result<Option<usize>, ExportError>>>,
    path: PathBuf,
    is_cancelled: Arc<AtomicBool>,
}

/// What is exported.
struct Subject {
    species: Species,
    /// As it was grown; none where nothing stands on a turntable.
    model: Option<TreeModel>,
    age_years: f32,
    seed: u64,
    year: f32,
    wind: Option<Arc<WindResponse>>,
}

impl Subject {
    /// Writes the file. Returns its length, bytes; none where it was cancelled: then nothing is written.
    fn write(self, path: &Path, is_cancelled: &AtomicBool) -> Result<Option<usize>, ExportError> {
        let Self { species, model, age_years, seed, year, wind } = self;
        let textures = species_textures(&species);
        let model = model.unwrap_or_else(|| TreeModel::bake(&species, age_years, seed));
        let tree = ExportedTree { species: &species, textures: &textures, model: &model, age_years, seed };
        let glb = tree_glb(&tree, &ExportSettings { year, ..ExportSettings::default() }, wind.as_deref())?;
        if is_cancelled.load(Ordering::Relaxed) {
            return Ok(None);
        }
        write_atomically(path, &glb)?;
        Ok(Some(glb.len()))
    }
}

/// Begins what was asked for, and tells what became of it.
pub(super) fn export_tree(
    mut workbench: ResMut<Workbench>,
    mut exporting: ResMut<Exporting>,
    season: Res<Season>,
    sway: Res<ActiveSway>,
    models: Res<Assets<TreeModel>>,
    trees: Query<(&StageTree, &Tree, &Grown)>,
) {
    let workbench = workbench.bypass_change_detection();
    if std::mem::take(&mut workbench.is_export_cancelled) {
        exporting.is_cancelled.store(true, Ordering::Relaxed);
    }
    if let Some(work) = &mut exporting.work {
        let Some(done) = block_on(poll_once(work)) else { return };
        exporting.work = None;
        workbench.is_exporting = false;
        let path = exporting.path.display();
        workbench.session.message = Some(match done {
            Ok(Ok(Some(bytes))) => Message::Done(format!("Exported {path}, {:.1} MB", bytes as f64 / 1e6)),
            Ok(Ok(None)) => Message::Done("The export was cancelled".into()),
            Ok(Err(error)) => Message::Failed(error.to_string()),
            Err(panic) => Message::Failed(panic.to_string()),
        });
    }
    let Some(path) = workbench.export_to.take() else { return };
    let species = workbench.species().clone();
    let age_years = workbench.stage.age_share * species.age.mature_years;
    let edited = trees.iter().find(|(staged, ..)| !staged.stand.is_saved);
    let subject = Subject {
        model: edited.and_then(|(.., grown)| models.get(&grown.model).cloned()),
        seed: edited.and_then(|(_, tree, _)| tree.seed).unwrap_or_default(),
        species,
        age_years,
        year: season.wrapped(),
        wind: sway.slots().into_iter().flatten().last().cloned(),
    };
    let is_cancelled = Arc::new(AtomicBool::new(false));
    (exporting.path, exporting.is_cancelled) = (path.clone(), is_cancelled.clone());
    workbench.is_exporting = true;
    exporting.work = Some(spawn_work(move || subject.write(&path, &is_cancelled)));
}

#[cfg(test)]
mod tests;
