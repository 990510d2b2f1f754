//! The panel of the wind: its settings, and what it is like.

use bevy_egui::egui::{Align, Align2, Color32, FontId, Layout, RichText, ScrollArea, Sense, Stroke, Ui, pos2, vec2};

use super::{
    file_bar::undo_buttons,
    live_rows::live_rows,
    plots::{Curve, PlotForm, plot, points},
    theme::{LABEL_WIDTH, palette},
};
use crate::{
    editor::{
        field_table::fields_of,
        fields::Section,
        live_settings::LiveSettings,
        stage::Stage,
        tip_motion::TipMotion,
        wind_measures::{COMPONENTS, Comparison, WindMeasures},
    },
    setting::SettingError,
    wind::{FieldSettings, Wind},
};

/// What is known of the wind.
#[derive(Clone, Copy, Default)]
pub struct WindFacts<'a> {
    pub measures: Option<&'a WindMeasures>,
    /// Of the tree that was pointed at last, and what that is called.
    pub tip: Option<(&'a str, &'a TipMotion)>,
    /// Whether another field is being built or fades in.
    pub is_changing: bool,
}

/// The check of a field's settings, for the wind that asks for it.
fn check(wind: &Wind) -> Result<(), SettingError> {
    let Wind { speed, direction, roughness_m, displacement_m, gustiness, seed, fade_s: _ } = *wind;
    FieldSettings { speed, direction, roughness_m, displacement_m, gustiness, seed, ..FieldSettings::default() }
        .validate()
}

/// The table of a wind's fields.
pub fn wind_table(wind: &Wind) -> Section {
    fields_of(wind, check)
}

/// Draws the settings.
pub fn wind_panel(ui: &mut Ui, wind: &mut LiveSettings<Wind>, stage: &mut Stage, table: &Section, facts: WindFacts) {
    ui.heading("Wind");
    ui.weak("A change is built in the background and fades in.");
    ui.horizontal(|ui| undo_buttons(ui, wind));
    ui.add_space(4.0);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        if let Some((changed, step)) = live_rows(ui, wind.value(), &Wind::default(), table) {
            wind.change(changed, &step);
        }
        ui.add_space(6.0);
        ui.checkbox(&mut stage.shows_wind, "Arrows of the wind about the tree");
        ui.add_space(6.0);
        compass(ui, wind.value());
        facts_table(ui, facts);
    });
}

/// Where the wind blows to, seen from above: x to the right, z down.
fn compass(ui: &mut Ui, wind: &Wind) {
    let (response, painter) = ui.allocate_painter(vec2(ui.available_width(), 132.0), Sense::hover());
    let (middle, radius) = (response.rect.center(), 42.0);
    let weak = ui.visuals().weak_text_color();
    painter.circle_stroke(middle, radius, Stroke::new(1.0, weak));
    for (name, x, y) in [("+x", 1.0, 0.0), ("−x", -1.0, 0.0), ("+z", 0.0, 1.0), ("−z", 0.0, -1.0)] {
        let at = middle + vec2(x, y) * (radius + 11.0);
        painter.text(at, Align2::CENTER_CENTER, name, FontId::proportional(11.0), weak);
    }
    let length = radius * (0.25 + 0.75 * (wind.speed / 30.0).clamp(0.0, 1.0));
    let along = vec2(wind.direction.x, wind.direction.y);
    painter.arrow(pos2(middle.x, middle.y) - along * length, along * (2.0 * length), Stroke::new(2.5, accent(ui)));
    response.on_hover_text("Where the wind blows to, seen from above");
}

fn accent(ui: &Ui) -> Color32 {
    palette(ui.visuals()).lines[0]
}

