//! The bar at the bottom: what was done last, and what is being done.

use bevy_egui::egui::{Align, Label, Layout, ProgressBar, RichText, Ui};

use super::theme::palette;
use crate::editor::file_session::Message;

/// Width of the bar that tells how far a forest is planted, points.
const PLANTING_WIDTH: f32 = 140.0;

/// What is told of the tree that is shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TreeFacts {
    pub height_m: f32,
    pub beams: usize,
    pub triangles: usize,
    /// From the last change to the tree that shows it, ms.
    pub grown_in_ms: Option<f64>,
    /// Whether a tree is being grown.
    pub is_growing: bool,
}

/// Work in the background that is not wanted any more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cancelled {
    /// The tree that is being grown.
    pub growing: bool,
    pub exporting: bool,
    /// The forest that is planted after the last change of its plan, which is taken back.
    pub planting: bool,
}

/// A forest that is being planted as a changed plan says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planting<'a> {
    /// How much of it is, 0 to 1.
    pub share: f32,
    /// What cancelling it takes back, if there is anything.
    pub step: Option<&'a str>,
}

/// The bar at the bottom: what was done last, what is shown of a tree, and what is being done.
pub fn status_bar(
    ui: &mut Ui,
    message: Option<&Message>,
    facts: Option<&TreeFacts>,
    is_exporting: bool,
    planting: Option<Planting>,
) -> Cancelled {
    let palette = palette(ui.visuals());
    let mut cancelled = Cancelled::default();
    ui.horizontal(|ui| {
        ui.set_height(20.0);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            cancelled.growing = facts.is_some_and(|facts| tree_facts(ui, facts));
            cancelled.exporting = is_exporting && under_way(ui, "Exporting", "Nothing is written then");
            cancelled.planting = planting.is_some_and(|planting| planting_bar(ui, planting));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let (text, colour) = match message {
                    Some(Message::Done(text)) => (text.as_str(), palette.good),
                    Some(Message::Failed(text)) => (text.as_str(), palette.bad),
                    None => ("", palette.good),
                };
                let text = Label::new(RichText::new(text).color(colour)).truncate();
                ui.add(text);
            });
        });
    });
    cancelled
}

fn tree_facts(ui: &mut Ui, facts: &TreeFacts) -> bool {
    let time = facts.grown_in_ms.map_or_else(String::new, |ms| format!("  ·  grown in {ms:.0} ms"));
    let counts = format!("{:.1} m  ·  {} beams  ·  {} triangles{time}", facts.height_m, facts.beams, facts.triangles);
    ui.label(RichText::new(counts).weak());
    facts.is_growing && under_way(ui, "Growing", "Go back to the tree that is shown")
}

/// Work that goes on. Returns whether it is to be cancelled.
fn under_way(ui: &mut Ui, what: &str, cancel: &str) -> bool {
    let is_cancelled = ui.small_button("Cancel").on_hover_text(cancel).clicked();
    ui.label(what);
    ui.spinner();
    is_cancelled
}

/// How far the forest is planted. Returns whether that is to be cancelled.
fn planting_bar(ui: &mut Ui, planting: Planting) -> bool {
    let is_cancelled = planting.step.is_some_and(|step| {
        let hint = format!("Take back: {step}");
        ui.small_button("Cancel").on_hover_text(hint).clicked()
    });
    let bar = ProgressBar::new(planting.share).show_percentage();
    let bar = ui.add(bar.desired_width(PLANTING_WIDTH).desired_height(16.0));
    let named = ui.label("Planting");
    bar.labelled_by(named.id);
    is_cancelled
}
