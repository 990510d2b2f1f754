//! Command-line options.

use crate::arguments::{in_range, size};
use bevy::math::DVec2;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Characterises real ground and real patterns of plants.
#[derive(Parser, Clone, Debug)]
#[command(about = "Characterises real ground and real patterns of plants, and draws random ones of the same kind")]
pub struct Options {
    #[command(subcommand)]
    pub subject: Subject,
}

#[derive(Subcommand, Clone, Debug)]
pub enum Subject {
    /// Fits covariance models to a map of elevations.
    Terrain(TerrainOptions),
    /// Fits laws of counts to a pattern of points.
    Points(PointsOptions),
}

#[derive(Args, Clone, Debug)]
pub struct TerrainOptions {
    /// A PNG with 16 bits of grey and at most 4096 x 4096 samples.
    pub file: PathBuf,
    /// Distance of neighbouring samples, m: 0.001 to 7000.
    #[arg(long, value_parser = cell_m)]
    pub cell_size: f64,
    /// Distance of samples from north to south, where it differs, m.
    #[arg(long, value_parser = cell_m)]
    pub cell_size_z: Option<f64>,
    /// Rise for each unit of a sample, m: 0.000001 to 1000.
    #[arg(long, default_value_t = 1.0, value_parser = metres_per_unit)]
    pub metres_per_unit: f64,
    /// Elevation of a sample of 0, m: -100000 to 100000.
    #[arg(long, default_value_t = 0.0, value_parser = base_m, allow_hyphen_values = true)]
    pub base: f64,
    /// Seed of the random ground.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// File for the results as JSON.
    #[arg(long)]
    pub json: Option<PathBuf>,
    /// File for the picture.
    #[arg(long, default_value = "out/characterise_terrain.png")]
    pub out: PathBuf,
}

#[derive(Args, Clone, Debug)]
pub struct PointsOptions {
    /// Comma-separated values: x and y in the first two columns, or in those that the first line calls x and y; at most
    /// a million points.
    pub file: PathBuf,
    /// The rectangle in which all points were recorded, m: least x, least y, greatest x, greatest y.
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = window, allow_hyphen_values = true)]
    pub window: Window,
    /// Columns and rows of quadrats, such as 20x15. By default there are as many quadrats as points.
    #[arg(long, value_name = "CxR", value_parser = size)]
    pub quadrats: Option<(u32, u32)>,
    /// Seed of the random pattern.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// File for the results as JSON.
    #[arg(long)]
    pub json: Option<PathBuf>,
    /// File for the picture.
    #[arg(long, default_value = "out/characterise_points.png")]
    pub out: PathBuf,
}

/// A rectangle with an area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    pub min_m: DVec2,
    pub max_m: DVec2,
}

impl Window {
    /// Width and height, m.
    pub fn size_m(&self) -> DVec2 {
        self.max_m - self.min_m
    }

    /// Whether a point lies inside or on the edge. NaN does not.
    pub fn contains(&self, point: DVec2) -> bool {
        point.cmpge(self.min_m).all() && point.cmple(self.max_m).all()
    }
}

fn cell_m(text: &str) -> Result<f64, String> {
    in_range(text, 1e-3, 7e3, "m")
}

fn metres_per_unit(text: &str) -> Result<f64, String> {
    in_range(text, 1e-6, 1e3, "m")
}

fn base_m(text: &str) -> Result<f64, String> {
    in_range(text, -1e5, 1e5, "m")
}

fn window(text: &str) -> Result<Window, String> {
    /// Length of the equator.
    const FARTHEST_M: f64 = 4e7;
    const NARROWEST_M: f64 = 1e-3;
    let numbers: Vec<f64> = text
        .split(',')
        .map(|number| in_range(number.trim(), -FARTHEST_M, FARTHEST_M, "m"))
        .collect::<Result<_, _>>()
        .map_err(|error| format!("{error} for each of X0,Y0,X1,Y1"))?;
    let &[x0, y0, x1, y1] = numbers.as_slice() else {
        return Err(format!("expected four numbers X0,Y0,X1,Y1, but there are {}", numbers.len()));
    };
    let window = Window { min_m: DVec2::new(x0, y0), max_m: DVec2::new(x1, y1) };
    if window.size_m().min_element() < NARROWEST_M {
        let size_m = window.size_m();
        return Err(format!(
            "its size is {} x {} m, but must be at least {NARROWEST_M} m each way (X0 < X1, Y0 < Y1)",
            size_m.x, size_m.y
        ));
    }
    Ok(window)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn window_has_four_numbers_and_an_area() {
        let expected = Window { min_m: DVec2::new(-5.0, 0.0), max_m: DVec2::new(10.0, 2e3) };
        assert_eq!(window("-5, 0,10,2e3"), Ok(expected));
        assert_eq!(window("1,2,3").unwrap_err(), "expected four numbers X0,Y0,X1,Y1, but there are 3");
        assert!(window("0,0,nan,1").unwrap_err().starts_with("expected a number from -40000000 to 40000000 m"));
        assert!(window("0,0,0,1").unwrap_err().starts_with("its size is 0 x 1 m"));
        assert!(window("5,0,0,1").unwrap_err().starts_with("its size is -5 x 1 m"));
    }
}
