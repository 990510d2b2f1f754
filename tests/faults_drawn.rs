//! What goes wrong with what is drawn: a species that is removed while its trees are drawn, ground that panics, windows of no size, viewports
//! of a pixel, a device with a quarter of the usual memory. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::{
    camera::{RenderTarget, Viewport},
    math::DVec2,
    prelude::*,
    render::render_resource::WgpuLimits,
    window::{PrimaryWindow, WindowResolution},
};
use bevy_windwood::{
    forest::ForestImpostors,
    prelude::*,
    render::{RenderCapabilities, TreeMeshes},
    terrain::TerrainChunks,
};
use std::time::Duration;
use support::{capture, covered, forest::TestForest, headless_app, update_until};

/// Trees near by, impostors farther off.
fn settings() -> ForestSettings {
    ForestSettings { trees_to_m: 80.0, far_to_m: 300.0, ..default() }
}

#[test]
fn a_species_that_is_removed_is_drawn_as_it_was() {
    let mut forest = TestForest::new(settings(), None);
    let before = forest.picture();
    let world = forest.app.world_mut();
    let fir = world.query::<&Tree>().iter(world).next().expect("a tree").species.clone();
    world.resource_mut::<Assets<Species>>().remove(&fir).expect("it is loaded");
    // Other species come meanwhile, and take what room there is.
    let hazel = world.resource::<AssetServer>().load("species/hazel.species.ron");
    let behind = Transform::from_xyz(0.0, 0.0, 60.0);
    let other = world.spawn((Tree::new(hazel).with_age(3.0), behind)).id();
    let is_drawn = update_until(&mut forest.app, |world| world.get::<TreeMeshes>(other).is_some());
    assert!(is_drawn, "the other tree was not drawn in time");
    assert!(covered(&before) > 0.1);
    assert!(forest.picture() == before, "the picture is another");
    // A tree that comes after that is drawn, too.
    let later = forest.app.world_mut().spawn((Tree::new(fir).with_age(60.0), behind)).id();
    let is_drawn = update_until(&mut forest.app, |world| world.get::<TreeMeshes>(later).is_some());
    assert!(is_drawn, "a later tree of the species was not drawn in time");
}

#[test]
fn a_quarter_of_the_memory_draws_the_same_forest() {
    let usual = WgpuLimits::default();
    let quarter = WgpuLimits {
        max_storage_buffer_binding_size: usual.max_storage_buffer_binding_size / 4,
        max_buffer_size: usual.max_buffer_size / 4,
        ..usual.clone()
    };
    let [whole, quarter] = [usual, quarter].map(|limits| {
        let mut forest = TestForest::new(settings(), Some(limits));
        assert!(forest.app.world().resource::<RenderCapabilities>().sways);
        let picture = forest.picture();
        let world = forest.app.world_mut();
        let impostors: usize = world.query::<&ForestImpostors>().iter(world).map(ForestImpostors::trees).sum();
        assert!(impostors > 100, "{impostors} impostors");
        picture
    });
    let differs = whole.pixels().zip(quarter.pixels()).filter(|(a, b)| a != b).count();
    let share = differs as f32 / whole.pixels().len() as f32;
    println!("{share} of the picture is another on a quarter of the memory");
    assert!(covered(&quarter) > 0.1 && (covered(&whole) - covered(&quarter)).abs() < 0.01);
}

/// A picture of one tree in the middle of a camera's own target.
struct OneTree {
    app: App,
    camera: Entity,
    target: Handle<Image>,
}

impl OneTree {
    const SIZE: (u32, u32) = (96, 64);

