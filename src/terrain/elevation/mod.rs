//! Elevations from the files that people have.
//!
//! | format | how it is known | cell size | no data |
//! |---|---|---|---|
//! | PNG, 16 bits of grey (8 with a range of heights) | by its first bytes | told | told |
//! | GeoTIFF, one band of integers or floats | by its first bytes | from the file | `GDAL_NODATA` |
//! | ESRI ASCII grid | by its header | from the file | `NODATA_value`, or -9999 |
//! | SRTM `.hgt`, 1201 or 3601 squared | by its name | from its size, at the latitude of its name | -32768 |
//! | raw samples | because a [`RawLayout`] is given | told | told |
//!
//! What is told stands in [`ElevationSettings`], and goes before what the file says. A sample that is no finite number, or beyond 10^30, is
//! no data in every format.
//!
//! | file | what |
//! |---|---|
//! | `settings` | What is told about a file. |
//! | `samples`, `georeference` | What all readers give: samples as they are written, and where they lie. |
//! | `png`, `raw`, `geotiff`, `geokeys`, `ascii_grid`, `srtm` | The readers. |
//! | `read` | From a file to a grid in metres. |
//! | `notice`, `apart` | What should be known about a file; samples that look like no data. |

mod apart;
mod ascii_grid;
mod geokeys;
mod georeference;
mod geotiff;
mod notice;
mod png;
mod raw;
mod read;
mod samples;
mod settings;
mod srtm;
#[cfg(test)]
mod tests;

pub use notice::ElevationNotice;
pub use read::Elevation;
pub use settings::{ElevationSettings, RawLayout, RawSample};
