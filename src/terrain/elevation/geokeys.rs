//! What the tags of a GeoTIFF say about places and units (OGC 19-008r4, and GDAL's own two tags).

use super::georeference::{Georeference, MapUnit};
use crate::terrain::error::TerrainError;
use bevy::math::DVec2;

/// Whether places have lengths or angles.
const MODEL_TYPE: u16 = 1024;
const PROJECTED: u16 = 1;
const GEOGRAPHIC: u16 = 2;
const ANGULAR_UNITS: u16 = 2054;
const DEGREE: u16 = 9102;
const LINEAR_UNITS: u16 = 3076;
const VERTICAL_UNITS: u16 = 4099;
/// A key that is not used, and one whose value has a definition of its own.
const UNDEFINED: u16 = 0;
/// Turned by less than this share of a cell over a cell, a map is not turned.
const NOT_TURNED: f64 = 1e-6;

/// The tags of a GeoTIFF, as far as they are there.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct GeoTags {
    /// Key, location, count and value of every key, after a header of the same length.
    pub directory: Vec<u16>,
    /// Eastwards, southwards, upwards.
    pub pixel_scale: Vec<f64>,
    /// Column, row, level, and x, y, z of the same point.
    pub tie_point: Vec<f64>,
    /// From column, row and level to x, y and z, as a matrix of 4 x 4, row by row.
    pub transformation: Vec<f64>,
}

impl GeoTags {
    /// Where the samples lie, where the tags say it.
    ///
    /// # Errors
    /// [`TerrainError::Format`] for a map that is turned, and for units that are not known.
    pub fn georeference(&self) -> Result<Option<Georeference>, TerrainError> {
        let unit = self.unit()?;
        let of = |cell, west_north| Some(Georeference { unit, cell, west_north });
        if let [x_scale, y_scale, ..] = self.pixel_scale[..] {
            let cell = DVec2::new(x_scale, y_scale);
            let west_north = match self.tie_point[..] {
                [column, row, _, x, y, ..] => DVec2::new(x - column * cell.x, y + row * cell.y),
                _ => DVec2::ZERO,
            };
            return Ok(of(cell, west_north));
        }
        let [x_scale, x_turn, _, west, y_turn, y_scale, _, north, ..] = self.transformation[..] else {
            return Ok(None);
        };
        if x_turn.abs().max(y_turn.abs()) > NOT_TURNED * x_scale.abs() || x_scale < 0.0 || y_scale > 0.0 {
            return Err(TerrainError::Format {
                found: "a GeoTIFF that is turned or mirrored".to_owned(),
                allowed: "one with north up (gdalwarp makes one)",
            });
        }
        Ok(of(DVec2::new(x_scale, -y_scale), DVec2::new(west, north)))
    }

    /// Metres for each unit of height, where the tags say it.
    pub fn vertical_unit_m(&self) -> Result<Option<f64>, TerrainError> {
        self.key(VERTICAL_UNITS).map(length_m).transpose()
    }

    fn unit(&self) -> Result<MapUnit, TerrainError> {
        match self.key(MODEL_TYPE) {
            Some(GEOGRAPHIC) => match self.key(ANGULAR_UNITS) {
                None | Some(DEGREE) => Ok(MapUnit::Degrees),
                Some(other) => Err(unknown_unit(other)),
            },
            Some(PROJECTED) => Ok(MapUnit::Length(self.key(LINEAR_UNITS).map_or(Ok(1.0), length_m)?)),
            _ => Ok(MapUnit::Unknown),
        }
    }

    /// The value of a key that has a short value of its own.
    fn key(&self, wanted: u16) -> Option<u16> {
        let keys = self.directory.get(4..)?.chunks_exact(4);
        let mut values = keys.filter(|key| key[0] == wanted && key[1] == 0).map(|key| key[3]);
        values.next().filter(|&value| value != UNDEFINED)
    }
}

/// Metres of a unit of length, by its number in the EPSG register.
fn length_m(unit: u16) -> Result<f64, TerrainError> {
    match unit {
        9001 => Ok(1.0),
        9002 => Ok(0.3048),
        9003 => Ok(1200.0 / 3937.0),
        9036 => Ok(1000.0),
        other => Err(unknown_unit(other)),
    }
}

