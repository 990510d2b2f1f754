//! Forests of no cell, of one, and of ten million trees.

use super::{
    birches, edit, places,
    server::{server_app, shipped_assets},
    settle, spawn_forest,
};
use bevy::prelude::*;
use bevy_windwood::{
    forest::ForestCells,
    prelude::*,
    scatter::{ForestPlan, Planter},
};
use std::{f32::consts::PI, time::Duration};

fn cells(app: &App, forest: Entity) -> &ForestCells {
    app.world().get::<ForestCells>(forest).expect("it has begun")
}

fn replace_plan(app: &mut App, plan: ForestPlan) {
    let mut plans = app.world_mut().resource_mut::<Assets<ForestPlan>>();
    let id = plans.ids().next().expect("the plan");
    plans.insert(id, plan).expect("the handle lives");
}

#[test]
fn a_forest_of_no_cell_is_complete_and_may_become_one_of_one_cell() {
    let mut app = server_app(&shipped_assets(), Duration::ZERO);
    app.world_mut().spawn((Viewpoint, WindListener::default()));
    let none = || ForestPlan { areas: Vec::new(), ..birches(10.0, 100.0) };
    assert_eq!(Planter::new(&none()).expect("a valid plan").cells(), None);
    let forest = spawn_forest(&mut app, none(), [100.0, 200.0]);
    settle(&mut app, forest);
    assert!(places(&mut app).is_empty() && cells(&app, forest).store().plants() == 0);
    assert!(edit(&mut app, |editor| editor.nearest(Vec2::ZERO, 1e4).is_none()));
    // Nothing can be planted, since the plan has no species.
    let stem = NewStem { place_m: Vec2::ONE, species: "birch".into(), age_years: 2.0 };
    assert!(edit(&mut app, |editor| editor.plant(forest, &stem)).is_err());

    // One cell, from its corner on.
    let mut one = birches(10.0, 900.0);
    one.areas[0].shape = bevy_windwood::scatter::plan::Shape::Rectangle { min_m: [1.0; 2], max_m: [31.0; 2] };
    assert_eq!(Planter::new(&one).expect("a valid plan").cells(), Some([IVec2::ZERO; 2]));
    replace_plan(&mut app, one);
    settle(&mut app, forest);
    let trees = places(&mut app);
    assert!((40..140).contains(&trees.len()), "{} trees", trees.len());
    assert!(trees.iter().all(|at| (1.0..=31.0).contains(&at.x) && (1.0..=31.0).contains(&at.z)));
    let (of, stem) = edit(&mut app, |editor| editor.nearest(Vec2::ZERO, 1e4)).expect("a tree");
    edit(&mut app, |editor| editor.fell(of, stem.id)).expect("it stands");
    settle(&mut app, forest);
    assert_eq!(places(&mut app).len(), trees.len() - 1);

    replace_plan(&mut app, none());
    settle(&mut app, forest);
    (0..10).for_each(|_| app.update());
    assert!(places(&mut app).is_empty() && cells(&app, forest).store().plants() == 0);
}

#[test]
fn a_forest_that_reaches_nowhere_has_no_trees() {
    let mut app = server_app(&shipped_assets(), Duration::ZERO);
    app.world_mut().spawn((Viewpoint, Transform::from_xyz(1000.0, 0.0, 0.0)));
    let forest = spawn_forest(&mut app, birches(500.0, 100.0), [0.0, 0.0]);
    settle(&mut app, forest);
    assert!(places(&mut app).is_empty());
}

/// 20 km x 20 km with 250 trees a hectare. Only what is near to the viewers is ever planted.
#[test]
fn a_plan_of_ten_million_trees_costs_what_is_seen_of_it() {
    const SIDE_M: f32 = 20_000.0;
    const PER_HA: f32 = 250.0;
    const KNOWN_M: f32 = 800.0;
    let plan = birches(SIDE_M, PER_HA);
    assert_eq!(SIDE_M * SIDE_M * 1e-4 * PER_HA, 1e7);
    let mut app = server_app(&shipped_assets(), Duration::ZERO);
    let viewer = app.world_mut().spawn(Viewpoint).id();
    let forest = spawn_forest(&mut app, plan, [60.0, KNOWN_M]);
    let within = |radius_m: f32| PI * radius_m * radius_m * 1e-4 * PER_HA;
    let mut first = None;
    // To the far corners, and back.
    for [x, z] in [[0.0, 0.0], [9000.0, 9000.0], [-9000.0, 4000.0], [123.0, -9100.0], [0.0, 0.0]] {
        *app.world_mut().get_mut::<Transform>(viewer).expect("a viewer") = Transform::from_xyz(x, 2.0, z);
        settle(&mut app, forest);
        // What is left behind goes a few cells a frame.
        (0..500).for_each(|_| app.update());
        let (near, known) = (places(&mut app), cells(&app, forest).store().plants() as f32);
        let eye = Vec2::new(x, z);
        let in_reach = near.iter().filter(|at| at.xz().distance(eye) <= 60.0).count() as f32;
        assert!((in_reach / within(60.0) - 1.0).abs() < 0.25, "{in_reach} trees within 60 m of {eye}");
        assert!((1.0..1.9).contains(&(known / within(KNOWN_M))), "{known} stems are known at {eye}");
        let mut sorted: Vec<[u32; 3]> = near.iter().map(|at| at.to_array().map(f32::to_bits)).collect();
        sorted.sort_unstable();
        if eye == Vec2::ZERO {
            assert_eq!(*first.get_or_insert(sorted.clone()), sorted, "the same trees after the way");
        }
    }
}
