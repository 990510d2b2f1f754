//! Rows of fields: a label, a control that suits the kind of value, a way back. All by the table of fields.

use bevy::{
    math::{Dir2, Vec2},
    reflect::{
        GetPath, PartialReflect, Reflect, ReflectRef,
        enums::{DynamicEnum, DynamicVariant},
    },
};
use bevy_egui::egui::{
    self, Align, Button, CollapsingHeader, ComboBox, DragValue, Id, Label, Layout, Response, RichText, Slider,
    SliderClamping, TextEdit, TextStyle, Ui, vec2,
};

use super::theme::{LABEL_WIDTH, ROW};
use crate::editor::fields::{Choice, Field, Kind, Row, Section, number, set_number, words};

/// Width of a number, points.
const NUMBER_WIDTH: f32 = 84.0;
/// Width of the way back, points.
const BACK_WIDTH: f32 = 20.0;
/// A range with ends so far apart has a logarithmic slider.
const WIDE: f64 = 300.0;

/// A range of that length has no upper end, and no slider.
const ENDLESS: f64 = 1e30;

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

/// To six digits: what a person wrote as a number of 32 bits.
fn rounded(number: f64) -> f64 {
    let digits = if number == 0.0 { 0 } else { 5 - number.abs().log10().floor() as i32 };
    let scale = 10_f64.powi(digits.clamp(-30, 30));
    (number * scale).round() / scale
}

fn number_control(ui: &mut Ui, field: &Field, value: &mut dyn PartialReflect, named: Id) -> (Response, bool) {
    let factor = field.unit.map_or(1.0, |unit| unit.factor);
    let is_whole = field.kind == Kind::Whole;
    let before = number(value).unwrap_or_default() * factor;
    let before = if is_whole { before } else { rounded(before) };
    let mut shown = before;
    let range = field.range.as_ref().map(|range| rounded(range.start() * factor)..=rounded(range.end() * factor));
    let span = range.as_ref().map_or(1.0, |range| range.end() - range.start());
    let finite_span = if span < ENDLESS { span } else { 10.0 * before.abs().max(1.0) };
    let gap = ui.spacing().item_spacing.x;
    let mut response = None;
    if let Some(range) = range.as_ref().filter(|_| span < ENDLESS) {
        ui.spacing_mut().slider_width = (ui.available_width() - NUMBER_WIDTH - gap).max(20.0);
        let is_wide = *range.start() >= 0.0 && span / (range.start().max(before.abs()).max(1e-9)) > WIDE;
        let mut slider = Slider::new(&mut shown, range.clone())
            .show_value(false)
            .clamping(SliderClamping::Edits)
            .logarithmic(is_wide)
            .smallest_positive(if is_whole { 1.0 } else { 1e-3 * span.min(1.0) });
        if is_whole {
            slider = slider.integer();
        }
        response = Some(ui.add(slider));
    } else {
        ui.add_space((ui.available_width() - NUMBER_WIDTH - gap).max(0.0));
    }
    let mut drag = DragValue::new(&mut shown)
        .speed(if is_whole {
            (finite_span / 400.0).clamp(0.02, 4.0)
        } else {
            finite_span.min(20.0 * before.abs().max(0.01)) / 400.0
        })
        .clamp_existing_to_range(false)
        .update_while_editing(false);
    if let Some(range) = range.clone() {
        drag = drag.range(range);
    }
    if let Some(unit) = field.unit {
        drag = drag.suffix(if unit.symbol == "°" { "°".into() } else { format!(" {}", unit.symbol) });
    }
    drag = if is_whole { drag.fixed_decimals(0) } else { drag.max_decimals(decimals(finite_span)) };
    let dragged = ui.add_sized(vec2(NUMBER_WIDTH, ROW - 4.0), drag).labelled_by(named);
    let is_set = shown != before && shown.is_finite();
    if is_set {
        let clamped = range.map_or(shown, |range| shown.clamp(*range.start(), *range.end()));
        set_number(value, clamped / factor);
    }
    (response.map_or(dragged.clone(), |slider| slider | dragged), is_set)
}

/// How many decimals tell two values of a range apart.
fn decimals(span: f64) -> usize {
    (4 - span.abs().max(1e-3).log10().floor() as i32).clamp(1, 5) as usize
}

fn seed_control(ui: &mut Ui, value: &mut dyn PartialReflect, named: Id) -> (Response, bool) {
    let Some(seed) = value.try_downcast_mut::<u64>() else { return (ui.label("?"), false) };
    let before = *seed;
    let gap = ui.spacing().item_spacing.x;
    let width = ui.available_width() - NUMBER_WIDTH - gap;
    let next = ui.add_sized(vec2(width.max(40.0), ROW - 4.0), Button::new("Another"));
    if next.clicked() {
        *seed = seed.wrapping_add(1);
    }
    let drag = ui
        .add_sized(vec2(NUMBER_WIDTH, ROW - 4.0), DragValue::new(seed).update_while_editing(false))
        .labelled_by(named);
    (next | drag, *seed != before)
}

fn colour_control(ui: &mut Ui, colour: &mut [f32; 3]) -> (Response, bool) {
    let mut bytes = colour.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8);
    let response = ui.color_edit_button_srgb(&mut bytes);
    let is_set = response.changed();
    if is_set {
        *colour = bytes.map(|byte| (f32::from(byte) / 255.0 * 1000.0).round() / 1000.0);
    }
    let [red, green, blue] = *colour;
    ui.label(RichText::new(format!("{red:.2}  {green:.2}  {blue:.2}")).weak());
    (response, is_set)
}

fn direction_control(ui: &mut Ui, direction: &mut Dir2, named: Id) -> (Response, bool) {
    let before = rounded(f64::from(direction.y.atan2(direction.x).to_degrees().rem_euclid(360.0)));
    let mut degrees = before;
    let gap = ui.spacing().item_spacing.x;
    ui.spacing_mut().slider_width = (ui.available_width() - NUMBER_WIDTH - gap).max(20.0);
    let slider = Slider::new(&mut degrees, 0.0..=360.0).show_value(false).step_by(1.0);
    let slider = ui.add(slider.clamping(SliderClamping::Edits));
    let drag = DragValue::new(&mut degrees).range(0.0..=360.0).suffix("°").max_decimals(0).update_while_editing(false);
    let drag = ui.add_sized(vec2(NUMBER_WIDTH, ROW - 4.0), drag).labelled_by(named);
    let is_set = degrees != before;
    if is_set {
        *direction = Dir2::new(Vec2::from_angle((degrees as f32).to_radians())).unwrap_or(*direction);
    }
    (slider | drag, is_set)
}

fn choice_control<'c>(
    ui: &mut Ui,
    field: &Field,
    value: &dyn PartialReflect,
    choices: &'c [Choice],
) -> (Response, Option<&'c Choice>) {
    let now = match value.reflect_ref() {
        ReflectRef::Enum(variant) => variant.variant_name().to_owned(),
        _ => String::new(),
    };
    let mut chosen = None;
    let combo = ComboBox::from_id_salt(&field.path).selected_text(words(&now)).width(ui.available_width());
    let response = combo
        .show_ui(ui, |ui| {
            for choice in choices {
                let label = ui.selectable_label(choice.name == now, words(choice.name));
                let label = if choice.docs.is_empty() { label } else { label.on_hover_text(&choice.docs) };
                if label.clicked() && choice.name != now {
                    chosen = Some(choice);
                }
            }
        })
        .response;
    (response, chosen)
}
