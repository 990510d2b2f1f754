//! Every species that is shipped, and species files with typing errors.

use bevy_windwood::tree::{Species, SpeciesError, TreeModel, foliage::CLUSTERS_LIMIT, growth::BEAMS_LIMIT};
use bevy_windwood::{SettingError, SyntaxError};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::{fs, path::Path};

/// Ages at which each is grown, as shares of the mature age.
const AGES: [f32; 5] = [0.03, 0.1, 0.3, 1.0, 3.0];

/// Name and text of every file in `assets/species`, in alphabetical order.
fn shipped() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/species");
    let mut files: Vec<_> =
        fs::read_dir(&folder).expect("it is there").map(|file| file.expect("readable").path()).collect();
    files.sort();
    let read = |path: std::path::PathBuf| {
        let name = path.file_name().expect("it has one").to_string_lossy().into_owned();
        (name, fs::read_to_string(&path).expect("readable"))
    };
    files.into_iter().map(read).collect()
}

fn check(name: &str, species: &Species, age_years: f32, seed: u64) -> TreeModel {
    let model = TreeModel::bake(species, age_years, seed);
    let finite = |floats: &[[f32; 3]]| floats.iter().flatten().all(|value| value.is_finite());
    assert!(finite(&model.wood.positions) && finite(&model.wood.normals), "{name} at {age_years}: wood");
    assert!(finite(&model.leaves.positions) && finite(&model.leaves.normals), "{name} at {age_years}: leaves");
    assert!(model.beams.len() <= BEAMS_LIMIT && model.skeleton.clusters.len() <= CLUSTERS_LIMIT, "{name}");
    assert!(
        model.beams.iter().all(|beam| beam.in_leaf.gain.is_finite() && beam.bare.class.is_finite()),
        "{name}: dynamics"
    );
    model
}

#[test]
fn twelve_kinds_of_trees_are_shipped() {
    let wanted = [
        "oak",
        "beech",
        "birch",
        "maple",
        "willow",
        "poplar",
        "scots_pine",
        "norway_spruce",
        "fir",
        "larch",
        "hazel",
        "dead_tree",
    ];
    let names: Vec<String> = shipped().into_iter().map(|(name, _)| name).collect();
    for kind in wanted {
        assert!(names.contains(&format!("{kind}.species.ron")), "{kind} is not shipped");
    }
}

#[test]
fn every_shipped_species_grows_from_sapling_to_old() {
    for (name, text) in shipped() {
        let species = Species::from_ron(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        let models = AGES.map(|share| check(&name, &species, share * species.age.mature_years, 3));
        let heights: Vec<f32> = models.iter().map(TreeModel::height_m).collect();
        // A broken trunk may be shorter than a younger whole one.
        let falls = heights.windows(2).filter(|pair| pair[1] < 0.9 * pair[0]).count();
        assert!(falls == 0 || species.damage.broken_trunks > 0.0, "{name}: heights {heights:?}");
        assert!(heights[0] < 0.5 * heights[3], "{name}: heights {heights:?}");
    }
}

/// Thousands of trees are drawn at once, so each has a budget.
#[test]
fn shipped_species_keep_to_the_budget_of_vertices_and_beams() {
    for (name, text) in shipped() {
        let species = Species::from_ron(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        for seed in 0..2 {
            let model = check(&name, &species, species.age.mature_years, seed);
            let vertices = model.wood.positions.len() + model.leaves.positions.len();
            assert!(vertices < 40_000, "{name} has {vertices} vertices");
            assert!(model.beams.len() < 1500, "{name} has {} beams", model.beams.len());
        }
    }
}

/// Replaces one number of a file by something else. Reading it gives an error that says where, or a species that grows.
#[test]
fn a_wrong_number_in_a_species_file_is_refused_with_its_place_or_grows_a_valid_tree() {
    const WRONG: [&str; 8] = ["NaN", "-1.0", "0", "1e30", "-1e30", "inf", "\"much\"", "99999999"];
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    let (mut refused, mut grown) = (0, 0);
    for (name, text) in shipped() {
        let numbers: Vec<(usize, usize)> = numbers(&text);
        for _ in 0..12 {
            let (from, to) = numbers[random.random_range(0..numbers.len())];
            let wrong = WRONG[random.random_range(0..WRONG.len())];
            let broken = format!("{}{wrong}{}", &text[..from], &text[to..]);
            match Species::from_ron(&broken) {
                Ok(species) => {
                    check(&name, &species, species.age.mature_years, 1);
                    grown += 1;
                }
                Err(SpeciesError::Syntax(SyntaxError { line, .. })) => {
                    assert_eq!(line, text[..from].matches('\n').count() + 1, "{name}: {wrong}");
                    refused += 1;
                }
                Err(SpeciesError::Setting(SettingError { field, allowed, .. })) => {
                    assert!(!field.is_empty() && !allowed.is_empty());
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 50, "{refused} were refused, {grown} grew");
}

/// Where the numbers of a text are, those in comments left out.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let code = line.split("//").next().unwrap_or("");
        let mut start = None;
        for (index, c) in code.char_indices().chain([(code.len(), ' ')]) {
            match (c.is_ascii_digit() || c == '.' || c == '-', start) {
                (true, None) => start = Some(index),
                (false, Some(from)) if code[from..index].contains(|c: char| c.is_ascii_digit()) => {
                    let named = code[..from].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '"');
                    if !named && !c.is_alphanumeric() {
                        found.push((at + from, at + index));
                    }
                    start = None;
                }
                (false, Some(_)) => start = None,
                _ => {}
            }
        }
        at += line.len();
    }
    found
}
