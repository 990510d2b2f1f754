//! Meshes of finer levels are on the GPU while a viewer is near enough to see them. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::{
    mesh::MeshTag,
    prelude::*,
    render::{RenderApp, mesh::RenderMesh, render_asset::RenderAssets},
};
use bevy_windwood::{
    prelude::*,
    render::{TreeMeshOf, TreePart},
};
use std::time::Duration;
use support::{capture, update_until};

/// So far away a fir is drawn at its coarsest level, and so near at its finest, m.
const FAR_M: f32 = 180.0;
const NEAR_M: f32 = 12.0;
/// Meshes are kept for some 500 frames after they were last wanted.
const FRAMES_UNTIL_FREED: usize = 700;

struct Stand {
    app: App,
    viewer: Entity,
    trees: Vec<Entity>,
}

impl Stand {
    /// Firs of one model, 8 m apart, that a viewer sees from afar.
    fn new() -> Self {
        let mut app = support::headless_app(Duration::from_millis(16), None);
        capture::begin(&mut app).expect("a graphics device");
        let species = app.world().resource::<AssetServer>().load("species/fir.species.ron");
        let world = app.world_mut();
        let viewer = world.spawn((Viewpoint, Transform::from_xyz(0.0, 2.0, FAR_M))).id();
        let tree = |number: u8| {
            let place = Transform::from_xyz(8.0 * f32::from(number), 0.0, 0.0);
            world.spawn((Tree::new(species.clone()).with_seed(1), place)).id()
        };
        let trees: Vec<Entity> = (0..5).map(tree).collect();
        let is_drawn = |world: &mut World| trees.iter().all(|tree| world.get::<TreeMeshes>(*tree).is_some());
        assert!(update_until(&mut app, is_drawn), "the trees were not drawn in time");
        Self { app, viewer, trees }
    }

    fn go_to(&mut self, distance_m: f32) {
        let place = Transform::from_xyz(0.0, 2.0, distance_m);
        self.app.world_mut().entity_mut(self.viewer).insert(place);
    }

    /// Levels of the wood that is drawn of a tree, from the finest.
    fn levels(&self, tree: Entity) -> Vec<u32> {
        let world = self.app.world();
        let meshes = world.get::<TreeMeshes>(tree).into_iter().flat_map(TreeMeshes::iter);
        let wood = meshes.filter(|mesh| world.get::<TreePart>(*mesh) == Some(&TreePart::Wood));
        let mut levels: Vec<u32> = wood.filter_map(|mesh| Some(world.get::<MeshTag>(mesh)?.value >> 16 & 3)).collect();
        levels.sort_unstable();
        levels
    }

    /// Vertices of all meshes on the GPU.
    fn vertices(&self) -> u32 {
        let meshes = self.app.sub_app(RenderApp).world().resource::<RenderAssets<RenderMesh>>();
        meshes.iter().map(|(_, mesh)| mesh.vertex_count).sum()
    }

    /// Advances a frame. In each of them each tree is drawn once: a level has one mesh of wood, and where one fades into the next, which
    /// has less of the same wood, that of the finer one stands for both.
    fn step(&mut self) {
        self.app.update();
        for tree in &self.trees {
            assert_eq!(self.levels(*tree).len(), 1, "meshes of wood of {tree}");
            let meshes = self.app.world().get::<TreeMeshes>(*tree).expect("it is drawn");
            let meshes = meshes.iter().filter_map(|mesh| self.app.world().get::<Mesh3d>(mesh));
            let there = self.app.world().resource::<Assets<Mesh>>();
            assert!(meshes.clone().count() >= 2 && meshes.clone().all(|mesh| there.contains(&mesh.0)));
        }
    }
}

#[test]
fn finer_meshes_come_with_the_viewer_and_go_after_a_while() {
    let mut stand = Stand::new();
    // Until a viewer was known, trees may have wanted more.
    (0..FRAMES_UNTIL_FREED).for_each(|_| stand.step());
    let trees = stand.trees.clone();
    assert!(trees.iter().all(|tree| stand.levels(*tree) == [2]), "from afar");
    let coarse = stand.vertices();

    stand.go_to(NEAR_M);
    let has_come = (0..600).any(|_| {
        stand.step();
        std::thread::sleep(Duration::from_millis(2));
        stand.levels(trees[0]) == [0]
    });
    assert!(has_come, "the nearest tree has {:?}", stand.levels(trees[0]));
    let fine = stand.vertices();
    assert!(fine > 2 * coarse, "{fine} vertices, {coarse} from afar");

    stand.go_to(FAR_M);
    (0..60).for_each(|_| stand.step());
    assert!(stand.vertices() == fine, "the viewer may turn round");
    (0..FRAMES_UNTIL_FREED).for_each(|_| stand.step());
    assert_eq!(stand.vertices(), coarse);
    let world = stand.app.world_mut();
    assert_eq!(world.query::<&TreeMeshOf>().iter(world).count(), 2 * trees.len());
}
