//! The panels: drawn by egui, with nothing of the engine. They show and change what [`Subjects`] lends them.

mod bars;
mod controls;
pub mod dialogs;
mod envelope_view;
mod file_bar;
mod ground_panel;
mod ground_plots;
mod land_view;
mod levels_panel;
mod live_rows;
mod picture_keys;
mod plots;
mod rows;
mod session_rows;
mod shortcuts;
mod species_panel;
mod spline_view;
mod starling;
mod status_bar;
pub mod theme;
mod value_rows;
mod wind_panel;
mod woods_panel;
mod woods_plots;

pub use bars::Panel;
pub use ground_plots::GroundFacts;
pub use levels_panel::{LevelSettings, LevelTables};
pub use status_bar::{Cancelled, TreeFacts};
pub use wind_panel::{WindFacts, wind_table};
pub use woods_plots::WoodsFacts;

use std::path::PathBuf;

use self::{
    bars::{land_bar, stage_bar, top_bar},
    dialogs::{Answer, Dialog},
    envelope_view::envelope_in_picture,
    ground_panel::ground_panel,
    ground_plots::ground_plots,
    land_view::{empty_picture, move_stage, move_view, pointer, wood_in_picture},
    levels_panel::{costs_panel, levels_panel},
    picture_keys::picture_keys,
    shortcuts::{Command, pressed},
    species_panel::species_panel,
    spline_view::spline_in_picture,
    status_bar::{Planting, status_bar},
    theme::{MARGIN, PANEL_WIDTH},
    wind_panel::{wind_panel, wind_plots},
    woods_panel::woods_panel,
    woods_plots::woods_plots,
};
use super::{
    costs::Costs,
    envelope_handles::EnvelopeHandle,
    fields::Section,
    file_session::FileSession,
    ground_desk::{GroundDesk, GroundKind},
    land_pose::LandPose,
    live_settings::LiveSettings,
    randomiser::Randomiser,
    scene_view::SceneView,
    session::Session,
    stage::Stage,
    steps::Steps,
    woods::Woods,
};
use crate::{
    tree::{Season, Species},
    wind::Wind,
};
use bevy_egui::egui::{Align2, Area, Color32, Frame, Id, Margin, Panel as EguiPanel, Pos2, Rect, RichText, Ui, vec2};

/// Width of the panel with plots, points.
const PLOTS_WIDTH: f32 = 400.0;

/// What the panels keep from frame to frame.
#[derive(Debug, Default)]
pub struct UiState {
    pub panel: Panel,
    pub dialog: Option<Dialog>,
    pub filter: String,
    pub randomiser: Randomiser,
    /// What the pointer holds of the envelope.
    envelope: Option<EnvelopeHandle>,
    has_theme: bool,
}

/// What the panels show and change.
pub struct Subjects<'a> {
    pub session: &'a mut Session<Species>,
    pub stage: &'a mut Stage,
    pub season: &'a mut Season,
    pub wind: &'a mut LiveSettings<Wind>,
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
    pub levels: &'a mut LiveSettings<LevelSettings>,
    pub level_tables: &'a LevelTables,
    pub is_frozen: &'a mut bool,
    pub costs: &'a Costs,
    pub tree: &'a TreeFacts,
    /// Whether a tree is being exported.
    pub is_exporting: bool,
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

    /// What undoing acts on while a panel is open.
    fn steps(&mut self, panel: Panel) -> &mut dyn Steps {
        match panel {
            Panel::Wind => self.wind,
            Panel::Levels => self.levels,
            Panel::Species => self.session,
            Panel::Woods => &mut self.woods.session,
            Panel::Ground => match self.ground.kind {
                GroundKind::Random | GroundKind::Map => &mut self.ground.random,
                GroundKind::Spline => &mut self.ground.spline,
            },
        }
    }
}

