//! The panel of levels of detail and of what everything costs.

use bevy_egui::egui::{Align, Grid, Label, Layout, RichText, ScrollArea, Ui, vec2};

use super::{
    file_bar::undo_buttons,
    live_rows::live_rows,
    plots::{Curve, PlotForm, plot},
    theme::palette,
};
use crate::{
    editor::{
        costs::{Costs, SpeciesCost},
        field_table::fields_of,
        fields::Section,
        live_settings::LiveSettings,
    },
    forest::ForestSettings,
    render::LevelOfDetail,
};

/// The systems that are told by name.
const DEAREST: usize = 12;
/// The species that are.
const DEAREST_SPECIES: usize = 5;

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

/// What this panel edits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LevelSettings {
    pub levels: LevelOfDetail,
    /// Of the forest that there is.
    pub forest: Option<ForestSettings>,
}

/// Draws the settings.
pub fn levels_panel(
    ui: &mut Ui,
    settings: &mut LiveSettings<LevelSettings>,
    is_frozen: &mut bool,
    tables: &LevelTables,
) {
    ui.heading("Levels of detail");
    ui.horizontal(|ui| undo_buttons(ui, settings));
    ui.add_space(4.0);
    ui.checkbox(is_frozen, "Freeze, and fly out to look").on_hover_text(
        "Levels, streaming and culling stay as they are from here, while the camera goes elsewhere to look at them",
    );
    ui.add_space(4.0);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let now = settings.value().clone();
        if let Err(error) = now.levels.validate() {
            ui.colored_label(palette(ui.visuals()).bad, format!("{error}. The last good settings stay."));
        }
        if let Some((levels, step)) = live_rows(ui, &now.levels, &LevelOfDetail::default(), &tables.levels) {
            settings.change(LevelSettings { levels, ..now.clone() }, &step);
        }
        ui.add_space(8.0);
        ui.heading("Forest");
        let Some(forest) = &now.forest else {
            ui.weak("There is no forest here.");
            return;
        };
        if let Some((forest, step)) = live_rows(ui, forest, &ForestSettings::default(), &tables.forest) {
            settings.change(LevelSettings { forest: Some(forest), ..now }, &step);
        }
    });
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
    ui.label(RichText::new("Dearest species").strong())
        .on_hover_text("Of the trees that are entities, by triangles of the full level");
    let species = costs.species.iter().take(DEAREST_SPECIES);
    let told = |cost: &SpeciesCost| format!("{} · {} k triangles", cost.trees, cost.triangles.div_ceil(1000));
    let species: Vec<(&str, String)> = species.map(|cost| (cost.name.as_str(), told(cost))).collect();
    table(ui, "species", &species);
    ui.add_space(8.0);
    ui.label(RichText::new("Our dearest systems").strong());
    let dearest = costs.systems.iter().take(DEAREST);
    let dearest: Vec<(&str, String)> = dearest.map(|(name, us)| (*name, format!("{us:.0} µs"))).collect();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| table(ui, "systems", &dearest));
}

/// Names to the left, values to the right.
fn table(ui: &mut Ui, id: &str, rows: &[(&str, String)]) {
    if rows.is_empty() {
        ui.weak("None yet.");
        return;
    }
    let width = ui.available_width() - 12.0;
    Grid::new(id).num_columns(2).striped(true).spacing(vec2(8.0, 4.0)).min_row_height(18.0).show(ui, |ui| {
        for (name, value) in rows {
            ui.allocate_ui_with_layout(vec2(width - 180.0, 18.0), Layout::left_to_right(Align::Center), |ui| {
                ui.set_width(width - 180.0);
                ui.add(Label::new(*name).truncate());
            });
            ui.allocate_ui_with_layout(vec2(172.0, 18.0), Layout::right_to_left(Align::Center), |ui| {
                ui.label(RichText::new(value).monospace());
            });
            ui.end_row();
        }
    });
}
