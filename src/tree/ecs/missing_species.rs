//! Tells which trees wait for a species that cannot be loaded.

use crate::tree::{
    components::{Grown, Tree},
    species::Species,
};
use bevy::{
    asset::{AssetLoadFailedEvent, AssetPath, LoadState},
    platform::collections::HashSet,
    prelude::*,
};
use std::fmt;

/// A tree whose species cannot be loaded: one a species, however many trees wait for it.
#[derive(Message, Clone, Debug)]
pub(in crate::tree) struct MissingSpecies {
    pub tree: Entity,
    pub path: Option<AssetPath<'static>>,
    /// Why it was not loaded.
    pub reason: String,
}

impl fmt::Display for MissingSpecies {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { tree, path, reason } = self;
        match path {
            Some(path) => write!(f, "tree {tree} has no species: `{path}` cannot be loaded: {reason}"),
            None => write!(f, "tree {tree} has no species: {reason}"),
        }
    }
}

/// Logs an error for a species that cannot be loaded, with the first tree that waits for it. It is logged once, and again
/// after the species was loaded and lost.
pub(in crate::tree) fn report_missing_species(
    server: Res<AssetServer>,
    mut failures: MessageReader<AssetLoadFailedEvent<Species>>,
    mut assets: MessageReader<AssetEvent<Species>>,
    waiting: Query<(Entity, &Tree), Without<Grown>>,
    changed: Query<(Entity, &Tree), (Changed<Tree>, Without<Grown>)>,
    mut reported: Local<HashSet<AssetId<Species>>>,
    mut missing: MessageWriter<MissingSpecies>,
) {
    for event in assets.read() {
        if let AssetEvent::Added { id } = event {
            reported.remove(id);
        }
    }
    let failed: HashSet<AssetId<Species>> = failures.read().map(|failure| failure.id).collect();
    let of_failed = waiting.iter().filter(|(_, tree)| failed.contains(&tree.species.id()));
    // The first frame of a tree is the only one in which its species can have failed before.
    for (entity, tree) in of_failed.chain(&changed) {
        let id = tree.species.id();
        if reported.contains(&id) {
            continue;
        }
        let Some(LoadState::Failed(error)) = server.get_load_state(id) else { continue };
        let path = tree.species.path().cloned();
        let report = MissingSpecies { tree: entity, path, reason: error.to_string() };
        error!("{report}");
        missing.write(report);
        reported.insert(id);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::TreePlugin;

    #[test]
    fn a_missing_file_is_reported_once_with_its_tree_and_path() {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default(), TreePlugin));
        let species: Handle<Species> = app.world().resource::<AssetServer>().load("species/no_such.species.ron");
        let tree = app.world_mut().spawn(Tree::new(species.clone())).id();
        let mut reports = Vec::new();
        let run = |app: &mut App, frames: u32, reports: &mut Vec<MissingSpecies>| {
            for _ in 0..frames {
                app.update();
                reports.extend(app.world_mut().resource_mut::<Messages<MissingSpecies>>().drain());
                std::thread::sleep(std::time::Duration::from_millis(1));
            }
        };
        for _ in 0..10_000 {
            run(&mut app, 1, &mut reports);
            if !reports.is_empty() {
                break;
            }
        }
        // Trees that come later wait for the same species.
        app.world_mut().spawn(Tree::new(species));
        run(&mut app, 20, &mut reports);
        assert_eq!(reports.len(), 1, "{reports:?}");
        let message = reports[0].to_string();
        assert!(message.contains(&tree.to_string()) && message.contains("species/no_such.species.ron"), "{message}");
    }

    #[test]
    fn a_tree_that_is_spawned_after_the_failure_is_reported() {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default(), TreePlugin));
        let species: Handle<Species> = app.world().resource::<AssetServer>().load("species/no_such.species.ron");
        let failed = |app: &App| {
            let state = app.world().resource::<AssetServer>().get_load_state(&species);
            matches!(state, Some(LoadState::Failed(_)))
        };
        for _ in 0..10_000 {
            app.update();
            if failed(&app) {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        assert!(failed(&app));
        (0..3).for_each(|_| app.update());
        let tree = app.world_mut().spawn(Tree::new(species.clone())).id();
        app.update();
        let mut messages = app.world_mut().resource_mut::<Messages<MissingSpecies>>();
        assert_eq!(messages.drain().map(|report| report.tree).collect::<Vec<_>>(), [tree]);
    }
}
