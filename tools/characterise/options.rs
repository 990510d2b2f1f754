//! Command-line options.

use crate::{
    arguments::{in_range, size},
    window::{FARTHEST_M, Window},
};
use bevy::math::DVec2;
use bevy_windwood::terrain::{RawLayout, RawSample};
use clap::{Args, Parser, Subcommand, ValueEnum};
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
    /// Elevations: a GeoTIFF of one band, an ESRI ASCII grid, an SRTM tile (N40W106.hgt), a PNG with 16 bits of grey, or raw samples; at
    /// most 4096 x 4096.
    pub file: PathBuf,
    /// Distance of neighbouring samples, m: 0.001 to 7000. A PNG and raw samples need it; other files have it. Degrees are turned to metres
    /// at the latitude of the map.
    #[arg(long, value_parser = cell_m)]
    pub cell_size: Option<f64>,
    /// Distance of samples from north to south, where it differs, m.
    #[arg(long, value_parser = cell_m, requires = "cell_size")]
    pub cell_size_z: Option<f64>,
    /// Rise for each unit of a sample, m: 0.000001 to 1000.
    #[arg(long, default_value_t = 1.0, value_parser = metres_per_unit)]
    pub metres_per_unit: f64,
    /// Elevation of a sample of 0, m: -100000 to 100000.
    #[arg(long, default_value_t = 0.0, value_parser = base_m, allow_hyphen_values = true)]
    pub base: f64,
    /// Elevations of black and of white, m, in place of --metres-per-unit and --base. A PNG with 8 bits of grey needs them.
    #[arg(long, value_name = "LOW,HIGH", value_parser = height_range, allow_hyphen_values = true)]
    pub height_range: Option<HeightRange>,
    /// The sample that says that there is no data, where the file does not say it. Such cells are left out of the variogram, and filled in
    /// the picture.
    #[arg(long, value_name = "VALUE", value_parser = no_data, allow_hyphen_values = true)]
    pub no_data: Option<f64>,
    /// The file has raw samples, so many from west to east and from north to south.
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = raw_size)]
    pub raw: Option<(u32, u32)>,
    /// How a raw sample is written.
    #[arg(long, value_enum, default_value_t = Sample::U16le, requires = "raw")]
    pub sample: Sample,
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
    /// A table of at most a million places. Columns are separated by commas, semicolons, tabs or blanks; numbers may have decimal commas.
    /// x and y are in columns with usual names (x, gx, easting, "X (m)", ...), or else in the first two.
    pub file: PathBuf,
    /// The area in which all points were recorded, m: a rectangle by its least x, least y, greatest x, greatest y; a circle by its centre
    /// and radius; or a polygon by a table of its corners. Quadrats that lie wholly inside count.
    #[arg(long, value_name = "X0,Y0,X1,Y1|circle:X,Y,R|polygon:FILE", value_parser = window, allow_hyphen_values = true)]
    pub window: WindowOption,
    /// Names of the columns of x and y, or their numbers from 1.
    #[arg(long, value_name = "NAME,NAME", value_parser = columns)]
    pub columns: Option<Columns>,
    /// Columns and rows of quadrats, such as 20x15, in the box around the window. By default there are as many quadrats as points.
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

/// A window as it is told: a polygon's corners are still in their file.
#[derive(Clone, Debug, PartialEq)]
pub enum WindowOption {
    Given(Window),
    PolygonFile(PathBuf),
}

/// Names of the columns of x and y.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Columns(pub [String; 2]);

/// Elevations of the least and the greatest sample, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightRange(pub [f64; 2]);

/// How a raw sample is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Sample {
    U16le,
    U16be,
    I16le,
    I16be,
    F32le,
    F32be,
}

impl TerrainOptions {
    /// How raw samples lie, where the file has them.
    pub fn raw_layout(&self) -> Option<RawLayout> {
        let sample = match self.sample {
            Sample::U16le => RawSample::U16LittleEndian,
            Sample::U16be => RawSample::U16BigEndian,
            Sample::I16le => RawSample::I16LittleEndian,
            Sample::I16be => RawSample::I16BigEndian,
            Sample::F32le => RawSample::F32LittleEndian,
            Sample::F32be => RawSample::F32BigEndian,
        };
        self.raw.map(|(columns, rows)| RawLayout { columns, rows, sample })
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

fn no_data(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "expected a number, or nan".to_owned())
}

fn raw_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once('x').and_then(|(columns, rows)| Some((columns.parse().ok()?, rows.parse().ok()?)));
    sides.ok_or_else(|| "expected COLUMNSxROWS, such as 1025x1025".to_owned())
}