/// What came of drawing the panels.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// What the panels leave free, points.
    pub picture: Rect,
    /// Where the pointer is, if it is there.
    pub pointer: Option<Pos2>,
    pub is_quitting: bool,
    /// What is not wanted any more.
    pub cancelled: Cancelled,
    /// Where the tree is to be exported to, if it was asked for.
    pub export_to: Option<PathBuf>,
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
    let planted_share = subjects.woods_facts.planted_share.filter(|_| state.panel == Panel::Woods);
    let planting = planted_share.map(|share| Planting { share, step: subjects.woods.session.undo_step() });
    let cancelled =
        status.show(ui, |ui| status_bar(ui, message.as_ref(), facts, subjects.is_exporting, planting)).inner;
    if cancelled.planting {
        subjects.woods.session.undo();
    }
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
                stage_bar(ui, state.panel, subjects.stage, subjects.season, subjects.wind, mature_years);
            }
        });
    }
    let picture = ui.available_rect_before_wrap();
    if state.panel.is_of_land() {
        land(ui, state.panel, picture, &mut subjects);
    } else {
        legend(&context, picture, subjects.legend);
        if subjects.has_turntable {
            let response = pointer(ui, picture);
            let keys = picture_keys(ui, &response, "Picture of the tree: arrows turn it, page keys bring it nearer");
            let held = &mut state.envelope;
            let view = subjects.view.filter(|_| state.panel == Panel::Species);
            let is_free = view
                .is_none_or(|view| envelope_in_picture(ui, &response, view, subjects.stage, held, subjects.session));
            move_stage(ui, &response, subjects.stage, &keys, is_free);
        }
    }
    let Answer { is_quitting, export_to } = dialogs::show(&context, subjects.files(state.panel), &mut state.dialog);
    end_gesture(&context, subjects.steps(state.panel));
    // The bar under the picture sets the wind, whatever panel is open.
    end_gesture(&context, subjects.wind);
    let pointer = context.pointer_latest_pos().filter(|at| picture.contains(*at) && state.dialog.is_none());
    Drawn { picture, pointer, is_quitting, cancelled, export_to }
}

fn left_panel(ui: &mut Ui, state: &mut UiState, subjects: &mut Subjects) {
    let dialog = &mut state.dialog;
    match state.panel {
        Panel::Species => species_panel(ui, subjects.session, &mut state.randomiser, &mut state.filter, dialog),
        Panel::Woods => woods_panel(ui, subjects.woods, subjects.pose, dialog),
        Panel::Ground => ground_panel(ui, subjects.ground, subjects.pose, dialog),
        Panel::Wind => wind_panel(ui, subjects.wind, subjects.stage, subjects.wind_table, subjects.wind_facts),
        Panel::Levels => levels_panel(ui, subjects.levels, subjects.is_frozen, subjects.level_tables),
    }
}

/// The picture of a wood or of ground, and what the pointer does in it.
fn land(ui: &Ui, panel: Panel, picture: Rect, subjects: &mut Subjects) {
    let Some(view) = subjects.view else {
        empty_picture(ui, picture, "There is no camera.");
        return;
    };
    let response = pointer(ui, picture);
    let hint = "Picture of the land: arrows turn it, with Shift they shift it, Space puts the tool down";
    let keys = picture_keys(ui, &response, hint);
    let is_free = match panel {
        Panel::Ground if subjects.ground.kind == GroundKind::Spline => {
            spline_in_picture(ui, &response, view, &keys, subjects.ground)
        }
        Panel::Woods => wood_in_picture(ui, &response, view, &keys, subjects.woods),
        _ => true,
    };
    if subjects.has_turntable {
        move_view(ui, &response, subjects.pose, &keys, is_free);
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
            Command::Undo => subjects.steps(state.panel).undo(),
            Command::Redo => subjects.steps(state.panel).redo(),
            Command::Randomise if !state.panel.is_of_land() => state.randomiser.randomise(subjects.session),
            Command::Turn => subjects.stage.turns ^= true,
            Command::Help => state.dialog = Some(Dialog::Shortcuts),
            Command::Panel(number) => state.panel = Panel::ALL[number].0,
            Command::Close | Command::Randomise => {}
        }
    }
}

/// A change ends when the pointer is released and no text is edited.
fn end_gesture(context: &bevy_egui::egui::Context, steps: &mut dyn Steps) {
    let is_pressed = context.input(|input| input.pointer.any_down() || !input.keys_down.is_empty());
    if !is_pressed && !context.egui_wants_keyboard_input() {
        steps.end_gesture();
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
