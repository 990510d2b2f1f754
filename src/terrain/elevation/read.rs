//! From a file to a grid in metres.

use super::georeference::MapUnit;
use super::{
    apart::standing_apart,
    ascii_grid, geotiff,
    notice::ElevationNotice,
    png, raw,
    samples::{Samples, is_number},
    settings::ElevationSettings,
    srtm,
};
use crate::{
    setting::SettingError,
    terrain::{
        elevation_grid::ElevationGrid,
        elevation_map::{ElevationMap, MapPlacement},
        error::TerrainError,
    },
};
use bevy::math::DVec2;

/// Two cell sizes that differ by less than this share are the same.
const SAME_CELL: f64 = 1e-3;

/// Elevations read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Elevation {
    /// The elevations. Cells without data are filled, and known as such.
    pub grid: ElevationGrid,
    /// What should be known about the file.
    pub notices: Vec<ElevationNotice>,
}

impl Elevation {
    /// Reads a file of any of the formats. Its name is asked for what is not in the file: the place of an SRTM tile.
    ///
    /// # Errors
    /// [`TerrainError`]: a setting outside its domain; a file of another kind, damaged or cut off; one without a cell with data; one
    /// that leaves its cell size open where none is told; more than 16384 samples a side or 2^26 in all.
    pub fn read(name: &str, bytes: &[u8], settings: &ElevationSettings) -> Result<Self, TerrainError> {
        settings.validate()?;
        let samples = read_samples(name, bytes, settings)?;
        let mut notices = Vec::new();
        let cell_m = cell_m(&samples, settings, &mut notices)?;
        let [unit_m, base_m] = scale(&samples, settings)?;
        let Samples { columns, rows, mut values, no_data, .. } = samples;
        clear_no_data(&mut values, no_data, settings, &mut notices);
        notices.extend(standing_apart(&values).into_iter().map(|apart| ElevationNotice::StandsApart {
            value: apart.value,
            cells: apart.cells,
            nearest: apart.nearest,
        }));
        for value in &mut values {
            *value = (base_m + unit_m * f64::from(*value)) as f32;
        }
        let grid = ElevationGrid::with_gaps(columns, rows, cell_m, values)?;
        if grid.gaps() > 0 {
            notices.insert(0, ElevationNotice::NoData { cells: grid.gaps(), of: grid.heights_m().len() });
        }
        Ok(Self { grid, notices })
    }

    /// The ground of it, which lies in the world as `placement` says.
    ///
    /// # Errors
    /// As [`ElevationMap::new`].
    pub fn into_map(self, placement: MapPlacement) -> Result<ElevationMap, SettingError> {
        ElevationMap::new(self.grid, placement)
    }
}

/// Finds out the format, and reads the samples as they are written.
fn read_samples(name: &str, bytes: &[u8], settings: &ElevationSettings) -> Result<Samples, TerrainError> {
    if let Some(layout) = &settings.raw {
        return raw::read(bytes, layout);
    }
    let lower = name.to_ascii_lowercase();
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => png::read(bytes, settings),
        [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => geotiff::read(bytes, settings),
        [b'P', b'K', 3, 4, ..] | [0x1f, 0x8b, ..] => Err(TerrainError::Format {
            found: "a packed file (ZIP or gzip)".to_owned(),
            allowed: "what is in it: unpack it first",
        }),
        _ if ascii_grid::is_grid(bytes) => ascii_grid::read(bytes),
        _ if lower.ends_with(".hgt") => srtm::read(name, bytes, settings),
        [] => Err(TerrainError::Unreadable { reason: "it is empty".to_owned() }),
        _ => Err(TerrainError::Format {
            found: "of no kind that is known".to_owned(),
            allowed: "a PNG, a GeoTIFF, an ESRI ASCII grid, an SRTM tile with a name that ends in .hgt, or raw samples whose `raw` \
                      layout is given",
        }),
    }
}

/// The size of cells, m: as told, or else as in the file.
fn cell_m(
    samples: &Samples,
    settings: &ElevationSettings,
    notices: &mut Vec<ElevationNotice>,
) -> Result<DVec2, TerrainError> {
    let in_file = samples.georeference.map(|georeference| georeference.cell_size(samples.rows));
    let told = settings.cell_x_m.map(|x_m| DVec2::new(x_m, settings.cell_z_m.unwrap_or(x_m)));
    match (told, in_file) {
        (Some(told_m), Some(Ok(in_file))) => {
            if ((told_m - in_file.cell_m) / in_file.cell_m).abs().max_element() > SAME_CELL {
                notices.push(ElevationNotice::OtherCellSize { in_file_m: in_file.cell_m.to_array() });
            }
            Ok(told_m)
        }
        (Some(told_m), _) => Ok(told_m),
        (None, Some(in_file)) => {
            let in_file = in_file?;
            let is_guessed = samples.georeference.is_some_and(|georeference| georeference.unit == MapUnit::Unknown);
            notices.extend(in_file.latitude_deg.map(|latitude_deg| ElevationNotice::Degrees {
                latitude_deg,
                cell_m: in_file.cell_m.to_array(),
                is_guessed,
            }));
            Ok(in_file.cell_m)
        }
        (None, None) => Err(SettingError::new(
            "cell_x_m",
            "not given",
            "given, in metres: the file does not have the size of its cells",
        )
        .into()),
    }
}

/// Metres of a unit of a sample, and of a sample of 0: as told, after what the file says.
fn scale(samples: &Samples, settings: &ElevationSettings) -> Result<[f64; 2], SettingError> {
    if let Some([low_m, high_m]) = settings.height_range_m {
        let Some(full_scale) = samples.full_scale else {
            let allowed = "left out for samples that are not unsigned with 8 or 16 bits: they are elevations already";
            return Err(SettingError::new("height_range_m", format!("{low_m} to {high_m}"), allowed));
        };
        return Ok([(high_m - low_m) / full_scale, low_m]);
    }
    let [unit_m, base_m] = samples.scale.unwrap_or([1.0, 0.0]);
    Ok([settings.metres_per_unit * unit_m, settings.base_m + settings.metres_per_unit * base_m])
}

/// Makes NaN of samples without data.
fn clear_no_data(
    values: &mut [f32],
    in_file: Option<f64>,
    settings: &ElevationSettings,
    notices: &mut Vec<ElevationNotice>,
) {
    let no_data = settings.no_data.or(in_file).map(|value| value as f32);
    let mut found = 0;
    for value in values {
        if no_data == Some(*value) {
            found += 1;
            *value = f32::NAN;
        } else if !is_number(*value) {
            *value = f32::NAN;
        }
    }
    // A file may well have a value for no data, and need it nowhere. Whoever tells one has seen it.
    if let Some(value) = settings.no_data.filter(|value| found == 0 && !value.is_nan()) {
        notices.push(ElevationNotice::NoDataUnused { value });
    }
}
