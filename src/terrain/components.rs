//! Ground as an entity.

use super::{chunk_key::CHUNK_CELLS, elevation_map::ElevationMap, pyramid::PyramidShape};
use crate::{
    ground::{Cover, Ground},
    setting::{SettingError, require},
};
use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Ground that is drawn about every [`Viewpoint`](crate::Viewpoint), in the world's own frame.
///
/// Insert it anew to change the ground: all of it is then built again.
#[derive(Component, Clone)]
#[require(TerrainSettings, GroundLook, Transform, Visibility)]
pub struct Terrain {
    /// Its elevations, m.
    pub ground: Arc<dyn Ground>,
    /// The woods on it, which colour it where trees are too far to be drawn.
    pub cover: Option<Arc<dyn Cover>>,
}

impl Terrain {
    /// Bare ground.
    pub fn new(ground: impl Ground + 'static) -> Self {
        Self { ground: Arc::new(ground), cover: None }
    }

    /// Ground with woods on it.
    #[must_use]
    pub fn with_cover(mut self, cover: impl Cover + 'static) -> Self {
        self.cover = Some(Arc::new(cover));
        self
    }
}

/// Ground from a file of elevations: the entity gets its [`Terrain`] when the file is loaded, and a new one when it changes on disk.
#[derive(Component, Clone, Debug)]
pub struct TerrainFile(pub Handle<ElevationMap>);

/// How finely ground is drawn, and how much is done for it in a frame.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default)]
#[serde(default, deny_unknown_fields)]
pub struct TerrainSettings {
    /// Cells of the finest level; a power of two, so that corners are the same number in all chunks.
    /// units: m, domain: 0.125 to 64.
    pub finest_cell_m: f32,
    /// How far the ground is drawn. units: m, domain: \[100, 200000\].
    pub reach_m: f32,
    /// A chunk of 32 x 32 cells is drawn finer when a viewer is nearer than so many of its sides: more is finer and
    /// dearer. domain: \[1.5, 8\].
    pub detail: f32,
    /// Chunks that are built at once in the background. domain: \[1, 64\].
    pub builds_at_once: u32,
    /// Chunks that are taken over in a frame, at most. domain: \[1, 64\].
    pub chunks_per_frame: u32,
}

impl Default for TerrainSettings {
    fn default() -> Self {
        Self { finest_cell_m: 2.0, reach_m: 20_000.0, detail: 1.6, builds_at_once: 8, chunks_per_frame: 4 }
    }
}

impl TerrainSettings {
    /// Checks every setting.
    ///
    /// # Errors
    /// [`SettingError`] for the first that is wrong.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("finest_cell_m", self.finest_cell_m, 0.125..=64.0)?;
        if self.finest_cell_m.log2().fract() != 0.0 {
            return Err(SettingError::new("finest_cell_m", self.finest_cell_m, "a power of two"));
        }
        require("reach_m", self.reach_m, 100.0..=2e5)?;
        require("detail", self.detail, 1.5..=8.0)?;
        require("builds_at_once", self.builds_at_once, 1..=64)?;
        require("chunks_per_frame", self.chunks_per_frame, 1..=64)
    }

    /// The pyramid that reaches so far: its coarsest squares are about as wide as the reach, so that there are some ten.
    #[must_use]
    pub fn shape(&self) -> PyramidShape {
        let finest_side_m = self.finest_cell_m * CHUNK_CELLS as f32;
        PyramidShape {
            finest_cell_m: f64::from(self.finest_cell_m),
            coarsest_level: (self.reach_m / finest_side_m).log2().floor().max(0.0) as u32,
            detail: f64::from(self.detail),
            reach_m: f64::from(self.reach_m),
        }
    }
}

