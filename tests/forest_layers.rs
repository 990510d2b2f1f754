//! The render layers of a forest are those of its trees and of its impostors. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::{camera::visibility::RenderLayers, prelude::*};
use bevy_windwood::{forest::ForestImpostors, prelude::*};
use support::{capture, forest::TestForest};

/// Asserts that there are trees and impostors, all of whose meshes have these layers. Returns the number of trees.
fn assert_layers(forest: &mut TestForest, layers: Option<RenderLayers>) -> usize {
    (0..3).for_each(|_| capture::step(&mut forest.app));
    let world = forest.app.world_mut();
    let impostors: usize = world.query::<&ForestImpostors>().iter(world).map(ForestImpostors::trees).sum();
    assert!(impostors > 100);
    let mut drawn = world.query_filtered::<(Option<&RenderLayers>, Has<TreeMeshes>), Or<(With<Mesh3d>, With<Tree>)>>();
    let (mut trees, mut meshes) = (0, 0);
    for (own, is_tree) in drawn.iter(world) {
        assert_eq!(own, layers.as_ref());
        *if is_tree { &mut trees } else { &mut meshes } += 1;
    }
    assert!(trees > 20 && meshes > trees, "{trees} trees, {meshes} meshes");
    trees
}

#[test]
fn trees_and_impostors_have_the_layers_of_their_forest_from_the_start_and_after_each_change() {
    let mut forest = TestForest::new(ForestSettings { trees_to_m: 80.0, far_to_m: 900.0, ..default() }, None);
    let before = assert_layers(&mut forest, None);
    let world = forest.app.world_mut();
    let entity = world.query_filtered::<Entity, With<Forest>>().single(world).expect("one forest");
    for layers in [RenderLayers::layer(1), RenderLayers::from_layers(&[0, 2])] {
        forest.app.world_mut().entity_mut(entity).insert(layers.clone());
        assert_layers(&mut forest, Some(layers));
    }
    // Trees that come now have them, too.
    forest.look(Vec3::new(-120.0, 12.0, 0.0), Vec3::NEG_Z);
    (0..2).for_each(|_| capture::step(&mut forest.app));
    assert!(support::update_until(&mut forest.app, capture::forests_are_drawn));
    let after = assert_layers(&mut forest, Some(RenderLayers::from_layers(&[0, 2])));
    assert!(before > 0 && after > 0);
    forest.app.world_mut().entity_mut(entity).remove::<RenderLayers>();
    assert_layers(&mut forest, None);
}
