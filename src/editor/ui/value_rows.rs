//! Rows of values that have no field of settings behind them, as wide as those that have.

use std::ops::RangeInclusive;

use bevy_egui::egui::{
    Align, Color32, DragValue, Label, Layout, Response, RichText, Slider, SliderClamping, Ui, emath::Numeric, vec2,
};

use super::theme::{LABEL_WIDTH, ROW};

/// Width of a number, points.
const NUMBER_WIDTH: f32 = 84.0;

/// A label, and controls to its right.
pub fn labelled<R>(ui: &mut Ui, label: &str, hint: &str, add: impl FnOnce(&mut Ui, Response) -> R) -> R {
    ui.horizontal(|ui| {
        ui.set_height(ROW);
        let width = LABEL_WIDTH - ui.spacing().item_spacing.x;
        let named = ui.allocate_ui_with_layout(vec2(width, ROW), Layout::left_to_right(Align::Center), |ui| {
            ui.set_width(width);
            ui.add(Label::new(label).truncate())
        });
        let named = if hint.is_empty() { named.inner } else { named.inner.on_hover_text(hint) };
        add(ui, named)
    })
    .inner
}

/// A slider with its value. Returns whether it was changed.
pub fn slider<N: Numeric>(
    ui: &mut Ui,
    (label, hint): (&str, &str),
    value: &mut N,
    range: RangeInclusive<N>,
    suffix: &str,
) -> bool {
    let before = *value;
    labelled(ui, label, hint, |ui, named| {
        ui.spacing_mut().slider_width = (ui.available_width() - NUMBER_WIDTH - ui.spacing().item_spacing.x).max(20.0);
        let (low, high) = (range.start().to_f64(), range.end().to_f64());
        let is_wide = low > 0.0 && high / low > 50.0;
        let bar =
            Slider::new(value, range.clone()).show_value(false).clamping(SliderClamping::Edits).logarithmic(is_wide);
        ui.add(bar).labelled_by(named.id);
        let drag = DragValue::new(value).range(range).suffix(suffix).speed((high - low) / 500.0).max_decimals(2);
        ui.add_sized(vec2(NUMBER_WIDTH, ROW - 4.0), drag).labelled_by(named.id);
    });
    *value != before
}

/// A fact: its name and its value.
pub fn fact(ui: &mut Ui, name: &str, value: &str, colour: Option<Color32>) {
    labelled(ui, name, "", |ui, _| {
        let text = RichText::new(value).strong();
        ui.label(colour.map_or(text.clone(), |colour| text.color(colour)));
    });
}
