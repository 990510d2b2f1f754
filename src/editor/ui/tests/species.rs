//! The panel of a species, driven by events.

use super::desk::Desk;
use crate::{
    editor::{
        envelope_handles::envelope_of,
        file_session::FileSession,
        steps::Steps,
        ui::{Panel, dialogs::Dialog, theme::PANEL_WIDTH},
    },
    tree::{Growth, Species},
};
use bevy_egui::egui::{Event, Key, Modifiers, Rect, accesskit::Role, pos2, vec2};
use std::fs;

/// Every slider in sight is dragged, one step each; then all is taken back.
#[test]
fn every_slider_changes_the_species_and_is_undone() {
    let mut desk = Desk::new("impression_summer");
    let original = desk.session.document().clone();
    let bytes = fs::read(desk.session.path()).unwrap();
    let panel = Rect::from_min_max(pos2(0.0, 160.0), pos2(PANEL_WIDTH, 660.0));
    let sliders: Vec<(String, Rect)> = desk
        .nodes()
        .into_iter()
        .filter(|(role, _, at)| *role == Role::Slider && panel.contains_rect(*at))
        .map(|(_, name, at)| (name, at))
        .collect();
    assert!(sliders.len() > 8, "{sliders:?}");
    for (number, (name, at)) in sliders.iter().enumerate() {
        let before = desk.session.document().clone();
        let [from, to] = [0.3, 0.6].map(|share| at.left_center() + vec2(share * at.width(), 0.0));
        let way: Vec<_> = (0..=4).map(|step| from.lerp(to, 0.25 * step as f32)).collect();
        desk.drag(&way);
        assert_ne!(*desk.session.document(), before, "{name}");
        let mut steps = 0;
        while desk.session.undo_step().is_some() {
            desk.session.undo();
            steps += 1;
        }
        assert_eq!(steps, number + 1, "a drag of {name} is one step");
        (0..steps).for_each(|_| desk.session.redo());
    }
    (0..sliders.len()).for_each(|_| desk.key(Modifiers::COMMAND, Key::Z));
    assert_eq!(*desk.session.document(), original);
    desk.key(Modifiers::COMMAND, Key::S);
    assert_eq!(fs::read(desk.session.path()).unwrap(), bytes);
}

#[test]
fn fields_are_found_by_their_letters_and_reset() {
    let mut desk = Desk::new("oak");
    desk.state.filter = "density".into();
    desk.frame(Vec::new());
    let slider = desk.find(Role::Slider, "Density");
    desk.click(slider.left_center() + vec2(0.9 * slider.width(), 0.0));
    assert!(desk.session.document().wood.density_kg_m3 > 1500.0);
    assert!(desk.session.is_changed());
    desk.press("Reset Density");
    assert_eq!(desk.session.document().wood.density_kg_m3, 1000.0);
    desk.state.filter = "no such field".into();
    desk.frame(Vec::new());
    assert!(
        desk.nodes().iter().all(|(role, name, at)| *role != Role::Slider || at.left() > PANEL_WIDTH || name.is_empty())
    );
}

#[test]
fn buttons_of_the_session_do_what_they_say() {
    let mut desk = Desk::new("oak");
    let original = desk.session.document().clone();
    desk.press("Randomise");
    assert_ne!(*desk.session.document(), original);
    desk.press("Undo");
    assert_eq!(*desk.session.document(), original);
    desk.press("Redo");
    assert_ne!(*desk.session.document(), original);
    desk.press("Save");
    assert_eq!(Species::from_ron(&fs::read_to_string(desk.session.path()).unwrap()).unwrap(), *desk.session.document());
    assert!(!desk.session.is_changed());
}

