//! Where the samples of a file lie, and how large their cells are in metres.

use crate::terrain::error::TerrainError;
use bevy::math::DVec2;

/// The ellipsoid of WGS 84: half of the equator's diameter, m, and the square of the eccentricity.
const EQUATOR_RADIUS_M: f64 = 6_378_137.0;
const ECCENTRICITY_SQUARED: f64 = 6.694_379_990_14e-3;
/// A cell below this is one of degrees if it lies where degrees can: it would have less than 2 cm otherwise, and has up to 2 km so.
const CERTAIN_DEGREES: f64 = 0.02;
/// A cell from this on has metres: it would have more than 100 km otherwise.
const CERTAIN_METRES: f64 = 1.0;

/// What places and cells are measured in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MapUnit {
    /// A length, m.
    Length(f64),
    /// Degrees of longitude and latitude.
    Degrees,
    /// The file does not say.
    Unknown,
}

/// Where the samples of a file lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Georeference {
    pub unit: MapUnit,
    /// Size of a cell, eastwards and southwards.
    pub cell: DVec2,
    /// The western and the northern edge, in the same unit.
    pub west_north: DVec2,
}

/// The size of cells in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CellSize {
    pub cell_m: DVec2,
    /// The latitude at which degrees were turned to metres.
    pub latitude_deg: Option<f64>,
}

impl Georeference {
    /// The size of cells, m. Those in degrees have the size that they have on the ellipsoid in the middle of the map, which
    /// has `rows` rows.
    ///
    /// # Errors
    /// [`TerrainError::Format`] where the file does not say whether cells have metres or degrees, and both are likely.
    pub fn cell_size(&self, rows: u32) -> Result<CellSize, TerrainError> {
        let latitude_deg = self.west_north.y - 0.5 * f64::from(rows) * self.cell.y;
        match self.unit_of(latitude_deg) {
            Some(MapUnit::Degrees) => {
                let latitude_deg = latitude_deg.clamp(-90.0, 90.0);
                Ok(CellSize { cell_m: self.cell * degree_m(latitude_deg), latitude_deg: Some(latitude_deg) })
            }
            Some(MapUnit::Length(unit_m)) => Ok(CellSize { cell_m: self.cell * unit_m, latitude_deg: None }),
            _ => Err(TerrainError::Format {
                found: format!(
                    "one with cells of {} whose unit it does not say: they may have metres or degrees",
                    self.cell.x
                ),
                allowed: "one that says it, or read with `cell_x_m` given",
            }),
        }
    }

    /// The unit, which is guessed where the file does not say it: `None` where a guess would not be safe.
    fn unit_of(&self, latitude_deg: f64) -> Option<MapUnit> {
        if self.unit != MapUnit::Unknown {
            return Some(self.unit);
        }
        let lies_on_the_globe = self.west_north.x.abs() <= 360.0 && latitude_deg.abs() <= 90.0;
        let cell = self.cell.max_element();
        if !lies_on_the_globe || cell >= CERTAIN_METRES {
            Some(MapUnit::Length(1.0))
        } else {
            (cell < CERTAIN_DEGREES).then_some(MapUnit::Degrees)
        }
    }
}

/// Length of a degree of longitude and of latitude at a latitude, m: those of the parallel and of the meridian of the ellipsoid.
fn degree_m(latitude_deg: f64) -> DVec2 {
    let (sin, cos) = latitude_deg.to_radians().sin_cos();
    let flattened = 1.0 - ECCENTRICITY_SQUARED * sin * sin;
    let normal_m = EQUATOR_RADIUS_M / flattened.sqrt();
    let meridian_m = normal_m * (1.0 - ECCENTRICITY_SQUARED) / flattened;
    DVec2::new(normal_m * cos, meridian_m) * 1f64.to_radians()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn degrees_have_their_published_lengths() {
        // Table of the lengths of a degree on WGS 84 (National Geospatial-Intelligence Agency), m.
        for (latitude_deg, longitude_m, latitude_m) in
            [(0.0, 111_320.0, 110_574.0), (45.0, 78_847.0, 111_132.0), (60.0, 55_800.0, 111_412.0)]
        {
            let found = degree_m(latitude_deg);
            assert_relative_eq!(found.x, longitude_m, epsilon = 1.0);
            assert_relative_eq!(found.y, latitude_m, epsilon = 1.0);
        }
        assert_relative_eq!(degree_m(90.0).x, 0.0, epsilon = 1e-6);
    }

    #[test]
    fn units_are_guessed_only_where_that_is_safe() {
        let size = |cell: f64, west: f64, north: f64| {
            let georeference =
                Georeference { unit: MapUnit::Unknown, cell: DVec2::splat(cell), west_north: DVec2::new(west, north) };
            georeference.cell_size(10)
        };
        assert_eq!(size(466.0, 423_000.0, 4_489_338.0).unwrap().cell_m, DVec2::splat(466.0));
        assert_eq!(size(0.5, 423_000.0, 4_489_338.0).unwrap().cell_m, DVec2::splat(0.5));
        assert_eq!(size(1.0, 0.0, 10.0).unwrap().cell_m, DVec2::splat(1.0));
        let degrees = size(1.0 / 3600.0, -105.0, 40.0).unwrap();
        assert_relative_eq!(degrees.cell_m.y, 30.84, epsilon = 0.01);
        assert_relative_eq!(degrees.latitude_deg.unwrap(), 40.0 - 5.0 / 3600.0, epsilon = 1e-9);
        let error = size(0.25, 0.0, 50.0).unwrap_err().to_string();
        assert!(error.contains("cells of 0.25") && error.contains("`cell_x_m`"), "{error}");
    }
}
