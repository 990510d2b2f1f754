//! Tells which plans ask for a species that cannot be loaded.

use super::cells::ForestCells;
use crate::tree::{ReportedSpecies, Species};
use bevy::{
    asset::{AssetLoadFailedEvent, AssetPath, LoadState},
    platform::collections::HashSet,
    prelude::*,
};
use std::fmt;

/// A forest whose plan has a species that cannot be loaded: nothing of it will grow there.
#[derive(Message, Clone, Debug)]
pub(super) struct MissingPlanSpecies {
    pub forest: Entity,
    pub path: Option<AssetPath<'static>>,
    /// Why it was not loaded.
    pub reason: String,
}

impl fmt::Display for MissingPlanSpecies {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { forest, path, reason } = self;
        match path {
            Some(path) => write!(f, "forest {forest} lacks a species: `{path}` cannot be loaded: {reason}"),
            None => write!(f, "forest {forest} lacks a species: {reason}"),
        }
    }
}

/// Logs an error for each species of a plan that cannot be loaded: once a forest, whether any of its trees is near or not. It is logged
/// again after the species was loaded and lost. No tree has to say it again.
pub(super) fn report_missing_plan_species(
    server: Res<AssetServer>,
    mut failures: MessageReader<AssetLoadFailedEvent<Species>>,
    mut assets: MessageReader<AssetEvent<Species>>,
    forests: Query<(Entity, Ref<ForestCells>)>,
    mut told: Local<HashSet<(Entity, AssetId<Species>)>>,
    mut reported: ResMut<ReportedSpecies>,
    mut missing: MessageWriter<MissingPlanSpecies>,
) {
    for event in assets.read() {
        if let AssetEvent::Added { id } = event {
            told.retain(|(_, of_old)| of_old != id);
        }
    }
    let some_failed = failures.read().count() > 0;
    for (forest, cells) in forests.iter().filter(|(_, cells)| some_failed || cells.is_added()) {
        for species in cells.species() {
            let Some(LoadState::Failed(error)) = server.get_load_state(species) else { continue };
            if told.insert((forest, species.id())) {
                let report = MissingPlanSpecies { forest, path: species.path().cloned(), reason: error.to_string() };
                error!("{report}");
                missing.write(report);
            }
            reported.insert(species.id());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        WindwoodMinimalPlugins,
        forest::Forest,
        scatter::{
            ForestPlan,
            plan::{Area, Stock},
        },
        viewpoint::Viewpoint,
    };

    fn plan() -> ForestPlan {
        let stock = |species: &str| Stock { species: species.into(), ..default() };
        ForestPlan { areas: vec![Area { stock: vec![stock("no_such"), stock("oak")], ..default() }], ..default() }
    }

    fn app() -> (App, Entity) {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins));
        app.finish();
        app.cleanup();
        let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan());
        let forest = app.world_mut().spawn(Forest::new(plan)).id();
        (app, forest)
    }

    /// The reports of some frames.
    fn reports(app: &mut App) -> Vec<MissingPlanSpecies> {
        let mut all = Vec::new();
        for _ in 0..100 {
            app.update();
            all.extend(app.world_mut().resource_mut::<Messages<MissingPlanSpecies>>().drain());
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        all
    }

    #[test]
    fn a_missing_species_of_a_plan_is_reported_once_without_any_tree() {
        let (mut app, forest) = app();
        let told = reports(&mut app);
        assert_eq!(told.len(), 1, "{told:?}");
        let message = told[0].to_string();
        assert!(message.contains(&forest.to_string()) && message.contains("species/no_such.species.ron"), "{message}");
        // Neither an edit of the plan nor a viewer who comes near tells it again.
        let mut plans = app.world_mut().resource_mut::<Assets<ForestPlan>>();
        let id = plans.ids().next().expect("the plan");
        plans.get_mut(id).expect("the plan").areas[0].density_per_ha *= 0.5;
        app.world_mut().spawn((Viewpoint, Transform::default()));
        let told = reports(&mut app);
        assert!(told.is_empty(), "{told:?}");
        let world = app.world_mut();
        assert!(world.query::<&crate::tree::Tree>().iter(world).count() > 0);
    }

    #[test]
    fn each_forest_tells_it() {
        let (mut app, first) = app();
        let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan());
        let second = app.world_mut().spawn(Forest::new(plan)).id();
        let mut forests: Vec<Entity> = reports(&mut app).iter().map(|report| report.forest).collect();
        forests.sort_unstable();
        let mut wanted = vec![first, second];
        wanted.sort_unstable();
        assert_eq!(forests, wanted);
    }
}
