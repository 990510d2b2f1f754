//! Charts as images: a title, two pictures side by side where there are any, and below them the chart.

// Each program that includes this file uses a part of it.
#![allow(dead_code)]

use image::{RgbImage, imageops};
use plotters::{
    chart::{ChartContext, MeshStyle, SeriesLabelPosition},
    coord::{
        CoordTranslate, Shift,
        cartesian::Cartesian2d,
        ranged1d::{Ranged, ValueFormatter},
    },
    prelude::{BitMapBackend, DrawingArea, DrawingBackend, IntoDrawingArea, RGBColor},
    style::{Color, FontStyle, IntoFont, ShapeStyle, TextStyle, register_font},
};
use std::fmt::Display;

pub const BACKGROUND: RGBColor = RGBColor(252, 251, 248);
pub const TEXT: RGBColor = RGBColor(38, 42, 46);
pub const FAINT: RGBColor = RGBColor(120, 124, 128);
pub const GRID: RGBColor = RGBColor(226, 225, 220);
/// Colour of what was measured.
pub const MEASURED: RGBColor = RGBColor(70, 76, 82);
/// Colour of what was fitted. It differs from all others in brightness too, for prints.
pub const FITTED: RGBColor = RGBColor(200, 84, 24);

/// Heights of text, pixels.
const TITLE: u32 = 26;
const CAPTION: u32 = 19;
const LABEL: u32 = 17;
/// Text and charts are drawn at this multiple of their size and scaled down, because plotters rounds to whole pixels.
const SCALE: u32 = 3;

const MARGIN: u32 = 36;
const TITLE_HEIGHT: u32 = 44;
const CAPTION_HEIGHT: u32 = 32;
const CHART_HEIGHT: u32 = 380;
/// Least width of a picture with its caption, and so of half a chart.
const LEAST_COLUMN_WIDTH: u32 = 520;

/// The area of a chart.
pub type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;

/// A picture and its caption.
pub struct Panel {
    pub caption: String,
    pub picture: RgbImage,
}

/// Draws two pictures with their captions and a chart. Lengths in the chart are those of [`pixels`].
///
/// # Errors
/// What plotters says.
pub fn pictures_and_chart(
    title: &str,
    panels: &[Panel; 2],
    chart_caption: &str,
    chart: impl FnOnce(&Area) -> Result<(), String>,
) -> Result<RgbImage, String> {
    let column_width = panels.iter().map(|panel| panel.picture.width()).fold(LEAST_COLUMN_WIDTH, u32::max);
    let picture_height = panels.iter().map(|panel| panel.picture.height()).max().unwrap_or(0);
    let width = 3 * MARGIN + 2 * column_width;
    let pictures_top = MARGIN + TITLE_HEIGHT + CAPTION_HEIGHT;
    let chart_top = pictures_top + picture_height + MARGIN;
    let height = chart_top + CAPTION_HEIGHT + CHART_HEIGHT + MARGIN;
    let left = |index: usize| MARGIN + index as u32 * (column_width + MARGIN);

    let mut figure = draw_scaled(width, height, |page| {
        let write = |text: &str, size: u32, colour: &RGBColor, x: u32, y: u32| {
            page.draw_text(text, &style(size, colour), (pixels(x), pixels(y))).map_err(plot_error)
        };
        write(title, TITLE, &TEXT, MARGIN, MARGIN)?;
        for (index, panel) in panels.iter().enumerate() {
            write(&panel.caption, CAPTION, &FAINT, left(index), MARGIN + TITLE_HEIGHT)?;
        }
        write(chart_caption, CAPTION, &FAINT, MARGIN, chart_top)?;
        chart(&page.margin(pixels(chart_top + CAPTION_HEIGHT), pixels(MARGIN), pixels(MARGIN), pixels(MARGIN)))
    })?;
    for (index, panel) in panels.iter().enumerate() {
        imageops::replace(&mut figure, &panel.picture, left(index).into(), pictures_top.into());
    }
    Ok(figure)
}

