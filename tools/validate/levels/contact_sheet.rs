//! The contact sheet: a row for each species, two pictures for each change of level (the full tree and the coarser level), and
//! the two levels of the paper.

use image::{RgbImage, imageops};
use std::path::Path;

/// Size of a picture on the sheet, pixels.
const CELL: (u32, u32) = (208, 160);
const GAP: u32 = 4;

/// Pictures, row by row.
#[derive(Default)]
pub struct ContactSheet {
    rows: Vec<Vec<RgbImage>>,
}

impl ContactSheet {
    /// Begins a row.
    pub fn begin_row(&mut self) {
        self.rows.push(Vec::new());
    }

    /// Adds part of a picture (left, top, width, height).
    pub fn add(&mut self, picture: &RgbImage, [left, top, width, height]: [u32; 4]) {
        let part = imageops::crop_imm(picture, left, top, width, height).to_image();
        let part = imageops::resize(&part, CELL.0, CELL.1, imageops::FilterType::Triangle);
        if let Some(row) = self.rows.last_mut() {
            row.push(part);
        }
    }

    /// Writes the sheet.
    pub fn save(&self, path: &Path) -> Result<(), String> {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0) as u32;
        let size = (columns * (CELL.0 + GAP), self.rows.len() as u32 * (CELL.1 + GAP));
        let mut sheet = RgbImage::from_pixel(size.0.max(1), size.1.max(1), image::Rgb([255; 3]));
        for (row, pictures) in (0u32..).zip(&self.rows) {
            for (column, picture) in (0u32..).zip(pictures) {
                let (x, y) = (column * (CELL.0 + GAP), row * (CELL.1 + GAP));
                imageops::replace(&mut sheet, picture, x.into(), y.into());
            }
        }
        sheet.save(path).map_err(|error| error.to_string())
    }
}
