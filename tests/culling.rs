//! Frustum culling of cells changes no picture. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::{light::CascadeShadowConfigBuilder, prelude::*};
use bevy_windwood::{
    forest::{ForestCell, ForestCulling},
    prelude::*,
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use support::forest::TestForest;

fn hidden_cells(forest: &mut TestForest) -> usize {
    let world = forest.app.world_mut();
    let mut cells = world.query_filtered::<&Visibility, With<ForestCell>>();
    cells.iter(world).filter(|visibility| **visibility == Visibility::Hidden).count()
}

#[test]
fn pictures_are_equal_with_and_without_culling() {
    let settings = ForestSettings { trees_to_m: 300.0, far_to_m: 0.0, ..default() };
    let mut forest = TestForest::new(settings, None);
    let world = forest.app.world_mut();
    let ground = world.resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(900.0, 900.0));
    let white = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial::from(Color::WHITE));
    world.spawn((Mesh3d(ground), MeshMaterial3d(white)));
    let cascades = CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: 120.0, ..default() }.build();
    let sun = DirectionalLight { illuminance: 8000.0, shadow_maps_enabled: true, ..default() };
    // Low, so that shadows are long.
    world.spawn((sun, cascades, Transform::default().looking_to(Vec3::new(0.3, -0.35, 0.9), Vec3::Y)));

    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    let mut hidden = 0;
    for view in 0..5 {
        let mut place = || random.random_range(-120.0..120.0_f32);
        let eye = Vec3::new(place(), 8.0, place());
        let towards = Vec3::new(place(), -12.0, place());
        forest.look(eye, towards);
        forest.app.world_mut().insert_resource(ForestCulling { around_m: 0.0, lingering_frames: 0, ..default() });
        let culled = forest.picture();
        hidden += hidden_cells(&mut forest);
        forest.app.world_mut().insert_resource(ForestCulling { enabled: false, ..default() });
        let all = forest.picture();
        assert_eq!(hidden_cells(&mut forest), 0);
        let differing = culled.pixels().zip(all.pixels()).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "pixels of view {view}, from {eye} towards {towards}");
    }
    assert!(hidden > 200, "{hidden} cells were hidden");
}
