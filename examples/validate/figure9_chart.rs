//! The chart of figure 9: frames a second over the number of trees, both logarithmic.

use crate::{
    figure9::{Curve, PAPER},
    sheet::{self, FAINT_INK, GRID, INK, PAPER as SHEET, axis_number, label, line, pixels, refused},
};
use plotters::{
    chart::{ChartBuilder, SeriesLabelPosition},
    element::{Circle, Cross, PathElement},
    prelude::IntoLogRange,
    series::LineSeries,
    style::{Color, RGBColor},
};
use std::path::Path;

const COLOURS: [RGBColor; 4] =
    [RGBColor(176, 58, 46), RGBColor(202, 138, 4), RGBColor(37, 99, 165), RGBColor(34, 120, 60)];

/// Draws the curves, and the paper's frame rates at 1,000 trees as crosses.
///
/// # Errors
/// Where the plotting library refuses, or the file cannot be written.
pub fn draw(path: &Path, curves: &[Curve; 4]) -> Result<(), String> {
    let rates = || curves.iter().flat_map(|curve| curve.points.iter().map(|point| point.1));
    let least = rates().fold(PAPER[0].1, f64::min);
    let greatest = rates().fold(PAPER[3].1, f64::max);
    let picture = sheet::chart("Frame rate over number of trees (crosses: the paper)", |area| {
        let mut chart = ChartBuilder::on(area)
            .margin_right(pixels(10))
            .x_label_area_size(pixels(52))
            .y_label_area_size(pixels(92))
            .build_cartesian_2d((8.0..13_000.0).log_scale(), (least / 1.6..greatest * 1.6).log_scale())
            .map_err(refused)?;
        chart
            .configure_mesh()
            .bold_line_style(line(GRID, 1))
            .axis_style(line(FAINT_INK, 1))
            .label_style(label(&FAINT_INK))
            .axis_desc_style(label(&INK))
            .x_desc("trees")
            .y_desc("frames/s")
            .x_label_formatter(&|&value| axis_number(value))
            .y_label_formatter(&|&value| axis_number(value))
            .draw()
            .map_err(refused)?;
        for ((curve, colour), (_, paper)) in curves.iter().zip(COLOURS).zip(PAPER) {
            let points = || curve.points.iter().map(|(trees, rate)| (f64::from(*trees), *rate));
            let stroke = line(colour, 3);
            chart
                .draw_series(LineSeries::new(points(), stroke))
                .map_err(refused)?
                .label(curve.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + pixels(22), y)], stroke));
            chart.draw_series(points().map(|point| Circle::new(point, pixels(4), colour.filled()))).map_err(refused)?;
            let cross = Cross::new((1000.0, paper), pixels(7), line(colour, 2));
            chart.draw_series([cross]).map_err(refused)?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerLeft)
            .label_font(label(&INK))
            .background_style(SHEET)
            .border_style(line(GRID, 1))
            .legend_area_size(pixels(34))
            .margin(pixels(14))
            .draw()
            .map_err(refused)
    })?;
    picture.save(path).map_err(|error| error.to_string())
}
