//! The ground: random fields with the covariance of real terrain, maps, and surfaces formed by hand.
//!
//! After Setas et al., *Dynamic Simulation of Natural Environments in Virtual Reality* (section 2.1), and Zaharia, *Procedural modeling of
//! natural phenomena* (section 2.4):
//!
//! 1. A [`CovarianceModel`] says how alike the elevations of two places are, by their distance.
//! 2. [`TurningBands`] draws ground with that covariance: the sum of one-dimensional processes along lines in the plane
//!    (algorithm 1), without end and without a grid.
//! 3. A [`Variogram`] measures the covariance of a real map ([`ElevationGrid`]), and [`fit_models`] finds the models
//!    that have it (Levenberg-Marquardt), so that new ground of the same kind can be made ([`Fit::settings`]).
//! 4. [`ElevationMap`] is the real ground itself, [`SplineGround`] ground formed by control points, [`Layers`] the sum
//!    of several. All are [`Ground`](crate::Ground).
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use bevy_windwood::{
//!     Ground,
//!     terrain::{CovarianceModel, Elevation, ElevationSettings, TurningBands, Variogram, VariogramSettings, fit_models},
//! };
//!
//! let name = "assets/terrain/rmnp-dem-16bit.png";
//! let map = Elevation::read(name, &std::fs::read(name)?, &ElevationSettings::with_cells(233.0, 234.0))?;
//! let variogram = Variogram::estimate(&map.grid, &VariogramSettings::default())?;
//! let best = fit_models(&variogram, &CovarianceModel::ALL)?[0];
//! let ground = TurningBands::new(&best.settings(60.0, 7))?;
//! println!("{} m", ground.height_m(bevy::math::DVec2::new(1e6, -2e5)));
//! # Ok(())
//! # }
//! ```
//!
//! 5. [`Terrain`] is ground as an entity: a pyramid of [`chunk`]s about every [`Viewpoint`](crate::Viewpoint), finer where
//!    a viewer is near ([`pyramid`]), built in the background.
//!
//! | files | what |
//! |---|---|
//! | `error` | What can be wrong with settings, maps and files. |
//! | `place` | Places that may be asked about. |
//! | `covariance`, `bessel_integrals`, `spectral_sampling`, `line_process`, `turning_bands`, `settings` | Random fields. |
//! | [`elevation`], `elevation_grid`, `gaps`, `elevation_map` | Maps: read, held, filled, interpolated. |
//! | `drift`, `autocorrelation`, `lag_pairs`, `variogram`, `fit` | Estimates from maps. |
//! | `spline_ground`, `layers` | Ground formed by control points; sums of grounds. |
//! | `triangle_ground`, `mesh`, `ray_cast_ground` | A game's own ground: triangles, meshes, rays. |
//! | `chunk_key`, `chunk`, `pyramid`, `ground_texture`, `litter_texture` | What is drawn of it. |
//! | `components`, `ecs`, `material`, `plugin` | Ground as entities, maps as assets. All others are plain arithmetic without an app. |

mod autocorrelation;
mod bessel_integrals;
pub mod chunk;
mod chunk_key;
mod components;
mod covariance;
mod drift;
mod ecs;
pub mod elevation;
mod elevation_grid;
mod elevation_map;
mod error;
mod fit;
mod gaps;
#[cfg(feature = "render")]
mod ground_texture;
mod lag_pairs;
mod layers;
mod line_process;
#[cfg(feature = "render")]
mod litter_texture;
#[cfg(feature = "render")]
mod material;
mod mesh;
mod place;
mod plugin;
pub mod pyramid;
mod ray_cast_ground;
mod settings;
mod spectral_sampling;
mod spline_ground;
mod triangle_ground;
mod turning_bands;
mod variogram;

pub use crate::ground::Cover;
pub use components::{GroundLook, Terrain, TerrainFile, TerrainSettings};
pub use covariance::CovarianceModel;
pub use drift::{Drift, FoundDrift};
pub use ecs::elevation_loader::{ElevationLoadError, ElevationLoader, ElevationMapSettings};
pub use elevation::{Elevation, ElevationNotice, ElevationSettings, RawLayout, RawSample};
pub use elevation_grid::ElevationGrid;
pub use elevation_map::{ElevationMap, Interpolation, MapPlacement};
pub use error::TerrainError;
#[cfg(feature = "editor")]
pub(crate) use fit::best_first;
pub use fit::{Fit, SHORTEST_WAVE_CELLS, fit_model, fit_models};
pub use layers::Layers;
pub use plugin::TerrainPlugin;
pub use ray_cast_ground::RayCastGround;
pub use settings::{Anisotropy, TurningBandsSettings};
pub use spline_ground::{SplineGround, SplineGroundSettings, SplinePatch};
pub use triangle_ground::TriangleGround;
pub use turning_bands::TurningBands;
pub use variogram::{LagClass, Variogram, VariogramSettings};
#[cfg(feature = "render")]
pub use {
    ecs::stream::{TerrainChunk, TerrainChunks},
    plugin::TerrainDrawPlugin,
};
