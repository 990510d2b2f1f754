//! Maps as assets: any file of elevations, with settings of its own in a `.meta` file or by
//! [`load_builder`](bevy::asset::AssetServer::load_builder).

use crate::terrain::{
    elevation::{Elevation, ElevationSettings},
    elevation_grid::ElevationGrid,
    elevation_map::{ElevationMap, MapPlacement},
    error::TerrainError,
};
use bevy::{
    asset::{AssetLoader, LoadContext, io::Reader},
    log::{info, warn},
    math::DVec2,
    reflect::{Reflect, TypePath},
};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Greatest size of a file: the largest grid as text, with eight characters a sample.
const MOST_BYTES: u64 = 1 << 29;

/// How a file becomes a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ElevationMapSettings {
    /// What is told about the file.
    pub elevation: ElevationSettings,
    /// How the map lies in the world.
    pub placement: MapPlacement,
    /// Whether the middle of the map lies at the world's origin, and not where `placement` says.
    pub is_centred: bool,
}

/// Loads an [`ElevationMap`] from a file of any of the formats. Say which asset is wanted:
/// `assets.load::<ElevationMap>("terrain/rmnp-dem-16bit.png")`; a PNG is a picture otherwise.
#[derive(Default, TypePath)]
pub struct ElevationLoader;

/// Why a file of elevations was not taken.
#[derive(Debug, Error)]
pub enum ElevationLoadError {
    /// The file could not be read.
    #[error("cannot read the file: {0}")]
    Read(#[from] std::io::Error),
    /// The file is too long.
    #[error("the file is longer than {} MiB, the most that is read", MOST_BYTES >> 20)]
    TooLong,
    /// The file or its settings are wrong.
    #[error(transparent)]
    Content(#[from] TerrainError),
}

impl AssetLoader for ElevationLoader {
    type Asset = ElevationMap;
    type Settings = ElevationMapSettings;
    type Error = ElevationLoadError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        settings: &ElevationMapSettings,
        context: &mut LoadContext<'_>,
    ) -> Result<ElevationMap, ElevationLoadError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        if bytes.len() as u64 > MOST_BYTES {
            return Err(ElevationLoadError::TooLong);
        }
        let name = context.path().to_string();
        let elevation = Elevation::read(&name, &bytes, &settings.elevation)?;
        for notice in &elevation.notices {
            if notice.is_warning() {
                warn!("{name}: {notice}");
            } else {
                info!("{name}: {notice}");
            }
        }
        let placement = settings.placement_of(&elevation.grid);
        Ok(elevation.into_map(placement).map_err(|error| TerrainError::from(error.inside("placement")))?)
    }

    /// PNG is not among them, so that pictures stay pictures.
    fn extensions(&self) -> &[&str] {
        &["tif", "tiff", "asc", "hgt"]
    }
}

impl ElevationMapSettings {
    fn placement_of(&self, grid: &ElevationGrid) -> MapPlacement {
        if !self.is_centred {
            return self.placement;
        }
        let corner_m = -0.5 * grid.cell_m() * (DVec2::new(grid.columns() as f64, grid.rows() as f64) - 1.0);
        MapPlacement { west_m: corner_m.x, north_m: corner_m.y, ..self.placement }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_centred_map_has_its_middle_at_the_origin() {
        let grid = ElevationGrid::new(5, 3, DVec2::new(10.0, 20.0), vec![0.0; 15]).unwrap();
        let settings = ElevationMapSettings { is_centred: true, ..Default::default() };
        let placement = settings.placement_of(&grid);
        assert_eq!((placement.west_m, placement.north_m), (-20.0, -20.0));
        assert_eq!(ElevationMapSettings::default().placement_of(&grid), MapPlacement::default());
    }
}
