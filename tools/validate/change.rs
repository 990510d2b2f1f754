//! A forest of a million trees that a game changes: what a change takes, how large it is when saved, and whether the forest is the same after
//! a walk, an edit of its plan elsewhere, and loading.
//!
//! The app has no renderer. Every stem is known to the store, as it would be for impostors to 10 km.

use crate::report::Report;
use bevy::{ecs::system::SystemState, prelude::*};
use bevy_windwood::{
    SystemTimes,
    forest::{ForestCells, TreeFelled},
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::{
    hash::{DefaultHasher, Hasher},
    time::{Duration, Instant},
};

const TREES: f32 = 1e6;
/// Half the side of the forest, m.
const HALF_M: f32 = 5000.0;
/// Changes of each kind.
const CHANGES: usize = 10_000;
/// Frames whose median counts: so many times so many.
const TURNS: usize = 20;
const FRAMES_A_TURN: usize = 30;
/// Longest wait for a forest, s.
const TIMEOUT_S: f64 = 120.0;
/// How far the viewer walks away, m, and in steps of what length.
const WALK_M: f32 = 700.0;
const STEP_M: f32 = 5.0;

/// Kinds of changes, and the keys of their times.
const KINDS: [(&str, Change); 5] = [
    ("fell_us", |editor, forest, draw| editor.fell(forest, draw.stem)),
    ("plant_us", |editor, forest, draw| {
        let stem = NewStem { place_m: draw.place_m, species: "birch".into(), age_years: 12.0 };
        editor.plant(forest, &stem).map(|_| ())
    }),
    ("set_age_us", |editor, forest, draw| editor.set_age(forest, draw.stem, 40.0)),
    ("set_species_us", |editor, forest, draw| editor.set_species(forest, draw.stem, "birch")),
    ("restore_us", |editor, forest, draw| editor.restore(forest, draw.stem)),
];

type Change = fn(&mut ForestEditor, Entity, &Draw) -> Result<(), bevy_windwood::SettingError>;

/// What a change is made with.
struct Draw {
    stem: StemId,
    place_m: Vec2,
}

pub fn run() -> Report {
    let mut report = Report::default();
    if let Err(error) = measure(&mut report) {
        eprintln!("{error}");
        report.at_most("hash_mismatches", f64::NAN, 0.0, "could not be measured");
    }
    report
}

fn measure(report: &mut Report) -> Result<(), String> {
    let mut game = Game::new(ForestChanges::default())?;
    let stems = game.cells().store().plants();
    report.record("stems", stems as f64, "of the forest");

    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    // Those that are restored are the first that were felled.
    let mut felled: Vec<StemId> = Vec::new();
    for (key, change) in KINDS {
        let mut draws: Vec<Draw> = (0..CHANGES).map(|_| game.draw(&mut random)).collect();
        match key {
            "fell_us" => felled = draws.iter().map(|draw| draw.stem).collect(),
            "restore_us" => {
                draws.truncate(CHANGES / 2);
                draws.iter_mut().zip(&felled).for_each(|(draw, felled)| draw.stem = *felled);
            }
            _ => {}
        }
        let [call_us, take_over_us, slowest_us] = game.change(&draws, change)?;
        println!("  {key:<16} call {call_us:.2} us (slowest {slowest_us:.0}), taking over {take_over_us:.2} us");
        report.at_most(
            key,
            call_us + take_over_us,
            50.0,
            "a call and the frame's part, mean of 10,000 (restore: 5,000)",
        );
        game.settle()?;
    }
    let [near_us, far_us] = game.single_changes_us(&mut random)?;
    report.at_most("near_fell_us", near_us, 50.0, "taking over a single felled tree that stands near, median of 100");
    report.at_most("far_fell_us", far_us, 50.0, "the same, far");
    let mut plain = Game::new(ForestChanges::default())?;
    let [changed_ms, unchanged_ms] = median_frames_ms([&mut game, &mut plain]);
    report.record("frame_us_unchanged", unchanged_ms * 1e3, "all our systems, without changes, median");
    report.at_most("frame_growth", changed_ms / unchanged_ms, 1.5, "of that, with all changes; in turn");

    let start = Instant::now();
    let text = ron::to_string(game.changes()).map_err(|error| error.to_string())?;
    let save_us = start.elapsed().as_secs_f64() * 1e6;
    let start = Instant::now();
    let loaded: ForestChanges = ron::from_str(&text).map_err(|error| error.to_string())?;
    let load_us = start.elapsed().as_secs_f64() * 1e6;
    let changes = loaded.len() as f64;
    report.record("changes", changes, "stems that are not as in the plan");
    report.at_most("bytes_per_change", text.len() as f64 / changes, 64.0, "as RON text");
    report.at_most("save_us", save_us / changes, 50.0, "for each change, to RON");
    report.at_most("load_us", load_us / changes, 50.0, "for each change, from RON");

    let mut mismatches = 0;
    let mut compare = |what: &str, same: bool| {
        println!("  {what}: {}", if same { "the same" } else { "ANOTHER" });
        mismatches += u32::from(!same);
    };
    let (near, known) = (game.near_hash(), game.known_hash());
    game.walk(WALK_M)?;
    let away = game.near_hash();
    game.walk(0.0)?;
    compare("near trees after a walk of 700 m and back", game.near_hash() == near && away != near);
    game.edit_elsewhere()?;
    compare(
        "all stems and near trees after an edit of the plan elsewhere",
        (game.near_hash(), game.known_hash()) == (near, known),
    );
    drop(game);
    let mut other = Game::new(loaded)?;
    compare("all stems and near trees after loading", (other.near_hash(), other.known_hash()) == (near, known));
    // A hash that sees no change could not tell anything.
    compare("a forest without changes, which should be another", (plain.near_hash(), plain.known_hash()).1 != known);
    report.at_most("hash_mismatches", f64::from(mismatches), 0.0, "of 4 comparisons of forests, by hash");
    Ok(())
}

fn plan() -> ForestPlan {
    let stock = |species: &str, age_years| Stock { species: species.into(), age_years, ..default() };
    let area = Area {
        shape: Shape::Rectangle { min_m: [-HALF_M; 2], max_m: [HALF_M; 2] },
        density_per_ha: TREES / (2.0 * HALF_M).powi(2) * 1e4,
        stock: vec![stock("fir", 75.0), stock("oak", 95.0), stock("birch", 45.0)],
        ..default()
    };
    ForestPlan { areas: vec![area], ..default() }
}

/// A forest and one who walks in it.
struct Game {
    app: App,
    forest: Entity,
    viewer: Entity,
}

impl Game {
    fn new(changes: ForestChanges) -> Result<Self, String> {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins));
        app.finish();
        app.cleanup();
        let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan());
        let settings = ForestSettings { far_to_m: 1.5 * HALF_M, trees_to_m: 300.0, trees_per_frame: 500, ..default() };
        let forest = app.world_mut().spawn((Forest::new(plan), settings, changes)).id();
        let viewer = app.world_mut().spawn(Viewpoint).id();
        let mut game = Self { app, forest, viewer };
        game.settle()?;
        Ok(game)
    }

    fn cells(&self) -> &ForestCells {
        self.app.world().get(self.forest).expect("the forest has begun")
    }

    fn changes(&self) -> &ForestChanges {
        self.app.world().get(self.forest).expect("a forest has changes")
    }

    /// Runs frames until all that is wanted stands, and is as it is changed.
    fn settle(&mut self) -> Result<(), String> {
        let start = Instant::now();
        (0..3).for_each(|_| self.app.update());
        loop {
            self.app.update();
            let cells = self.cells();
            if cells.is_complete() && cells.is_planted() && cells.is_up_to_date() {
                return Ok(());
            }
            if start.elapsed().as_secs_f64() > TIMEOUT_S {
                return Err(format!("the forest was not ready after {TIMEOUT_S} s"));
            }
            std::thread::sleep(Duration::from_micros(200));
        }
    }

    /// A random stem of the plan that stands, and a random place.
    fn draw(&self, random: &mut Xoshiro256PlusPlus) -> Draw {
        let cells = self.cells();
        let mut place = || Vec2::new(random.random_range(-HALF_M..HALF_M), random.random_range(-HALF_M..HALF_M));
        loop {
            let found = cells.nearest_stem(place(), 30.0).filter(|stem| !stem.id.is_planted());
            if let Some(stem) = found.filter(|stem| !self.changes().is_felled(stem.id)) {
                return Draw { stem: stem.id, place_m: place() };
            }
        }
    }

    /// Makes changes in one frame. Returns the mean times of a call and of its part of the frame, and the slowest call, us.
    fn change(&mut self, draws: &[Draw], change: Change) -> Result<[f64; 3], String> {
        let forest = self.forest;
        let mut state = SystemState::<ForestEditor>::new(self.app.world_mut());
        let mut editor = state.get_mut(self.app.world_mut()).map_err(|error| error.to_string())?;
        let (mut all, mut slowest, mut refused) = (Duration::ZERO, Duration::ZERO, 0);
        for draw in draws {
            let start = Instant::now();
            let result = change(&mut editor, forest, draw);
            let time = start.elapsed();
            (all, slowest) = (all + time, slowest.max(time));
            refused += usize::from(result.is_err());
        }
        // A stem may be drawn twice.
        if refused * 50 > draws.len() {
            return Err(format!("{refused} of {} changes were refused", draws.len()));
        }
        self.app.update();
        let calls = draws.len() as f64;
        Ok([all.as_secs_f64() * 1e6 / calls, self.taking_over_us() / calls, slowest.as_secs_f64() * 1e6])
    }

    /// What the last frame has taken to take changes over, us.
    fn taking_over_us(&self) -> f64 {
        let times = self.app.world().resource::<SystemTimes>();
        let of_changes = times.iter().filter(|(name, _)| name.contains("apply_changes"));
        of_changes.map(|(_, time)| time.as_secs_f64() * 1e6).sum()
    }

    /// Medians of the times in which single felled trees are taken over, a near and a far one, us.
    fn single_changes_us(&mut self, random: &mut Xoshiro256PlusPlus) -> Result<[f64; 2], String> {
        let mut medians_us = [0.0; 2];
        for (median_us, reach_m) in medians_us.iter_mut().zip([200.0, HALF_M]) {
            let mut times_us = Vec::new();
            while times_us.len() < 100 {
                let place_m = Vec2::from_angle(random.random_range(0.0..std::f32::consts::TAU))
                    * reach_m
                    * random.random_range(0.5..1.0);
                let Some(stem) = self.cells().nearest_stem(place_m, 30.0) else { continue };
                self.app.world_mut().resource_mut::<Messages<TreeFelled>>().clear();
                let draw = Draw { stem: stem.id, place_m };
                self.change(&[draw], |editor, forest, draw| editor.fell(forest, draw.stem))?;
                times_us.push(self.taking_over_us());
                let told: Vec<_> = self.app.world_mut().resource_mut::<Messages<TreeFelled>>().drain().collect();
                if told.len() != 1 || told[0].tree.is_none() && reach_m < 300.0 {
                    return Err(format!("of {} it was told {told:?}", stem.id));
                }
                self.settle()?;
            }
            *median_us = median(&mut times_us);
        }
        Ok(medians_us)
    }

    /// Time of all our systems in a frame, ms.
    fn frame_ms(&mut self) -> f64 {
        self.app.update();
        std::thread::sleep(Duration::from_millis(1));
        self.app.world().resource::<SystemTimes>().total().as_secs_f64() * 1e3
    }

    /// Walks along x to a place, and waits there.
    fn walk(&mut self, to_m: f32) -> Result<(), String> {
        loop {
            let mut at = self.app.world_mut().get_mut::<Transform>(self.viewer).ok_or("no viewer")?;
            let left_m = to_m - at.translation.x;
            at.translation.x += left_m.clamp(-STEP_M, STEP_M);
            self.app.update();
            if left_m.abs() < 0.5 * STEP_M {
                self.settle()?;
                // Cells that nobody is near to go one in a frame.
                (0..200).for_each(|_| self.app.update());
                return Ok(());
            }
        }
    }

    /// Another area far from all others.
    fn edit_elsewhere(&mut self) -> Result<(), String> {
        let mut plans = self.app.world_mut().resource_mut::<Assets<ForestPlan>>();
        let id = plans.ids().next().ok_or("no plan")?;
        let shape = Shape::Rectangle { min_m: [HALF_M + 200.0; 2], max_m: [HALF_M + 400.0; 2] };
        plans.get_mut(id).ok_or("no plan")?.areas.push(Area { shape, ..default() });
        self.settle()
    }

    /// Hash of all near trees within reach: which they are, where, how old, of what species.
    fn near_hash(&mut self) -> u64 {
        let world = self.app.world_mut();
        let eye = world.get::<Transform>(self.viewer).map_or(Vec2::ZERO, |at| at.translation.xz());
        let mut trees = world.query::<(&StemId, &Transform, &Tree)>();
        // Beyond 300 m some stay for a while.
        let within = trees.iter(world).filter(|(_, at, _)| at.translation.xz().distance(eye) < 300.0);
        let mut rows: Vec<_> = within
            .map(|(id, at, tree)| {
                let place = at.translation.to_array().map(f32::to_bits);
                (*id, place, tree.age_years.map(f32::to_bits), tree.species.path().map(ToString::to_string))
            })
            .collect();
        rows.sort_unstable();
        hash_of(format!("{rows:?}").as_bytes())
    }

    /// Hash of all stems of the plan's square, near and far, as the store has them.
    fn known_hash(&self) -> u64 {
        let mut bytes = Vec::new();
        let store = self.cells().store();
        let within = |cell: IVec2| (cell.as_vec2() * store.cell_m()).abs().max_element() <= HALF_M + 100.0;
        for (cell, content) in store.iter().filter(|(cell, _)| within(*cell)) {
            let words = [cell.x.cast_unsigned(), cell.y.cast_unsigned()].into_iter();
            let words = words.chain(content.records().iter().flatten().copied());
            words.for_each(|word| bytes.extend(word.to_le_bytes()));
        }
        hash_of(&bytes)
    }
}

/// Median frames of some games, ms, which take turns: the speed of a machine comes and goes.
fn median_frames_ms<const GAMES: usize>(mut games: [&mut Game; GAMES]) -> [f64; GAMES] {
    let mut times_ms = [const { Vec::new() }; GAMES];
    for _ in 0..TURNS {
        for (game, times_ms) in games.iter_mut().zip(&mut times_ms) {
            times_ms.extend((0..FRAMES_A_TURN).map(|_| game.frame_ms()));
        }
    }
    times_ms.map(|mut times_ms| median(&mut times_ms))
}

fn hash_of(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write(bytes);
    hasher.finish()
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}
