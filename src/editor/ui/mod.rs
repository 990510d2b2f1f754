//! The panels: drawn by egui, with nothing of the engine. They show and change what [`Subjects`] lends them.

mod bars;
mod controls;
pub mod dialogs;
mod file_bar;
mod ground_panel;
mod ground_plots;
mod land_view;
mod levels_panel;
mod plots;
mod rows;
mod session_rows;
mod shortcuts;
mod species_panel;
mod spline_view;
mod starling;
pub mod theme;
mod value_rows;
mod wind_panel;
mod woods_panel;
mod woods_plots;

pub use bars::{Panel, TreeFacts};
pub use ground_plots::GroundFacts;
pub use levels_panel::LevelTables;
pub use wind_panel::{WindFacts, wind_table};
pub use woods_plots::WoodsFacts;

use self::{
    bars::{land_bar, stage_bar, status_bar, top_bar},
    dialogs::Dialog,
    ground_panel::ground_panel,
    ground_plots::ground_plots,
    land_view::{empty_picture, move_view, pointer, wood_in_picture},
    levels_panel::{costs_panel, levels_panel},
    shortcuts::{Command, pressed},
    species_panel::species_panel,
    spline_view::spline_in_picture,
    theme::{MARGIN, PANEL_WIDTH},
    wind_panel::{wind_panel, wind_plots},
    woods_panel::woods_panel,
    woods_plots::woods_plots,
};
use super::{
    costs::Costs,
    fields::Section,
    file_session::FileSession,
    ground_desk::{GroundDesk, GroundKind},
    land_pose::LandPose,
    randomiser::Randomiser,
    scene_view::SceneView,
    session::Session,
    stage::Stage,
    woods::Woods,
};
use crate::{
    forest::ForestSettings,
    render::LevelOfDetail,
    tree::{Season, Species},
    wind::Wind,
};
use bevy_egui::egui::{Align2, Area, Color32, Frame, Id, Margin, Panel as EguiPanel, Rect, RichText, Ui, vec2};

/// Width of the panel with plots, points.
const PLOTS_WIDTH: f32 = 400.0;

/// What the panels keep from frame to frame.
#[derive(Debug, Default)]
pub struct UiState {
    pub panel: Panel,
    pub dialog: Option<Dialog>,
    pub filter: String,
    pub randomiser: Randomiser,
    has_theme: bool,
}

/// What the panels show and change.
pub struct Subjects<'a> {
    pub session: &'a mut Session<Species>,
    pub stage: &'a mut Stage,
    pub season: &'a mut Season,
    pub wind: &'a mut Wind,
    pub wind_table: &'a Section,
    pub wind_facts: WindFacts<'a>,
    pub woods: &'a mut Woods,
    pub woods_facts: WoodsFacts<'a>,
    pub ground: &'a mut GroundDesk,
    pub ground_facts: GroundFacts<'a>,
    /// From where a wood or ground is looked at, on the turntable.
    pub pose: &'a mut LandPose,
    /// The picture of it, if there is one.
    pub view: Option<&'a SceneView>,
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

