//! Rows of fields of settings that the running program has: their way back is the default.

use bevy::reflect::Reflect;
use bevy_egui::egui::Ui;

use super::rows::{Action, Rows};
use crate::editor::{
    fields::{Field, Section, copy_at, is_same_at},
    variants::with_list_of,
};

/// Draws rows. Returns the changed settings, and what the step is called, if anything was changed.
pub fn live_rows<T: Reflect + Clone + PartialEq>(
    ui: &mut Ui,
    settings: &T,
    default: &T,
    table: &Section,
) -> Option<(T, String)> {
    let is_changed = |field: &Field| !is_same_at(settings, default, &field.path);
    let mut draft = settings.clone();
    let mut rows = Rows::new(ui, &mut draft, &is_changed);
    rows.section(ui, table);
    let actions = std::mem::take(&mut rows.actions);
    let done = |action| match action {
        Action::Changed(step) => Some((draft.clone(), step)),
        Action::Reset(field) => {
            let mut reset = settings.clone();
            copy_at(&mut reset, default, &field.path).then_some((reset, field.label))
        }
        Action::Lengthen(list) => Some((with_list_of(settings, default, &list, true)?, "Add an item".to_owned())),
        Action::Shorten(list) => Some((with_list_of(settings, default, &list, false)?, "Remove an item".to_owned())),
        // None of them has a variant with settings.
        Action::Variant(..) => None,
    };
    actions.into_iter().find_map(done)
}
