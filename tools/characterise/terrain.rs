//! A map of real ground: its variogram, the models that fit it, and random ground of the same kind.

use crate::{
    chart::{Panel, pictures_and_chart},
    files,
    map_picture::{Shading, reduced},
    note::Note,
    options::TerrainOptions,
    variogram_chart,
};
use bevy::math::DVec2;
use bevy_windwood::terrain::{
    CovarianceModel, Elevation, ElevationGrid, ElevationNotice, ElevationSettings, Fit, SHORTEST_WAVE_CELLS,
    TerrainError, TurningBands, TurningBandsSettings, Variogram, VariogramSettings, fit_models,
};
use serde_json::{Value, json};

/// Greatest size of a file: twice that of 4096 x 4096 samples of 64 bits, or of as many in text.
const MOST_FILE_BYTES: u64 = 256 << 20;
/// Share of the longest scale that is tried beyond which a fitted scale means that the map shows no range.
const NO_RANGE: f64 = 0.99;

/// A map and its analysis.
struct Analysis {
    map: ElevationGrid,
    notes: Vec<Note>,
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
    let named = |error: TerrainError| format!("{}: {}", options.file.display(), in_options(&error.to_string()));
    let name = options.file.file_name().unwrap_or_default().to_string_lossy();
    let analysis = Analysis::of(&name, &bytes, &options.settings()).map_err(named)?;
    analysis.print();
    let shown = reduced(&analysis.map).map_err(named)?;
    let settings = analysis.settings(shown.cell_m().min_element(), options.seed);
    files::write_json(options.json.as_deref(), &analysis.to_json(&settings))?;
    let simulated = simulated(&settings, &analysis.map, &shown).map_err(named)?;
    let shading = Shading::of(&shown);
    let panels = [
        Panel { caption: analysis.describe_map(), picture: shading.draw(&shown) },
        Panel { caption: analysis.describe_best(options.seed), picture: shading.draw(&simulated) },
    ];
    let title = format!("{name:.60}: real and simulated");
    let figure = pictures_and_chart(&title, &panels, "Variogram", |area| {
        variogram_chart::draw(area, &analysis.variogram, &analysis.fits)
    })?;
    files::write_picture(&options.out, &figure)
}

impl TerrainOptions {
    fn settings(&self) -> ElevationSettings {
        ElevationSettings {
            cell_x_m: self.cell_size,
            cell_z_m: self.cell_size_z,
            metres_per_unit: self.metres_per_unit,
            base_m: self.base,
            height_range_m: self.height_range.map(|range| range.0),
            no_data: self.no_data,
            raw: self.raw_layout(),
        }
    }
}

/// What the library says of its settings, said of the options that set them.
fn in_options(text: &str) -> String {
    let options = [
        ("`cell_x_m`", "`--cell-size`"),
        ("`cell_z_m`", "`--cell-size-z`"),
        ("`metres_per_unit`", "`--metres-per-unit`"),
        ("`base_m`", "`--base`"),
        ("`height_range_m`", "`--height-range LOW,HIGH`"),
        ("set `no_data` to", "use --no-data"),
        ("`no_data`", "`--no-data`"),
        ("`raw` layout", "`--raw COLUMNSxROWS`"),
    ];
    options.into_iter().fold(text.to_owned(), |text, (setting, option)| text.replace(setting, option))
}

fn note(notice: &ElevationNotice) -> Note {
    Note { is_warning: notice.is_warning(), text: in_options(&notice.to_string()) }
}

impl Analysis {
    fn of(name: &str, bytes: &[u8], settings: &ElevationSettings) -> Result<Self, TerrainError> {
        let Elevation { grid: map, notices } = Elevation::read(name, bytes, settings)?;
        let notes = notices.iter().map(note).collect();
        let variogram = Variogram::estimate(&map, &VariogramSettings::default())?;
        let fits = fit_models(&variogram, &CovarianceModel::ALL)?;
        Ok(Self { map, notes, variogram, fits })
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

    /// Whether the ground varies at all scales of the map, so that it has neither range nor sill.
    fn has_no_range(&self, fit: &Fit) -> bool {
        let longest_m = self.variogram.classes().iter().map(|class| class.distance_m).fold(0.0, f64::max);
        fit.scale_m > NO_RANGE * 2.0 * longest_m
    }

    fn print(&self) {
        self.notes.iter().for_each(Note::print);
        let mean_m = self.variogram.drift().mean_m;
        println!("{}, mean {mean_m:.1} m, deviation {:.1} m", self.describe_map(), self.deviation_m());
        println!("{:<20} {:>11} {:>11} {:>13} {:>7}", "model", "scale m", "range m", "deviation m", "error");
        for fit in &self.fits {
            let (scale_m, range_m, deviation_m) = (fit.scale_m, fit.practical_range_m(), fit.deviation_m);
            let note = if self.has_no_range(fit) { "   no range within the map" } else { "" };
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
        let end = if self.has_no_range(best) { ", no range" } else { "" };
        format!("simulated: {}, scale {:.0} m{end}, seed {seed}", name(best), best.scale_m)
    }

    /// Settings for random ground of the best model, with waves as short as cells of `cell_m` can show.
    fn settings(&self, cell_m: f64, seed: u64) -> TurningBandsSettings {
        self.best().settings_like(&self.variogram, cell_m, seed)
    }

    fn to_json(&self, settings: &TurningBandsSettings) -> Value {
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
                "no_range_within_the_map": self.has_no_range(fit),
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
                "least_m": self.map.measured_m().fold(f32::INFINITY, f32::min),
                "greatest_m": self.map.measured_m().fold(f32::NEG_INFINITY, f32::max),
                "cells_without_data": self.map.gaps(),
                "mean_m": self.variogram.drift().mean_m,
                "deviation_m": self.deviation_m(),
            },
            "notes": self.notes.iter().map(Note::to_json).collect::<Vec<_>>(),
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
    let is_rougher_than_shown = settings.finest_wavelength_m < SHORTEST_WAVE_CELLS * shown.cell_m().min_element();
    // Waves that the picture cannot show are averaged away as those of the map are.
    if is_rougher_than_shown { reduced(&in_cells_of(map)?) } else { in_cells_of(shown) }
}

/// The name of a model, with the dimension of a fractal.
fn name(fit: &Fit) -> String {
    match fit.model {
        CovarianceModel::Fractal { dimension } => format!("fractal, D {dimension:.2}"),
        model => model.name().to_owned(),
    }
}
