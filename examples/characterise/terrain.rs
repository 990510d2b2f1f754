//! Real ground: its variogram, the models that fit it, and random ground of the same kind.

use crate::{
    files,
    map_picture::{Shading, reduced},
    options::TerrainOptions,
    sheet::{Panel, compose},
    variogram_chart,
};
use bevy::math::DVec2;
use bevy_windwood::terrain::{
    CovarianceModel, ElevationGrid, ElevationScale, Fit, TerrainError, TurningBands, TurningBandsSettings, Variogram,
    VariogramSettings, fit_models,
};
use serde_json::{Value, json};

/// 4096 x 4096 samples of 16 bits that cannot be compressed are half of it.
const MOST_FILE_BYTES: u64 = 64 << 20;
/// Lines of the random ground: so many leave no streaks in hill shading.
const LINES: u32 = 64;
/// Cells in the shortest wave that they can show.
const WAVE_CELLS: f64 = 2.0;
/// A fitted scale that is nearer than this to the longest that is tried has no end within the map.
const ENDLESS: f64 = 0.99;

/// A map and all that was found about it.
struct Found {
    map: ElevationGrid,
    variogram: Variogram,
    /// The best first.
    fits: Vec<Fit>,
}

/// Characterises the map that `options` name.
///
/// # Errors
/// In one line, naming the file and what is wrong with it.
pub fn run(options: &TerrainOptions) -> Result<(), String> {
    let bytes = files::read(&options.file, MOST_FILE_BYTES)?;
    let named = |error: TerrainError| format!("{}: {error}", options.file.display());
    let found = Found::in_map(&bytes, &options.scale()).map_err(named)?;
    found.print();
    let shown = reduced(&found.map).map_err(named)?;
    let settings = found.settings(shown.cell_m().min_element(), options.seed);
    files::write_json(options.json.as_deref(), &found.to_json(&settings))?;
    let simulated = simulated(&settings, &found.map, &shown).map_err(named)?;
    let shading = Shading::of(&shown);
    let panels = [
        Panel { caption: found.describe_map(), picture: shading.draw(&shown) },
        Panel { caption: found.describe_best(options.seed), picture: shading.draw(&simulated) },
    ];
    let name = options.file.file_name().unwrap_or_default().to_string_lossy();
    let title = format!("{name:.60}: real and simulated");
    let sheet =
        compose(&title, &panels, "Variogram", |area| variogram_chart::draw(area, &found.variogram, &found.fits))?;
    files::write_picture(&options.out, &sheet)
}

impl TerrainOptions {
    fn scale(&self) -> ElevationScale {
        ElevationScale {
            cell_x_m: self.cell_size,
            cell_z_m: self.cell_size_z.unwrap_or(self.cell_size),
            metres_per_unit: self.metres_per_unit,
            base_m: self.base,
        }
    }
}

impl Found {
    fn in_map(png: &[u8], scale: &ElevationScale) -> Result<Self, TerrainError> {
        let map = ElevationGrid::from_png(png, scale)?;
        let variogram = Variogram::estimate(&map, &VariogramSettings::default())?;
        let fits = fit_models(&variogram, &CovarianceModel::ALL)?;
        Ok(Self { map, variogram, fits })
    }

    fn best(&self) -> &Fit {
        &self.fits[0]
    }

    fn size_m(&self) -> DVec2 {
        self.map.cell_m() * DVec2::new(self.map.columns() as f64 - 1.0, self.map.rows() as f64 - 1.0)
    }

    fn deviation_m(&self) -> f64 {
        self.variogram.variance_m2().sqrt()
    }

    /// Whether the ground varies at all scales of the map, so that it shows neither a range nor a sill.
    fn is_endless(&self, fit: &Fit) -> bool {
        let longest_m = self.variogram.classes().iter().map(|class| class.distance_m).fold(0.0, f64::max);
        fit.scale_m > ENDLESS * 2.0 * longest_m
    }