fn unknown_unit(unit: u16) -> TerrainError {
    let found = format!("a GeoTIFF with the unit EPSG {unit}");
    TerrainError::Format {
        found,
        allowed: "one in metres (9001), feet (9002, 9003), kilometres (9036) or degrees (9102)",
    }
}

/// The scale and the offset of the first band in GDAL's metadata, `<Item name="SCALE" sample="0" role="scale">0.1</Item>`: metres of a
/// unit, and of a sample of 0.
pub(super) fn scale_of_metadata(xml: &str) -> Option<[f64; 2]> {
    let value = |role: &str| {
        let (_, rest) = xml.split_once(&format!("role=\"{role}\">"))?;
        rest.split_once('<')?.0.trim().parse::<f64>().ok().filter(|value| value.is_finite())
    };
    let (scale, offset) = (value("scale"), value("offset"));
    (scale.is_some() || offset.is_some()).then(|| [scale.unwrap_or(1.0), offset.unwrap_or(0.0)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tags(keys: &[[u16; 4]]) -> GeoTags {
        let header = [1, 1, 0, keys.len() as u16];
        GeoTags {
            directory: std::iter::once(&header).chain(keys).flatten().copied().collect(),
            pixel_scale: vec![10.0, 20.0, 0.0],
            tie_point: vec![1.0, 2.0, 0.0, 500.0, 900.0, 0.0],
            transformation: Vec::new(),
        }
    }

    #[test]
    fn a_tie_point_and_a_matrix_say_where_a_map_lies() {
        let found = tags(&[[MODEL_TYPE, 0, 1, PROJECTED]]).georeference().unwrap().unwrap();
        let expected = Georeference {
            unit: MapUnit::Length(1.0),
            cell: DVec2::new(10.0, 20.0),
            west_north: DVec2::new(490.0, 940.0),
        };
        assert_eq!(found, expected);
        let mut matrix = GeoTags { pixel_scale: vec![], ..tags(&[[MODEL_TYPE, 0, 1, PROJECTED]]) };
        matrix.transformation = vec![10.0, 0.0, 0.0, 490.0, 0.0, -20.0, 0.0, 940.0];
        assert_eq!(matrix.georeference().unwrap().unwrap(), expected);
        matrix.transformation[1] = 3.0;
        assert!(matrix.georeference().unwrap_err().to_string().contains("turned"));
        matrix.transformation.clear();
        assert_eq!(matrix.georeference().unwrap(), None);
    }

    #[test]
    fn units_are_those_of_the_keys() {
        let unit = |keys: &[[u16; 4]]| tags(keys).unit();
        assert_eq!(unit(&[]), Ok(MapUnit::Unknown));
        assert_eq!(unit(&[[MODEL_TYPE, 0, 1, GEOGRAPHIC], [ANGULAR_UNITS, 0, 1, DEGREE]]), Ok(MapUnit::Degrees));
        assert_eq!(unit(&[[MODEL_TYPE, 0, 1, PROJECTED], [LINEAR_UNITS, 0, 1, 9002]]), Ok(MapUnit::Length(0.3048)));
        assert!(unit(&[[MODEL_TYPE, 0, 1, PROJECTED], [LINEAR_UNITS, 0, 1, 9999]]).is_err());
        assert_eq!(tags(&[[VERTICAL_UNITS, 0, 1, 9003]]).vertical_unit_m(), Ok(Some(1200.0 / 3937.0)));
        // A directory that is cut off.
        assert_eq!(GeoTags { directory: vec![1, 1], ..GeoTags::default() }.unit(), Ok(MapUnit::Unknown));
    }

    #[test]
    fn scale_and_offset_are_found_in_the_metadata() {
        let xml = "<GDALMetadata><Item name=\"OFFSET\" sample=\"0\" role=\"offset\">-100</Item>\
                   <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item></GDALMetadata>";
        assert_eq!(scale_of_metadata(xml), Some([0.1, -100.0]));
        assert_eq!(scale_of_metadata("<Item role=\"scale\">no number</Item>"), None);
    }
}
