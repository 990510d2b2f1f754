//! The sheet of paper that charts are drawn on: a title, and where there are any, two pictures side by side, and under them
//! the chart.

// Each of the examples uses a part of it.
#![allow(dead_code)]

use image::{RgbImage, imageops};
use plotters::{
    coord::Shift,
    prelude::{BitMapBackend, DrawingArea, IntoDrawingArea, RGBColor},
    style::{Color, FontStyle, IntoFont, ShapeStyle, TextStyle, register_font},
};
use std::fmt::Display;

pub const PAPER: RGBColor = RGBColor(252, 251, 248);
pub const INK: RGBColor = RGBColor(38, 42, 46);
pub const FAINT_INK: RGBColor = RGBColor(120, 124, 128);
pub const GRID: RGBColor = RGBColor(226, 225, 220);
/// What was measured, in charts.
pub const MEASURED: RGBColor = RGBColor(70, 76, 82);
/// What was fitted, in charts: a blue and an orange tell it apart from all other lines, in print too.
pub const FITTED: RGBColor = RGBColor(200, 84, 24);

/// Heights of text, pixels.
const TITLE: u32 = 26;
const CAPTION: u32 = 19;
const LABEL: u32 = 17;
/// Text and charts are drawn so many times as large and scaled down: the plotting library knows whole pixels only.
const DETAIL: u32 = 3;

const MARGIN: u32 = 36;
const TITLE_HEIGHT: u32 = 44;
const CAPTION_HEIGHT: u32 = 32;
const CHART_HEIGHT: u32 = 380;
/// Room for a chart and for captions, however narrow the pictures are.
const LEAST_COLUMN_WIDTH: u32 = 520;

/// Where a chart is drawn.
pub type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;

/// A picture with what it shows.
pub struct Panel {
    pub caption: String,
    pub picture: RgbImage,
}

/// Draws the sheet; lengths in the chart are those of [`pixels`].
///
/// # Errors
/// Where the plotting library refuses.
pub fn compose(
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

    let mut sheet = drawn(width, height, |paper| {
        let write = |text: &str, size: u32, colour: &RGBColor, x: u32, y: u32| {
            paper.draw_text(text, &style(size, colour), (pixels(x), pixels(y))).map_err(refused)
        };
        write(title, TITLE, &INK, MARGIN, MARGIN)?;
        for (index, panel) in panels.iter().enumerate() {
            write(&panel.caption, CAPTION, &FAINT_INK, left(index), MARGIN + TITLE_HEIGHT)?;
        }
        write(chart_caption, CAPTION, &FAINT_INK, MARGIN, chart_top)?;
        chart(&paper.margin(pixels(chart_top + CAPTION_HEIGHT), pixels(MARGIN), pixels(MARGIN), pixels(MARGIN)))
    })?;
    for (index, panel) in panels.iter().enumerate() {
        imageops::replace(&mut sheet, &panel.picture, left(index).into(), pictures_top.into());
    }
    Ok(sheet)
}

/// Draws a sheet with nothing but a title and a chart.
///
/// # Errors
/// Where the plotting library refuses.
pub fn chart(title: &str, chart: impl FnOnce(&Area) -> Result<(), String>) -> Result<RgbImage, String> {
    let (width, height) =
        (3 * MARGIN + LEAST_COLUMN_WIDTH + LEAST_COLUMN_WIDTH / 2, CHART_HEIGHT + TITLE_HEIGHT + 2 * MARGIN);
    drawn(width, height, |paper| {
        paper.draw_text(title, &style(TITLE, &INK), (pixels(MARGIN), pixels(MARGIN))).map_err(refused)?;
        chart(&paper.margin(pixels(MARGIN + TITLE_HEIGHT), pixels(MARGIN), pixels(MARGIN), pixels(MARGIN)))
    })
}

/// A picture of a size, on which `draw` has drawn.
fn drawn(width: u32, height: u32, draw: impl FnOnce(&Area) -> Result<(), String>) -> Result<RgbImage, String> {
    register_font("sans-serif", FontStyle::Normal, bevy::text::DEFAULT_FONT_DATA)
        .map_err(|_| "the font for the picture cannot be read")?;
    let (fine_width, fine_height) = (width * DETAIL, height * DETAIL);
    let mut channels = vec![0; fine_width as usize * fine_height as usize * 3];
    {
        let paper = BitMapBackend::with_buffer(&mut channels, (fine_width, fine_height)).into_drawing_area();
        paper.fill(&PAPER).map_err(refused)?;
        draw(&paper)?;
        paper.present().map_err(refused)?;
    }
    let fine =
        RgbImage::from_raw(fine_width, fine_height, channels).ok_or("the picture has lost some of its pixels")?;
    Ok(imageops::thumbnail(&fine, width, height))
}

/// A length on the sheet, as charts are drawn.
pub fn pixels(length: u32) -> i32 {
    (length * DETAIL).cast_signed()
}

/// Text on axes and in legends.
pub fn label(colour: &RGBColor) -> TextStyle<'static> {
    style(LABEL, colour)
}

/// A line of a colour and a width.
pub fn line(colour: impl Color, width: u32) -> ShapeStyle {
    colour.stroke_width(width * DETAIL)
}

fn style(size: u32, colour: &RGBColor) -> TextStyle<'static> {
    ("sans-serif", size * DETAIL).into_font().color(&colour.to_rgba())
}

/// What the plotting library says.
pub fn refused(error: impl Display) -> String {
    format!("the picture cannot be drawn: {error}")
}

/// A number on an axis: in full, where it is short.
pub fn axis_number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e7).contains(&value.abs()) { format!("{value}") } else { format!("{value:.0e}") }
}
