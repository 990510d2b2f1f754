//! The stand of a forest plan.

use crate::{find, options::Options, read, tree::write};
use bevy::math::{IVec2, Vec2, Vec3Swizzles};
use bevy_windwood::{
    LevelGround,
    export::{ExportedFiles, ExportedTree, StandInstance, stand_glb},
    scatter::{ForestPlan, Planted, Planter},
    tree::{
        Species, TreeModel,
        textures::{SpeciesTextures, species_textures},
    },
};
use std::time::Instant;

/// A species of the plan, and the trees of one age that stand for all of it.
struct Stock {
    species: Species,
    textures: SpeciesTextures,
    age_years: f32,
    models: Vec<TreeModel>,
}

/// Writes the part of a plan about its origin.
pub fn export(options: &Options, plan: &str) -> Result<(), String> {
    let start = Instant::now();
    let path = find(plan, "assets/forests", ".forest.ron");
    let plan = read(&path, ForestPlan::from_ron)?;
    let planter = Planter::new(&plan).map_err(|error| format!("{}: {error}", path.display()))?;
    let planted = planted(&planter, options.stand.reach);
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

/// What the plan has in the square about its origin, on level ground.
fn planted(planter: &Planter, reach_m: f32) -> Vec<Planted> {
    let cell = |place_m: f32| (place_m / planter.cell_m()).floor() as i32;
    let (first, last) = (cell(-reach_m), cell(reach_m));
    let (mut all, mut of_cell) = (Vec::new(), Vec::new());
    for cell in (first..=last).flat_map(|z| (first..=last).map(move |x| IVec2::new(x, z))) {
        planter.plant(cell, &LevelGround(0.0), &mut of_cell);
        all.extend(of_cell.iter().filter(|plant| plant.position.xz().abs().cmple(Vec2::splat(reach_m)).all()));
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
