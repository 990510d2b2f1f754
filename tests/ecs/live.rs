//! Trees that a game touches: they wake, move and sleep again.

use super::*;
use bevy_windwood::{
    dynamics::{BeamSway, FrequencyClasses},
    sway::{SwaySettings, TreePose},
};
use std::f32::consts::TAU;

/// In a calm, so that nothing else moves.
fn calm_app() -> App {
    let mut app = app();
    app.world_mut().resource_mut::<Wind>().speed = 0.0;
    wait_for_wind(&mut app);
    app
}

fn is_awake(app: &App, tree: Entity) -> bool {
    app.world().get::<LiveSway>(tree).is_some()
}

/// Frames in which a bend of a radian dies down to a hundred thousandth of that in the slowest mode of a tree's beams, as `exp(-zeta w t)`
/// where wood alone damps it. It is in leaf, and its beams have rounded frequencies, which are off by a tenth at most.
fn frames_to_rest(app: &App, tree: Entity) -> usize {
    let grown = app.world().get::<Grown>(tree).expect("it is grown");
    let model = app.world().resource::<Assets<TreeModel>>().get(&grown.model).expect("its model is there");
    let slowest_class = |sway: &BeamSway| {
        let second = sway.class + if sway.second.share > 0.0 { sway.second.class_offset } else { 0.0 };
        sway.class.min(second)
    };
    let class = model.beams.iter().map(|beam| slowest_class(&beam.in_leaf)).fold(f32::INFINITY, f32::min);
    let slowest_hz = FrequencyClasses::default().frequency_at_hz(class.max(0.0));
    let time_s = 1e5_f32.ln() / (SwaySettings::default().damping_ratio * TAU * slowest_hz);
    (1.1 * time_s / FRAME_S) as usize
}

/// Updates until the tree sleeps, with the tip of its stem at rest. Returns the farthest that it came from there.
fn farthest_until_asleep(app: &mut App, tree: Entity, rest: Vec3) -> f32 {
    let mut farthest_m = 0.0_f32;
    for _ in 0..frames_to_rest(app, tree) {
        app.update();
        farthest_m = farthest_m.max(stem_tip(app).distance(rest));
        if !is_awake(app, tree) {
            app.update();
            assert!(stem_tip(app).distance(rest) < 1e-6, "a tree that sleeps is where the wind alone has it");
            return farthest_m;
        }
    }
    panic!("the tree does not come to rest");
}

#[test]
fn a_struck_tree_sways_and_sleeps_again() {
    let mut app = calm_app();
    let tree = plant(&mut app, "birch", Vec3::new(4.0, 1.0, 2.0));
    let other = plant(&mut app, "birch", Vec3::new(14.0, 1.0, 2.0));
    app.world_mut().entity_mut(tree).insert(only_the_trunk());
    wait_for_trees(&mut app);
    app.update();
    assert!(!is_awake(&app, tree));
    let rest = stem_tip(&mut app);
    let blow = TreeImpulse { tree, place: Vec3::new(4.0, 4.0, 2.0), impulse_n_s: Vec3::X * 600.0 };
    app.world_mut().write_message(blow);
    app.update();
    assert!(is_awake(&app, tree) && !is_awake(&app, other));
    let farthest_m = farthest_until_asleep(&mut app, tree, rest);
    assert!(farthest_m > 0.02 && farthest_m < 5.0, "{farthest_m} m");
    assert!(app.world().get::<TreePose>(tree).is_some(), "it is still articulated");
}

