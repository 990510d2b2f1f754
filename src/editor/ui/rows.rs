//! Rows of fields: a label, a control that suits the kind of value, a way back. All by the table of fields.

use bevy::{
    math::Dir2,
    reflect::{
        GetPath, Reflect,
        enums::{DynamicEnum, DynamicVariant},
    },
};
use bevy_egui::egui::{
    self, Align, Button, CollapsingHeader, Id, Label, Layout, Response, RichText, TextEdit, TextStyle, Ui, vec2,
};

use super::{
    controls::{ENDLESS, choice_control, colour_control, direction_control, number_control, rounded, seed_control},
    theme::{LABEL_WIDTH, ROW},
};
use crate::editor::fields::{Choice, Field, Kind, Row, Section};

/// Width of the way back, points.
const BACK_WIDTH: f32 = 20.0;

/// What was done in the rows besides changing values.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// A value was changed in the draft: what the step is called.
    Changed(String),
    Reset(Field),
    /// A variant with settings was chosen: the path of the enum, and the variant's name.
    Variant(Field, &'static str),
    /// The list at a path gets one more item, or one less.
    Lengthen(String),
    Shorten(String),
}

/// Draws fields and changes the draft.
pub struct Rows<'a> {
    draft: &'a mut dyn Reflect,
    is_changed: &'a dyn Fn(&Field) -> bool,
    /// Where controls begin, points from the left of the screen.
    controls_at: f32,
    /// Size of labels, points.
    pub label_size: f32,
    pub actions: Vec<Action>,
}

impl<'a> Rows<'a> {
    /// Rows of a panel. `is_changed` says of which fields there is a way back.
    pub fn new(ui: &Ui, draft: &'a mut dyn Reflect, is_changed: &'a dyn Fn(&Field) -> bool) -> Self {
        Self {
            draft,
            is_changed,
            controls_at: ui.max_rect().left() + LABEL_WIDTH,
            label_size: TextStyle::Body.resolve(ui.style()).size,
            actions: Vec::new(),
        }
    }

    /// All rows of a section, with the sections in it folded.
    pub fn section(&mut self, ui: &mut Ui, section: &Section) {
        for row in &section.rows {
            match row {
                Row::Field(field) => self.field(ui, field),
                Row::Section(inside) => self.folded(ui, inside, false),
            }
        }
        if section.is_list {
            self.list_buttons(ui, section);
        }
    }

    /// All rows of a section, with the sections in it open.
    pub fn section_open(&mut self, ui: &mut Ui, section: &Section) {
        for row in &section.rows {
            match row {
                Row::Field(field) => self.field(ui, field),
                Row::Section(inside) => self.folded(ui, inside, true),
            }
        }
    }

    /// A section under a heading that opens and closes.
    pub fn folded(&mut self, ui: &mut Ui, section: &Section, is_open: bool) {
        let heading = CollapsingHeader::new(&section.title).id_salt(&section.path).default_open(is_open);
        let shown = heading.show(ui, |ui| self.section(ui, section));
        if !section.docs.is_empty() {
            shown.header_response.on_hover_text(&section.docs);
        }
    }

    fn list_buttons(&mut self, ui: &mut Ui, list: &Section) {
        ui.horizontal(|ui| {
            if ui.button("Add one like the last").clicked() {
                self.actions.push(Action::Lengthen(list.path.clone()));
            }
            if ui.add_enabled(!list.rows.is_empty(), Button::new("Remove the last")).clicked() {
                self.actions.push(Action::Shorten(list.path.clone()));
            }
        });
    }

    /// One field.
    pub fn field(&mut self, ui: &mut Ui, field: &Field) {
        self.labelled(ui, field, &field.label.clone());
    }

