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

/// Species that were reported as missing, and have not been loaded since. Whoever reports one for others puts it in.
#[derive(Resource, Default, Deref, DerefMut)]
pub(crate) struct ReportedSpecies(HashSet<AssetId<Species>>);

/// Logs an error for a species that cannot be loaded, with the first tree that waits for it. It is logged once, and again
/// after the species was loaded and lost.
pub(in crate::tree) fn report_missing_species(
    server: Res<AssetServer>,
    mut failures: MessageReader<AssetLoadFailedEvent<Species>>,
    mut assets: MessageReader<AssetEvent<Species>>,
    waiting: Query<(Entity, &Tree), Without<Grown>>,
    changed: Query<(Entity, &Tree), (Changed<Tree>, Without<Grown>)>,
    mut reported: ResMut<ReportedSpecies>,
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
    use crate::tree::ecs::test_app::{app, wait};

    /// Takes the reports of the last frames.
    fn reports(world: &mut World) -> Vec<MissingSpecies> {
        world.resource_mut::<Messages<MissingSpecies>>().drain().collect()
    }

    #[test]
    fn a_missing_file_is_reported_once_with_its_tree_and_path() {
        let mut app = app();
        let species: Handle<Species> = app.world().resource::<AssetServer>().load("species/no_such.species.ron");
        let tree = app.world_mut().spawn(Tree::new(species.clone())).id();
        let mut all = Vec::new();
        wait(&mut app, |world| {
            all.extend(reports(world));
            !all.is_empty()
        });
        // Trees that come later wait for the same species.
        app.world_mut().spawn(Tree::new(species));
        let mut frames = 0;
        wait(&mut app, |world| {
            all.extend(reports(world));
            frames += 1;
            frames == 20
        });
        assert_eq!(all.len(), 1, "{all:?}");
        let message = all[0].to_string();
        assert!(message.contains(&tree.to_string()) && message.contains("species/no_such.species.ron"), "{message}");
    }

    #[test]
    fn a_tree_that_is_spawned_after_the_failure_is_reported() {
        let mut app = app();
        let species: Handle<Species> = app.world().resource::<AssetServer>().load("species/no_such.species.ron");
        let has_failed = wait(&mut app, |world| {
            let state = world.resource::<AssetServer>().get_load_state(&species);
            matches!(state, Some(LoadState::Failed(_)))
        });
        assert!(has_failed);
        (0..3).for_each(|_| app.update());
        let tree = app.world_mut().spawn(Tree::new(species.clone())).id();
        app.update();
        assert_eq!(reports(app.world_mut()).iter().map(|report| report.tree).collect::<Vec<_>>(), [tree]);
    }
}
