//! Nothing is lost, and what is asked and told is seen: driven by events.

use super::desk::Desk;
use crate::editor::{
    document_file::OnDisk,
    file_session::{FileSession, Message, Question},
    session::Session,
    steps::Steps,
    ui::{Panel, dialogs::Dialog},
};
use crate::tree::Species;
use std::{fs, path::PathBuf};

#[test]
fn work_that_goes_on_is_cancelled_by_its_button() {
    let mut desk = Desk::new("oak");
    desk.tree.is_growing = true;
    desk.frame(Vec::new());
    desk.frame(Vec::new());
    let at = desk.find(bevy_egui::egui::accesskit::Role::Button, "Cancel").center();
    assert!(desk.press_and_see(at).cancelled.growing);
    (desk.tree.is_growing, desk.is_exporting) = (false, true);
    desk.frame(Vec::new());
    desk.frame(Vec::new());
    let at = desk.find(bevy_egui::egui::accesskit::Role::Button, "Cancel").center();
    assert!(desk.press_and_see(at).cancelled.exporting);
}

#[test]
fn a_broken_file_is_told_in_the_status_bar_and_the_old_tree_stays() {
    let mut desk = Desk::new("oak");
    let original = desk.session.document().clone();
    let broken = desk.session.path().with_file_name("broken.species.ron");
    fs::write(&broken, "(name: ").unwrap();
    desk.session.open_another(&broken);
    desk.frame(Vec::new());
    let texts = desk.texts();
    assert!(texts.iter().any(|text| text.contains("broken.species.ron")), "{texts:?}");
    assert_eq!(*desk.session.document(), original);
}

#[test]
fn what_is_wrong_is_told_over_the_fields_and_can_be_undone() {
    let mut desk = Desk::new("oak");
    let original = desk.session.document().clone();
    desk.session.change(Species { variants: 99, ..original.clone() }, "Variants");
    desk.frame(Vec::new());
    let told = |desk: &Desk| desk.texts().iter().any(|text| text.contains("`variants` is 99"));
    assert!(told(&desk));
    desk.press("Undo");
    assert!(!told(&desk) && *desk.session.document() == original);
}

#[test]
fn a_change_by_another_program_is_told_and_read_again() {
    let mut desk = Desk::new("oak");
    let text = fs::read_to_string(desk.session.path()).unwrap();
    fs::write(desk.session.path(), text.replace("variants: 4", "variants: 2")).unwrap();
    desk.session.look_at_disk();
    assert_eq!(desk.session.on_disk(), OnDisk::Changed);
    desk.frame(Vec::new());
    desk.frame(Vec::new());
    assert!(desk.texts().iter().any(|text| text.contains("Another program")));
    desk.press("Read it again");
    assert_eq!((desk.session.document().variants, desk.session.on_disk()), (2, OnDisk::AsKnown));
    // Saving over such a change is asked about first.
    desk.press("Randomise");
    fs::write(desk.session.path(), &text).unwrap();
    desk.press("Save");
    assert_eq!(desk.session.question, Some(Question::Overwrite));
    desk.frame(Vec::new());
    desk.press("Cancel");
    assert_eq!(fs::read_to_string(desk.session.path()).unwrap(), text);
    desk.press("Save");
    desk.frame(Vec::new());
    desk.press("Overwrite");
    assert_eq!(Species::from_ron(&fs::read_to_string(desk.session.path()).unwrap()).unwrap(), *desk.session.document());
}

/// A program that is killed leaves what it has kept beside the file. The next one offers it.
#[test]
fn an_autosave_is_offered_after_a_crash() {
    for is_wanted in [true, false] {
        let mut desk = Desk::new("oak");
        desk.press("Randomise");
        let work = desk.session.document().clone();
        desk.session.keep();
        let path = desk.session.path().to_owned();
        // Nothing of the session runs any more when it is killed.
        std::mem::forget(std::mem::replace(&mut desk.session, Session::open(&path).unwrap()));
        let saved = desk.session.saved().clone();
        for _ in 0..3 {
            desk.frame(Vec::new());
        }
        assert!(desk.texts().iter().any(|text| text.contains("ended before changes")));
        desk.press(if is_wanted { "Restore" } else { "Forget it" });
        assert_eq!(*desk.session.document(), if is_wanted { work } else { saved.clone() });
        if is_wanted {
            assert_eq!(desk.session.undo_step(), Some("Restore unsaved work"));
            desk.press("Undo");
            assert_eq!(*desk.session.document(), saved);
        } else {
            assert_eq!(Session::<Species>::open(&path).unwrap().question, None);
        }
    }
}

/// Where a file cannot be written, the old one stays, and the panel tells why.
#[test]
fn what_cannot_be_written_is_told_and_the_old_file_stays() {
    let mut desk = Desk::new("oak");
    let text = fs::read_to_string(desk.session.path()).unwrap();
    desk.press("Randomise");
    assert!(!desk.session.save_to(Some(&PathBuf::from("/proc/oak.species.ron"))));
    let Some(Message::Failed(error)) = desk.session.message.clone() else { panic!("{:?}", desk.session.message) };
    desk.frame(Vec::new());
    assert!(desk.texts().iter().any(|told| told.contains("/proc/oak.species.ron")), "{error}");
    assert_eq!(fs::read_to_string(desk.session.path()).unwrap(), text);
    assert!(desk.session.is_changed(), "the work is not lost");
}

/// Undoing in the panels of the wind and the levels leaves the species alone.
#[test]
fn each_panel_undoes_what_is_its_own() {
    let mut desk = Desk::new("oak");
    desk.press("Randomise");
    let species = desk.session.document().clone();
    desk.open(Panel::Wind);
    let wind = desk.wind.value().clone();
    desk.wind.change(crate::wind::Wind { speed: 20.0, ..wind.clone() }, "Speed");
    desk.wind.end_gesture();
    desk.key(bevy_egui::egui::Modifiers::COMMAND, bevy_egui::egui::Key::Z);
    assert_eq!((desk.wind.value(), desk.session.document()), (&wind, &species));
    desk.key(bevy_egui::egui::Modifiers::COMMAND, bevy_egui::egui::Key::Z);
    assert_eq!(*desk.session.document(), species);
}

#[test]
fn an_export_is_asked_for_by_its_button() {
    if !cfg!(feature = "export") {
        return;
    }
    let mut desk = Desk::new("oak");
    desk.press("Export…");
    let Some(Dialog::Export(field)) = &desk.state.dialog else { panic!("{:?}", desk.state.dialog) };
    let path = field.path.clone();
    assert!(path.ends_with("oak.glb"));
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    let at = desk.find(bevy_egui::egui::accesskit::Role::Button, "Export").center();
    assert_eq!(desk.press_and_see(at).export_to, Some(path.into()));
}
