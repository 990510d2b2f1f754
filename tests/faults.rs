//! What goes wrong while a game runs: a worker that panics, a species that is deleted, plans and folders of any size. It is told, the last
//! good thing stays, and the app goes on. `tests/faults_drawn.rs` has the faults of what is drawn.

#[path = "support/server.rs"]
mod server;
#[path = "faults/sizes.rs"]
mod sizes;
#[path = "faults/species.rs"]
mod species;
#[path = "faults/workers.rs"]
mod workers;

use bevy::{ecs::system::SystemState, prelude::*};
use bevy_windwood::{
    forest::ForestCells,
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use std::time::Duration;

/// Updates until `is_so`, for some minutes at most.
fn wait(app: &mut App, what: &str, mut is_so: impl FnMut(&mut World) -> bool) {
    for _ in 0..60_000 {
        app.update();
        if is_so(app.world_mut()) {
            return;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    panic!("{what} did not come about");
}

/// A square of young birches with its middle at the origin.
fn birches(side_m: f32, density_per_ha: f32) -> ForestPlan {
    let half_m = 0.5 * side_m;
    let stock = Stock { species: "birch".into(), age_years: 2.0, age_spread_years: 0.0, ..default() };
    let shape = Shape::Rectangle { min_m: [-half_m; 2], max_m: [half_m; 2] };
    let area = Area { shape, density_per_ha, stock: vec![stock], ..default() };
    ForestPlan { seed: 3, cell_m: 32.0, areas: vec![area], ..default() }
}

fn spawn_forest(app: &mut App, plan: ForestPlan, [trees_to_m, far_to_m]: [f32; 2]) -> Entity {
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan);
    let settings = ForestSettings { trees_to_m, far_to_m, trees_per_frame: 10_000, cells_at_once: 64, ..default() };
    app.world_mut().spawn((Forest::new(plan), settings)).id()
}

/// Waits until all stands that is wanted.
fn settle(app: &mut App, forest: Entity) {
    (0..3).for_each(|_| app.update());
    wait(app, "the forest", |world| {
        let cells = world.get::<ForestCells>(forest);
        cells.is_some_and(|cells| cells.is_complete() && cells.is_planted() && cells.is_up_to_date())
    });
}

/// Places of the trees that stand as entities.
fn places(app: &mut App) -> Vec<Vec3> {
    let world = app.world_mut();
    world.query_filtered::<&Transform, With<StemId>>().iter(world).map(|at| at.translation).collect()
}

/// What a game does with its forests.
fn edit<T>(app: &mut App, edit: impl FnOnce(&mut ForestEditor) -> T) -> T {
    let mut state = SystemState::<ForestEditor>::new(app.world_mut());
    edit(&mut state.get_mut(app.world_mut()).expect("an editor"))
}
