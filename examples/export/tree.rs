//! One tree.

use crate::{
    find,
    options::{Format, Options},
    read,
};
use bevy_windwood::{
    export::{ExportedFiles, ExportedTree, impostor_files, obj_files, polygon_files, tree_glb},
    sway::{SwaySettings, WindResponse},
    tree::{Species, TreeModel, textures::species_textures},
    wind::{FieldSettings, WindField},
};
use std::{sync::Arc, time::Instant};

/// Writes the tree that the options ask for.
pub fn export(options: &Options) -> Result<(), String> {
    let species = read(&find(&options.species, "assets/species", ".species.ron"), Species::from_ron)?;
    let start = Instant::now();
    let (age_years, seed) = (options.age.unwrap_or(species.age.mature_years), options.seed);
    let (textures, model) = (species_textures(&species), TreeModel::bake(&species, age_years, seed));
    let tree = ExportedTree { species: &species, textures: &textures, model: &model, age_years, seed };
    let wind = options.sway.wind.map(|speed| wind(speed, seed)).transpose()?;
    println!("{}: grown after {:.2} s", species.name, start.elapsed().as_secs_f32());
    let (settings, name) = (options.settings(), options.file_name());
    for format in &options.formats {
        let start = Instant::now();
        let files = match format {
            Format::Glb => {
                tree_glb(&tree, &settings, wind.as_ref()).map(|glb| ExportedFiles(vec![(format!("{name}.glb"), glb)]))
            }
            Format::Obj => obj_files(&tree, &name, &settings),
            Format::Polygons => polygon_files(&tree, &format!("{name}_polygons")),
            Format::Impostor => impostor_files(&tree, &format!("{name}_impostor"), &settings),
        };
        write(&files.map_err(|error| error.to_string())?, options, start)?;
    }
    Ok(())
}

/// Writes files, and tells how large they are and how long it took since `start`.
pub fn write(files: &ExportedFiles, options: &Options, start: Instant) -> Result<(), String> {
    std::fs::create_dir_all(&options.out).map_err(|error| format!("{}: {error}", options.out.display()))?;
    files.write(&options.out).map_err(|error| error.to_string())?;
    for (name, bytes) in &files.0 {
        println!("{}: {:.2} MB", options.out.join(name).display(), bytes.len() as f32 / 1e6);
    }
    println!("written in {:.2} s", start.elapsed().as_secs_f32());
    Ok(())
}

fn wind(speed: f32, seed: u64) -> Result<WindResponse, String> {
    let field = WindField::synthesise(&FieldSettings { speed, seed, ..FieldSettings::default() });
    let field = field.map_err(|error| error.to_string())?;
    Ok(WindResponse::new(Arc::new(field), &SwaySettings::default()))
}
