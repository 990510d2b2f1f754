//! Fields in an app without a renderer.

use super::*;
use crate::{
    Viewpoint,
    grass::{GrassLook, GrassPlugin, Meadow, Sward},
};
use bevy::asset::AssetPlugin;

/// An app with a field of patches of 8 x 8 m that are seen as far as 20 m, and a viewer in the origin.
fn app() -> (App, Entity, Entity) {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default(), TransformPlugin, GrassPlugin));
    let field = app.world_mut().spawn(field()).id();
    let viewer = app.world_mut().spawn((Viewpoint, Transform::from_xyz(0.0, 1.7, 0.0))).id();
    settle(&mut app, field);
    (app, field, viewer)
}

fn field() -> GrassField {
    let sward = Sward { width_m: 8.0, depth_m: 8.0, tufts_per_m2: 0.2, seed: 5, ..Sward::default() };
    let look = GrassLook { vanishes_at_m: 20.0, thins_from_m: 10.0, ..GrassLook::default() };
    GrassField { patch: GrassPatch { sward, look, ..GrassPatch::default() }, patches_per_frame: 6 }
}

/// Updates until every patch is there with its blades.
fn settle(app: &mut App, field: Entity) {
    for _ in 0..10_000 {
        app.update();
        let world = app.world();
        let patches = world.get::<GrassFieldPatches>(field).expect("the field has patches");
        if patches.is_complete() && patches.iter().all(|patch| world.get::<Meadow>(patch).is_some()) {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    panic!("the field did not settle");
}

/// All roots in the world, in the order of their patches.
fn roots_m(app: &App, field: Entity) -> Vec<Vec3> {
    let world = app.world();
    let patches = world.get::<GrassFieldPatches>(field).expect("the field has patches");
    let of_patch = |patch: Entity| {
        let at = world.get::<Transform>(patch).expect("it has a place").translation;
        let meadow = world.get::<Meadow>(patch).expect("it has blades");
        meadow.blades.iter().map(move |blade| blade.root + at).collect::<Vec<_>>()
    };
    patches.iter().flat_map(of_patch).collect()
}

fn patch_count(app: &mut App) -> usize {
    let world = app.world_mut();
    world.query::<&GrassPatch>().iter(world).count()
}

fn walk_to(app: &mut App, field: Entity, viewer: Entity, x_m: f32) {
    app.world_mut().entity_mut(viewer).insert(Transform::from_xyz(x_m, 1.7, 0.0));
    // The place in the world follows one update later.
    app.update();
    settle(app, field);
}

#[test]
fn grass_is_about_the_viewer_wherever_he_goes_and_the_same_when_he_returns() {
    let (mut app, field, viewer) = app();
    let before = roots_m(&app, field);
    assert!(before.iter().any(|root| root.x > 12.0) && before.iter().all(|root| root.xz().length() < 20.0 + 12.0));
    let count = patch_count(&mut app);
    walk_to(&mut app, field, viewer, 3000.0);
    let there = roots_m(&app, field);
    assert!(there.iter().all(|root| (root.x - 3000.0).abs() < 32.0) && there.len() > before.len() / 2);
    assert!(patch_count(&mut app) <= count + 6, "patches are left behind");
    walk_to(&mut app, field, viewer, 0.0);
    assert_eq!(roots_m(&app, field), before);
}

#[test]
fn no_two_patches_are_alike() {
    let (app, field, _) = app();
    let patches = app.world().get::<GrassFieldPatches>(field).expect("the field has patches");
    let first = |patch: Entity| app.world().get::<Meadow>(patch).expect("it has blades").blades[0].azimuth_rad;
    let mut azimuths: Vec<u32> = patches.iter().map(|patch| first(patch).to_bits()).collect();
    azimuths.sort_unstable();
    azimuths.dedup();
    assert_eq!(azimuths.len(), patches.iter().count());
}

#[test]
fn it_follows_its_ground() {
    let (mut app, field, _) = app();
    fn slope(at: DVec2) -> f64 {
        if at.x > 4.0 { f64::NAN } else { 0.25 * at.x + 0.1 * at.y }
    }
    app.world_mut().entity_mut(field).insert(GrassGround(Arc::new(slope)));
    app.update();
    settle(&mut app, field);
    let other = |at: DVec2| slope(at) + 2.0;
    app.world_mut().entity_mut(field).insert(GrassGround(Arc::new(other)));
    app.update();
    settle(&mut app, field);
    let roots = roots_m(&app, field);
    assert!(!roots.is_empty() && roots.iter().all(|root| root.x <= 4.0));
    assert!(roots.iter().all(|root| (root.y - (0.25 * root.x + 0.1 * root.z + 2.0)).abs() < 1e-3));
}

#[test]
fn settings_out_of_range_leave_the_last_good_field() {
    let (mut app, field, _) = app();
    let before = roots_m(&app, field);
    let mut wrong = self::field();
    wrong.patch.look.vanishes_at_m = 500.0;
    let error = wrong.validate().expect_err("60 patches to each side").to_string();
    assert_eq!(error, "`patch.look.vanishes_at_m` is 500, but must be 1 to 128");
    app.world_mut().entity_mut(field).insert(wrong);
    app.update();
    settle(&mut app, field);
    assert_eq!(roots_m(&app, field), before);
}

#[test]
fn what_the_component_made_goes_with_it() {
    let (mut app, field, _) = app();
    app.world_mut().entity_mut(field).remove::<GrassField>();
    app.update();
    assert_eq!(patch_count(&mut app), 0);
    assert!(app.world().get::<GrassFieldPatches>(field).is_none());
    app.world_mut().entity_mut(field).insert(self::field());
    settle(&mut app, field);
    assert!(patch_count(&mut app) > 0);
}

#[test]
fn a_change_of_look_keeps_every_blade_and_entity() {
    let (mut app, field, _) = app();
    let entities = |app: &App| -> Vec<Entity> {
        app.world().get::<GrassFieldPatches>(field).expect("the field has patches").iter().collect()
    };
    let (before, roots) = (entities(&app), roots_m(&app, field));
    app.world_mut().get_mut::<GrassField>(field).expect("it is there").patch.look.translucency = 0.9;
    settle(&mut app, field);
    assert_eq!((entities(&app), roots_m(&app, field)), (before, roots));
}
