//! The panel of levels of detail and of what everything costs.

use bevy::reflect::Reflect;
use bevy_egui::egui::{Align, Grid, Label, Layout, RichText, ScrollArea, Ui, vec2};

use super::{
    plots::{Curve, PlotForm, plot},
    rows::{Action, Rows},
    theme::palette,
};
use crate::{
    editor::{
        costs::Costs,
        field_table::fields_of,
        fields::{Field, Section, copy_at, is_same_at},
    },
    forest::ForestSettings,
    render::LevelOfDetail,
};

/// The systems that are told by name.
const DEAREST: usize = 12;

/// The tables of what this panel edits.
pub struct LevelTables {
    pub levels: Section,
    pub forest: Section,
}

impl LevelTables {
    pub fn new(levels: &LevelOfDetail, forest: &ForestSettings) -> Self {
        Self { levels: fields_of(levels, LevelOfDetail::validate), forest: fields_of(forest, ForestSettings::validate) }
    }
}

/// Draws the settings. `forest` are those of the forest that there is.
pub fn levels_panel(
    ui: &mut Ui,
    levels: &mut LevelOfDetail,
    forest: Option<&mut ForestSettings>,
    is_frozen: &mut bool,
    tables: &LevelTables,
) {
    ui.heading("Levels of detail");
    ui.add_space(4.0);
    ui.checkbox(is_frozen, "Freeze, and fly out to look").on_hover_text(
        "Levels, streaming and culling stay as they are from here, while the camera goes elsewhere to look at them",
    );
    ui.add_space(4.0);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let error = levels.validate().err();
        if let Some(error) = error {
            ui.colored_label(palette(ui.visuals()).bad, format!("{error}. The last good settings stay."));
        }
        rows_of(ui, levels, &LevelOfDetail::default(), &tables.levels);
        ui.add_space(8.0);
        ui.heading("Forest");
        match forest {
            Some(forest) => rows_of(ui, forest, &ForestSettings::default(), &tables.forest),
            None => {
                ui.weak("There is no forest here.");
            }
        }
    });
}

/// Rows of settings whose way back is the default.
fn rows_of<T: Reflect + Clone + PartialEq>(ui: &mut Ui, settings: &mut T, default: &T, table: &Section) {
    let now = settings.clone();
    let is_changed = |field: &Field| !is_same_at(&now, default, &field.path);
    let mut draft = settings.clone();
    let mut rows = Rows::new(ui, &mut draft, &is_changed);
    rows.section(ui, table);
    for action in std::mem::take(&mut rows.actions) {
        match action {
            Action::Changed(_) => settings.clone_from(&draft),
            Action::Reset(field) => drop(copy_at(settings, default, &field.path)),
            Action::Lengthen(_) | Action::Shorten(_) | Action::Variant(..) => {}
        }
    }
}

/// Draws counts, times and bytes.
pub fn costs_panel(ui: &mut Ui, costs: &Costs) {
    let palette = palette(ui.visuals());
    ui.heading("Cost");
    ui.add_space(4.0);
    let of = |value: fn(&crate::editor::costs::Step) -> f64| {
        let last_s = costs.steps.back().map_or(0.0, |step| step.time_s);
        costs.steps.iter().map(|step| [step.time_s - last_s, value(step)]).collect::<Vec<_>>()
    };
    let curves = vec![
        Curve { name: "frame", points: of(|step| step.frame_ms), colour: palette.lines[1], is_target: false },
        Curve { name: "our systems", points: of(|step| step.ours_ms), colour: palette.lines[0], is_target: false },
    ];
    let form = PlotForm { title: "Time of a frame", axes: ["s", "ms"], height: 150.0, ..PlotForm::default() };
    plot(ui, &form, curves);
    ui.add_space(8.0);
    let [full, lower, lowest] = costs.last.trees;
    let rows = [
        ("Trees, grown", full.to_string()),
        ("Trees, first lower level", lower.to_string()),
        ("Trees, second lower level", lowest.to_string()),
        ("Tables on the GPU", format!("{:.2} MiB", costs.last.bytes as f64 / f64::from(1 << 20))),
    ];
    table(ui, "counts", &rows);
    ui.add_space(8.0);
    ui.label(RichText::new("Our dearest systems").strong());
    let dearest = costs.systems.iter().take(DEAREST);
    let dearest: Vec<(&str, String)> = dearest.map(|(name, us)| (*name, format!("{us:.0} µs"))).collect();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| table(ui, "systems", &dearest));
}

/// Names to the left, values to the right.
fn table(ui: &mut Ui, id: &str, rows: &[(&str, String)]) {
    let width = ui.available_width() - 12.0;
    Grid::new(id).num_columns(2).striped(true).spacing(vec2(8.0, 4.0)).min_row_height(18.0).show(ui, |ui| {
        for (name, value) in rows {
            ui.allocate_ui_with_layout(vec2(width - 90.0, 18.0), Layout::left_to_right(Align::Center), |ui| {
                ui.set_width(width - 90.0);
                ui.add(Label::new(*name).truncate());
            });
            ui.allocate_ui_with_layout(vec2(82.0, 18.0), Layout::right_to_left(Align::Center), |ui| {
                ui.label(RichText::new(value).monospace());
            });
            ui.end_row();
        }
    });
}
