//! A game at random.

use super::support::{capture, headless_app};
use bevy::{ecs::system::RunSystemOnce, prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{
    forest::{ForestCells, ForestImpostors},
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
    tree::SpeciesModels,
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::time::Duration;

/// Frame of the game, s.
const FRAME_S: f32 = 0.1;
const SIZE: (u32, u32) = (64, 36);
/// One of so many frames is drawn: that takes a hundred times as long as all else.
const DRAWN_EVERY: u32 = 10;
/// Trees of the game's own, at most.
const MOST_TREES: usize = 12;
/// Half the side of the forest, m.
const HALF_M: f32 = 600.0;
/// Small plants, which are baked in no time: nothing here depends on how large they are.
const SPECIES: [&str; 2] = ["bracken", "bilberry"];
/// Ages at which trees are baked.
const AGES: [f32; 2] = [2.0, 3.0];

pub struct Game {
    pub app: App,
    camera: Entity,
    forest: Entity,
    random: Xoshiro256PlusPlus,
    species: Vec<Handle<Species>>,
    own: Vec<Entity>,
    heading: f32,
}

impl Game {
    pub fn new(seed: u64) -> Self {
        let mut app = headless_app(Duration::ZERO, None);
        capture::begin(&mut app).expect("a graphics device");
        let target = capture::target(&mut app, SIZE);
        let world = app.world_mut();
        let species =
            SPECIES.map(|name| world.resource::<AssetServer>().load(format!("species/{name}.species.ron"))).to_vec();
        let stock = |species: &str, age_years: f32| Stock {
            species: species.into(),
            age_years,
            age_spread_years: 0.0,
            ..default()
        };
        let area = Area {
            shape: Shape::Rectangle { min_m: [-HALF_M; 2], max_m: [HALF_M; 2] },
            density_per_ha: 60.0,
            stock: vec![stock(SPECIES[0], AGES[0]), stock(SPECIES[1], AGES[1])],
            ..default()
        };
        let plan = ForestPlan { seed: 3, cell_m: 32.0, areas: vec![area], ..default() };
        let plan = world.resource_mut::<Assets<ForestPlan>>().add(plan);
        let settings = ForestSettings {
            trees_to_m: 40.0,
            far_to_m: 200.0,
            articulated_to_m: 10.0,
            wind_cells: true,
            trees_per_frame: 1000,
            cells_at_once: 64,
            ..default()
        };
        let forest = world.spawn((Forest::new(plan), settings)).id();
        let camera = world.spawn((capture::camera(&target), Pusher::default(), WindListener::default(), HOME)).id();
        world.get_mut::<Camera>(camera).expect("a camera").is_active = false;
        // Where the camera is, somebody is who keeps the forest about it.
        world.spawn((Viewpoint, ChildOf(camera)));
        world.spawn((DirectionalLight { shadow_maps_enabled: true, ..default() }, HOME));
        world.insert_resource(Wind { fade_s: 0.5, ..default() });
        world.resource_mut::<LevelOfDetail>().changes_per_frame = 10_000;
        let random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut game = Self { app, camera, forest, random, species, own: Vec::new(), heading: 0.0 };
        // Whatever may be asked for is baked once, so that later minutes have no other species than the first.
        for species in game.species.clone() {
            for age_years in AGES {
                game.spawn((Tree::new(species.clone()).with_age(age_years), Transform::from_xyz(0.0, 0.0, -5.0)));
            }
        }
        // One wind comes before the other has faded: there are never more tables than now.
        game.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(FRAME_S)));
        for speed in [4.0, 8.0, 12.0, 16.0] {
            game.app.world_mut().resource_mut::<Wind>().speed = speed;
            (0..10).for_each(|_| game.app.update());
        }
        game.go_home();
        game.draw();
        game
    }

    /// Plays for so long, s of the game's time.
    pub fn play(&mut self, seconds: f32) {
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(FRAME_S)));
        for frame in 0..(seconds / FRAME_S).round() as u32 {
            self.walk();
            self.act();
            self.switch_camera(frame.is_multiple_of(DRAWN_EVERY));
            capture::step(&mut self.app);
        }
        self.switch_camera(false);
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    }

    fn walk(&mut self) {
        self.heading += self.random.random_range(-0.2..0.2);
        let step = Quat::from_rotation_y(self.heading) * Vec3::NEG_Z * (4.0 * FRAME_S);
        let heading = self.heading;
        let mut at = self.app.world_mut().get_mut::<Transform>(self.camera).expect("a camera");
        at.translation += step;
        at.rotation = Quat::from_rotation_y(heading);
    }

    /// In most frames nothing happens.
    fn act(&mut self) {
        let place = self.app.world().get::<Transform>(self.camera).expect("a camera").translation;
        let mut spread = |size: f32| self.random.random_range(-size..size);
        let near = Transform::from_xyz(place.x + spread(15.0), 0.0, place.z + spread(15.0));
        let far = Transform::from_xyz(spread(HALF_M), 2.0, spread(HALF_M));
        match self.random.random_range(0..200) {
            0..2 => *self.app.world_mut().get_mut::<Transform>(self.camera).expect("a camera") = far,
            2 => {
                let mut wind = self.app.world_mut().resource_mut::<Wind>();
                wind.speed = 2.0 + 0.03 * far.translation.x.abs();
                wind.direction = Rot2::radians(far.translation.z) * wind.direction;
            }
            3..10 => self.edit(move |editor| {
                if let Some((forest, stem)) = editor.nearest(near.translation.xz(), 20.0) {
                    editor.fell(forest, stem.id).ok();
                }
            }),
            10..14 => {
                let forest = self.forest;
                let stem = NewStem { place_m: near.translation.xz(), species: SPECIES[1].into(), age_years: AGES[0] };
                self.edit(move |editor| drop(editor.plant(forest, &stem)));
            }
            14..20 if self.own.len() < MOST_TREES => {
                let species = self.species[self.random.random_range(0..self.species.len())].clone();
                let age_years = AGES[self.random.random_range(0..2)];
                self.spawn((Tree::new(species).with_age(age_years), near));
            }
            20..25 => {
                if let Some(tree) = self.own.pop() {
                    self.app.world_mut().despawn(tree);
                }
            }
            25..27 => {
                let blast = WindSource::new(SourceKind::Blast { charge_kg: 50.0 });
                self.spawn((blast, near));
            }
            27..29 => self.app.world_mut().resource_mut::<Season>().year = 0.5 + 0.0005 * far.translation.x,
            29..31 => {
                let world = self.app.world_mut();
                let tree = world.query_filtered::<Entity, With<Grown>>().iter(world).next();
                if let Some(tree) = tree {
                    world.write_message(TreeImpulse { tree, place, impulse_n_s: Vec3::X * 20.0 });
                }
            }
            31..35 => {
                let age_years = AGES[self.random.random_range(0..2)];
                self.edit(move |editor| {
                    if let Some((forest, stem)) = editor.nearest(near.translation.xz(), 20.0) {
                        editor.set_age(forest, stem.id, age_years).ok();
                    }
                });
            }
            35..38 => {
                let age_years = AGES[self.random.random_range(0..2)];
                let tree = self.own.last().and_then(|own| self.app.world_mut().get_mut::<Tree>(*own));
                tree.into_iter().for_each(|mut tree| tree.age_years = Some(age_years));
            }
            _ => {}
        }
    }

    fn edit(&mut self, edit: impl FnOnce(&mut ForestEditor) + Send + Sync + 'static) {
        let mut edit = Some(edit);
        let system = move |mut editor: ForestEditor| edit.take().into_iter().for_each(|edit| edit(&mut editor));
        self.app.world_mut().run_system_once(system).expect("a system that runs");
    }

    fn spawn(&mut self, bundle: impl Bundle) {
        self.own.push(self.app.world_mut().spawn(bundle).id());
    }

    /// Puts away all that the game has done, goes home by way of a far corner, and waits until everything rests.
    pub fn go_home(&mut self) {
        self.rest();
        for own in std::mem::take(&mut self.own) {
            self.app.world_mut().despawn(own);
        }
        self.app.world_mut().entity_mut(self.forest).insert(ForestChanges::default());
        self.app.insert_resource(Season::SUMMER);
        for place in [Transform::from_xyz(-HALF_M, 2.0, -HALF_M), HOME] {
            *self.app.world_mut().get_mut::<Transform>(self.camera).expect("a camera") = place;
            // Cells that nobody is near to go, a few a frame.
            (0..60).for_each(|_| self.app.update());
            self.rest();
        }
        // Trees that were touched come to rest, and what lingers goes: meshes that no tree has wanted for 32 rounds of 17 frames.
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(60)));
        (0..640).for_each(|_| self.app.update());
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    }

    /// Draws some frames, so that all is on the device.
    fn draw(&mut self) {
        self.switch_camera(true);
        (0..6).for_each(|_| capture::step(&mut self.app));
        self.switch_camera(false);
        self.app.update();
    }

    fn switch_camera(&mut self, is_active: bool) {
        self.app.world_mut().get_mut::<Camera>(self.camera).expect("a camera").is_active = is_active;
    }

    fn rest(&mut self) {
        let is_at_rest = |world: &mut World| {
            let forests = world.query::<(&ForestCells, &ForestImpostors)>().iter(world).all(|(cells, impostors)| {
                cells.is_complete() && cells.is_planted() && cells.is_up_to_date() && impostors.is_complete()
            });
            let waiting = world.query_filtered::<(), (With<Tree>, Without<TreeMeshes>)>().iter(world).count();
            forests
                && waiting == 0
                && !world.resource::<SpeciesModels>().is_baking()
                && world.resource::<ActiveSway>().is_settled()
                && world.resource::<ActiveWind>().is_settled()
        };
        // Winds fade in the game's time.
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(FRAME_S)));
        let rests = (0..6000).any(|_| {
            self.app.update();
            std::thread::sleep(Duration::from_millis(5));
            is_at_rest(self.app.world_mut())
        });
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
        assert!(rests, "the game did not come to rest");
    }
}

/// Where the game begins.
const HOME: Transform = Transform::from_xyz(0.0, 2.0, 0.0);