    /// One field under another name than its own.
    pub fn labelled(&mut self, ui: &mut Ui, field: &Field, label: &str) {
        let is_changed = (self.is_changed)(field);
        ui.horizontal(|ui| {
            ui.set_height(ROW);
            let named = self.label(ui, field, label, is_changed);
            let width = ui.available_width() - BACK_WIDTH - ui.spacing().item_spacing.x;
            let control = ui
                .allocate_ui_with_layout(vec2(width, ROW), Layout::left_to_right(Align::Center), |ui| {
                    ui.set_width(width);
                    self.control(ui, field, label, named.id)
                })
                .inner;
            if let Some(control) = control {
                control.on_hover_ui(|ui| tooltip(ui, field));
            }
            let back = Button::new(RichText::new("↺")).frame(false).min_size(vec2(BACK_WIDTH, ROW - 4.0));
            let back =
                ui.add_visible(is_changed, back).on_hover_text("Back to what the file says, and then to the default");
            back.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, format!("Reset {label}")));
            if back.clicked() {
                self.actions.push(Action::Reset(field.clone()));
            }
        });
    }

    fn label(&self, ui: &mut Ui, field: &Field, label: &str, is_changed: bool) -> Response {
        let width = (self.controls_at - ui.cursor().left() - ui.spacing().item_spacing.x).max(40.0);
        let text = RichText::new(label).size(self.label_size);
        let text = if is_changed { text.strong().italics() } else { text };
        let layout = Layout::left_to_right(Align::Center);
        let named = ui.allocate_ui_with_layout(vec2(width, ROW), layout, |ui| {
            ui.set_width(width);
            ui.add(Label::new(text).truncate())
        });
        named.inner.on_hover_ui(|ui| tooltip(ui, field))
    }

    /// `named` is the label that tells its name.
    fn control(&mut self, ui: &mut Ui, field: &Field, label: &str, named: Id) -> Option<Response> {
        let draft = &mut *self.draft;
        let value = draft.reflect_path_mut(field.path.as_str()).ok()?;
        let (response, is_set) = match &field.kind {
            Kind::Number | Kind::Whole => number_control(ui, field, value, named),
            Kind::Seed => seed_control(ui, value, named),
            Kind::Switch => {
                let on = value.try_downcast_mut::<bool>()?;
                let response = ui.checkbox(on, "");
                let is_set = response.changed();
                (response, is_set)
            }
            Kind::Text => {
                let response =
                    ui.add(TextEdit::singleline(value.try_downcast_mut::<String>()?).desired_width(f32::INFINITY));
                let is_set = response.changed();
                (response, is_set)
            }
            Kind::Colour => colour_control(ui, value.try_downcast_mut::<[f32; 3]>()?),
            Kind::Direction => direction_control(ui, value.try_downcast_mut::<Dir2>()?, named),
            Kind::Choice(choices) => {
                let (response, chosen) = choice_control(ui, field, value, choices);
                if let Some(choice) =
                    chosen.filter(|choice| choices.iter().any(|any| any.has_settings) || choice.has_settings)
                {
                    self.actions.push(Action::Variant(field.clone(), choice.name));
                    return Some(response.labelled_by(named));
                }
                let unit = |choice: &Choice| DynamicEnum::new(choice.name, DynamicVariant::Unit);
                (response, chosen.is_some_and(|choice| value.try_apply(&unit(choice)).is_ok()))
            }
        };
        if is_set {
            self.actions.push(Action::Changed(label.to_owned()));
        }
        Some(response.labelled_by(named))
    }
}

/// What a field is: documentation, range and name.
fn tooltip(ui: &mut Ui, field: &Field) {
    ui.set_max_width(340.0);
    ui.label(&field.docs);
    let factor = field.unit.map_or(1.0, |unit| unit.factor);
    let symbol = field.unit.map_or("", |unit| unit.symbol);
    if let Some(range) = &field.range {
        let [low, high] = [range.start(), range.end()].map(|end| rounded(end * factor));
        let text = if high < ENDLESS { format!("{low} to {high} {symbol}") } else { format!("{low} {symbol} or more") };
        ui.label(RichText::new(text).strong());
    }
    ui.label(RichText::new(&field.name).monospace().weak());
}