fn facts_table(ui: &mut Ui, facts: WindFacts) {
    let Some(measures) = facts.measures else {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label("The wind is being built");
        });
        return;
    };
    let row = |ui: &mut Ui, name: &str, value: String| {
        ui.horizontal(|ui| {
            ui.allocate_ui_with_layout(vec2(LABEL_WIDTH, 18.0), Layout::left_to_right(Align::Center), |ui| {
                ui.set_width(LABEL_WIDTH);
                ui.label(name);
            });
            ui.label(RichText::new(value).strong());
        });
    };
    row(ui, &format!("Mean at {:.0} m", measures.height_m), format!("{:.1} m/s", measures.mean_m_s));
    row(ui, "Turbulence", format!("{:.0}% of the mean", 100.0 * measures.intensity));
    if let Some((name, tip)) = facts.tip {
        row(ui, "Tree", format!("{name}, {:.1} m", tip.height_m));
        for (name, hz) in &tip.own {
            row(ui, &format!("Frequency of the {name}"), format!("{hz:.2} Hz"));
        }
    }
    if facts.is_changing {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label("Another wind comes");
        });
    }
}

/// What was measured, and what it should be.
fn beside_target<'a>(name: &'a str, comparison: &Comparison, colour: Color32, target: Color32) -> [Curve<'a>; 2] {
    [
        Curve { name, points: points(&comparison.measured), colour, is_target: false },
        Curve { name: "target", points: points(&comparison.target), colour: target, is_target: true },
    ]
}

/// A plot of that title, axes and height.
fn form<'a>(title: &'a str, axes: [&'a str; 2], height: f32) -> PlotForm<'a> {
    PlotForm { title, axes, height, ..PlotForm::default() }
}

/// Draws what the wind is like.
pub fn wind_plots(ui: &mut Ui, facts: WindFacts) {
    let palette = palette(ui.visuals());
    let Some(measures) = facts.measures else {
        ui.vertical_centered(|ui| {
            ui.add_space(80.0);
            ui.spinner();
            ui.label("The first wind is being built");
        });
        return;
    };
    let rows = if facts.tip.is_some() { 5.0 } else { 3.0 };
    let height = ((ui.available_height() - 26.0 * rows) / rows).clamp(104.0, 420.0);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let series = Curve {
            name: "along the wind",
            points: measures.series.clone(),
            colour: palette.lines[0],
            is_target: false,
        };
        plot(ui, &form("Speed at one place", ["s", "m/s"], height), vec![series]);
        let mut curves = Vec::new();
        for ((spectrum, (_, name)), colour) in measures.spectra.iter().zip(COMPONENTS).zip(palette.lines) {
            curves.extend(beside_target(name, spectrum, colour, palette.target));
        }
        let spectra =
            PlotForm { is_logarithmic: true, ..form("Spectrum beside its target", ["Hz", "m²/s² per Hz"], height) };
        plot(ui, &spectra, curves);
        let mut curves = Vec::new();
        let names: Vec<String> = measures.coherence.iter().map(|(lateral_m, _)| format!("{lateral_m:.0} m")).collect();
        for (((_, coherence), colour), name) in measures.coherence.iter().zip(palette.lines).zip(&names) {
            curves.extend(beside_target(name, coherence, colour, palette.target));
        }
        let coherence =
            PlotForm { has_logarithmic_x: true, ..form("Coherence across the wind", ["Hz", "root coherence"], height) };
        plot(ui, &coherence, curves);
        let Some((name, tip)) = facts.tip else {
            ui.weak("Point at a tree to see how it moves.");
            return;
        };
        let motion = vec![
            Curve {
                name: "along",
                points: tip.along.iter().take(1024).copied().collect(),
                colour: palette.lines[0],
                is_target: false,
            },
            Curve {
                name: "across",
                points: tip.across.iter().take(1024).copied().collect(),
                colour: palette.lines[1],
                is_target: false,
            },
        ];
        plot(ui, &form(&format!("Top of the {name}"), ["s", "m"], height), motion);
        let spectrum =
            vec![Curve { name: "along", points: points(&tip.spectrum), colour: palette.lines[0], is_target: false }];
        let marked = PlotForm {
            is_logarithmic: true,
            marks: &tip.own,
            ..form("Its spectrum, and its own frequencies", ["Hz", "m²/Hz"], height)
        };
        plot(ui, &marked, spectrum);
    });
}