impl Subjects<'_> {
    /// What the keys and the dialogs act on while a panel is open.
    fn files(&mut self, panel: Panel) -> &mut dyn FileSession {
        match panel {
            Panel::Woods => &mut self.woods.session,
            Panel::Ground => self.ground.session(),
            Panel::Species | Panel::Wind | Panel::Levels => self.session,
        }
    }
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
    let facts = (!state.panel.is_of_land()).then_some(subjects.tree);
    let message = subjects.files(state.panel).message().cloned();
    let is_cancelled = status.show(ui, |ui| status_bar(ui, message.as_ref(), facts)).inner;
    let fields = EguiPanel::left("windwood fields").frame(frame(ui)).resizable(false).exact_size(PANEL_WIDTH);
    fields.show(ui, |ui| left_panel(ui, state, &mut subjects));
    if state.panel != Panel::Species {
        let plots = EguiPanel::right("windwood plots").frame(frame(ui)).resizable(false).exact_size(PLOTS_WIDTH);
        plots.show(ui, |ui| match state.panel {
            Panel::Wind => wind_plots(ui, subjects.wind_facts),
            Panel::Woods => woods_plots(ui, subjects.woods_facts),
            Panel::Ground => ground_plots(ui, subjects.ground, subjects.ground_facts),
            Panel::Levels | Panel::Species => costs_panel(ui, subjects.costs),
        });
    }
    if subjects.has_turntable {
        let mature_years = subjects.session.document().age.mature_years;
        let stage = EguiPanel::bottom("windwood stage").frame(bar(ui));
        stage.show(ui, |ui| {
            if state.panel.is_of_land() {
                land_bar(ui, subjects.pose, subjects.season, subjects.wind);
            } else {
                stage_bar(ui, subjects.stage, subjects.season, subjects.wind, mature_years);
            }
        });
    }
    let picture = ui.available_rect_before_wrap();
    if state.panel.is_of_land() {
        land(ui, state.panel, picture, &mut subjects);
    } else {
        legend(&context, picture, subjects.legend);
    }
    let is_quitting = dialogs::show(&context, subjects.files(state.panel), &mut state.dialog);
    end_gesture(&context, subjects.files(state.panel));
    Drawn { picture, is_quitting, is_cancelled }
}

fn left_panel(ui: &mut Ui, state: &mut UiState, subjects: &mut Subjects) {
    let dialog = &mut state.dialog;
    match state.panel {
        Panel::Species => species_panel(ui, subjects.session, &mut state.randomiser, &mut state.filter, dialog),
        Panel::Woods => woods_panel(ui, subjects.woods, subjects.pose, dialog),
        Panel::Ground => ground_panel(ui, subjects.ground, subjects.pose, dialog),
        Panel::Wind => wind_panel(ui, subjects.wind, subjects.stage, subjects.wind_table, subjects.wind_facts),
        Panel::Levels => {
            let forest = subjects.forest.as_deref_mut();
            levels_panel(ui, subjects.levels, forest, subjects.is_frozen, subjects.level_tables);
        }
    }
}

/// The picture of a wood or of ground, and what the pointer does in it.
fn land(ui: &Ui, panel: Panel, picture: Rect, subjects: &mut Subjects) {
    let Some(view) = subjects.view else {
        empty_picture(ui, picture, "There is no camera.");
        return;
    };
    let response = pointer(ui, picture);
    let is_free = match panel {
        Panel::Ground if subjects.ground.kind == GroundKind::Spline => {
            spline_in_picture(ui, &response, view, subjects.ground)
        }
        Panel::Woods => wood_in_picture(ui, &response, view, subjects.woods),
        _ => true,
    };
    if subjects.has_turntable {
        move_view(ui, &response, subjects.pose, is_free);
    }
}

/// Does what the pressed shortcuts say. While a question waits, nothing else is done.
fn obey(context: &bevy_egui::egui::Context, state: &mut UiState, subjects: &mut Subjects) {
    let commands = pressed(context);
    if subjects.files(state.panel).question().is_some() {
        return;
    }
    for command in commands {
        let files = subjects.files(state.panel);
        match command {
            Command::Open => state.dialog = Some(Dialog::open(files.path())),
            Command::SaveAs => state.dialog = Some(Dialog::save_as(files.path())),
            Command::Save => files.save(),
            Command::Undo => files.undo(),
            Command::Redo => files.redo(),
            Command::Randomise if !state.panel.is_of_land() => state.randomiser.randomise(subjects.session),
            Command::Turn => subjects.stage.turns ^= true,
            Command::Help => state.dialog = Some(Dialog::Shortcuts),
            Command::Panel(number) => state.panel = Panel::ALL[number].0,
            Command::Close | Command::Randomise => {}
        }
    }
}

/// A change ends when the pointer is released and no text is edited.
fn end_gesture(context: &bevy_egui::egui::Context, session: &mut dyn FileSession) {
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
