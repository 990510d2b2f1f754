//! Forests that a game changes: stems that are felled, planted, aged and made others stay so, near and far, whatever way the viewers come,
//! after an edit of the plan, and after saving.

use bevy::{ecs::system::SystemState, prelude::*};
use bevy_windwood::{
    SettingError,
    forest::{ForestCells, TreeEntered, TreeFelled, TreeLeft},
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, KeepOut, Shape},
    },
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::collections::BTreeMap;

const TREES_TO_M: f32 = 90.0;
const KNOWN_TO_M: f32 = 320.0;

fn plan() -> ForestPlan {
    let shape = Shape::Rectangle { min_m: [-1500.0; 2], max_m: [1500.0; 2] };
    let more_species = vec!["plum".into()];
    ForestPlan { cell_m: 32.0, areas: vec![Area { shape, ..default() }], more_species, ..default() }
}

/// A forest, and one who looks at it from the origin. Its species need not exist.
struct World {
    app: App,
    forest: Entity,
    viewer: Entity,
}

impl World {
    fn new(changes: ForestChanges) -> Self {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins));
        app.finish();
        app.cleanup();
        let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan());
        let settings = ForestSettings {
            trees_to_m: TREES_TO_M,
            far_to_m: KNOWN_TO_M,
            trees_per_frame: 1000,
            cells_at_once: 16,
            ..default()
        };
        app.world_mut().spawn(Terrain::new(|at: bevy::math::DVec2| 8.0 * (at.x / 31.0).sin() * (at.y / 17.0).cos()));
        let forest = app.world_mut().spawn((Forest::new(plan), settings, changes)).id();
        let viewer = app.world_mut().spawn(Viewpoint).id();
        let mut world = Self { app, forest, viewer };
        world.settle();
        world
    }

    fn cells(&self) -> &ForestCells {
        self.app.world().get::<ForestCells>(self.forest).expect("the forest has begun")
    }

    fn changes(&mut self) -> Mut<'_, ForestChanges> {
        self.app.world_mut().get_mut::<ForestChanges>(self.forest).expect("a forest has changes")
    }

    fn go(&mut self, place: Vec2) {
        let mut at = self.app.world_mut().get_mut::<Transform>(self.viewer).expect("a viewer");
        *at = Transform::from_xyz(place.x, 2.0, place.y);
    }

    /// Updates until all that is wanted stands and all that is known is as it is changed.
    fn settle(&mut self) {
        (0..2).for_each(|_| self.app.update());
        for _ in 0..4000 {
            self.app.update();
            let cells = self.cells();
            if cells.is_complete() && cells.is_planted() && cells.is_up_to_date() {
                // What nobody is near to any more goes, one cell a frame.
                (0..60).for_each(|_| self.app.update());
                return;
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        panic!("the forest did not settle");
    }

    fn walk_away_and_back(&mut self) {
        self.go(Vec2::new(700.0, 0.0));
        self.settle();
        self.go(Vec2::ZERO);
        self.settle();
    }

    /// Every near tree: where it stands, its age, and its entity.
    fn trees(&mut self) -> BTreeMap<StemId, (Vec3, Option<f32>, Entity)> {
        let world = self.app.world_mut();
        let mut trees = world.query::<(&StemId, &Transform, &Tree, Entity)>();
        let all: Vec<_> =
            trees.iter(world).map(|(id, at, tree, entity)| (*id, (at.translation, tree.age_years, entity))).collect();
        let by_id: BTreeMap<_, _> = all.iter().copied().collect();
        assert_eq!(by_id.len(), all.len(), "no stem stands twice");
        by_id
    }

    /// Where the near trees stand, their ages and species, without their entities.
    fn standing(&mut self) -> BTreeMap<StemId, (Vec3, Option<f32>)> {
        self.trees().into_iter().map(|(id, (at, age_years, _))| (id, (at, age_years))).collect()
    }

    /// All stems of the store, as it has packed them.
    fn stored(&self) -> BTreeMap<(i32, i32), Vec<[u32; 4]>> {
        self.cells().store().iter().map(|(cell, content)| ((cell.y, cell.x), content.records().to_vec())).collect()
    }

    fn edit_plan(&mut self, edit: impl FnOnce(&mut ForestPlan)) {
        let mut plans = self.app.world_mut().resource_mut::<Assets<ForestPlan>>();
        let id = plans.ids().next().expect("the plan");
        edit(&mut plans.get_mut(id).expect("the plan"));
        (0..3).for_each(|_| self.app.update());
    }

    fn messages<M: Message>(&mut self) -> Vec<M> {
        self.app.world_mut().resource_mut::<Messages<M>>().drain().collect()
    }

    fn edit<T>(&mut self, edit: impl FnOnce(&mut ForestEditor, Entity) -> T) -> T {
        let mut state = SystemState::<ForestEditor>::new(self.app.world_mut());
        let mut editor = state.get_mut(self.app.world_mut()).expect("an editor");
        edit(&mut editor, self.forest)
    }

    /// Stems of the store within 5 cm of a place.
    fn stored_at(&self, place: Vec3) -> usize {
        let mut found = 0;
        self.cells().store().within(place.xz(), 0.05, |_| found += 1);
        found
    }
}

fn saved(changes: &ForestChanges) -> ForestChanges {
    let text = ron::to_string(changes).expect("changes are saved");
    ron::from_str(&text).expect("changes are loaded")
}

#[test]
fn ids_are_the_same_on_two_runs_whatever_way_the_viewers_came() {
    let mut first = World::new(default());
    let here = first.standing();
    assert!(here.len() > 200, "{} trees", here.len());
    let mut second = World::new(default());
    second.go(Vec2::new(400.0, 300.0));
    second.settle();
    second.go(Vec2::ZERO);
    second.settle();
    assert_eq!(second.standing(), here);
    for (id, (at, _)) in here {
        assert_eq!(id.place_m(), Some(at.xz()));
        assert_eq!(first.cells().stem(id).map(|stem| stem.plant.position), Some(at));
    }
}

#[test]
fn a_felled_tree_goes_at_once_and_stays_felled() {
    let mut world = World::new(default());
    let before = world.trees();
    let (felled, (place, _, tree)) = before.iter().next().map(|(id, tree)| (*id, *tree)).expect("a tree");
    world.messages::<TreeFelled>();
    world.changes().fell(felled).unwrap();
    world.app.update();
    let mut wanted = before.clone();
    wanted.remove(&felled);
    assert_eq!(world.trees(), wanted, "all others are the same entities");
    assert_eq!(world.stored_at(place), 0);
    let told = world.messages::<TreeFelled>();
    assert_eq!(told.len(), 1);
    assert_eq!((told[0].id, told[0].tree, told[0].place), (felled, Some(tree), place));

    let wanted: BTreeMap<_, _> = wanted.into_iter().map(|(id, (at, age, _))| (id, (at, age))).collect();
    world.walk_away_and_back();
    assert_eq!(world.standing(), wanted, "after a walk of 700 m");
    assert_eq!(world.stored_at(place), 0);

    // An edit elsewhere: another area, and a pond.
    world.edit_plan(|plan| {
        let shape = Shape::Rectangle { min_m: [600.0; 2], max_m: [700.0; 2] };
        plan.areas.push(Area { shape, ..default() });
        plan.keep_out.push(KeepOut::Disc { centre_m: [900.0, 0.0], radius_m: 40.0 });
    });
    world.settle();
    assert_eq!(world.standing(), wanted, "after an edit elsewhere");
    // Cells do not change what stands where.
    world.edit_plan(|plan| plan.cell_m = 40.0);
    world.settle();
    assert!(!world.trees().contains_key(&felled) && world.stored_at(place) == 0, "after an edit of the cells");

    let changes = saved(&world.changes());
    let mut other = World::new(changes);
    assert_eq!(other.standing(), wanted, "after saving");
    assert_eq!(other.stored_at(place), 0);
    other.changes().restore(felled).unwrap();
    other.settle();
    assert_eq!(other.standing(), before.into_iter().map(|(id, (at, age, _))| (id, (at, age))).collect());
    assert_eq!(other.stored_at(place), 1);
}

#[test]
fn planted_stems_stand_near_and_far() {
    let mut world = World::new(default());
    let stem = |x: f32| NewStem { place_m: Vec2::new(x, 3.0), species: "plum".into(), age_years: 12.0 };
    let [near, far] = [10.0, 250.0].map(|x| world.edit(|editor, forest| editor.plant(forest, &stem(x))).unwrap());
    world.app.update();
    let tree = world.trees()[&near];
    assert_eq!((tree.0.xz(), tree.1), (Vec2::new(10.0, 3.0), Some(12.0)));
    let species = world.app.world().get::<Tree>(tree.2).expect("a tree").species.path().expect("a path").to_string();
    assert_eq!(species, "species/plum.species.ron");
    world.settle();
    assert!(!world.trees().contains_key(&far));
    let cells = world.cells();
    for (id, x) in [(near, 10.0), (far, 250.0)] {
        let found = cells.nearest_stem(Vec2::new(x, 3.01), 5.0).expect("a stem");
        assert_eq!((found.id, found.plant.age_years), (id, 12.0));
        let stored = cells.store().nearest(Vec2::new(x, 3.0), 0.1).expect("it is stored");
        assert_eq!(cells.identify(stored.cell, &stored.stem), Some(id));
    }
    world.go(Vec2::new(240.0, 0.0));
    world.settle();
    assert!(world.trees().contains_key(&far) && !world.trees().contains_key(&near));
}

#[test]
fn age_and_species_change_near_and_far() {
    let mut world = World::new(default());
    let (near, (_, _, before)) = world.trees().into_iter().next().expect("a tree");
    let far = world.cells().nearest_stem(Vec2::new(0.0, 250.0), 50.0).expect("a stem");
    for id in [near, far.id] {
        world.edit(|editor, forest| {
            editor.set_age(forest, id, 2.5).unwrap();
            editor.set_species(forest, id, "plum").unwrap();
        });
    }
    // The next one enters in the first frame, and the one before leaves in the second.
    (0..2).for_each(|_| world.app.update());
    let (age_years, entity) = (world.trees()[&near].1, world.trees()[&near].2);
    assert!(age_years == Some(2.5) && entity != before);
    assert!(world.app.world().get_entity(before).is_err(), "the tree of before goes when its successor stands");
    world.settle();
    let stored = world.cells().store().nearest(far.plant.position.xz(), 0.1).expect("it is stored");
    assert_eq!(world.cells().planter().species()[usize::from(stored.stem.species)], "plum");
    assert!(stored.stem.plan_size < 0.2 && far.plant.plan_size > 0.5, "{}", stored.stem.plan_size);
}

#[test]
fn trees_that_enter_leave_and_are_felled_are_told() {
    let mut world = World::new(default());
    let mut known: BTreeMap<Entity, StemId> = world.trees().into_iter().map(|(id, (.., tree))| (tree, id)).collect();
    assert!(known.len() > 200);
    let first = known.clone();
    world.messages::<TreeEntered>();
    world.messages::<TreeLeft>();
    for step in 0..300_u16 {
        world.go(Vec2::new(f32::from(step) * 2.0, 0.0));
        if step % 10 == 0 {
            known.values().take(1).for_each(|id| world.changes().fell(*id).unwrap());
        }
        world.app.update();
        for TreeEntered { tree, id, .. } in world.messages() {
            assert_eq!(known.insert(tree, id), None);
        }
        for TreeLeft { tree, id, .. } in world.messages() {
            assert_eq!(known.remove(&tree), Some(id));
        }
        for TreeFelled { tree, id, .. } in world.messages() {
            assert!(tree.is_none_or(|tree| known.remove(&tree) == Some(id)));
        }
        let trees: BTreeMap<Entity, StemId> = world.trees().into_iter().map(|(id, (.., tree))| (tree, id)).collect();
        assert_eq!(known, trees);
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert!(known.keys().all(|tree| !first.contains_key(tree)), "the walk has led away");
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let mut world = World::new(default());
    let id = *world.trees().keys().next().expect("a tree");
    world.edit(|editor, forest| editor.fell(forest, id)).unwrap();
    let before = world.changes().clone();
    let nowhere = StemId::try_from(u64::from(3.0_f32.to_bits()) << 32 | u64::from(4.0_f32.to_bits())).unwrap();
    let stem = |species: &str, x: f32| NewStem { place_m: Vec2::new(x, 0.0), species: species.into(), age_years: 3.0 };
    let refused = |result: Result<StemId, SettingError>| result.unwrap_err().to_string();
    let messages = world.edit(|editor, forest| {
        [
            refused(editor.fell(forest, nowhere).map(|()| nowhere)),
            refused(editor.fell(forest, id).map(|()| id)),
            refused(editor.set_age(forest, id, 3.0).map(|()| id)),
            refused(editor.set_species(forest, nowhere, "gum").map(|()| id)),
            refused(editor.plant(forest, &stem("gum", 0.0))),
            refused(editor.plant(forest, &stem("plum", f32::NAN))),
            refused(editor.plant(forest, &stem("plum", 1e9))),
            refused(editor.restore(forest, nowhere).map(|()| id)),
            refused(editor.fell(Entity::PLACEHOLDER, id).map(|()| id)),
        ]
    });
    for (message, wanted) in messages.iter().zip([
        "`id` is the stem at 3, 4, but must be a stem of the forest that stands",
        "`id` is the stem at ",
        "`id` is the stem at ",
        "`species` is `gum`, but must be a species of the plan",
        "`species` is `gum`, but must be a species of the plan",
        "`place_m",
        "`place_m.x` is 1000000000, but must be -100000 to 100000",
        "`id` is the stem at 3, 4, but must be a stem of the plan that was changed",
        "`forest` is ",
    ]) {
        assert!(message.starts_with(wanted), "{message}");
    }
    assert_eq!(*world.changes(), before);
    // Without the editor, what does not exist has no effect.
    let standing = world.standing();
    world.changes().fell(nowhere).unwrap();
    world.changes().plant(&stem("gum", 0.0)).unwrap();
    world.settle();
    let mut wanted = standing;
    wanted.remove(&id);
    assert_eq!(world.standing(), wanted);
}

/// Whatever is changed, and whenever: in the end the forest is one that has begun with these changes.
#[test]
fn changes_on_the_way_lead_to_the_forest_that_begins_with_them() {
    let mut world = World::new(default());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
    let mut changed: Vec<StemId> = Vec::new();
    for step in 0..250 {
        if step % 25 == 0 {
            world.go(Vec2::new(random.random_range(-300.0..300.0), random.random_range(-300.0..300.0)));
        }
        for _ in 0..random.random_range(0..12) {
            let place_m = Vec2::new(random.random_range(-500.0..500.0), random.random_range(-500.0..500.0));
            let kind = random.random_range(0..6);
            let known = world.cells().nearest_stem(place_m, 30.0).map(|stem| stem.id);
            let mut changes = world.changes();
            // Some of these are refused, such as to fell what is felled: that is part of it.
            let _ = match (kind, known) {
                (0 | 1, Some(id)) => changes.fell(id).map(|()| id),
                (2, Some(id)) => changes.set_age(id, random.random_range(1.0..200.0)).map(|()| id),
                (3, Some(id)) => changes.set_species(id, "plum").map(|()| id),
                (4, _) if !changed.is_empty() => {
                    let id = changed[random.random_range(0..changed.len())];
                    changes.restore(id).map(|()| id)
                }
                _ => changes.plant(&NewStem { place_m, species: "oak".into(), age_years: 30.0 }),
            }
            .map(|id| changed.push(id));
        }
        if step == 120 {
            world.edit_plan(|plan| plan.areas[0].density_per_ha = 150.0);
        }
        world.app.update();
    }
    world.go(Vec2::new(20.0, -30.0));
    world.settle();
    let changes = saved(&world.changes());
    assert!(changes.felled().count() > 100 && changes.planted().count() > 100);
    assert!(changes == *world.changes());

    let mut fresh = World::new(changes);
    fresh.edit_plan(|plan| plan.areas[0].density_per_ha = 150.0);
    fresh.go(Vec2::new(20.0, -30.0));
    fresh.settle();
    // Beyond, what stands depends on the way: cells stay for a while when nobody is near any longer.
    let is_near = |(_, (at, _)): &(StemId, (Vec3, Option<f32>))| at.xz().distance(Vec2::new(20.0, -30.0)) < TREES_TO_M;
    let near = |world: &mut World| world.standing().into_iter().filter(is_near).collect::<BTreeMap<_, _>>();
    let (ours, theirs) = (near(&mut world), near(&mut fresh));
    let differ: Vec<_> = ours.iter().filter(|(id, tree)| theirs.get(*id) != Some(*tree)).collect();
    assert!(ours.len() == theirs.len() && differ.is_empty(), "{} and {}: {differ:?}", ours.len(), theirs.len());
    let (ours, theirs) = (world.stored(), fresh.stored());
    let both: Vec<_> = ours.keys().filter(|cell| theirs.contains_key(*cell)).collect();
    assert!(both.len() > 200, "{} cells", both.len());
    assert!(both.iter().all(|cell| ours[*cell] == theirs[*cell]));
}

/// Its first rows shelter a wood: where they are cut, the wind comes in.
#[test]
fn trees_beside_a_clearing_lose_their_shelter() {
    let mut world = World::new(default());
    world.edit_plan(|plan| plan.areas[0].shape = Shape::Rectangle { min_m: [-300.0; 2], max_m: [300.0; 2] });
    let open_to_x = |world: &mut World| {
        let app = &mut world.app;
        let mut trees = app.world_mut().query_filtered::<(&Transform, &InCanopy), With<StemId>>();
        let row = trees.iter(app.world()).filter(|(at, _)| (0.0..8.0).contains(&at.translation.x));
        let open: Vec<f32> = row.map(|(_, canopy)| canopy.0.exposure[0]).collect();
        (open.len() > 10).then(|| open.iter().sum::<f32>() / open.len() as f32)
    };
    let wait = |world: &mut World, is_done: &dyn Fn(f32) -> bool| {
        (0..3000).find_map(|_| {
            world.app.update();
            std::thread::sleep(std::time::Duration::from_millis(2));
            open_to_x(world).filter(|open| is_done(*open))
        })
    };
    world.settle();
    wait(&mut world, &|open| open < 0.1).expect("it is sheltered in the wood");
    let mut felled = Vec::new();
    world.cells().stems_within(Vec2::new(-150.0, 0.0), 300.0, |stem| {
        felled.extend((stem.plant.position.x < 0.0).then_some(stem.id));
    });
    assert!(felled.len() > 500);
    felled.into_iter().for_each(|id| world.changes().fell(id).unwrap());
    wait(&mut world, &|open| open > 0.5).expect("the wind comes in");
    let changes = saved(&world.changes());
    let mut loaded = World::new(changes);
    wait(&mut loaded, &|open| open > 0.3).expect("so it does after loading");
}
