//! What the ground is like: its variogram beside that of its model.

use bevy_egui::egui::{RichText, Ui};

use super::{
    plots::{Curve, PlotForm, plot},
    theme::palette,
    value_rows::fact,
};
use crate::editor::{
    ground_desk::{GroundDesk, GroundKind},
    ground_variogram::GroundVariogram,
    map_fit::MapFit,
};

/// What is known of the ground.
#[derive(Clone, Copy, Default)]
pub struct GroundFacts<'a> {
    /// Of the random ground that was made last.
    pub variogram: Option<&'a GroundVariogram>,
    /// Whether ground is being built.
    pub is_building: bool,
}

/// Draws what is known.
pub fn ground_plots(ui: &mut Ui, ground: &GroundDesk, facts: GroundFacts) {
    ui.heading("Variogram");
    ui.add_space(4.0);
    match ground.kind {
        GroundKind::Random => random(ui, facts.variogram),
        GroundKind::Map => match &ground.fit {
            Some(fit) => map(ui, fit, ground.chosen_fit),
            None => {
                ui.weak("Press Fit to read a map and measure it.");
            }
        },
        GroundKind::Spline => {
            ui.weak("Ground of control points has no model.");
        }
    }
    if facts.is_building {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label("The ground is being built");
        });
    }
}

const AXES: [&str; 2] = ["m", "semivariance, m²"];

fn height(ui: &Ui) -> f32 {
    (ui.available_height() - 220.0).clamp(140.0, 380.0)
}

fn random(ui: &mut Ui, variogram: Option<&GroundVariogram>) {
    let Some(variogram) = variogram else {
        ui.weak("Level ground has none.");
        return;
    };
    let palette = palette(ui.visuals());
    let curves = vec![
        Curve { name: "made", points: variogram.measured.clone(), colour: palette.lines[0], is_target: false },
        Curve { name: "model", points: variogram.model.clone(), colour: palette.target, is_target: true },
    ];
    let form = PlotForm { title: "Made ground and model", axes: AXES, height: height(ui), ..PlotForm::default() };
    plot(ui, &form, curves);
    ui.add_space(8.0);
    fact(ui, "Sill", &format!("{:.1} m²", variogram.sill_m2), None);
    let longest_m = variogram.measured.last().map_or(0.0, |last| last[0]);
    fact(ui, "Longest lag", &format!("{longest_m:.0} m"), None);
    ui.add_space(4.0);
    ui.weak("The mean of sixteen windows of 192 x 192 samples, 16 to a scale. One piece of ground differs from its model by chance.");
}

fn map(ui: &mut Ui, fit: &MapFit, chosen: usize) {
    let palette = palette(ui.visuals());
    let classes = fit.variogram.classes();
    let measured = classes.iter().map(|class| [class.distance_m, class.semivariance_m2]).collect();
    let mut curves = vec![Curve { name: "map", points: measured, colour: palette.lines[0], is_target: false }];
    let model = fit.fits.get(chosen);
    if let Some(model) = model {
        let points = classes.iter().map(|class| [class.distance_m, model.semivariance_m2(class.lag_m())]).collect();
        curves.push(Curve { name: model.model.name(), points, colour: palette.target, is_target: true });
    }
    let form = PlotForm { title: "Map and model", axes: AXES, height: height(ui), ..PlotForm::default() };
    plot(ui, &form, curves);
    ui.add_space(8.0);
    let grid = fit.map.grid();
    let cell_m = grid.cell_m();
    fact(ui, "Samples", &format!("{} x {} of {:.0} m", grid.columns(), grid.rows(), cell_m.min_element()), None);
    fact(ui, "Mean", &format!("{:.0} m", fit.variogram.drift().mean_m), None);
    let Some(model) = model else { return };
    fact(ui, "Scale", &format!("{:.0} m", model.scale_m), None);
    fact(ui, "Range", &format!("{:.0} m", model.practical_range_m()), None);
    fact(ui, "Standard deviation", &format!("{:.1} m", model.deviation_m), None);
    ui.label(
        RichText::new(format!("The {} model misses the map by {:.1}%.", model.model.name(), 100.0 * model.residual))
            .weak(),
    );
}
