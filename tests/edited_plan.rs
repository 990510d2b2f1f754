//! An edited plan changes the impostors of those tiles whose plants it changes, and no others. So do changes of single stems. Needs a Vulkan driver. Mesa's software one
//! will do.

mod support;

use bevy::prelude::*;
use bevy_windwood::{
    forest::{ForestCell, ForestCells, ForestImpostors},
    prelude::*,
    scatter::{ForestPlan, plan::Shape},
};
use std::collections::BTreeMap;
use support::{capture, forest::TestForest};

/// The meshes of impostors: entity, mesh, and where its tile begins.
fn tiles(forest: &mut TestForest) -> BTreeMap<Entity, (AssetId<Mesh>, Vec3)> {
    let world = forest.app.world_mut();
    let root = world.query_filtered::<Entity, With<Forest>>().single(world).expect("one forest");
    let mut meshes = world.query_filtered::<(Entity, &Mesh3d, &Transform, &ChildOf), Without<ForestCell>>();
    let of_forest = meshes.iter(world).filter(|(.., parent)| parent.parent() == root);
    of_forest.map(|(entity, mesh, at, _)| (entity, (mesh.id(), at.translation))).collect()
}

fn impostors(forest: &mut TestForest) -> usize {
    let world = forest.app.world_mut();
    world.query::<&ForestImpostors>().iter(world).map(ForestImpostors::trees).sum()
}

/// Changes the area of the plan to x from `min_x_m` on, and waits. Returns the fewest impostors on the way.
fn change(forest: &mut TestForest, min_x_m: f32) -> usize {
    let mut plans = forest.app.world_mut().resource_mut::<Assets<ForestPlan>>();
    let id = plans.ids().next().expect("the plan");
    plans.get_mut(id).expect("the plan").areas[0].shape =
        Shape::Rectangle { min_m: [min_x_m, -200.0], max_m: [200.0; 2] };
    let mut fewest = usize::MAX;
    for _ in 0..200 {
        forest.app.update();
        fewest = fewest.min(impostors(forest));
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert!(support::update_until(&mut forest.app, capture::forests_are_drawn));
    fewest
}

#[test]
fn tiles_whose_plants_stay_keep_their_meshes() {
    let mut forest = TestForest::new(ForestSettings { trees_to_m: 40.0, far_to_m: 900.0, ..default() }, None);
    let (before, trees_before) = (tiles(&mut forest), impostors(&mut forest));
    assert!(before.len() >= 9, "{} tiles", before.len());

    // Nothing grows to the west any more. Tiles are 128 m wide: those farther than that from the new border have the plants that they had.
    let fewest = change(&mut forest, 0.0);
    let (after, trees_after) = (tiles(&mut forest), impostors(&mut forest));
    assert!(trees_after > trees_before / 3 && trees_after < trees_before * 2 / 3);
    assert!(fewest as f32 > 0.95 * trees_after as f32, "{fewest} of {trees_after} impostors for a while");
    let kept: Vec<_> = before.iter().filter(|(_, (_, at))| at.x >= 128.0).collect();
    assert!(kept.len() >= 3);
    assert!(kept.iter().all(|(entity, tile)| after.get(*entity) == Some(*tile)), "a tile was made anew");
    assert!(after.values().all(|(_, at)| at.x >= 0.0), "impostors are left in the west");

    // Back again: what stayed stays, the rest comes.
    change(&mut forest, -200.0);
    let again = tiles(&mut forest);
    assert_eq!((again.len(), impostors(&mut forest)), (before.len(), trees_before));
    assert!(kept.iter().all(|(entity, tile)| again.get(*entity) == Some(*tile)), "a tile was made anew");
}

/// Updates until all changes are drawn.
fn draw_changes(forest: &mut TestForest) {
    assert!(support::update_until(&mut forest.app, |world| {
        let is_up_to_date = world.query::<&ForestCells>().iter(world).all(ForestCells::is_up_to_date);
        is_up_to_date && capture::forests_are_drawn(world)
    }));
}

#[test]
fn felled_and_planted_stems_change_the_impostors_of_their_tiles_alone() {
    let mut forest = TestForest::new(ForestSettings { trees_to_m: 40.0, far_to_m: 900.0, ..default() }, None);
    let (before, trees_before) = (tiles(&mut forest), impostors(&mut forest));
    let world = forest.app.world_mut();
    let (cells, mut changes) =
        world.query::<(&ForestCells, &mut ForestChanges)>().single_mut(world).expect("one forest");
    let [far, near] = [Vec2::new(150.0, 150.0), Vec2::new(5.0, 5.0)]
        .map(|place_m| cells.nearest_stem(place_m, 50.0).expect("a stem").id);
    changes.fell(far).expect("it stands");
    draw_changes(&mut forest);
    assert_eq!(impostors(&mut forest), trees_before - 1);
    let after = tiles(&mut forest);
    let kept = before.iter().filter(|(entity, tile)| after.get(*entity) == Some(*tile)).count();
    assert_eq!((kept, after.len()), (before.len() - 1, before.len()), "one tile was made anew");

    let world = forest.app.world_mut();
    let mut changes = world.query::<&mut ForestChanges>().single_mut(world).expect("one forest");
    changes.fell(near).expect("it stands");
    for x in [-150.0, -149.0] {
        let stem = NewStem { place_m: Vec2::new(x, 150.0), species: "fir".into(), age_years: 60.0 };
        changes.plant(&stem).expect("it can be planted");
    }
    draw_changes(&mut forest);
    assert_eq!(impostors(&mut forest), trees_before);
}
