//! The chart of a variogram: what was measured, and what was fitted.

use crate::chart::{Area, FAINT, FITTED, MEASURED, draw_axes, draw_legend, line, pixels, plot_error};
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
/// Greatest number of decades of semivariance that are shown.
const MOST_DECADES: i32 = 6;
/// Greatest number of decades with ticks between the powers of ten.
const MOST_SUBDIVIDED_DECADES: i32 = 4;

/// Draws the semivariance over distance, both logarithmic, with the best of `fits`, and the others in grey.
///
/// # Errors
/// What plotters says.
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
        .map_err(plot_error)?;
    draw_axes(&mut chart, ["distance, m", "semivariance, m^2"], |_| ())?;

    let curve = |fit: Fit| {
        let span = (farthest_m / nearest_m).ln();
        (0..=CURVE_POINTS).map(move |point| {
            let distance_m = nearest_m * (span * f64::from(point) / f64::from(CURVE_POINTS)).exp();
            (distance_m, fit.semivariance_m2(DVec2::new(distance_m, 0.0)))
        })
    };
    let is_shown = |&(_, semivariance_m2): &(f64, f64)| y.contains(&semivariance_m2);
    for (rank, &fit) in fits.iter().enumerate().rev() {
        let (stroke, name) = match rank {
            0 => (line(FITTED, 3), fit.model.name()),
            _ => (line(FAINT.mix(0.45), 1), "the other models"),
        };
        let series = chart.draw_series(LineSeries::new(curve(fit).filter(is_shown), stroke)).map_err(plot_error)?;
        if rank < 2 {
            series.label(name).legend(move |(x, y)| PathElement::new([(x, y), (x + pixels(22), y)], stroke));
        }
    }
    let dots = classes.iter().map(|class| (class.distance_m, class.semivariance_m2)).filter(is_shown);
    chart
        .draw_series(dots.map(|dot| Circle::new(dot, pixels(4), MEASURED.filled())))
        .map_err(plot_error)?
        .label("measured")
        .legend(|(x, y)| Circle::new((x + pixels(11), y), pixels(4), MEASURED.filled()));
    draw_legend(&mut chart, SeriesLabelPosition::LowerRight)
}

/// 1, 2 and 5 times the powers of ten, or over many decades the powers alone.
fn ticks(range: &Range<f64>) -> Vec<f64> {
    let (first, last) = (range.start.log10().floor() as i32, range.end.log10().floor() as i32);
    let digits: &[f64] = if last - first > MOST_SUBDIVIDED_DECADES { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let of_decade = |decade: i32| digits.iter().map(move |digit| digit * 10f64.powi(decade));
    (first..=last).flat_map(of_decade).filter(|tick| range.contains(tick)).collect()
}
