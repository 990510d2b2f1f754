//! A map of real ground: read, measured, and the models of random ground that are like it. It takes seconds for a large map, so it tells how
//! far it is, and can be cancelled.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, AtomicU32, Ordering},
};

use bevy::math::DVec2;

use crate::terrain::{
    CovarianceModel, Elevation, ElevationMap, ElevationSettings, Fit, MapPlacement, TurningBandsSettings, Variogram,
    VariogramSettings, best_first, fit_model,
};

/// Greatest size of a file.
const MOST_BYTES: u64 = 256 << 20;
/// Steps of the work: reading, measuring, and each model.
const STEPS: u32 = 2 + CovarianceModel::ALL.len() as u32;

/// Which map is read, and what is told about it.
#[derive(Clone, Debug, PartialEq)]
pub struct MapRequest {
    pub path: String,
    /// Distance of samples along x and z, m; 0 where the file says it.
    pub cell_x_m: f64,
    pub cell_z_m: f64,
    /// Rise for each unit of a sample, m.
    pub metres_per_unit: f64,
}

impl Default for MapRequest {
    fn default() -> Self {
        Self { path: String::new(), cell_x_m: 0.0, cell_z_m: 0.0, metres_per_unit: 1.0 }
    }
}

/// How far the work is. Shared with whoever does it.
#[derive(Debug, Default)]
pub struct Progress {
    done: AtomicU32,
    is_cancelled: AtomicBool,
}

impl Progress {
    /// 0 to 1.
    pub fn share(&self) -> f32 {
        self.done.load(Ordering::Relaxed) as f32 / STEPS as f32
    }

    /// Has the work end at its next step.
    pub fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }

    /// One more step is done.
    fn step(&self) -> Result<(), NoFit> {
        self.done.fetch_add(1, Ordering::Relaxed);
        if self.is_cancelled.load(Ordering::Relaxed) { Err(NoFit::Cancelled) } else { Ok(()) }
    }
}

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoFit {
    Cancelled,
    Failed(String),
}

/// A map with what was found of it.
#[derive(Clone, Debug, PartialEq)]
pub struct MapFit {
    pub path: PathBuf,
    /// The map as ground, its middle at the origin.
    pub map: ElevationMap,
    pub variogram: Variogram,
    /// The best first.
    pub fits: Vec<Fit>,
    /// What was noticed about the file.
    pub notices: Vec<String>,
}

impl MapFit {
    /// Reads a map and fits all models.
    ///
    /// # Errors
    /// Where it was cancelled, or the file cannot be used.
    pub fn of(request: &MapRequest, progress: &Progress) -> Result<Self, NoFit> {
        let failed = |error: &dyn std::fmt::Display| NoFit::Failed(format!("{}: {error}", request.path));
        let elevation = request.read().map_err(|error| failed(&error))?;
        progress.step()?;
        let variogram =
            Variogram::estimate(&elevation.grid, &VariogramSettings::default()).map_err(|error| failed(&error))?;
        progress.step()?;
        let mut fits = Vec::new();
        for model in CovarianceModel::ALL {
            fits.push(fit_model(&variogram, model).map_err(|error| failed(&error))?);
            progress.step()?;
        }
        best_first(&mut fits);
        let notices = elevation.notices.iter().map(ToString::to_string).collect();
        let samples = DVec2::new(elevation.grid.columns() as f64, elevation.grid.rows() as f64);
        let corner_m = -0.5 * elevation.grid.cell_m() * (samples - 1.0);
        let placement = MapPlacement { west_m: corner_m.x, north_m: corner_m.y, ..MapPlacement::default() };
        let map = elevation.into_map(placement).map_err(|error| failed(&error))?;
        Ok(Self { path: request.path.clone().into(), map, variogram, fits, notices })
    }

    /// Settings for more ground of the map's kind, by one of the fits.
    pub fn settings(&self, fit: usize, seed: u64) -> Option<TurningBandsSettings> {
        let fit = self.fits.get(fit)?;
        let settings = fit.settings_like(&self.variogram, self.map.grid().cell_m().min_element(), seed);
        Some(settings).filter(|settings| settings.validate().is_ok())
    }
}

impl MapRequest {
    fn read(&self) -> Result<Elevation, String> {
        let path = Path::new(&self.path);
        let size = fs::metadata(path).map_err(|error| error.to_string())?.len();
        if size > MOST_BYTES {
            return Err(format!("the file is longer than {} MiB, the most that is read", MOST_BYTES >> 20));
        }
        let bytes = fs::read(path).map_err(|error| error.to_string())?;
        let given = |cell_m: f64| (cell_m > 0.0).then_some(cell_m);
        let settings = ElevationSettings {
            cell_x_m: given(self.cell_x_m),
            cell_z_m: given(self.cell_z_m).filter(|_| self.cell_x_m > 0.0),
            metres_per_unit: self.metres_per_unit,
            ..ElevationSettings::default()
        };
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Elevation::read(&name, &bytes, &settings).map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rockies() -> MapRequest {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/terrain/rmnp-dem-16bit.png").to_owned();
        MapRequest { path, cell_x_m: 233.0, cell_z_m: 234.0, metres_per_unit: 1.0 }
    }

    #[test]
    fn a_real_map_is_fitted_and_more_of_its_kind_can_be_made() {
        let progress = Progress::default();
        let fit = MapFit::of(&rockies(), &progress).unwrap();
        assert_eq!((progress.share(), fit.fits.len()), (1.0, 8));
        assert!(fit.fits.windows(2).all(|pair| pair[0].residual <= pair[1].residual));
        let settings = fit.settings(0, 3).unwrap();
        assert_eq!((settings.seed, settings.finest_wavelength_m), (3, 466.0));
        assert!((2500.0..3500.0).contains(&settings.mean_m) && settings.deviation_m > 100.0, "{settings:?}");
        assert_eq!(fit.settings(8, 3), None);
        let placement = fit.map.placement();
        assert_eq!((placement.west_m, placement.north_m), (-0.5 * 151.0 * 233.0, -0.5 * 186.0 * 234.0));
    }

    #[test]
    fn work_that_is_cancelled_ends_at_its_next_step() {
        let progress = Progress::default();
        progress.cancel();
        assert_eq!(MapFit::of(&rockies(), &progress), Err(NoFit::Cancelled));
        assert!(progress.share() <= 1.0 / STEPS as f32);
    }

    #[test]
    fn what_is_no_map_is_told_with_its_name() {
        let of = |request: &MapRequest| MapFit::of(request, &Progress::default());
        let Err(NoFit::Failed(error)) = of(&MapRequest { path: "nowhere.tif".into(), ..rockies() }) else { panic!() };
        assert!(error.starts_with("nowhere.tif: "), "{error}");
        let Err(NoFit::Failed(error)) = of(&MapRequest { cell_x_m: 0.0, ..rockies() }) else { panic!() };
        assert!(error.contains("cell_x_m"), "{error}");
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml").to_owned();
        assert!(matches!(of(&MapRequest { path, ..rockies() }), Err(NoFit::Failed(_))));
    }
}