/// What the ground looks like: colours by slope, height and woods. Colours are sRGB.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default)]
#[serde(default, deny_unknown_fields)]
pub struct GroundLook {
    /// Fresh grass.
    pub grass: [f32; 3],
    /// Grass that has dried.
    pub dry_grass: [f32; 3],
    /// Bare earth.
    pub earth: [f32; 3],
    /// Rock.
    pub rock: [f32; 3],
    /// Snow.
    pub snow: [f32; 3],
    /// What lies under trees, most of it: leaves that have rotted for some time.
    pub litter: [f32; 3],
    /// Leaves that have come down lately.
    pub pale_litter: [f32; 3],
    /// Crowns seen from afar.
    pub canopy: [f32; 3],
    /// Share of the sky's light that comes through closed crowns to the ground: 2 to 10% in summer woods, about a half in bare ones.
    /// domain: \[0, 1\].
    pub sky_under_trees: f32,
    /// Slopes at which earth shows between the grass, and at which there is only rock. units: degrees, domain: 0 to 90.
    pub bare_slope_deg: [f32; 2],
    /// Above this there is no more than short, dry grass. units: m, domain: \[-100000, 100000\].
    pub grass_line_m: f32,
    /// Above this lies snow, but on steep ground. units: m, domain: \[-100000, 100000\].
    pub snow_line_m: f32,
    /// Height over which these lines blur. units: m, domain: \[0.1, 10000\].
    pub line_blur_m: f32,
    /// Side of one repeat of the finest texture. units: m, domain: \[0.1, 1000\].
    pub texture_m: f32,
    /// Distance from which on woods are the colour of their crowns alone, because trees are no longer drawn; it comes between
    /// the half of this and four fifths.
    /// units: m, domain: \[0, 1000000\].
    pub canopy_from_m: f32,
}

impl Default for GroundLook {
    /// A temperate mountain side in summer.
    fn default() -> Self {
        Self {
            grass: [0.29, 0.36, 0.18],
            dry_grass: [0.39, 0.39, 0.24],
            earth: [0.30, 0.28, 0.215],
            rock: [0.44, 0.43, 0.42],
            snow: [0.93, 0.95, 0.98],
            litter: [0.26, 0.225, 0.175],
            pale_litter: [0.43, 0.375, 0.29],
            canopy: [0.11, 0.165, 0.095],
            sky_under_trees: 0.1,
            bare_slope_deg: [27.0, 40.0],
            grass_line_m: 1e5,
            snow_line_m: 1e5,
            line_blur_m: 150.0,
            texture_m: 2.0,
            canopy_from_m: 400.0,
        }
    }
}

impl GroundLook {
    /// Checks every setting.
    ///
    /// # Errors
    /// [`SettingError`] for the first that is wrong.
    pub fn validate(&self) -> Result<(), SettingError> {
        let colours = [
            ("grass", self.grass),
            ("dry_grass", self.dry_grass),
            ("earth", self.earth),
            ("rock", self.rock),
            ("snow", self.snow),
            ("litter", self.litter),
            ("pale_litter", self.pale_litter),
            ("canopy", self.canopy),
        ];
        for (field, colour) in colours {
            colour.into_iter().try_for_each(|channel| require(field, channel, 0.0..=1.0))?;
        }
        let [earth, rock] = self.bare_slope_deg;
        require("bare_slope_deg[0]", earth, 0.0..=90.0)?;
        require("bare_slope_deg[1]", rock, earth..=90.0)?;
        require("sky_under_trees", self.sky_under_trees, 0.0..=1.0)?;
        require("grass_line_m", self.grass_line_m, -1e5..=1e5)?;
        require("snow_line_m", self.snow_line_m, -1e5..=1e5)?;
        require("line_blur_m", self.line_blur_m, 0.1..=1e4)?;
        require("texture_m", self.texture_m, 0.1..=1e3)?;
        require("canopy_from_m", self.canopy_from_m, 0.0..=1e6)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid_and_errors_name_the_field() {
        TerrainSettings::default().validate().unwrap();
        GroundLook::default().validate().unwrap();
        let error = TerrainSettings { finest_cell_m: 3.0, ..default() }.validate().unwrap_err().to_string();
        assert_eq!(error, "`finest_cell_m` is 3, but must be a power of two");
        let error = TerrainSettings { reach_m: f32::NAN, ..default() }.validate().unwrap_err().to_string();
        assert!(error.starts_with("`reach_m` is NaN"), "{error}");
        let error = GroundLook { bare_slope_deg: [50.0, 40.0], ..default() }.validate().unwrap_err().to_string();
        assert!(error.starts_with("`bare_slope_deg[1]` is 40"), "{error}");
    }

    #[test]
    fn the_coarsest_squares_are_about_as_wide_as_the_reach() {
        for reach_m in [100.0, 5000.0, 60_000.0] {
            let shape = TerrainSettings { reach_m, ..default() }.shape();
            let side_m = 64.0 * f64::from(1_u32 << shape.coarsest_level);
            assert!(side_m <= shape.reach_m && shape.reach_m < 2.0 * side_m, "{side_m} for {reach_m}");
        }
    }
}
