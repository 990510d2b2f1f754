//! The panels: drawn by egui, with nothing of the engine. They show and change what [`Subjects`] lends them.

mod bars;
pub mod dialogs;
mod levels_panel;
mod plots;
mod rows;
mod shortcuts;
mod species_panel;
mod starling;
pub mod theme;
mod wind_panel;

pub use bars::{Panel, TreeFacts};
pub use levels_panel::LevelTables;
pub use wind_panel::{WindFacts, wind_table};

use self::{
    bars::{stage_bar, status_bar, top_bar},
    dialogs::Dialog,
    levels_panel::{costs_panel, levels_panel},
    shortcuts::{Command, pressed},
    species_panel::species_panel,
    theme::{MARGIN, PANEL_WIDTH},
    wind_panel::{wind_panel, wind_plots},
};
use super::{costs::Costs, fields::Section, session::Session, stage::Stage};
use crate::{forest::ForestSettings, render::LevelOfDetail, tree::Season, wind::Wind};
use bevy_egui::egui::{Align2, Area, Color32, Frame, Id, Margin, Panel as EguiPanel, Rect, RichText, Ui, vec2};

/// Width of the panel with plots, points.
const PLOTS_WIDTH: f32 = 400.0;

/// What the panels keep from frame to frame.
#[derive(Debug, Default)]
pub struct UiState {
    pub panel: Panel,
    pub dialog: Option<Dialog>,
    pub filter: String,
    has_theme: bool,
}

/// What the panels show and change.
pub struct Subjects<'a> {
    pub session: &'a mut Session,
    pub stage: &'a mut Stage,
    pub season: &'a mut Season,
    pub wind: &'a mut Wind,
    pub wind_table: &'a Section,
    pub wind_facts: WindFacts<'a>,
    pub levels: &'a mut LevelOfDetail,
    pub forest: Option<&'a mut ForestSettings>,
    pub level_tables: &'a LevelTables,
    pub is_frozen: &'a mut bool,
    pub costs: &'a Costs,
    pub tree: &'a TreeFacts,
    /// What the colours of the view mean.
    pub legend: &'a [(String, [f32; 3])],
    /// Whether the picture between the panels is a turntable; else it is a game's.
    pub has_turntable: bool,
}

/// What came of drawing the panels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn {
    /// What the panels leave free, points.
    pub picture: Rect,
    pub is_quitting: bool,
    /// Whether the tree that is being grown is not wanted any more.
    pub is_cancelled: bool,
}

/// Draws all panels into a whole window.
pub fn draw(ui: &mut Ui, state: &mut UiState, mut subjects: Subjects) -> Drawn {
    let context = ui.ctx().clone();
    if !state.has_theme {
        theme::apply(&context);
        state.has_theme = true;
    }
    obey(&context, state, &mut subjects);
    let frame = |ui: &Ui| Frame::new().fill(ui.visuals().panel_fill).inner_margin(Margin::same(MARGIN));
    let bar = |ui: &Ui| Frame::new().fill(ui.visuals().panel_fill).inner_margin(Margin::symmetric(MARGIN, 4));
    EguiPanel::top("windwood top").frame(bar(ui)).show(ui, |ui| top_bar(ui, &mut state.panel, &mut state.dialog));
    let status = EguiPanel::bottom("windwood status").frame(bar(ui));
    let is_cancelled = status.show(ui, |ui| status_bar(ui, subjects.session, subjects.tree)).inner;
    let fields = EguiPanel::left("windwood fields").frame(frame(ui)).resizable(false).exact_size(PANEL_WIDTH);
    fields.show(ui, |ui| left_panel(ui, state, &mut subjects));
    if state.panel != Panel::Species {
        let plots = EguiPanel::right("windwood plots").frame(frame(ui)).resizable(false).exact_size(PLOTS_WIDTH);
        plots.show(ui, |ui| match state.panel {
            Panel::Wind => wind_plots(ui, subjects.wind_facts),
            Panel::Levels | Panel::Species => costs_panel(ui, subjects.costs),
        });
    }
    if subjects.has_turntable {
        let mature_years = subjects.session.species().age.mature_years;
        let stage = EguiPanel::bottom("windwood stage").frame(bar(ui));
        stage.show(ui, |ui| stage_bar(ui, subjects.stage, subjects.season, subjects.wind, mature_years));
    }
    let picture = ui.available_rect_before_wrap();
    legend(&context, picture, subjects.legend);
    let is_quitting = dialogs::show(&context, subjects.session, &mut state.dialog);
    end_gesture(&context, subjects.session);
    Drawn { picture, is_quitting, is_cancelled }
}

fn left_panel(ui: &mut Ui, state: &mut UiState, subjects: &mut Subjects) {
    match state.panel {
        Panel::Species => species_panel(ui, subjects.session, &mut state.filter, &mut state.dialog),
        Panel::Wind => wind_panel(ui, subjects.wind, subjects.stage, subjects.wind_table, subjects.wind_facts),
        Panel::Levels => {
            let forest = subjects.forest.as_deref_mut();
            levels_panel(ui, subjects.levels, forest, subjects.is_frozen, subjects.level_tables);
        }
    }
}

/// Does what the pressed shortcuts say. While a question waits, nothing else is done.
fn obey(context: &bevy_egui::egui::Context, state: &mut UiState, subjects: &mut Subjects) {
    let commands = pressed(context);
    if subjects.session.question.is_some() {
        return;
    }
    for command in commands {
        match command {
            Command::Open => state.dialog = Some(Dialog::open(subjects.session.path())),
            Command::SaveAs => state.dialog = Some(Dialog::save_as(subjects.session.path())),
            Command::Save => subjects.session.save(),
            Command::Undo => subjects.session.undo(),
            Command::Redo => subjects.session.redo(),
            Command::Randomise => subjects.session.randomise(),
            Command::Turn => subjects.stage.turns ^= true,
            Command::Help => state.dialog = Some(Dialog::Shortcuts),
            Command::Panel(number) => state.panel = Panel::ALL[number].0,
            Command::Close => {}
        }
    }
}

/// A change ends when the pointer is released and no text is edited.
fn end_gesture(context: &bevy_egui::egui::Context, session: &mut Session) {
    let is_pressed = context.input(|input| input.pointer.any_down() || !input.keys_down.is_empty());
    if !is_pressed && !context.egui_wants_keyboard_input() {
        session.end_gesture();
    }
}

/// What the colours of the view mean, in a corner of the picture.
fn legend(context: &bevy_egui::egui::Context, picture: Rect, entries: &[(String, [f32; 3])]) {
    if entries.is_empty() {
        return;
    }
    let corner = picture.right_top() + vec2(-10.0, 10.0);
    Area::new(Id::new("windwood legend"))
        .pivot(Align2::RIGHT_TOP)
        .fixed_pos(corner)
        .interactable(false)
        .fade_in(false)
        .show(context, |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                for (text, colour) in entries {
                    ui.horizontal(|ui| {
                        let (at, _) = ui.allocate_exact_size(vec2(14.0, 14.0), bevy_egui::egui::Sense::hover());
                        let [red, green, blue] = colour.map(|channel| (channel * 255.0) as u8);
                        ui.painter().rect_filled(at, 3.0, Color32::from_rgb(red, green, blue));
                        ui.label(RichText::new(text));
                    });
                }
            });
        });
}

#[cfg(test)]
mod tests;