    fn print(&self) {
        let mean_m = self.variogram.drift().mean_m;
        println!("{}, mean {mean_m:.1} m, deviation {:.1} m", self.describe_map(), self.deviation_m());
        println!("{:<20} {:>11} {:>11} {:>13} {:>7}", "model", "scale m", "range m", "deviation m", "error");
        for fit in &self.fits {
            let (scale_m, range_m, deviation_m) = (fit.scale_m, fit.practical_range_m(), fit.deviation_m);
            let note = if self.is_endless(fit) { "   no range within the map" } else { "" };
            println!(
                "{:<20} {scale_m:>11.1} {range_m:>11.1} {deviation_m:>13.2} {:>7.3}{note}",
                name(fit),
                fit.residual
            );
        }
    }

    fn describe_map(&self) -> String {
        let size_km = self.size_m() * 1e-3;
        let (columns, rows) = (self.map.columns(), self.map.rows());
        format!("real: {columns} x {rows} samples, {:.1} x {:.1} km", size_km.x, size_km.y)
    }

    fn describe_best(&self, seed: u64) -> String {
        let best = self.best();
        let end = if self.is_endless(best) { ", no range" } else { "" };
        format!("simulated: {}, scale {:.0} m{end}, seed {seed}", name(best), best.scale_m)
    }

    /// Settings for random ground of the best model, with waves as short as cells of `cell_m` can show.
    fn settings(&self, cell_m: f64, seed: u64) -> TurningBandsSettings {
        let best = self.best();
        let finest_m = (WAVE_CELLS * cell_m).min(best.scale_m);
        let mean_m = self.variogram.drift().mean_m;
        TurningBandsSettings { mean_m, lines: LINES, ..best.settings(finest_m, seed) }
    }

    fn to_json(&self, settings: &TurningBandsSettings) -> Value {
        let heights_m = self.map.heights_m();
        let fit = |fit: &Fit| {
            let dimension = match fit.model {
                CovarianceModel::Fractal { dimension } => Some(dimension),
                _ => None,
            };
            json!({
                "model": fit.model.name(),
                "dimension": dimension,
                "scale_m": fit.scale_m,
                "range_m": fit.practical_range_m(),
                "no_range_within_the_map": self.is_endless(fit),
                "deviation_m": fit.deviation_m,
                "sill_m2": fit.deviation_m.powi(2),
                "error": fit.residual,
            })
        };
        let class = |class: &bevy_windwood::terrain::LagClass| {
            json!({
                "distance_m": class.distance_m,
                "semivariance_m2": class.semivariance_m2,
                "pairs": class.pairs,
            })
        };
        json!({
            "map": {
                "columns": self.map.columns(),
                "rows": self.map.rows(),
                "cell_m": self.map.cell_m().to_array(),
                "least_m": heights_m.iter().copied().fold(f32::INFINITY, f32::min),
                "greatest_m": heights_m.iter().copied().fold(f32::NEG_INFINITY, f32::max),
                "mean_m": self.variogram.drift().mean_m,
                "deviation_m": self.deviation_m(),
            },
            "fits": self.fits.iter().map(fit).collect::<Vec<_>>(),
            "variogram": self.variogram.classes().iter().map(class).collect::<Vec<_>>(),
            "simulated": settings,
        })
    }
}

/// Random ground in the cells of a map, as it is shown.
fn simulated(
    settings: &TurningBandsSettings,
    map: &ElevationGrid,
    shown: &ElevationGrid,
) -> Result<ElevationGrid, TerrainError> {
    let ground = TurningBands::new(settings)?;
    let in_cells_of = |map: &ElevationGrid| {
        ElevationGrid::sample(&ground, DVec2::ZERO, map.columns() as u32, map.rows() as u32, map.cell_m())
    };
    let is_rougher_than_shown = settings.finest_wavelength_m < WAVE_CELLS * shown.cell_m().min_element();
    // Where there are waves that the picture does not show, they are taken away by the same means as from the map.
    if is_rougher_than_shown { reduced(&in_cells_of(map)?) } else { in_cells_of(shown) }
}

/// A model's name, with a fractal's dimension.
fn name(fit: &Fit) -> String {
    match fit.model {
        CovarianceModel::Fractal { dimension } => format!("fractal, D {dimension:.2}"),
        model => model.name().to_owned(),
    }
}
