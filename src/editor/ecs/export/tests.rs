use super::*;
use crate::tree::SpeciesModels;
use std::time::Duration;

/// An app without a renderer in which a young oak is edited.
fn app() -> (tempfile::TempDir, App) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("oak.species.ron");
    std::fs::write(&path, include_str!("../../../../assets/species/oak.species.ron")).unwrap();
    let mut workbench = Workbench::new(Some(path.as_path()), None, None, true);
    workbench.stage.age_share = 0.03;
    let mut app = App::new();
    app.add_plugins(TaskPoolPlugin::default())
        .insert_resource(workbench)
        .init_resource::<Exporting>()
        .init_resource::<Season>()
        .init_resource::<ActiveSway>()
        .insert_resource(Assets::<TreeModel>::default())
        .init_resource::<SpeciesModels>()
        .add_systems(Update, export_tree);
    (folder, app)
}

/// Asks for an export, and waits for what is told of it.
fn export(app: &mut App, path: &Path, is_cancelled: bool) -> Message {
    let mut workbench = app.world_mut().resource_mut::<Workbench>();
    (workbench.session.message, workbench.export_to) = (None, Some(path.to_owned()));
    app.update();
    app.world_mut().resource_mut::<Workbench>().is_export_cancelled = is_cancelled;
    for _ in 0..30_000 {
        app.update();
        let workbench = app.world().resource::<Workbench>();
        if let Some(message) = &workbench.session.message {
            assert!(!workbench.is_exporting);
            return message.clone();
        }
        assert!(workbench.is_exporting);
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("nothing was told");
}

#[test]
fn a_tree_is_exported_and_a_cancelled_one_is_not() {
    let (folder, mut app) = app();
    let path = folder.path().join("oak.glb");
    assert_eq!(export(&mut app, &path, true), Message::Done("The export was cancelled".into()));
    assert!(!path.exists());
    let Message::Done(told) = export(&mut app, &path, false) else { panic!("it failed") };
    assert!(told.contains("oak.glb"), "{told}");
    assert_eq!(&std::fs::read(&path).unwrap()[..4], b"glTF");
}

#[test]
fn a_file_that_cannot_be_written_is_told() {
    let (folder, mut app) = app();
    let Message::Failed(told) = export(&mut app, &folder.path().join("nowhere/oak.glb"), false) else {
        panic!("it was written")
    };
    assert!(told.contains("nowhere"), "{told}");
}
