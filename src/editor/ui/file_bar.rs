//! What all panels with a file have on top: its name, its buttons, and what is wrong with it.

use bevy_egui::egui::{Button, Frame, Ui};

use super::{dialogs::Dialog, theme::palette};
use crate::editor::{document_file::OnDisk, file_session::FileSession, steps::Steps};

/// The name of the file, and buttons to open and save it.
pub fn file_buttons(ui: &mut Ui, session: &mut dyn FileSession, dialog: &mut Option<Dialog>) {
    file_buttons_with(ui, session, dialog, |_, _| {});
}

/// The same, with more buttons in the row.
pub fn file_buttons_with(
    ui: &mut Ui,
    session: &mut dyn FileSession,
    dialog: &mut Option<Dialog>,
    add: impl FnOnce(&mut Ui, &mut Option<Dialog>),
) {
    let name = session.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
    ui.horizontal(|ui| {
        let title = if session.is_changed() { format!("{name} •") } else { name };
        let hint = if session.is_changed() { "There are changes that are not saved" } else { "As it is in its file" };
        ui.heading(title).on_hover_text(format!("{hint}\n{}", session.path().display()));
    });
    ui.horizontal(|ui| {
        if ui.button("Open…").on_hover_text("Ctrl+O").clicked() {
            *dialog = Some(Dialog::open(session.path()));
        }
        if ui.add_enabled(session.is_changed(), Button::new("Save")).on_hover_text("Ctrl+S").clicked() {
            session.save();
        }
        if ui.button("Save as…").on_hover_text("Ctrl+Shift+S").clicked() {
            *dialog = Some(Dialog::save_as(session.path()));
        }
        add(ui, dialog);
    });
}

/// Buttons to go back and forth, in a row with others.
pub fn undo_buttons(ui: &mut Ui, steps: &mut dyn Steps) {
    let undo = steps.undo_step().map(|step| format!("Take back: {step} (Ctrl+Z)"));
    let redo = steps.redo_step().map(|step| format!("Do again: {step} (Ctrl+Shift+Z)"));
    let button = |ui: &mut Ui, name: &str, hint: Option<String>| {
        let response = ui.add_enabled(hint.is_some(), Button::new(name));
        hint.map_or(response.clone(), |hint| response.on_hover_text(hint)).clicked()
    };
    if button(ui, "Undo", undo) {
        steps.undo();
    }
    if button(ui, "Redo", redo) {
        steps.redo();
    }
}

/// What is wrong with what is edited or with its file. `shown` is what stays meanwhile.
pub fn warnings(ui: &mut Ui, session: &mut dyn FileSession, shown: &str) {
    let palette = palette(ui.visuals());
    if let Some(error) = session.error() {
        banner(ui, |ui| ui.colored_label(palette.bad, format!("{error}. The last good {shown} stays.")));
    }
    let remark = match session.on_disk() {
        OnDisk::AsKnown => return,
        OnDisk::Changed => "Another program has changed the file.",
        OnDisk::Removed => "The file has been removed.",
    };
    banner(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.colored_label(palette.warning, remark);
            if session.on_disk() == OnDisk::Changed && ui.button("Read it again").clicked() {
                session.reload();
            }
        });
    });
}

fn banner<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) {
    Frame::group(ui.style()).show(ui, |ui| {
        ui.set_width(ui.available_width());
        add(ui);
    });
}