#[test]
fn files_are_opened_and_saved_by_dialogs_and_broken_ones_are_told() {
    let mut desk = Desk::new("oak");
    let folder = desk.session.path().parent().unwrap().to_owned();
    fs::write(folder.join("broken.species.ron"), "(name: ").unwrap();
    desk.key(Modifiers::COMMAND, Key::O);
    assert!(matches!(desk.state.dialog, Some(Dialog::Open(_))));
    desk.press("broken");
    desk.press("Open");
    assert_eq!((desk.state.dialog.clone(), desk.session.document().name.as_str()), (None, "oak"));
    let Some(crate::editor::file_session::Message::Failed(error)) = &desk.session.message else { panic!("no message") };
    assert!(error.contains("broken.species.ron"), "{error}");
    desk.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    let Some(Dialog::SaveAs(field)) = &mut desk.state.dialog else { panic!("no dialog") };
    field.path = folder.join("elm").display().to_string();
    desk.frame(Vec::new());
    desk.frame(Vec::new());
    // The panel has a button of that name, too.
    let is_in_dialog = |(role, name, at): &(Role, String, Rect)| {
        *role == Role::Button && name == "Save" && at.center().x > PANEL_WIDTH
    };
    let save = desk.nodes().into_iter().find(is_in_dialog).unwrap().2.center();
    desk.click(save);
    assert!(folder.join("elm.species.ron").exists(), "{:?}", desk.session.message);
    desk.key(Modifiers::COMMAND, Key::O);
    desk.key(Modifiers::NONE, Key::Escape);
    desk.frame(Vec::new());
    assert_eq!(desk.state.dialog, None);
}

#[test]
fn nothing_else_is_done_while_a_question_waits() {
    let mut desk = Desk::new("oak");
    desk.press("Randomise");
    assert!(!desk.session.may_quit());
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    let changed = desk.session.document().clone();
    desk.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(*desk.session.document(), changed);
    desk.press("Cancel");
    assert_eq!(desk.session.question, None);
    assert!(!desk.session.may_quit());
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    let at = desk.find(Role::Button, "Do not save").center();
    desk.frame(vec![Event::PointerMoved(at)]);
    desk.frame(vec![Desk::button(at, true)]);
    assert!(desk.frame(vec![Desk::button(at, false)]).is_quitting);
}

#[test]
fn another_model_of_growth_is_chosen_from_its_list() {
    let mut desk = Desk::new("oak");
    let combo = desk.find(Role::ComboBox, "Growth").center();
    desk.click(combo);
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    desk.press("Impressionist");
    assert!(matches!(desk.session.document().growth, Growth::Impressionist(_)));
    desk.key(Modifiers::COMMAND, Key::Z);
    assert!(matches!(desk.session.document().growth, Growth::ReevesBlau(_)));
}

#[test]
fn the_top_of_the_envelope_is_dragged_in_the_picture_in_one_step() {
    let mut desk = Desk::new("oak");
    desk.open(Panel::Species);
    desk.stage.shows_envelope = true;
    desk.frame(Vec::new());
    let original = desk.session.document().clone();
    let turn_rad = desk.stage.turn_rad;
    let envelope = |desk: &Desk| envelope_of(desk.session.document(), 1.0).unwrap();
    let top_m = envelope(&desk).top_m;
    let view = desk.view.clone().unwrap();
    let [from, to] = [top_m, top_m + 6.0].map(|height_m| {
        let at = view.screen(height_m * bevy::math::Vec3::Y).unwrap();
        pos2(at.x, at.y)
    });
    desk.drag(&[from, from.lerp(to, 0.5), to]);
    assert!((envelope(&desk).top_m - top_m - 6.0).abs() < 0.2, "{}", envelope(&desk).top_m);
    assert_eq!(desk.stage.turn_rad, turn_rad, "the tree is not turned meanwhile");
    desk.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(*desk.session.document(), original);
    desk.drag(&[to + vec2(80.0, 0.0), to + vec2(140.0, 0.0)]);
    assert_ne!(desk.stage.turn_rad, turn_rad, "beside the handles it is");
}
