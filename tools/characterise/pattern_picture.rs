//! Patterns of points as pictures: a dot for each point, fainter where there are many.

use crate::{
    chart::{GRID, TEXT},
    window::{Shape, Window},
};
use bevy::math::DVec2;
use image::{Rgb, RgbImage};

/// Pixels along the longer side of a window.
const LONGEST_PIXELS: f64 = 720.0;
/// Radius of a dot over the mean distance of points.
const DOT_RADIUS: f64 = 0.16;
/// Least and greatest radius of a dot, pixels.
const RADIUS: (f64, f64) = (0.6, 5.0);
/// Greatest share of the picture that dots would cover if none overlapped. Beyond it they are drawn fainter.
const MOST_COVERED: f64 = 0.7;

/// Draws points in their window, y upwards.
pub fn draw(points: &[DVec2], window: &Window) -> RgbImage {
    let scale = LONGEST_PIXELS / window.size_m().max_element();
    let size = (window.size_m() * scale).round().max(DVec2::ONE).as_uvec2();
    let area = f64::from(size.x) * f64::from(size.y);
    let spacing = (area / points.len() as f64).sqrt();
    let radius = (DOT_RADIUS * spacing).clamp(RADIUS.0, RADIUS.1);
    let covered = points.len() as f64 * std::f64::consts::PI * radius * radius / area;
    let opacity = (MOST_COVERED / covered).min(1.0);

    let mut light = vec![1.0_f32; (size.x * size.y) as usize];
    for &point in points {
        let from_corner = (point - window.min_m) * scale;
        let centre = DVec2::new(from_corner.x, f64::from(size.y) - from_corner.y);
        draw_dot(&mut light, size.x as usize, centre, radius, opacity);
    }
    let mut picture = RgbImage::from_fn(size.x, size.y, |x, y| grey(light[(y * size.x + x) as usize]));
    match window.shape {
        Shape::Rectangle => draw_frame(&mut picture),
        Shape::Circle { .. } | Shape::Polygon(_) => draw_outline(&mut picture, window, scale),
    }
    picture
}

/// Darkens the pixels of a dot, with a soft edge of one pixel.
fn draw_dot(light: &mut [f32], width: usize, centre: DVec2, radius: f64, opacity: f64) {
    let height = light.len() / width;
    let reach = radius + 0.5;
    let pixels = |middle: f64, most: usize| {
        let first = (middle - reach).floor().max(0.0) as usize;
        first..((middle + reach).ceil().max(0.0) as usize).min(most)
    };
    for y in pixels(centre.y, height) {
        for x in pixels(centre.x, width) {
            let away = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - centre;
            let covered = (reach - away.length()).clamp(0.0, 1.0);
            light[y * width + x] *= (1.0 - opacity * covered) as f32;
        }
    }
}

/// From the colour of text to white.
fn grey(light: f32) -> Rgb<u8> {
    Rgb([TEXT.0, TEXT.1, TEXT.2].map(|dark| (255.0 * light + f32::from(dark) * (1.0 - light)).round() as u8))
}

/// Draws a line along the edges, because the background around the picture is nearly as white.
fn draw_frame(picture: &mut RgbImage) {
    let (width, height) = picture.dimensions();
    let line = frame_colour();
    for x in 0..width {
        picture.put_pixel(x, 0, line);
        picture.put_pixel(x, height - 1, line);
    }
    for y in 0..height {
        picture.put_pixel(0, y, line);
        picture.put_pixel(width - 1, y, line);
    }
}

/// Draws the outline of a window that is no rectangle, pixel by pixel along its edges.
fn draw_outline(picture: &mut RgbImage, window: &Window, scale: f64) {
    let (width, height) = picture.dimensions();
    let corners = window.outline();
    let in_pixels = |corner: DVec2| {
        let from_corner = (corner - window.min_m) * scale;
        DVec2::new(from_corner.x, f64::from(height) - from_corner.y)
    };
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let (from, to) = (in_pixels(*from), in_pixels(*to));
        let steps = (to - from).abs().max_element().ceil().max(1.0) as u32;
        for step in 0..=steps {
            let at = from.lerp(to, f64::from(step) / f64::from(steps));
            let (x, y) = ((at.x.max(0.0) as u32).min(width - 1), (at.y.max(0.0) as u32).min(height - 1));
            picture.put_pixel(x, y, frame_colour());
        }
    }
}

fn frame_colour() -> Rgb<u8> {
    Rgb([GRID.0, GRID.1, GRID.2].map(|channel| channel - 40))
}
