//! Tiles of the Shuttle Radar Topography Mission and of all that come in its form (`.hgt`).
//!
//! A tile covers one degree by one degree, with samples on its edges: 1201 squared (three arc seconds) or 3601 squared (one). Samples have
//! signed 16 bits, the higher byte first; -32768 is no data. The name has the south-western corner: `N40W106.hgt`. (NASA LP DAAC, *SRTM
//! Collection User Guide*.)

use super::{
    georeference::{Georeference, MapUnit},
    samples::Samples,
    settings::{ElevationSettings, RawLayout, RawSample},
};
use crate::terrain::error::TerrainError;
use bevy::math::DVec2;

const NO_DATA: f64 = -32768.0;
const SIDES: [u32; 2] = [1201, 3601];

/// Reads the samples of a tile. Its name may be another where cells are told.
pub(super) fn read(name: &str, bytes: &[u8], settings: &ElevationSettings) -> Result<Samples, TerrainError> {
    let Some(side) = SIDES.into_iter().find(|side| (side * side * 2) as usize == bytes.len()) else {
        return Err(TerrainError::Format {
            found: format!("an SRTM tile of {} bytes", bytes.len()),
            allowed: "one of 2884802 bytes (1201 x 1201 samples) or 25934402 (3601 x 3601)",
        });
    };
    let corner = south_west(name);
    if corner.is_none() && settings.cell_x_m.is_none() {
        return Err(TerrainError::Format {
            found: "an SRTM tile whose name does not say where it lies".to_owned(),
            allowed: "one named like N40W106.hgt, by the latitude and longitude of its south-western corner, or read with `cell_x_m` \
                      given",
        });
    }
    let layout = RawLayout { columns: side, rows: side, sample: RawSample::I16BigEndian };
    let samples = super::raw::read(bytes, &layout)?;
    let cell = f64::from(side - 1).recip();
    // Samples on both edges: the outer cells reach over them by a half.
    let georeference = corner.map(|corner| Georeference {
        unit: MapUnit::Degrees,
        cell: DVec2::splat(cell),
        west_north: corner + DVec2::new(-0.5 * cell, 1.0 + 0.5 * cell),
    });
    Ok(Samples { no_data: Some(NO_DATA), georeference, ..samples })
}

/// Longitude and latitude of the south-western corner, degrees, if the name says it: `N40W106`, `n40_w106`, in whatever follows the last
/// slash.
pub(super) fn south_west(name: &str) -> Option<DVec2> {
    let name = name.rsplit(['/', '\\']).next()?.to_ascii_uppercase();
    let (latitude, rest) = signed(&name, ['N', 'S'], 2)?;
    let (longitude, _) = signed(rest.trim_start_matches('_'), ['E', 'W'], 3)?;
    let lies_on_the_globe = (-90.0..90.0).contains(&latitude) && (-180.0..180.0).contains(&longitude);
    lies_on_the_globe.then_some(DVec2::new(longitude, latitude))
}

/// The number of `digits` digits after a letter, negative after the second one, and what follows it.
fn signed(text: &str, [positive, negative]: [char; 2], digits: usize) -> Option<(f64, &str)> {
    let (sign, text) = match text.strip_prefix(positive) {
        Some(rest) => (1.0, rest),
        None => (-1.0, text.strip_prefix(negative)?),
    };
    let (number, rest) = text.split_at_checked(digits)?;
    let is_number = number.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| number.parse::<f64>().ok().map(|number| (sign * number, rest)))?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_where_a_tile_lies() {
        let at = |longitude, latitude| Some(DVec2::new(longitude, latitude));
        assert_eq!(south_west("N40W106.hgt"), at(-106.0, 40.0));
        assert_eq!(south_west("tiles/s33e151.SRTMGL1.hgt"), at(151.0, -33.0));
        assert_eq!(south_west("n00_e006_3arc_v2.hgt"), at(6.0, 0.0));
        for other in ["", "N4W106.hgt", "N40.hgt", "N95E000.hgt", "N40W200.hgt", "N40é106", "NééW106", "N40W10"] {
            assert_eq!(south_west(other), None, "{other}");
        }
    }
}
