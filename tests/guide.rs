//! The pages beside the code: their RON is valid, and their links lead to files. (Their Rust is compiled by the doc tests.)

use bevy_windwood::{scatter::ForestPlan, tree::Species};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// The pages and their texts.
fn pages() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["", "docs", "docs/guide", "examples", "tools", "assets/terrain"];
    let files = folders.iter().filter_map(|folder| fs::read_dir(root.join(folder)).ok()).flatten();
    let is_page = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "md");
    let pages = files.map(|file| file.expect("readable").path()).filter(is_page);
    pages.map(|path| (path.clone(), fs::read_to_string(path).expect("readable"))).collect()
}

/// The code blocks of a language.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    text.split(fence.as_str()).skip(1).map(|rest| rest.split("```").next().unwrap_or_default()).collect()
}

/// The targets of links and pictures that are files.
fn linked_files(text: &str) -> impl Iterator<Item = &str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let files = targets.filter(|target| !target.contains("://") && !target.starts_with('#') && !target.contains(' '));
    files.filter_map(|target| target.split('#').next())
}

#[test]
fn species_and_plans_of_the_pages_are_valid() {
    let mut found = 0;
    for (path, text) in pages() {
        for block in blocks(&text, "ron") {
            let error = if block.contains("areas:") {
                ForestPlan::from_ron(block).err().map(|error| error.to_string())
            } else {
                Species::from_ron(block).err().map(|error| error.to_string())
            };
            assert_eq!(error, None, "{}", path.display());
            found += 1;
        }
    }
    assert!(found >= 2, "the guide has a species and a plan");
}

#[test]
fn links_between_the_pages_lead_to_files() {
    // Of the pictures under `docs`, only some are in the package.
    let is_package = !Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/wide").exists();
    let mut found = 0;
    for (path, text) in pages() {
        for target in linked_files(&text) {
            let file = path.parent().expect("a page is in a folder").join(target);
            let may_be_missing = is_package && target.ends_with(".png");
            assert!(file.exists() || may_be_missing, "{} links to {target}", path.display());
            found += 1;
        }
    }
    assert!(found > 10, "pages link to one another");
}
