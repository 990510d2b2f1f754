use super::*;
use crate::WindwoodMinimalPlugins;

const MIXED: &str = include_str!("../../../../assets/forests/mixed.forest.ron");

/// An app without a renderer in which a wood is edited and grows.
fn app() -> (tempfile::TempDir, App) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mixed.forest.ron");
    std::fs::write(&path, MIXED).unwrap();
    let mut workbench = Workbench::new(None, Some(&path), None, true);
    workbench.panel = Panel::Woods;
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins))
        .insert_resource(workbench)
        .init_resource::<AppliedPlan>()
        .add_systems(Update, (apply_plan, count_quadrats).before(crate::schedule::WindwoodSystems::Stream))
        .add_systems(PostUpdate, note_woods);
    app.finish();
    app.cleanup();
    app.update();
    let handle = app.world().resource::<AppliedPlan>().handle.clone();
    app.world_mut()
        .spawn((Forest::new(handle), crate::forest::ForestSettings { trees_to_m: 0.0, far_to_m: 300.0, ..default() }));
    app.world_mut().spawn((crate::Viewpoint, Transform::default(), GlobalTransform::default()));
    (folder, app)
}

fn wait(app: &mut App, mut is_there: impl FnMut(&Workbench) -> bool) {
    for _ in 0..5000 {
        app.update();
        if is_there(app.world().resource::<Workbench>()) {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    let workbench = app.world().resource::<Workbench>();
    let (land, error) = (&workbench.land, workbench.woods.session.error());
    panic!("{} stems, growing: {}, {:?}, {error:?}", land.stems, land.is_growing, land.histogram);
}

fn change(app: &mut App, change: impl FnOnce(&mut ForestPlan)) {
    let mut workbench = app.world_mut().resource_mut::<Workbench>();
    let mut plan = workbench.woods.plan().clone();
    change(&mut plan);
    workbench.woods.session.change(plan, "test");
}

fn is_grown(workbench: &Workbench) -> bool {
    !workbench.land.is_growing && workbench.land.stems > 0
}

#[test]
fn a_changed_plan_grows_and_its_quadrats_are_counted() {
    let (_folder, mut app) = app();
    wait(&mut app, is_grown);
    wait(&mut app, |workbench| matches!(workbench.land.histogram, Some(Ok(_))));
    let before = app.world().resource::<Workbench>().land.stems;
    assert_eq!(app.world().resource::<Workbench>().land.planted_share, None);
    change(&mut app, |plan| plan.areas[0].density_per_ha = 90.0);
    wait(&mut app, |workbench| workbench.land.planted_share.is_some_and(|share| (0.0..1.0).contains(&share)));
    wait(&mut app, |workbench| is_grown(workbench) && workbench.land.stems < before * 3 / 4);
    wait(
        &mut app,
        |workbench| matches!(&workbench.land.histogram, Some(Ok(histogram)) if (histogram.law_mean - 90.0 * 0.0144).abs() < 1e-3),
    );
}

#[test]
fn a_plan_that_is_not_valid_leaves_the_last_good_forest() {
    let (_folder, mut app) = app();
    wait(&mut app, is_grown);
    let before = app.world().resource::<Workbench>().land.stems;
    change(&mut app, |plan| plan.areas[0].density_per_ha = -1.0);
    for _ in 0..30 {
        app.update();
    }
    let workbench = app.world().resource::<Workbench>();
    assert_eq!((workbench.land.stems, workbench.land.is_growing), (before, false));
    assert!(workbench.woods.session.error().is_some());
    let plan = app.world().resource::<Assets<ForestPlan>>().iter().next().unwrap().1;
    assert_eq!(plan.areas[0].density_per_ha, 180.0);
}
