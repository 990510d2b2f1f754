//! The chart of a table of counts: how many quadrats hold 0, 1, 2, ... points, and how many the best law expects.

use crate::sheet::{Area, FAINT_INK, FITTED, GRID, INK, MEASURED, PAPER, axis_number, label, line, pixels, refused};
use bevy_windwood::scatter::counts::{CountLaw, CountModel, Frequencies, Probabilities};
use plotters::{
    chart::{ChartBuilder, SeriesLabelPosition},
    element::{Circle, PathElement, Rectangle},
    series::LineSeries,
    style::{Color, RGBColor, TRANSPARENT},
};

/// Share of the quadrats that may lie beyond the end of the axis.
const BEYOND: f64 = 1e-4;
/// Counts on the axis at least, so that there is something to compare with and room for the legend.
const LEAST_COUNTS: usize = 6;
/// Half the width of a bar.
const HALF_BAR: f64 = 0.36;
/// With more counts than this, dots on the curves would touch.
const MOST_DOTS: usize = 60;

/// Draws the observed table as bars, with `best` over them and Poisson's law for comparison.
///
/// # Errors
/// Where the plotting library refuses.
pub fn draw(area: &Area, table: &Frequencies, best: &CountLaw) -> Result<(), String> {
    let quadrats = table.quadrats();
    let counts = shown(table).max(LEAST_COUNTS);
    let random = CountModel::Poisson.with_mean(table.mean()).map_err(refused)?;
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
        .map_err(refused)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .bold_line_style(line(GRID, 1))
        .light_line_style(TRANSPARENT)
        .axis_style(line(FAINT_INK, 1))
        .set_all_tick_mark_size(pixels(5))
        .label_style(label(&FAINT_INK))
        .axis_desc_style(label(&INK))
        .x_desc("points in a quadrat")
        .y_desc("quadrats")
        .x_labels(counts.min(20))
        .x_label_formatter(&|&value| axis_number(value))
        .y_label_formatter(&|&value| axis_number(value))
        .draw()
        .map_err(refused)?;

    let bar = |(count, &quadrats): (usize, &f64)| {
        let middle = count as f64;
        Rectangle::new([(middle - HALF_BAR, 0.0), (middle + HALF_BAR, quadrats)], MEASURED.mix(0.35).filled())
    };
    chart.draw_series(observed.iter().enumerate().map(bar)).map_err(refused)?.label("observed").legend(|(x, y)| {
        Rectangle::new([(x, y - pixels(6)), (x + pixels(22), y + pixels(6))], MEASURED.mix(0.35).filled())
    });
    let mut curve = |points: Vec<(f64, f64)>, colour: RGBColor, width: u32, name: &str| -> Result<(), String> {
        let stroke = line(colour, width);
        let dots = if counts <= MOST_DOTS { points.clone() } else { Vec::new() };
        chart
            .draw_series(LineSeries::new(points, stroke))
            .map_err(refused)?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + pixels(22), y)], stroke));
        chart
            .draw_series(dots.into_iter().map(|dot| Circle::new(dot, pixels(width + 1), colour.filled())))
            .map_err(refused)?;
        Ok(())
    };
    let kind = best.model().kind();
    if kind != random.model().kind() {
        curve(of_random, FAINT_INK, 1, "Poisson, as if random")?;
    }
    curve(of_best, FITTED, 3, kind.name())?;
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .label_font(label(&INK))
        .background_style(PAPER)
        .border_style(line(GRID, 1))
        .legend_area_size(pixels(34))
        .margin(pixels(14))
        .draw()
        .map_err(refused)
}

/// Counts from 0 that hold all but a negligible part of the quadrats.
fn shown(table: &Frequencies) -> usize {
    let most = table.quadrats() * (1.0 - BEYOND);
    let mut held = 0.0;
    let enough = table.quadrats_with().iter().position(|&quadrats| {
        held += quadrats as f64;
        held >= most
    });
    enough.unwrap_or(table.greatest()) + 1
}