/// Draws a title and a chart.
///
/// # Errors
/// What plotters says.
pub fn chart_alone(title: &str, chart: impl FnOnce(&Area) -> Result<(), String>) -> Result<RgbImage, String> {
    let (width, height) =
        (3 * MARGIN + LEAST_COLUMN_WIDTH + LEAST_COLUMN_WIDTH / 2, CHART_HEIGHT + TITLE_HEIGHT + 2 * MARGIN);
    draw_scaled(width, height, |page| {
        page.draw_text(title, &style(TITLE, &TEXT), (pixels(MARGIN), pixels(MARGIN))).map_err(plot_error)?;
        chart(&page.margin(pixels(MARGIN + TITLE_HEIGHT), pixels(MARGIN), pixels(MARGIN), pixels(MARGIN)))
    })
}

/// An image of a size, on which `draw` has drawn at [`SCALE`].
fn draw_scaled(width: u32, height: u32, draw: impl FnOnce(&Area) -> Result<(), String>) -> Result<RgbImage, String> {
    register_font("sans-serif", FontStyle::Normal, bevy::text::DEFAULT_FONT_DATA)
        .map_err(|_| "the font for the picture cannot be read")?;
    let (fine_width, fine_height) = (width * SCALE, height * SCALE);
    let mut channels = vec![0; fine_width as usize * fine_height as usize * 3];
    {
        let page = BitMapBackend::with_buffer(&mut channels, (fine_width, fine_height)).into_drawing_area();
        page.fill(&BACKGROUND).map_err(plot_error)?;
        draw(&page)?;
        page.present().map_err(plot_error)?;
    }
    let fine =
        RgbImage::from_raw(fine_width, fine_height, channels).ok_or("the picture has lost some of its pixels")?;
    Ok(imageops::thumbnail(&fine, width, height))
}

/// A length of the image in pixels of the chart.
pub fn pixels(length: u32) -> i32 {
    (length * SCALE).cast_signed()
}

/// Style of text on axes and in legends.
pub fn label(colour: &RGBColor) -> TextStyle<'static> {
    style(LABEL, colour)
}

/// Style of a line.
pub fn line(colour: impl Color, width: u32) -> ShapeStyle {
    colour.stroke_width(width * SCALE)
}

fn style(size: u32, colour: &RGBColor) -> TextStyle<'static> {
    ("sans-serif", size * SCALE).into_font().color(&colour.to_rgba())
}

/// An error of plotters.
pub fn plot_error(error: impl Display) -> String {
    format!("the picture cannot be drawn: {error}")
}

/// A number on an axis, with an exponent where it would be long.
pub fn axis_number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e7).contains(&value.abs()) { format!("{value}") } else { format!("{value:.0e}") }
}

/// Draws the axes of a chart with their names. `adjust` changes what is particular to it.
///
/// # Errors
/// What plotters says.
pub fn draw_axes<'a, DB: DrawingBackend + 'a, X, Y>(
    chart: &mut ChartContext<'a, DB, Cartesian2d<X, Y>>,
    [x_name, y_name]: [&str; 2],
    adjust: impl FnOnce(&mut MeshStyle<'a, '_, X, Y, DB>),
) -> Result<(), String>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let mut style = chart.configure_mesh();
    style
        .bold_line_style(line(GRID, 1))
        .axis_style(line(FAINT, 1))
        .set_all_tick_mark_size(pixels(5))
        .label_style(label(&FAINT))
        .axis_desc_style(label(&TEXT))
        .x_desc(x_name)
        .y_desc(y_name)
        .x_label_formatter(&|&value| axis_number(value))
        .y_label_formatter(&|&value| axis_number(value));
    adjust(&mut style);
    style.draw().map_err(plot_error)
}

/// Draws the legend of a chart.
///
/// # Errors
/// What plotters says.
pub fn draw_legend<'a, DB: DrawingBackend + 'a, C: CoordTranslate>(
    chart: &mut ChartContext<'a, DB, C>,
    position: SeriesLabelPosition,
) -> Result<(), String> {
    chart
        .configure_series_labels()
        .position(position)
        .label_font(label(&TEXT))
        .background_style(BACKGROUND)
        .border_style(line(GRID, 1))
        .legend_area_size(pixels(34))
        .margin(pixels(14))
        .draw()
        .map_err(plot_error)
}