    fn new() -> Self {
        let mut app = headless_app(Duration::from_millis(16), None);
        capture::begin(&mut app).expect("a graphics device");
        app.insert_resource(ClearColor(support::BACKGROUND));
        let species = app.world().resource::<AssetServer>().load("species/birch.species.ron");
        app.world_mut().spawn((Tree::new(species).with_age(12.0), Transform::default()));
        let target = capture::target(&mut app, Self::SIZE);
        let eye = Transform::from_xyz(0.0, 4.0, 12.0).looking_at(Vec3::Y * 3.0, Vec3::Y);
        let camera = app.world_mut().spawn((capture::camera(&target), eye)).id();
        let is_drawn = update_until(&mut app, |world| {
            let trees = world.query_filtered::<(), With<TreeMeshes>>().iter(world).count();
            trees == 1 && world.resource::<ActiveSway>().is_ready()
        });
        assert!(is_drawn, "the tree was not drawn in time");
        Self { app, camera, target }
    }

    fn covered(&mut self) -> f32 {
        (0..4).for_each(|_| capture::step(&mut self.app));
        covered(&capture::capture(&mut self.app, &self.target, Self::SIZE).expect("a picture"))
    }

    fn step(&mut self) {
        (0..4).for_each(|_| capture::step(&mut self.app));
    }

    fn set_viewport(&mut self, size: Option<UVec2>) {
        let viewport = size.map(|physical_size| Viewport { physical_size, ..default() });
        self.app.world_mut().get_mut::<Camera>(self.camera).expect("a camera").viewport = viewport;
    }
}

#[test]
fn windows_of_no_size_and_viewports_of_a_pixel_draw_nothing_and_come_back() {
    let mut scene = OneTree::new();
    let before = scene.covered();
    assert!(before > 0.03, "{before}");
    // A window that is minimised, as a player does.
    let minimised = WindowResolution::new(0, 0);
    let window = scene.app.world_mut().spawn((Window { resolution: minimised, ..default() }, PrimaryWindow)).id();
    let camera = scene.camera;
    scene.app.world_mut().entity_mut(camera).insert(RenderTarget::default());
    scene.step();
    for size in [(1, 1), (0, 300), (300, 0), (640, 360), (0, 0)] {
        let mut window = scene.app.world_mut().get_mut::<Window>(window).expect("a window");
        window.resolution.set_physical_resolution(size.0, size.1);
        scene.step();
    }
    // Viewports in a picture.
    let target = RenderTarget::Image(scene.target.clone().into());
    scene.app.world_mut().entity_mut(camera).insert(target);
    // One of no pixels is refused by Bevy itself, whose clusters of lights cannot be made for it.
    for size in [UVec2::ONE, UVec2::new(1, 20), UVec2::new(20, 1)] {
        scene.set_viewport(Some(size));
        scene.step();
    }
    scene.set_viewport(None);
    let after = scene.covered();
    assert!((after - before).abs() < 0.02, "{before} of the picture was tree, then {after}");
}

#[test]
fn terrain_whose_ground_panics_is_drawn_where_it_does_not() {
    let mut scene = OneTree::new();
    let tree = scene.covered();
    let ground = |at: DVec2| {
        assert!(at.x < 40.0, "the level ends here");
        0.0
    };
    let settings = TerrainSettings { reach_m: 500.0, builds_at_once: 64, chunks_per_frame: 64, ..default() };
    let terrain = scene.app.world_mut().spawn((Terrain::new(ground), settings)).id();
    let is_complete = update_until(&mut scene.app, |world| {
        world.get::<TerrainChunks>(terrain).is_some_and(TerrainChunks::is_complete)
    });
    assert!(is_complete, "the terrain goes on to be built");
    let drawn = scene.app.world().get::<TerrainChunks>(terrain).expect("it has chunks").drawn();
    scene.step();
    assert!(drawn > 0);
    // The ground under the camera is there.
    let picture = scene.covered();
    assert!(picture > tree + 0.15, "{tree} of the picture is tree, {picture} tree and ground");
    scene.app.world_mut().entity_mut(terrain).insert(Terrain::new(|_: DVec2| 0.0));
    let is_complete = update_until(&mut scene.app, |world| {
        world.get::<TerrainChunks>(terrain).is_some_and(TerrainChunks::is_complete)
    });
    assert!(is_complete && scene.covered() > picture + 0.02);
}
