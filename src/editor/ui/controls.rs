//! Controls that suit a kind of value. Each tells its response and whether the value was changed.

use bevy::{
    math::{Dir2, Vec2},
    reflect::{PartialReflect, ReflectRef},
};
use bevy_egui::egui::{Button, ComboBox, DragValue, Id, Response, RichText, Slider, SliderClamping, Ui, vec2};

use super::theme::ROW;
use crate::editor::fields::{Choice, Field, Kind, number, set_number, words};

/// Width of a number, points.
const NUMBER_WIDTH: f32 = 84.0;
/// A range with ends so far apart has a logarithmic slider.
const WIDE: f64 = 300.0;
/// A range of that length has no upper end, and no slider.
pub const ENDLESS: f64 = 1e30;

/// To six digits: what a person wrote as a number of 32 bits.
pub fn rounded(number: f64) -> f64 {
    let digits = if number == 0.0 { 0 } else { 5 - number.abs().log10().floor() as i32 };
    let scale = 10_f64.powi(digits.clamp(-30, 30));
    (number * scale).round() / scale
}

pub fn number_control(ui: &mut Ui, field: &Field, value: &mut dyn PartialReflect, named: Id) -> (Response, bool) {
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

pub fn seed_control(ui: &mut Ui, value: &mut dyn PartialReflect, named: Id) -> (Response, bool) {
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

pub fn colour_control(ui: &mut Ui, colour: &mut [f32; 3]) -> (Response, bool) {
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

pub fn direction_control(ui: &mut Ui, direction: &mut Dir2, named: Id) -> (Response, bool) {
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

pub fn choice_control<'c>(
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
