//! Rows of fields that are edited in a session: each change is a step of it.

use bevy_egui::egui::Ui;

use super::rows::{Action, Rows};
use crate::editor::{
    document::Document,
    fields::Field,
    session::Session,
    steps::Steps,
    variants::{with_list, with_variant},
};

/// Draws rows, and takes over what was done in them.
pub fn session_rows<T: Document>(ui: &mut Ui, session: &mut Session<T>, draw: impl FnOnce(&mut Ui, &mut Rows)) {
    let mut draft = session.document().clone();
    let actions = {
        let is_changed = |field: &Field| session.is_field_changed(field);
        let mut rows = Rows::new(ui, &mut draft, &is_changed);
        draw(ui, &mut rows);
        rows.actions
    };
    for action in actions {
        match action {
            Action::Changed(step) => session.change(draft.clone(), &step),
            Action::Reset(field) => session.reset(&field),
            Action::Variant(field, variant) => {
                step(session, with_variant(session.document(), &field.path, variant), &field.label);
            }
            Action::Lengthen(list) => step(session, with_list(session.document(), &list, true), "Add an item"),
            Action::Shorten(list) => step(session, with_list(session.document(), &list, false), "Remove an item"),
        }
    }
}

fn step<T: Document>(session: &mut Session<T>, changed: Option<T>, name: &str) {
    let Some(changed) = changed else { return };
    session.change(changed, name);
    session.end_gesture();
}
