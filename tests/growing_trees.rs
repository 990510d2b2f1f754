//! Trees that grow older are seen to grow: their next shape comes while the former one fades. Needs a Vulkan driver. Mesa's software one will
//! do.

mod support;

use bevy::{ecs::system::SystemState, prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{
    forest::{ForestCells, TreeEntered, TreeLeft},
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
    tree::SpeciesModels,
};
use image::RgbaImage;
use std::{fs, time::Duration};
use support::capture;

const SIZE: (u32, u32) = (160, 160);
/// From one picture to the next.
const FRAME: Duration = Duration::from_millis(50);
/// A tree of this age is drawn by another model than one of the other, years.
const AGES_YEARS: [f32; 2] = [40.0, 56.0];
/// A step from one picture to the next changes at most this share of all that growth changes; a pop changes all of it.
const MOST_OF_A_STEP: f64 = 0.1;

/// Someone who looks at trees that stand still, in front of a plain colour.
struct Viewer {
    app: App,
    target: Handle<Image>,
}

impl Viewer {
    fn new() -> Self {
        let mut app = support::headless_app(Duration::ZERO, None);
        capture::begin(&mut app).expect("a graphics device");
        let target = capture::target(&mut app, SIZE);
        let world = app.world_mut();
        support::light_plainly(world);
        world.insert_resource(Wind { speed: 0.0, ..default() });
        let eye = Transform::from_xyz(0.0, 9.0, 30.0).looking_at(Vec3::new(0.0, 9.0, 0.0), Vec3::Y);
        world.spawn((capture::camera(&target), eye));
        Self { app, target }
    }

    /// Updates until all is drawn, in the light of its stand.
    fn settle(&mut self) {
        let ready = support::update_until(&mut self.app, |world| {
            let without_stand = world.query_filtered::<(), (With<StemId>, Without<InCanopy>)>().iter(world).count();
            world.resource::<ActiveSway>().is_ready() && capture::forests_are_drawn(world) && without_stand == 0
        });
        assert!(ready, "the trees were not drawn in time");
        (0..20).for_each(|_| capture::step(&mut self.app));
    }

    fn picture(&mut self) -> RgbaImage {
        capture::capture(&mut self.app, &self.target, SIZE).expect("a picture")
    }

    /// Meshes that are drawn.
    fn meshes(&mut self) -> usize {
        let world = self.app.world_mut();
        world.query::<&Mesh3d>().iter(world).count()
    }

    /// Lets the clock run for a frame.
    fn advance(&mut self) {
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
        self.app.update();
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    }

    /// Has trees grow, and looks at them until nothing changes any more. Asserts that no step is a pop; the last picture is returned.
    fn watch(&mut self, grow: impl FnOnce(&mut World)) -> RgbaImage {
        let (first, meshes) = (self.picture(), self.meshes());
        grow(self.app.world_mut());
        // The clock stands until the other model is there: nothing has faded then.
        let has_begun = (0..2000).any(|_| {
            self.app.update();
            std::thread::sleep(Duration::from_millis(5));
            self.meshes() > meshes
        });
        assert!(has_begun, "nothing has grown");
        (0..20).for_each(|_| capture::step(&mut self.app));
        // The wood that fades has a mask, and may be shaded a little differently.
        let mut last = self.picture();
        let mut steps = vec![difference(&first, &last)];
        for _ in 0..40 {
            self.advance();
            let next = self.picture();
            steps.push(difference(&last, &next));
            last = next;
        }
        let whole = difference(&first, &last);
        let greatest = steps.iter().fold(0.0_f64, |most, step| most.max(*step));
        println!("{whole} in all, {greatest} in a step at most: {:.3}", greatest / whole);
        assert!(whole > 1e4, "{whole}: it has not grown");
        assert!(greatest <= MOST_OF_A_STEP * whole, "a step of {greatest} of {whole} is a pop: {steps:?}");
        assert_eq!(steps[36..], [0.0; 5], "it has ended");
        assert_eq!(self.meshes(), meshes, "what has faded is gone");
        last
    }
}

/// Sum over all pixels and colours.
fn difference(one: &RgbaImage, other: &RgbaImage) -> f64 {
    one.iter().zip(other.iter()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum()
}

#[test]
fn a_tree_that_grows_older_does_not_pop() {
    let mut viewer = Viewer::new();
    let species = viewer.app.world().resource::<AssetServer>().load("species/norway_spruce.species.ron");
    let spruce = |years: f32| (Tree::new(species.clone()).with_seed(2).with_age(years), Transform::default());
    let tree = viewer.app.world_mut().spawn(spruce(AGES_YEARS[0])).id();
    viewer.settle();
    let grown = viewer.watch(|world| {
        world.get_mut::<Tree>(tree).expect("it stands").age_years = Some(AGES_YEARS[1]);
    });
    // As one that has always been so old.
    viewer.app.world_mut().despawn(tree);
    viewer.app.world_mut().spawn(spruce(AGES_YEARS[1]));
    viewer.settle();
    assert_eq!(difference(&viewer.picture(), &grown), 0.0);
}

#[test]
fn stems_of_a_forest_that_grow_older_stay_and_do_not_pop() {
    let mut viewer = Viewer::new();
    let stock = Stock { species: "norway_spruce".into(), age_years: AGES_YEARS[0], age_spread_years: 0.0, ..default() };
    let shape = Shape::Rectangle { min_m: [-10.0, -15.0], max_m: [10.0, 5.0] };
    let area = Area { shape, density_per_ha: 150.0, stock: vec![stock], ..default() };
    let world = viewer.app.world_mut();
    let plan = world.resource_mut::<Assets<ForestPlan>>().add(ForestPlan { areas: vec![area], ..default() });
    let forest =
        world.spawn((Forest::new(plan), ForestSettings { trees_to_m: 100.0, far_to_m: 0.0, ..default() })).id();
    viewer.settle();
    let stems = |world: &mut World| {
        let mut stems: Vec<(StemId, Entity)> =
            world.query::<(&StemId, Entity)>().iter(world).map(|(id, it)| (*id, it)).collect();
        stems.sort_unstable();
        stems
    };
    let before = stems(viewer.app.world_mut());
    assert!(before.len() > 2, "{} stems", before.len());
    viewer.app.world_mut().resource_mut::<Messages<TreeEntered>>().clear();
    viewer.watch(|world| {
        let mut state = SystemState::<ForestEditor>::new(world);
        let mut editor = state.get_mut(world).expect("the editor's resources are there");
        for (id, _) in &before {
            editor.set_age(forest, *id, AGES_YEARS[1]).expect("it stands");
        }
    });
    let world = viewer.app.world_mut();
    assert_eq!(stems(world), before, "the same entities");
    assert!(world.query::<&Tree>().iter(world).all(|tree| tree.age_years == Some(AGES_YEARS[1])));
    assert_eq!(world.resource::<Messages<TreeEntered>>().len() + world.resource::<Messages<TreeLeft>>().len(), 0);
    assert!(world.get::<ForestCells>(forest).is_some_and(ForestCells::is_up_to_date));
}

/// Birches in winter and summer, of a species that is edited again and again while they grow, and two that come after that: they look as if
/// they had always been so.
#[test]
fn trees_that_grow_while_their_species_is_edited_keep_apart() {
    const MATURE_YEARS: [f32; 2] = [60.0, 45.0];
    // Places, m, and how far they are ahead of the season, days: those that grow, and those that come later.
    const GROWING: [(f32, f32); 2] = [(-6.0, -180.0), (6.0, 0.0)];
    const LATER: [(f32, f32); 2] = [(-2.0, 0.0), (2.0, -180.0)];
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species/birch.species.ron");
    let birch = Species::from_ron(&fs::read_to_string(file).expect("it is shipped")).expect("it is valid");
    let edited = |mature_years: f32| {
        let mut species = Species { variants: 1, ..birch.clone() };
        species.age.mature_years = mature_years;
        species
    };
    let plant = |viewer: &mut Viewer, species: &Handle<Species>, mature_years: f32, trees: &[(f32, f32)]| {
        let world = viewer.app.world_mut();
        let tree = |&(x, days): &(f32, f32)| {
            let tree = Tree::new(species.clone()).with_age(mature_years).with_season(days);
            world.spawn((tree, Transform::from_xyz(x, 0.0, 0.0))).id()
        };
        let trees: Vec<Entity> = trees.iter().map(tree).collect();
        viewer.settle();
        trees
    };
    let add = |viewer: &mut Viewer, mature_years: f32| {
        viewer.app.world_mut().resource_mut::<Assets<Species>>().add(edited(mature_years))
    };
    let mut viewer = Viewer::new();
    let species = add(&mut viewer, MATURE_YEARS[0]);
    let trees = plant(&mut viewer, &species, MATURE_YEARS[0], &GROWING);
    for round in 1..10 {
        let mature_years = MATURE_YEARS[round % 2];
        let world = viewer.app.world_mut();
        world.resource_mut::<Assets<Species>>().insert(&species, edited(mature_years)).expect("it is there");
        for tree in &trees {
            world.get_mut::<Tree>(*tree).expect("it stands").age_years = Some(mature_years);
        }
        // Of what is asked for, some is there before the next edit, and some is not.
        for _ in 0..3 * round {
            viewer.advance();
            std::thread::sleep(Duration::from_millis(5));
        }
    }
    let is_baked = support::update_until(&mut viewer.app, |world| !world.resource::<SpeciesModels>().is_baking());
    assert!(is_baked, "the species was not baked in time");
    // Meshes come some time after models. Then the last shapes fade.
    for _ in 0..400 {
        viewer.advance();
        std::thread::sleep(Duration::from_millis(5));
    }
    plant(&mut viewer, &species, MATURE_YEARS[1], &LATER);
    (0..60).for_each(|_| viewer.advance());
    let edited_picture = viewer.picture();
    let mut fresh = Viewer::new();
    let species = add(&mut fresh, MATURE_YEARS[1]);
    plant(&mut fresh, &species, MATURE_YEARS[1], &[GROWING, LATER].concat());
    assert_eq!(difference(&fresh.picture(), &edited_picture), 0.0);
}
