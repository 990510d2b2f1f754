//! The ground of the scenes: a map of real elevations, with random detail below its resolution.

use bevy::{math::DVec2, prelude::*};
use bevy_windwood::{
    Ground,
    terrain::{
        CovarianceModel, Elevation, ElevationSettings, Interpolation, Layers, MapPlacement, SplineGround,
        SplineGroundSettings, TurningBands, TurningBandsSettings, chunk::drawn_height_m,
    },
};
use std::{path::Path, sync::Arc};

/// The shipped elevations: Rocky Mountain National Park, see `assets/terrain/README.md`.
const SHIPPED: &[u8] = include_bytes!("../../assets/terrain/rmnp-dem-16bit.png");
/// Size of its cells, m.
const SHIPPED_CELL_M: DVec2 = DVec2::new(233.0, 234.0);
/// Place of the world's origin in the shipped map, as shares of its width and height: a slope by a valley.
const SHIPPED_PLACE: DVec2 = DVec2::new(0.675, 0.2366);
/// Ground of five B-spline patches with fifty control points, as Zaharia's.
const FIVE_PATCHES: &str = include_str!("../../assets/terrain/five_patches.ground.ron");
/// Corners of the rectangle of its control points: (x, z), m.
const FIVE_PATCHES_CORNERS_M: [DVec2; 2] = [DVec2::new(-270.0, -120.0), DVec2::new(270.0, 120.0)];
/// Size of the finest cells of the drawn ground, m.
pub const FINEST_CELL_M: f32 = 2.0;

/// Ground with its origin somewhere in a map.
#[derive(Clone)]
pub struct Landscape {
    pub ground: Arc<dyn Ground>,
    /// Corners of the map: (x, z), m.
    pub corners_m: [DVec2; 2],
}

impl Landscape {
    /// Reads elevations from a file, with cells of `cell_m` or those that the file says, or takes the shipped ones.
    pub fn load(file: Option<&Path>, cell_m: Option<f32>) -> Result<Self, String> {
        let (name, elevation, place) = match file {
            Some(path) => {
                let name = path.display().to_string();
                let bytes = std::fs::read(path).map_err(|error| format!("{name}: {error}"))?;
                let settings = ElevationSettings { cell_x_m: cell_m.map(f64::from), ..default() };
                (name.clone(), Elevation::read(&name, &bytes, &settings), DVec2::splat(0.5))
            }
            None => {
                let settings = ElevationSettings::with_cells(SHIPPED_CELL_M.x, SHIPPED_CELL_M.y);
                let name = "the shipped elevations".to_owned();
                let elevation = Elevation::read(&name, SHIPPED, &settings);
                (name, elevation, SHIPPED_PLACE)
            }
        };
        let elevation = elevation.map_err(|error| format!("{name}: {error}"))?;
        elevation.notices.iter().for_each(|notice| eprintln!("{name}: {notice}"));
        let (grid, cell) = (&elevation.grid, elevation.grid.cell_m());
        let size_m = cell * (DVec2::new(grid.columns() as f64, grid.rows() as f64) - 1.0);
        let corner_m = -place * size_m;
        let placement = MapPlacement { west_m: corner_m.x, north_m: corner_m.y, interpolation: Interpolation::Bicubic };
        let map = elevation.into_map(placement).map_err(|error| format!("{name}: {error}"))?;
        let layers: [Arc<dyn Ground>; 3] = [Arc::new(map), hills(0.22 * cell.x)?, bumps()?];
        Ok(Self { ground: Arc::new(Layers(layers.into())), corners_m: [corner_m, corner_m + size_m] })
    }

    /// The shipped ground of B-spline patches.
    pub fn five_patches() -> Result<Self, String> {
        let ground = SplineGroundSettings::from_ron(FIVE_PATCHES).and_then(|settings| SplineGround::new(&settings));
        let ground = ground.map_err(|error| format!("the shipped patches: {error}"))?;
        Ok(Self { ground: Arc::new(ground), corners_m: FIVE_PATCHES_CORNERS_M })
    }

    /// Height of the drawn ground at a place, m.
    pub fn height_m(&self, x: f32, z: f32) -> f32 {
        drawn_height_m(&self.ground, f64::from(FINEST_CELL_M), DVec2::new(f64::from(x), f64::from(z)))
    }

    /// The horizontal direction in which the ground rises at the origin, as world (x, z).
    pub fn uphill(&self) -> Dir2 {
        let rise = |x: f32, z: f32| self.height_m(x, z) - self.height_m(-x, -z);
        Dir2::new(Vec2::new(rise(25.0, 0.0), rise(0.0, 25.0))).unwrap_or(Dir2::NEG_Y)
    }
}

/// Hills between the samples of the map.
fn hills(scale_m: f64) -> Result<Arc<dyn Ground>, String> {
    bands(TurningBandsSettings {
        model: CovarianceModel::Bessel,
        scale_m,
        deviation_m: 0.09 * scale_m,
        finest_wavelength_m: (0.2 * scale_m).max(2.0),
        seed: 5,
        ..default()
    })
}

/// Bumps a few metres wide.
fn bumps() -> Result<Arc<dyn Ground>, String> {
    bands(TurningBandsSettings {
        model: CovarianceModel::Bessel,
        scale_m: 6.0,
        deviation_m: 0.3,
        finest_wavelength_m: 4.0,
        seed: 7,
        ..default()
    })
}

fn bands(settings: TurningBandsSettings) -> Result<Arc<dyn Ground>, String> {
    Ok(Arc::new(TurningBands::new(&settings).map_err(|error| error.to_string())?))
}