fn height_range(text: &str) -> Result<HeightRange, String> {
    let heights = text.split_once(',').ok_or("expected two numbers LOW,HIGH")?;
    let [low, high] = [base_m(heights.0.trim())?, base_m(heights.1.trim())?];
    if low >= high {
        return Err(format!("expected LOW below HIGH, but {low} is not below {high}"));
    }
    Ok(HeightRange([low, high]))
}

fn columns(text: &str) -> Result<Columns, String> {
    let names: Vec<&str> = text.split(',').map(str::trim).collect();
    match names[..] {
        [x, y] if !x.is_empty() && !y.is_empty() => Ok(Columns([x.to_owned(), y.to_owned()])),
        _ => Err("expected two names NAME,NAME".to_owned()),
    }
}

fn window(text: &str) -> Result<WindowOption, String> {
    if let Some(file) = text.strip_prefix("polygon:") {
        return Ok(WindowOption::PolygonFile(file.into()));
    }
    let circle = text.strip_prefix("circle:");
    let of = if circle.is_some() { "X,Y,R" } else { "X0,Y0,X1,Y1" };
    let numbers: Vec<f64> = circle
        .unwrap_or(text)
        .split(',')
        .map(|number| in_range(number.trim(), -FARTHEST_M, FARTHEST_M, "m"))
        .collect::<Result<_, _>>()
        .map_err(|error| format!("{error} for each of {of}"))?;
    match (circle, numbers.as_slice()) {
        (Some(_), &[x, y, radius_m]) => Window::circle(DVec2::new(x, y), radius_m).map(WindowOption::Given),
        (Some(_), _) => Err(format!("expected three numbers {of}, but there are {}", numbers.len())),
        (None, &[x0, y0, x1, y1]) => Window::rectangle(DVec2::new(x0, y0), DVec2::new(x1, y1)).map(WindowOption::Given),
        (None, _) => Err(format!("expected four numbers {of}, but there are {}", numbers.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn window_has_four_numbers_and_an_area() {
        let expected = Window::rectangle(DVec2::new(-5.0, 0.0), DVec2::new(10.0, 2e3)).unwrap();
        assert_eq!(window("-5, 0,10,2e3"), Ok(WindowOption::Given(expected)));
        assert_eq!(window("1,2,3").unwrap_err(), "expected four numbers X0,Y0,X1,Y1, but there are 3");
        assert!(window("0,0,nan,1").unwrap_err().starts_with("expected a number from -40000000 to 40000000 m"));
        assert!(window("0,0,0,1").unwrap_err().starts_with("its size is 0 x 1 m"));
        assert!(window("5,0,0,1").unwrap_err().starts_with("its size is -5 x 1 m"));
    }

    #[test]
    fn a_window_may_be_a_circle_or_a_polygon_of_a_file() {
        let circle = Window::circle(DVec2::new(-5.0, 3.0), 12.5).unwrap();
        assert_eq!(window("circle:-5,3,12.5"), Ok(WindowOption::Given(circle)));
        assert_eq!(window("circle:1,2").unwrap_err(), "expected three numbers X,Y,R, but there are 2");
        assert!(window("circle:0,0,-3").is_err());
        assert_eq!(window("polygon:a b.csv"), Ok(WindowOption::PolygonFile("a b.csv".into())));
    }

    #[test]
    fn pairs_have_two_parts() {
        assert_eq!(height_range("-10, 250.5"), Ok(HeightRange([-10.0, 250.5])));
        assert!(height_range("5,5").is_err() && height_range("5").is_err() && height_range("nan,5").is_err());
        assert_eq!(columns("east, north"), Ok(Columns(["east".to_owned(), "north".to_owned()])));
        assert!(columns("east").is_err() && columns("east,").is_err() && columns("a,b,c").is_err());
    }
}
