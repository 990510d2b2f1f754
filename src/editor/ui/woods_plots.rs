//! What a wood is like: the counts of the chosen area's quadrats beside its law.

use bevy_egui::egui::{RichText, Ui, vec2};
use egui_plot::{Bar, BarChart, PlotPoints, Points};

use super::{
    plots::{legend, still_plot},
    theme::palette,
    value_rows::fact,
};
use crate::editor::quadrat_histogram::QuadratHistogram;

/// What is known of a wood.
#[derive(Clone, Copy, Default)]
pub struct WoodsFacts<'a> {
    /// Of the chosen area; none while it is being counted, or where there is none.
    pub histogram: Option<&'a Result<QuadratHistogram, String>>,
    /// Stems about the viewer.
    pub stems: usize,
    /// Whether the wood is still growing to what the plan says.
    pub is_growing: bool,
    /// The share of the forest that is planted as a changed plan says; none where all is.
    pub planted_share: Option<f32>,
}

/// Draws what is known.
pub fn woods_plots(ui: &mut Ui, facts: WoodsFacts) {
    ui.heading("Pattern");
    ui.add_space(4.0);
    match facts.histogram {
        None => {
            ui.weak("No area is chosen.");
        }
        Some(Err(error)) => {
            ui.colored_label(palette(ui.visuals()).warning, error);
        }
        Some(Ok(histogram)) => {
            bars(ui, histogram);
            ui.add_space(8.0);
            numbers(ui, histogram);
        }
    }
    ui.add_space(12.0);
    ui.heading("Forest");
    ui.add_space(4.0);
    fact(ui, "Stems about the view", &facts.stems.to_string(), None);
    if facts.is_growing {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label("Cells are being planted");
        });
    }
}

fn bars(ui: &mut Ui, histogram: &QuadratHistogram) {
    let palette = palette(ui.visuals());
    ui.label(RichText::new("Plants in a quadrat").strong());
    ui.weak("Share of the quadrats over plants in them");
    let share = |quadrats: f64| quadrats / histogram.quadrats() as f64;
    let counted = histogram.observed.iter().enumerate();
    let bars = counted.map(|(count, quadrats)| Bar::new(count as f64, share(*quadrats as f64)).width(0.8)).collect();
    let law = histogram.expected.iter().enumerate().map(|(count, quadrats)| [count as f64, share(*quadrats)]);
    let height = (ui.available_height() - 260.0).clamp(140.0, 360.0);
    legend(ui, [("planted", palette.lines[0], false), ("law", palette.lines[1], false)]);
    still_plot("quadrats", height).include_y(0.0).set_margin_fraction(vec2(0.02, 0.06)).show(ui, |plot| {
        plot.bar_chart(BarChart::new("planted", bars).color(palette.lines[0]));
        plot.points(Points::new("law", PlotPoints::from_iter(law)).color(palette.lines[1]).radius(4.0));
    });
}

fn numbers(ui: &mut Ui, histogram: &QuadratHistogram) {
    let palette = palette(ui.visuals());
    fact(ui, "Quadrats", &format!("{} of {:.1} m", histogram.quadrats(), histogram.quadrat_m), None);
    fact(ui, "Mean", &format!("{:.2}, by the law {:.2}", histogram.mean, histogram.law_mean), None);
    fact(ui, "Variance / mean", &format!("{:.2}, by the law {:.2}", histogram.index, histogram.law_index), None);
    if let Some(p) = histogram.p {
        let (text, colour) = if p < 0.01 {
            (format!("p = {p:.1e}: another pattern"), palette.warning)
        } else {
            (format!("p = {p:.2}: as the law says"), palette.good)
        };
        fact(ui, "Chi-square test", &text, Some(colour));
    }
    ui.add_space(4.0);
    ui.weak(if histogram.is_in_outline {
        "Whole quadrats in the outline, without what is kept free. The least distance takes plants from dense quadrats."
    } else {
        "On open ground of full density: few whole quadrats are in the outline. The least distance takes plants from dense ones."
    });
}
