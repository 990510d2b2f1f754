//! The panel of a species: its menus and fields, and the buttons of the session.

use bevy_egui::egui::{Button, Frame, RichText, ScrollArea, TextEdit, Ui};

use super::{
    dialogs::Dialog,
    rows::{Action, Rows},
    starling,
    theme::palette,
};
use crate::{
    editor::{
        fields::{Row, Section, all_fields},
        session::{NATURAL_SPREAD, Session},
        species_file::OnDisk,
        variants,
    },
    tree::Growth,
};

/// Draws the panel. `filter` is what a person looks for among the fields.
pub fn species_panel(ui: &mut Ui, session: &mut Session, filter: &mut String, dialog: &mut Option<Dialog>) {
    file_buttons(ui, session, dialog);
    session_buttons(ui, session);
    warnings(ui, session);
    ui.horizontal(|ui| {
        let named = ui.label("Find a field");
        let find = TextEdit::singleline(filter).desired_width(f32::INFINITY);
        let hint = "Shows the fields whose name or documentation has these letters";
        ui.add(find).labelled_by(named.id).on_hover_text(hint);
    });
    ui.add_space(2.0);
    ui.separator();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| fields(ui, session, filter));
}

fn file_buttons(ui: &mut Ui, session: &mut Session, dialog: &mut Option<Dialog>) {
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
    });
}

fn session_buttons(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        let undo = session.history().undo_step().map(|step| format!("Take back: {step} (Ctrl+Z)"));
        let redo = session.history().redo_step().map(|step| format!("Do again: {step} (Ctrl+Shift+Z)"));
        let button = |ui: &mut Ui, name: &str, hint: Option<String>| {
            let response = ui.add_enabled(hint.is_some(), Button::new(name));
            hint.map_or(response.clone(), |hint| response.on_hover_text(hint)).clicked()
        };
        if button(ui, "Undo", undo) {
            session.undo();
        }
        if button(ui, "Redo", redo) {
            session.redo();
        }
        let spread = format!("Changes every measure at random, by {:.0}% (Ctrl+R)", 100.0 * NATURAL_SPREAD);
        if ui.button("Randomise").on_hover_text(spread).clicked() {
            session.randomise();
        }
        ui.checkbox(&mut session.is_seed_locked, "Lock seed")
            .on_hover_text("Randomising changes the measures and leaves the seed of the individuals");
    });
}

/// What is wrong with the species or its file.
fn warnings(ui: &mut Ui, session: &mut Session) {
    let palette = palette(ui.visuals());
    if let Some(error) = session.error() {
        banner(ui, |ui| ui.colored_label(palette.bad, format!("{error}. The last good tree stays.")));
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

fn fields(ui: &mut Ui, session: &mut Session, filter: &str) {
    let mut draft = session.species().clone();
    let table = session.table().clone();
    let crown = match &draft.growth {
        Growth::Impressionist(crown) => Some(*crown),
        _ => None,
    };
    let is_changed = |field: &_| session.is_field_changed(field);
    let mut rows = Rows::new(ui, &mut draft, &is_changed);
    if filter.trim().is_empty() {
        for row in &table.rows {
            match (row, &crown) {
                (Row::Section(inside), Some(crown)) if inside.path == "growth.0" => {
                    starling::menus(&mut rows, ui, inside, crown);
                }
                (Row::Section(inside), _) => rows.folded(ui, inside, inside.path == "growth.0"),
                (Row::Field(field), _) => rows.field(ui, field),
            }
        }
    } else {
        found(ui, &mut rows, &table, filter.trim());
    }
    let actions = std::mem::take(&mut rows.actions);
    for action in actions {
        match action {
            Action::Changed(step) => session.change(draft.clone(), &step),
            Action::Reset(field) => session.reset(&field),
            Action::Variant(field, variant) => {
                if let Some(species) = variants::with_variant(session.species(), &field.path, variant) {
                    session.change(species, &field.label);
                    session.end_gesture();
                }
            }
            Action::Lengthen(list) => change_list(session, &list, true),
            Action::Shorten(list) => change_list(session, &list, false),
        }
    }
}

/// The fields that are looked for, each under the section that it is in.
fn found(ui: &mut Ui, rows: &mut Rows, table: &Section, filter: &str) {
    let wanted = filter.to_lowercase();
    let mut section = "";
    let mut any = false;
    let fields = all_fields(table);
    for field in fields {
        let text = format!("{} {} {}", field.label, field.name, field.docs).to_lowercase();
        if !text.contains(&wanted) {
            continue;
        }
        let of = field.name.rsplit_once('.').map_or("species", |(section, _)| section);
        if of != section {
            ui.label(RichText::new(of).small().weak());
            section = of;
        }
        rows.field(ui, field);
        any = true;
    }
    if !any {
        ui.weak("No field has these letters in its name or documentation.");
    }
}

fn change_list(session: &mut Session, path: &str, is_longer: bool) {
    let Some(species) = variants::with_list(session.species(), path, is_longer) else { return };
    session.change(species, if is_longer { "Add an item" } else { "Remove an item" });
    session.end_gesture();
}
