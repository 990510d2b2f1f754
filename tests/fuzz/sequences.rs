//! A game that does anything in any order: afterwards everything is a number, belongs to something that is there, and goes with it.

use super::{
    from_environment, seed,
    server::{server_app, shipped_assets},
};
use bevy::{ecs::system::RunSystemOnce, prelude::*};
use bevy_windwood::{
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
    tree::{SpeciesModels, TreePlaces},
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::{fs, time::Duration};

/// Sequences with every test, and in a long run.
const FEW: u32 = 60;
const MANY: u32 = 10_000;
const OPERATIONS: u32 = 12;
/// Of the trees of a game, at most.
const MOST_TREES: usize = 12;
/// Ages of trees, years: each is drawn by a model of its own.
const AGES: [f32; 2] = [2.0, 3.0];
const ODD: [f32; 8] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 0.0, 1e-30, 1e30, 3.0];

struct Game {
    app: App,
    random: Xoshiro256PlusPlus,
    species: Vec<Handle<Species>>,
    plan: Handle<ForestPlan>,
    /// What the game itself has spawned.
    own: Vec<Entity>,
    trees: Vec<Entity>,
}

impl Game {
    fn new(seed: u64) -> Self {
        let assets = shipped_assets();
        let mut app = server_app(&assets, Duration::from_millis(40));
        let load = |name: &str| {
            let text =
                fs::read_to_string(assets.join("species").join(format!("{name}.species.ron"))).expect("it is there");
            Species { variants: 1, ..Species::from_ron(&text).expect("it is valid") }
        };
        let species = ["birch", "fir", "hazel"].map(load);
        let mut of = app.world_mut().resource_mut::<Assets<Species>>();
        let species: Vec<_> = species.into_iter().map(|species| of.add(species)).collect();
        let stock = Stock { species: "birch".into(), age_years: 3.0, age_spread_years: 0.5, ..default() };
        let shape = Shape::Rectangle { min_m: [-30.0; 2], max_m: [30.0; 2] };
        let area = Area { shape, density_per_ha: 60.0, stock: vec![stock], ..default() };
        let plan = ForestPlan { cell_m: 16.0, areas: vec![area], ..default() };
        let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan);
        let random = Xoshiro256PlusPlus::seed_from_u64(seed);
        Self { app, random, species, plan, own: Vec::new(), trees: Vec::new() }
    }

    fn place(&mut self) -> Transform {
        let mut spread = |size: f32| self.random.random_range(-size..size);
        let place = Transform::from_xyz(spread(40.0), spread(3.0), spread(40.0));
        let turned = place.with_rotation(Quat::from_rotation_y(spread(3.0)));
        turned.with_scale(Vec3::splat(1.0 + 0.5 * spread(1.0)))
    }

    fn odd(&mut self) -> f32 {
        ODD[self.random.random_range(0..ODD.len())]
    }

    fn any_tree(&mut self) -> Option<Entity> {
        (!self.trees.is_empty()).then(|| self.trees[self.random.random_range(0..self.trees.len())])
    }

    fn any_own(&mut self) -> Option<Entity> {
        (!self.own.is_empty()).then(|| self.own[self.random.random_range(0..self.own.len())])
    }

    fn any_age(&mut self) -> f32 {
        AGES[self.random.random_range(0..AGES.len())]
    }

    fn any_species(&mut self) -> Handle<Species> {
        self.species[self.random.random_range(0..self.species.len())].clone()
    }

    fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        let entity = self.app.world_mut().spawn(bundle).id();
        self.own.push(entity);
        entity
    }

    fn despawn(&mut self, entity: Entity) {
        self.app.world_mut().try_despawn(entity).ok();
        let world = self.app.world();
        self.own.retain(|own| world.get_entity(*own).is_ok());
        self.trees.retain(|tree| world.get_entity(*tree).is_ok());
    }

    fn plant(&mut self) {
        if self.trees.len() == MOST_TREES {
            return;
        }
        let tree = Tree::new(self.any_species()).with_age(self.any_age());
        let place = self.place();
        let tree = self.spawn((tree, place));
        self.trees.push(tree);
    }

    /// One thing that a game may do.
    fn act(&mut self) {
        match self.random.random_range(0..24) {
            0..3 => self.plant(),
            3 => self.any_own().into_iter().for_each(|entity| self.despawn(entity)),
            4 => {
                // No one is a child of its own child: only things without children are moved.
                let (Some(child), Some(parent)) = (self.any_tree(), self.any_own()) else { return };
                let world = self.app.world_mut();
                let is_free = world.get::<Children>(child).is_none() && world.get::<ChildOf>(parent).is_none();
                if child != parent && is_free {
                    world.entity_mut(child).insert(ChildOf(parent));
                }
            }
            5 => self.with_tree(|mut tree, _| {
                tree.remove::<ChildOf>();
            }),
            6 => self.with_tree(|mut tree, random| {
                tree.insert(if random.random() { Visibility::Hidden } else { Visibility::Inherited });
            }),
            7 => {
                let Some(tree) = self.any_tree() else { return };
                let copy = self.app.world().get::<Tree>(tree).cloned();
                let place = self.place();
                if let Some(copy) = copy.filter(|_| self.trees.len() < MOST_TREES) {
                    let copy = self.spawn((copy, place));
                    self.trees.push(copy);
                }
            }
            8 => {
                let species = self.any_species();
                self.with_tree(|mut tree, _| {
                    tree.get_mut::<Tree>().into_iter().for_each(|mut tree| tree.species = species.clone());
                });
            }
            9 => {
                let odd = self.odd();
                self.with_tree(|mut tree, random| {
                    let Some(mut of) = tree.get_mut::<Tree>() else { return };
                    (of.season_days, of.tint, of.seed) = (odd, Some(odd), random.random::<bool>().then_some(7));
                });
            }
            10 => self.with_tree(|mut tree, random| {
                tree.insert(Articulated { deepest_order: random.random_range(0..3), leaves: random.random() });
            }),
            11 => self.with_tree(|mut tree, _| {
                tree.remove::<Articulated>();
            }),
            12 => {
                let odd = self.odd();
                let canopy = Canopy { height_m: odd, frontal_area_index: self.odd(), exposure: [self.odd(); 8] };
                self.with_tree(|mut tree, _| {
                    tree.insert(InCanopy(canopy));
                });
            }
            13 => {
                let (speed, odd) = (self.random.random_range(0.0..20.0), self.odd());
                let is_odd = self.random.random_range(0..3) == 0;
                let mut wind = self.app.world_mut().resource_mut::<Wind>();
                wind.speed = if is_odd { odd } else { speed };
                wind.fade_s = 0.1;
            }
            14 => {
                let odd = f64::from(self.odd());
                let jump_s = if self.random.random() { odd } else { self.random.random_range(-1e5..1e5) };
                self.app.world_mut().resource_mut::<WindClock>().time_s += jump_s;
            }
            15 => self.app.world_mut().resource_mut::<Season>().year = self.random.random_range(-2.0..2.0),
            16 => {
                let place = self.place();
                self.spawn((Viewpoint, WindListener::default(), place));
            }
            17 => {
                let place = self.place();
                self.spawn((WindListener::default(), WindCell::default(), place));
            }
            18 => {
                let (plan, trees_to_m) = (self.plan.clone(), self.random.random_range(0.0..60.0));
                let articulated_to_m = self.random.random_range(0.0..20.0);
                let settings = ForestSettings { trees_to_m, articulated_to_m, wind_cells: true, ..default() };
                self.spawn((Forest::new(plan), settings));
            }
            19 => {
                let place = self.place().translation.xz();
                let fell = move |mut editor: ForestEditor| {
                    if let Some((forest, stem)) = editor.nearest(place, 30.0) {
                        editor.fell(forest, stem.id).ok();
                    }
                };
                self.app.world_mut().run_system_once(fell).expect("a system that runs");
            }
            20 => {
                let to_m = if self.random.random() { self.odd() } else { 25.0 };
                self.app.insert_resource(TreeColliderSettings { to_m, ..default() });
            }
            21 => {
                let years = self.any_age();
                self.with_tree(|mut tree, _| {
                    tree.get_mut::<Tree>().into_iter().for_each(|mut tree| tree.age_years = Some(years));
                });
            }
            22 => {
                let (place, years) = (self.place().translation.xz(), self.any_age());
                let grow = move |mut editor: ForestEditor| {
                    if let Some((forest, stem)) = editor.nearest(place, 30.0) {
                        editor.set_age(forest, stem.id, years).ok();
                    }
                };
                self.app.world_mut().run_system_once(grow).expect("a system that runs");
            }
            _ => {
                let place = self.place();
                self.with_tree(|mut tree, _| {
                    tree.insert(place);
                });
            }
        }
    }

    fn with_tree(&mut self, change: impl FnOnce(EntityWorldMut, &mut Xoshiro256PlusPlus)) {
        if let Some(tree) = self.any_tree() {
            change(self.app.world_mut().entity_mut(tree), &mut self.random);
        }
    }

    /// What holds after every frame.
    fn check(&mut self) {
        let (from, to) = (self.place().translation, self.place().translation);
        let world = self.app.world_mut();
        for (beam, of, at) in world.query::<(&Beam, &BeamOf, &Transform)>().iter(world) {
            assert!(at.is_finite(), "{beam:?} at {at:?}");
            assert!(world.get::<Tree>(of.0).is_some(), "a beam of no tree");
        }
        for (leaf, of, at) in world.query::<(&Leaf, &LeafOf, &Transform)>().iter(world) {
            assert!(at.is_finite(), "{leaf:?} at {at:?}");
            assert!(world.get::<Tree>(of.0).is_some(), "a leaf of no tree");
        }
        for listener in world.query::<&WindListener>().iter(world) {
            let WindListener { velocity, mean_m_s, gust_m_s, gust_level, rustle_level, .. } = *listener;
            assert!(velocity.is_finite() && mean_m_s.is_finite() && gust_m_s.is_finite(), "{listener:?}");
            assert!((0.0..=1.0).contains(&gust_level) && (0.0..=1.0).contains(&rustle_level), "{listener:?}");
        }
        for cell in world.query::<&WindCell>().iter(world) {
            assert!(cell.velocity.is_finite(), "{cell:?}");
        }
        let grown = world.query_filtered::<(), With<Grown>>().iter(world).count();
        assert!(world.resource::<TreePlaces>().len() <= grown, "places of trees that are gone");
        let sight = move |rays: TreeRays| rays.sight(from, to);
        let clear = world.run_system_once(sight).expect("a system that runs");
        assert!((0.0..=1.0).contains(&clear), "{clear}");
    }

    /// Entities that are there beside those of the app itself.
    fn count(&mut self) -> usize {
        let world = self.app.world_mut();
        world.query::<Entity>().iter(world).count()
    }

    fn clear(&mut self) {
        for entity in std::mem::take(&mut self.own) {
            self.app.world_mut().try_despawn(entity).ok();
        }
        self.trees.clear();
        self.app.insert_resource(TreeColliderSettings::default());
        (0..3).for_each(|_| self.app.update());
    }

    /// Waits until all species are baked at the ages that are asked for, and there is a wind.
    fn warm_up(&mut self) {
        for species in self.species.clone() {
            for age in AGES {
                self.spawn((Tree::new(species.clone()).with_age(age), Transform::default()));
            }
        }
        let ready = (0..12_000).any(|_| {
            self.app.update();
            std::thread::sleep(Duration::from_millis(5));
            let world = self.app.world_mut();
            let waiting = world.query_filtered::<(), (With<Tree>, Without<Grown>)>().iter(world).count();
            waiting == 0 && !world.resource::<SpeciesModels>().is_baking() && world.resource::<ActiveSway>().is_ready()
        });
        assert!(ready, "species and wind did not come about");
        self.clear();
    }
}

fn play(sequences: u32) {
    let sequences = from_environment("FUZZ_SEQUENCES", sequences);
    let mut game = Game::new(seed());
    game.warm_up();
    let at_first = game.count();
    for number in 0..sequences {
        for _ in 0..OPERATIONS {
            game.act();
            if game.random.random_range(0..3) == 0 {
                game.app.update();
                game.check();
            }
        }
        game.app.update();
        game.check();
        if number % 10 == 9 {
            game.clear();
            assert_eq!(game.count(), at_first, "entities are left over after sequence {number}");
            assert!(game.app.world().resource::<TreePlaces>().is_empty());
        }
    }
    println!("{sequences} sequences of {OPERATIONS} operations");
}

#[test]
fn a_game_may_do_anything_in_any_order() {
    play(FEW);
}

#[test]
#[ignore = "a long run: ten minutes"]
fn a_game_may_do_anything_in_any_order_for_long() {
    play(MANY);
}
