//! The chart of counts: how many quadrats hold 0, 1, 2, ... points, and how many the best law expects.

use crate::chart::{Area, FAINT, FITTED, MEASURED, draw_axes, draw_legend, line, pixels, plot_error};
use bevy_windwood::scatter::counts::{CountLaw, CountModel, Frequencies, Probabilities};
use plotters::{
    chart::{ChartBuilder, SeriesLabelPosition},
    element::{Circle, PathElement, Rectangle},
    series::LineSeries,
    style::{Color, RGBColor, TRANSPARENT},
};

/// Greatest share of the quadrats beyond the end of the axis.
const SHARE_BEYOND: f64 = 1e-4;
/// Least number of counts on the axis, so that the legend has room.
const LEAST_COUNTS: usize = 6;
/// Half the width of a bar.
const HALF_BAR: f64 = 0.36;
/// Greatest number of counts at which dots on the curves do not touch.
const MOST_DOTS: usize = 60;

/// Draws the observed table as bars, with `best` over them and Poisson's law for comparison.
///
/// # Errors
/// What plotters says.
pub fn draw(area: &Area, table: &Frequencies, best: &CountLaw) -> Result<(), String> {
    let quadrats = table.quadrats();
    let counts = shown(table).max(LEAST_COUNTS);
    let random = CountModel::Poisson.with_mean(table.mean()).map_err(plot_error)?;
    let expected = |law: &CountLaw| -> Vec<(f64, f64)> {
        let probabilities = Probabilities::new(law);
        (0..counts).map(|count| (count as f64, quadrats * probabilities.of(count))).collect()
    };
    let (of_best, of_random) = (expected(best), expected(&random));
    let observed: Vec<f64> = table.quadrats_with().iter().take(counts).map(|&quadrats| quadrats as f64).collect();
    let curves = of_best.iter().chain(&of_random).map(|point| point.1);
    let tallest = observed.iter().copied().chain(curves).fold(1.0, f64::max);

    let mut chart = ChartBuilder::on(area)
        .margin_right(pixels(10))
        .x_label_area_size(pixels(52))
        .y_label_area_size(pixels(92))
        .build_cartesian_2d(-0.6..counts as f64 - 0.4, 0.0..tallest * 1.08)
        .map_err(plot_error)?;
    draw_axes(&mut chart, ["points in a quadrat", "quadrats"], |style| {
        style.disable_x_mesh().light_line_style(TRANSPARENT).x_labels(counts.min(20));
    })?;

    let bar = |(count, &quadrats): (usize, &f64)| {
        let middle = count as f64;
        Rectangle::new([(middle - HALF_BAR, 0.0), (middle + HALF_BAR, quadrats)], MEASURED.mix(0.35).filled())
    };
    chart.draw_series(observed.iter().enumerate().map(bar)).map_err(plot_error)?.label("observed").legend(|(x, y)| {
        Rectangle::new([(x, y - pixels(6)), (x + pixels(22), y + pixels(6))], MEASURED.mix(0.35).filled())
    });
    let mut curve = |points: Vec<(f64, f64)>, colour: RGBColor, width: u32, name: &str| -> Result<(), String> {
        let stroke = line(colour, width);
        let dots = if counts <= MOST_DOTS { points.clone() } else { Vec::new() };
        chart
            .draw_series(LineSeries::new(points, stroke))
            .map_err(plot_error)?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + pixels(22), y)], stroke));
        chart
            .draw_series(dots.into_iter().map(|dot| Circle::new(dot, pixels(width + 1), colour.filled())))
            .map_err(plot_error)?;
        Ok(())
    };
    let kind = best.model().kind();
    if kind != random.model().kind() {
        curve(of_random, FAINT, 1, "Poisson, if random")?;
    }
    curve(of_best, FITTED, 3, kind.name())?;
    draw_legend(&mut chart, SeriesLabelPosition::UpperRight)
}

/// Number of counts, from 0, that hold all but a negligible share of the quadrats.
fn shown(table: &Frequencies) -> usize {
    let most = table.quadrats() * (1.0 - SHARE_BEYOND);
    let mut held = 0.0;
    let enough = table.quadrats_with().iter().position(|&quadrats| {
        held += quadrats as f64;
        held >= most
    });
    enough.unwrap_or(table.greatest()) + 1
}
