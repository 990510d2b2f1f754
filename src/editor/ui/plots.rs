//! Plots that all look alike.

use bevy_egui::egui::{Color32, Rangef, RichText, Sense, Shape, Stroke, TextStyle, Ui, vec2};
use egui_plot::{AxisHints, GridInput, GridMark, Line, LineStyle, Plot, PlotPoints, VLine};

use super::theme::palette;
use crate::editor::spectrum::Band;

/// Grid lines nearer than the first have no number, and those farther than the second have one in full strength, points.
const LABEL_SPACING: Rangef = Rangef { min: 34.0, max: 50.0 };

/// A curve of a plot.
pub struct Curve<'a> {
    pub name: &'a str,
    pub points: Vec<[f64; 2]>,
    pub colour: Color32,
    /// What is to be, beside what is.
    pub is_target: bool,
}

/// What a plot shows besides its curves.
#[derive(Clone, Copy, Default)]
pub struct PlotForm<'a> {
    pub title: &'a str,
    /// What is along the axes: across and up.
    pub axes: [&'a str; 2],
    pub height: f32,
    /// Whether both axes are decades.
    pub is_logarithmic: bool,
    /// Whether the axis across alone is decades.
    pub has_logarithmic_x: bool,
    /// Lines across it: a name and a place.
    pub marks: &'a [(&'static str, f64)],
}

/// A plot that stands still.
pub fn still_plot(title: &str, height: f32) -> Plot<'_> {
    Plot::new(title)
        .height(height)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .show_crosshair(false)
}

/// What is drawn how: above a plot, where it covers no curve.
pub fn legend<'a>(ui: &mut Ui, entries: impl IntoIterator<Item = (&'a str, Color32, bool)>) {
    const LINE: f32 = 16.0;
    let mut told = Vec::new();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for entry @ (name, colour, is_dashed) in entries {
            // Several curves may have targets.
            if told.contains(&entry) {
                continue;
            }
            told.push(entry);
            let (line, _) = ui.allocate_exact_size(vec2(LINE, ui.text_style_height(&TextStyle::Small)), Sense::hover());
            let stroke = Stroke::new(2.0, colour);
            let ends = [line.left_center(), line.right_center()];
            if is_dashed {
                ui.painter().extend(Shape::dashed_line(&ends, stroke, 0.25 * LINE, 0.125 * LINE));
            } else {
                ui.painter().line_segment(ends, stroke);
            }
            ui.small(name);
            ui.add_space(6.0);
        }
    });
}

/// Draws a plot.
pub fn plot(ui: &mut Ui, form: &PlotForm, curves: Vec<Curve>) {
    let target = palette(ui.visuals()).target;
    ui.horizontal(|ui| {
        ui.label(RichText::new(form.title).strong());
        ui.weak(format!("{} over {}", form.axes[1], form.axes[0]));
    });
    let [is_log_x, is_log_y] = [form.is_logarithmic || form.has_logarithmic_x, form.is_logarithmic];
    let marks = form.marks.iter().map(|(name, _)| (*name, target, true));
    legend(ui, curves.iter().map(|curve| (curve.name, curve.colour, curve.is_target)).chain(marks));
    let mut plot = still_plot(form.title, form.height)
        .set_margin_fraction(vec2(0.01, 0.06))
        .custom_x_axes(vec![AxisHints::new_x().label_spacing(LABEL_SPACING)]);
    if is_log_x {
        plot = plot.x_grid_spacer(decades).x_axis_formatter(|mark, _| power_of_ten(mark));
    }
    if is_log_y {
        plot = plot.y_grid_spacer(decades).y_axis_formatter(|mark, _| power_of_ten(mark));
    }
    let width = ui.available_width();
    plot.show(ui, |plot| {
        for (name, at) in form.marks {
            let at = if is_log_x { at.max(1e-12).log10() } else { *at };
            plot.vline(
                VLine::new(format!("{name} {at:.2}"), at).name(*name).color(target).style(LineStyle::dashed_dense()),
            );
        }
        for curve in curves {
            let place = |[x, y]: [f64; 2]| {
                let x = if is_log_x { x.log10() } else { x };
                [x, if is_log_y { y.log10() } else { y }]
            };
            let points =
                curve.points.into_iter().map(place).filter(|point| point.iter().all(|value| value.is_finite()));
            let points = PlotPoints::from(thinned(points.collect(), width));
            let style = if curve.is_target { LineStyle::dashed_loose() } else { LineStyle::Solid };
            plot.line(Line::new(curve.name, points).color(curve.colour).style(style).width(1.6));
        }
    });
}

/// A curve of evenly spaced points without those that cannot be told apart in a plot of that width, points of the screen: of what lies within
/// two of these the least and the greatest.
fn thinned(points: Vec<[f64; 2]>, width: f32) -> Vec<[f64; 2]> {
    let runs = (0.5 * width).max(1.0) as usize;
    if points.len() <= 4 * runs {
        return points;
    }
    let ends = |run: &[[f64; 2]]| {
        let by_value = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
        let (least, greatest) = (run.iter().min_by(by_value), run.iter().max_by(by_value));
        let mut ends: Vec<[f64; 2]> = least.into_iter().chain(greatest).copied().collect();
        ends.sort_by(|a, b| a[0].total_cmp(&b[0]));
        ends.dedup();
        ends
    };
    points.chunks(points.len().div_ceil(runs)).flat_map(ends).collect()
}

/// The points of bands.
pub fn points(bands: &[Band]) -> Vec<[f64; 2]> {
    bands.iter().map(|band| [band.frequency_hz, band.value]).collect()
}

/// Grid lines at every power of ten that is in sight.
fn decades(input: GridInput) -> Vec<GridMark> {
    let (low, high) = (input.bounds.0.ceil().max(-40.0) as i32, input.bounds.1.floor().min(40.0) as i32);
    (low..=high).map(|decade| GridMark { value: f64::from(decade), step_size: 1.0 }).collect()
}

fn power_of_ten(mark: GridMark) -> String {
    let decade = mark.value.round() as i32;
    if (-2..=2).contains(&decade) {
        return format!("{}", 10_f64.powi(decade));
    }
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits: String = decade.abs().to_string().bytes().map(|digit| DIGITS[usize::from(digit - b'0')]).collect();
    format!("10{}{digits}", if decade < 0 { "⁻" } else { "" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_curve_keeps_its_peaks_and_its_order() {
        let curve: Vec<[f64; 2]> = (0..4096).map(|i| [f64::from(i), (f64::from(i) * 0.9).sin()]).collect();
        let mut spiky = curve.clone();
        (spiky[1234][1], spiky[1235][1]) = (7.0, -5.0);
        let thin = thinned(spiky.clone(), 400.0);
        assert!(thin.len() <= 400, "{}", thin.len());
        assert!(thin.contains(&spiky[1234]) && thin.contains(&spiky[1235]));
        assert!(thin.is_sorted_by(|a, b| a[0] < b[0]));
        assert!(thin.iter().all(|point| spiky.contains(point)));
        // As it is where that saves little, and where there is no room at all it does not end in a division by nothing.
        assert_eq!(thinned(curve[..700].to_vec(), 400.0), curve[..700]);
        assert_eq!(thinned(curve, 0.0).len(), 2);
        assert_eq!(thinned(Vec::new(), f32::NAN), Vec::<[f64; 2]>::new());
    }
}
