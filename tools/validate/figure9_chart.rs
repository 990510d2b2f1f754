//! The chart of figure 9: frame rate over number of trees, both logarithmic.

use crate::{
    chart::{chart_alone, draw_axes, draw_legend, line, pixels, plot_error},
    figure9::{Curve, PAPER_RATES},
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
/// What plotters says, or that the file cannot be written.
pub fn draw(path: &Path, curves: &[Curve; 4]) -> Result<(), String> {
    let rates = || curves.iter().flat_map(|curve| curve.points.iter().map(|point| point.1));
    let least = rates().fold(PAPER_RATES[0].1, f64::min);
    let greatest = rates().fold(PAPER_RATES[3].1, f64::max);
    let picture = chart_alone("Frame rate over number of trees (crosses: the paper)", |area| {
        let mut chart = ChartBuilder::on(area)
            .margin_right(pixels(10))
            .x_label_area_size(pixels(52))
            .y_label_area_size(pixels(92))
            .build_cartesian_2d((8.0..13_000.0).log_scale(), (least / 1.6..greatest * 1.6).log_scale())
            .map_err(plot_error)?;
        draw_axes(&mut chart, ["trees", "frames/s"], |_| ())?;
        for ((curve, colour), (_, paper)) in curves.iter().zip(COLOURS).zip(PAPER_RATES) {
            let points = || curve.points.iter().map(|(trees, rate)| (f64::from(*trees), *rate));
            let stroke = line(colour, 3);
            chart
                .draw_series(LineSeries::new(points(), stroke))
                .map_err(plot_error)?
                .label(curve.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + pixels(22), y)], stroke));
            chart
                .draw_series(points().map(|point| Circle::new(point, pixels(4), colour.filled())))
                .map_err(plot_error)?;
            let cross = Cross::new((1000.0, paper), pixels(7), line(colour, 2));
            chart.draw_series([cross]).map_err(plot_error)?;
        }
        draw_legend(&mut chart, SeriesLabelPosition::LowerLeft)
    })?;
    picture.save(path).map_err(|error| error.to_string())
}
