use super::*;
use crate::{editor::ground_desk::GroundKind, editor::ui::Panel, terrain::TurningBandsSettings};
use bevy::math::DVec2;

/// An app without a renderer in which ground is edited.
fn app(has_turntable: bool) -> App {
    let mut workbench = Workbench::new(None, None, None, has_turntable);
    workbench.panel = Panel::Ground;
    let mut app = App::new();
    app.add_plugins(TaskPoolPlugin::default())
        .insert_resource(workbench)
        .init_resource::<BuiltGround>()
        .add_systems(Update, (fit_map, build_ground, raise_ground).chain());
    app
}

fn wait(app: &mut App, mut is_there: impl FnMut(&mut World) -> bool) {
    for _ in 0..30_000 {
        app.update();
        if is_there(app.world_mut()) {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("it did not come");
}

fn height_m(world: &mut World) -> Option<f64> {
    let mut terrains = world.query::<&Terrain>();
    terrains.iter(world).next().map(|terrain| terrain.ground.height_m(DVec2::new(10.0, 20.0)))
}

#[test]
fn changed_ground_is_built_and_takes_the_place_of_the_terrain() {
    let mut app = app(true);
    wait(&mut app, |world| height_m(world).is_some());
    let wanted = TurningBandsSettings { mean_m: 500.0, ..TurningBandsSettings::default() };
    let expected = TurningBands::new(&wanted).unwrap().height_m(DVec2::new(10.0, 20.0));
    app.world_mut().resource_mut::<Workbench>().ground.random.change(wanted, "test");
    wait(&mut app, |world| height_m(world) == Some(expected));
    let world = app.world_mut();
    assert_eq!(world.query::<&Terrain>().iter(world).count(), 1);
    assert!(world.resource::<Workbench>().land.variogram.is_some());
    // What is not valid leaves the last good ground.
    let wrong = TurningBandsSettings { lines: 1, ..TurningBandsSettings::default() };
    world.resource_mut::<Workbench>().ground.random.change(wrong, "test");
    (0..20).for_each(|_| app.update());
    assert_eq!(height_m(app.world_mut()), Some(expected));
}

#[test]
fn a_games_terrain_stays_until_it_is_asked_for() {
    let mut app = app(false);
    app.world_mut().spawn(Terrain::new(|_: DVec2| 7.0));
    wait(&mut app, |world| world.resource::<BuiltGround>().ground.is_some());
    assert_eq!(height_m(app.world_mut()), Some(7.0));
    app.world_mut().resource_mut::<Workbench>().ground.is_shown = true;
    wait(&mut app, |world| height_m(world) != Some(7.0));
}

#[test]
fn a_map_is_fitted_in_the_background() {
    let mut app = app(true);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/terrain/rmnp-dem-16bit.png").to_owned();
    let ground = &mut app.world_mut().resource_mut::<Workbench>().ground;
    ground.request =
        crate::editor::map_fit::MapRequest { path, cell_x_m: 233.0, cell_z_m: 234.0, metres_per_unit: 1.0 };
    ground.kind = GroundKind::Map;
    ground.fitting = Fitting::Wanted;
    app.update();
    assert!(matches!(app.world().resource::<Workbench>().ground.fitting, Fitting::Running(_)));
    wait(&mut app, |world| world.resource::<Workbench>().ground.fit.is_some());
    wait(&mut app, |world| height_m(world).is_some_and(|height_m| height_m > 2000.0));
}
