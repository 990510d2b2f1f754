//! The chart of a variogram: what was measured, and what was fitted.

use crate::sheet::{Area, FAINT_INK, FITTED, GRID, INK, MEASURED, PAPER, axis_number, label, line, pixels, refused};
use bevy::math::DVec2;
use bevy_windwood::terrain::{Fit, Variogram};
use plotters::{
    chart::{ChartBuilder, SeriesLabelPosition},
    element::{Circle, PathElement},
    prelude::{BindKeyPoints, IntoLogRange},
    series::LineSeries,
    style::Color,
};
use std::ops::Range;

/// Points of a fitted curve.
const CURVE_POINTS: u32 = 200;
/// Decades of semivariance below the greatest that are shown.
const MOST_DECADES: i32 = 6;

/// Decades up to which axes have more ticks than the powers of ten.
const MOST_SUBDIVIDED: i32 = 4;

/// Draws the semivariance over distance, both logarithmic, with the best of `fits` and, faint, the others.
///
/// # Errors
/// Where the plotting library refuses.
pub fn draw(area: &Area, variogram: &Variogram, fits: &[Fit]) -> Result<(), String> {
    let classes = variogram.classes();
    let distances_m = || classes.iter().map(|class| class.distance_m);
    let nearest_m = distances_m().fold(f64::INFINITY, f64::min);
    let farthest_m = distances_m().fold(0.0, f64::max);
    let greatest_m2 = classes.iter().map(|class| class.semivariance_m2).fold(0.0, f64::max);
    let floor_m2 = greatest_m2 * 10f64.powi(-MOST_DECADES);
    let least_m2 = classes.iter().map(|class| class.semivariance_m2).fold(greatest_m2, f64::min).max(floor_m2);
    let (x, y) = ((nearest_m / 1.15)..(farthest_m * 1.15), (least_m2 / 2.0)..(greatest_m2 * 2.0));
    let mut chart = ChartBuilder::on(area)
        .margin_right(pixels(10))
        .x_label_area_size(pixels(52))
        .y_label_area_size(pixels(92))
        .build_cartesian_2d(
            x.clone().log_scale().with_key_points(ticks(&x)),
            y.clone().log_scale().with_key_points(ticks(&y)),
        )
        .map_err(refused)?;
    chart
        .configure_mesh()
        .bold_line_style(line(GRID, 1))
        .axis_style(line(FAINT_INK, 1))
        .set_all_tick_mark_size(pixels(5))
        .label_style(label(&FAINT_INK))
        .axis_desc_style(label(&INK))
        .x_desc("distance, m")
        .y_desc("semivariance, m^2")
        .x_label_formatter(&|&value| axis_number(value))
        .y_label_formatter(&|&value| axis_number(value))
        .draw()
        .map_err(refused)?;

    let curve = |fit: Fit| {
        let octaves = (farthest_m / nearest_m).ln();
        (0..=CURVE_POINTS).map(move |point| {
            let distance_m = nearest_m * (octaves * f64::from(point) / f64::from(CURVE_POINTS)).exp();
            (distance_m, fit.semivariance_m2(DVec2::new(distance_m, 0.0)))
        })
    };
    let is_shown = |&(_, semivariance_m2): &(f64, f64)| y.contains(&semivariance_m2);
    for (rank, &fit) in fits.iter().enumerate().rev() {
        let (stroke, name) = match rank {
            0 => (line(FITTED, 3), fit.model.name()),
            _ => (line(FAINT_INK.mix(0.45), 1), "the other models"),
        };
        let series = chart.draw_series(LineSeries::new(curve(fit).filter(is_shown), stroke)).map_err(refused)?;
        if rank < 2 {
            series.label(name).legend(move |(x, y)| PathElement::new([(x, y), (x + pixels(22), y)], stroke));
        }
    }
    let dots = classes.iter().map(|class| (class.distance_m, class.semivariance_m2)).filter(is_shown);
    chart
        .draw_series(dots.map(|dot| Circle::new(dot, pixels(4), MEASURED.filled())))
        .map_err(refused)?
        .label("measured")
        .legend(|(x, y)| Circle::new((x + pixels(11), y), pixels(4), MEASURED.filled()));
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .label_font(label(&INK))
        .background_style(PAPER)
        .border_style(line(GRID, 1))
        .legend_area_size(pixels(34))
        .margin(pixels(14))
        .draw()
        .map_err(refused)
}

/// 1, 2 and 5 times the powers of ten; over many decades the powers alone.
fn ticks(range: &Range<f64>) -> Vec<f64> {
    let (first, last) = (range.start.log10().floor() as i32, range.end.log10().floor() as i32);
    let digits: &[f64] = if last - first > MOST_SUBDIVIDED { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let of_decade = |decade: i32| digits.iter().map(move |digit| digit * 10f64.powi(decade));
    (first..=last).flat_map(of_decade).filter(|tick| range.contains(tick)).collect()
}
