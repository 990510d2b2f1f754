//! The stand of a forest plan.

use crate::{
    find,
    options::{Options, StandOptions},
    read,
    tree::write,
};
use bevy::math::{DVec2, IVec2, Vec2, Vec3, Vec3Swizzles};
use bevy_windwood::{
    Ground, LevelGround,
    export::{ExportedFiles, ExportedTree, StandInstance, stand_glb},
    scatter::{ForestPlan, Planted, Planter},
    terrain::{Elevation, ElevationSettings, MapPlacement},
    tree::{
        Species, TreeModel,
        textures::{SpeciesTextures, species_textures},
    },
};
use std::{fmt::Display, sync::Arc, time::Instant};

/// A species of the plan, and the trees of one age that stand for all of it.
struct Stock {
    species: Species,
    textures: SpeciesTextures,
    age_years: f32,
    models: Vec<TreeModel>,
}

/// Writes a square of a plan.
pub fn export(options: &Options, plan: &str) -> Result<(), String> {
    let start = Instant::now();
    let path = find(plan, "assets/forests", ".forest.ron");
    let plan = read(&path, ForestPlan::from_ron)?;
    let planter = Planter::new(&plan).map_err(|error| format!("{}: {error}", path.display()))?;
    let ground = ground(&options.stand)?;
    let planted = planted(&planter, &ground, &options.stand);
    let stocks = (0u8..).zip(planter.species()).map(|(number, name)| {
        let ages: Vec<f32> =
            planted.iter().filter(|plant| plant.species == number).map(|plant| plant.age_years).collect();
        Stock::grow(name, &ages, options)
    });
    let stocks: Vec<Stock> = stocks.collect::<Result<_, _>>()?;
    let trees: Vec<ExportedTree> = stocks.iter().flat_map(|stock| stock.trees(options.seed)).collect();
    let instances: Vec<StandInstance> = planted.iter().map(|plant| instance(plant, &stocks)).collect();
    println!("{} trees: grown after {:.2} s", instances.len(), start.elapsed().as_secs_f32());
    let start = Instant::now();
    let glb = stand_glb(&trees, &instances, options.stand.places.into(), &options.settings());
    let glb = glb.map_err(|error| error.to_string())?;
    write(&ExportedFiles(vec![(format!("{}.glb", options.file_name()), glb)]), options, start)
}

/// The ground on which the plan grows.
fn ground(options: &StandOptions) -> Result<Arc<dyn Ground>, String> {
    let Some(path) = &options.ground else { return Ok(Arc::new(LevelGround(0.0))) };
    let told = |error: &dyn Display| format!("{}: {error}", path.display());
    let bytes = std::fs::read(path).map_err(|error| told(&error))?;
    let cells = options.cells.map(Vec2::as_dvec2);
    let settings = ElevationSettings {
        cell_x_m: cells.map(|cells| cells.x),
        cell_z_m: cells.map(|cells| cells.y),
        ..ElevationSettings::default()
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let elevation = Elevation::read(&name, &bytes, &settings).map_err(|error| told(&error))?;
    let samples = DVec2::new(elevation.grid.columns() as f64, elevation.grid.rows() as f64);
    let corner_m = -0.5 * elevation.grid.cell_m() * (samples - 1.0);
    let placement = MapPlacement { west_m: corner_m.x, north_m: corner_m.y, ..MapPlacement::default() };
    Ok(Arc::new(elevation.into_map(placement).map_err(|error| told(&error))?))
}

/// What the plan has in the square, with places from its middle on.
fn planted(planter: &Planter, ground: &Arc<dyn Ground>, options: &StandOptions) -> Vec<Planted> {
    let StandOptions { middle, reach, .. } = *options;
    let cell = |place_m: Vec2| (place_m / planter.cell_m()).floor().as_ivec2();
    let (first, last) = (cell(middle - reach), cell(middle + reach));
    let origin = Vec3::new(middle.x, ground.height_m(middle.as_dvec2()) as f32, middle.y);
    let (mut all, mut of_cell) = (Vec::new(), Vec::new());
    for cell in (first.y..=last.y).flat_map(|z| (first.x..=last.x).map(move |x| IVec2::new(x, z))) {
        planter.plant(cell, ground, &mut of_cell);
        let from_middle = |plant: &Planted| Planted { position: plant.position - origin, ..*plant };
        let is_inside = |plant: &Planted| plant.position.xz().abs().cmple(Vec2::splat(reach)).all();
        all.extend(of_cell.iter().map(from_middle).filter(is_inside));
    }
    all
}

/// Where a plant stands, and which of its stock's trees does. Its height is that of its own age.
fn instance(plant: &Planted, stocks: &[Stock]) -> StandInstance {
    let number = usize::from(plant.species);
    let stock = &stocks[number];
    let before: usize = stocks[..number].iter().map(|stock| stock.models.len()).sum();
    let height = |age_years| stock.species.age.stage(age_years).height;
    StandInstance {
        tree: before + plant.seed as usize % stock.models.len(),
        position: plant.position,
        turn_rad: plant.turn_rad,
        scale: plant.vigour * height(plant.age_years) / height(stock.age_years),
    }
}

impl Stock {
    /// Trees of the mean of these ages.
    fn grow(name: &str, ages: &[f32], options: &Options) -> Result<Self, String> {
        let species = read(&find(name, "assets/species", ".species.ron"), Species::from_ron)?;
        let mean = ages.iter().sum::<f32>() / ages.len() as f32;
        let age_years = if ages.is_empty() { species.age.mature_years } else { mean };
        let seeds = (0..options.stand.variants).map(|variant| options.seed.wrapping_add(variant.into()));
        let models = seeds.map(|seed| TreeModel::bake(&species, age_years, seed)).collect();
        Ok(Self { textures: species_textures(&species), species, age_years, models })
    }

    fn trees(&self, first_seed: u64) -> impl Iterator<Item = ExportedTree<'_>> {
        (0u64..).zip(&self.models).map(move |(variant, model)| ExportedTree {
            species: &self.species,
            textures: &self.textures,
            model,
            age_years: self.age_years,
            seed: first_seed.wrapping_add(variant),
        })
    }
}
