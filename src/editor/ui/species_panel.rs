//! The panel of a species: its menus and fields, and the buttons of the session.

use bevy_egui::egui::{RichText, ScrollArea, TextEdit, Ui};

use super::{
    dialogs::Dialog,
    file_bar::{file_buttons_with, undo_buttons, warnings},
    rows::Rows,
    session_rows::session_rows,
    starling,
};
use crate::{
    editor::{
        fields::{Row, Section, all_fields},
        file_session::FileSession,
        randomiser::{NATURAL_SPREAD, Randomiser},
        session::Session,
    },
    tree::{Growth, Species},
};

/// Draws the panel. `filter` is what a person looks for among the fields.
pub fn species_panel(
    ui: &mut Ui,
    session: &mut Session<Species>,
    randomiser: &mut Randomiser,
    filter: &mut String,
    dialog: &mut Option<Dialog>,
) {
    let path = session.path().to_owned();
    file_buttons_with(ui, session, dialog, |ui, dialog| {
        let hint = "A GLB file for other programs: the tree with its sway";
        if EXPORTS && ui.button("Export…").on_hover_text(hint).clicked() {
            *dialog = Some(Dialog::export(&path));
        }
    });
    session_buttons(ui, session, randomiser);
    warnings(ui, session, "tree");
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

/// Whether trees can be exported.
const EXPORTS: bool = cfg!(feature = "export");

fn session_buttons(ui: &mut Ui, session: &mut Session<Species>, randomiser: &mut Randomiser) {
    ui.horizontal(|ui| {
        undo_buttons(ui, session);
        let spread = format!("Changes every measure at random, by {:.0}% (Ctrl+R)", 100.0 * NATURAL_SPREAD);
        if ui.button("Randomise").on_hover_text(spread).clicked() {
            randomiser.randomise(session);
        }
        ui.checkbox(&mut randomiser.is_seed_locked, "Lock seed")
            .on_hover_text("Randomising changes the measures and leaves the seed of the individuals");
    });
}

fn fields(ui: &mut Ui, session: &mut Session<Species>, filter: &str) {
    let table = session.table().clone();
    let crown = match &session.document().growth {
        Growth::Impressionist(crown) => Some(*crown),
        _ => None,
    };
    session_rows(ui, session, |ui, rows| {
        if !filter.trim().is_empty() {
            found(ui, rows, &table, filter.trim());
            return;
        }
        for row in &table.rows {
            match (row, &crown) {
                (Row::Section(inside), Some(crown)) if inside.path == "growth.0" => {
                    starling::menus(rows, ui, inside, crown);
                }
                (Row::Section(inside), _) => rows.folded(ui, inside, inside.path == "growth.0"),
                (Row::Field(field), _) => rows.field(ui, field),
            }
        }
    });
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