#[test]
fn a_blast_wakes_what_is_near_and_lets_the_rest_sleep() {
    let mut app = calm_app();
    let near = plant(&mut app, "fir", Vec3::new(0.0, 0.0, 0.0));
    let far = plant(&mut app, "fir", Vec3::new(0.0, 0.0, 500.0));
    app.world_mut().entity_mut(near).insert(only_the_trunk());
    wait_for_trees(&mut app);
    app.update();
    let blast = WindSource::new(SourceKind::Blast { charge_kg: 300.0 });
    app.world_mut().spawn((blast, Transform::from_xyz(25.0, 1.0, 0.0)));
    let rest = stem_tip(&mut app);
    let mut woken = false;
    let mut lean_m = Vec3::ZERO;
    for _ in 0..10 {
        app.update();
        woken |= is_awake(&app, near);
        lean_m = lean_m.min(stem_tip(&mut app) - rest);
        assert!(!is_awake(&app, far));
    }
    assert!(woken && lean_m.x < -0.02, "it leans away from the blast, by {lean_m}");
    farthest_until_asleep(&mut app, near, rest);
}

#[test]
fn a_fan_bends_a_tree_for_as_long_as_it_blows() {
    let mut app = calm_app();
    let tree = plant(&mut app, "birch", Vec3::ZERO);
    app.world_mut().entity_mut(tree).insert(only_the_trunk());
    let cell = app.world_mut().spawn((WindCell::above(0.0), Transform::from_xyz(0.0, 8.0, 0.0))).id();
    wait_for_trees(&mut app);
    app.update();
    let rest = stem_tip(&mut app);
    let kind = SourceKind::Cone { speed_m_s: 20.0, nozzle_radius_m: 4.0, half_angle_deg: 15.0 };
    let behind = Transform::from_xyz(-12.0, 8.0, 0.0).looking_to(Vec3::X, Vec3::Y);
    app.world_mut().spawn((WindSource::new(kind).with_duration(20.0), behind));
    (0..590).for_each(|_| app.update());
    let velocity = app.world().get::<WindCell>(cell).expect("it is there").velocity;
    assert!(velocity.x > 8.0 && velocity.x < 20.0, "{velocity}");
    let leaning = stem_tip(&mut app) - rest;
    assert!(leaning.x > 0.02 && leaning.z.abs() < 0.1 * leaning.x, "{leaning}");
    assert!(is_awake(&app, tree));
    farthest_until_asleep(&mut app, tree, rest);
}

#[test]
fn a_walker_parts_a_hazel_and_leaves_it_as_it_was() {
    let mut app = calm_app();
    let hazel = plant(&mut app, "hazel", Vec3::ZERO);
    wait_for_trees(&mut app);
    let walker = app.world_mut().spawn((Pusher::default(), Transform::from_xyz(-6.0, 0.9, 0.4))).id();
    app.update();
    assert!(!is_awake(&app, hazel), "it is not yet there");
    let mut most_rad = 0.0_f32;
    for _ in 0..120 {
        app.world_mut().get_mut::<Transform>(walker).expect("it is there").translation.x += 1.5 * FRAME_S;
        app.update();
        let live = app.world().get::<LiveSway>(hazel);
        most_rad = live.into_iter().flat_map(LiveSway::angles).map(Vec3A::length).fold(most_rad, f32::max);
    }
    assert!(most_rad > 0.1, "its branches bend by {most_rad} rad");
    app.world_mut().get_mut::<Transform>(walker).expect("it is there").translation.x = 100.0;
    (0..900).for_each(|_| app.update());
    assert!(!is_awake(&app, hazel) && app.world().get::<TreePose>(hazel).is_none());
}

#[test]
fn a_tree_that_goes_while_it_is_touched_is_forgotten() {
    let mut app = calm_app();
    let tree = plant(&mut app, "hazel", Vec3::ZERO);
    wait_for_trees(&mut app);
    app.world_mut().spawn((Pusher::sphere(2.0), Transform::from_xyz(0.0, 1.0, 0.0)));
    app.world_mut().spawn(WindSource::default());
    (0..3).for_each(|_| app.update());
    assert!(is_awake(&app, tree));
    app.world_mut().write_message(TreeImpulse { tree, place: Vec3::Y, impulse_n_s: Vec3::X });
    app.world_mut().despawn(tree);
    (0..3).for_each(|_| app.update());
}
