//! Which file may import which: the rules of the source tree, each of which can be read off a path.
//!
//! 1. **Rooms.** Every folder of `src` is a room. [`MAY_KNOW`] says which rooms a room may import.
//! 2. **No circles.** No file imports, by way of others or not, a file that imports it. A path counts as an import of
//!    the file that defines the item, however many re-exports lie between. A `mod` declaration and a `pub use` are no
//!    imports; what a `mod.rs` does with its children's items in code of its own is one.
//! 3. **Engine.** Files are plain Rust on [`PURE_ENGINE`]. Only these may use more of Bevy (entities, systems, apps,
//!    rendering):
//!    - all files of the rooms in [`ENGINE_ROOMS`],
//!    - files with a name in [`ENGINE_FILES`],
//!    - files in a folder `ecs` (resources and systems, by subject),
//!    - the files beside `lib.rs`.
//!
//! Test code is not looked at: files and folders named `tests`, and modules under `#[cfg(test)]`.

#[path = "architecture/circles.rs"]
mod circles;
#[path = "architecture/imports.rs"]
mod imports;
#[path = "architecture/modules.rs"]
mod modules;
#[path = "architecture/tokens.rs"]
mod tokens;

use circles::circles;
use modules::{Crate, File};

/// A room and the rooms it may import. A room that is not here may not exist.
const MAY_KNOW: [(&str, &[&str]); 16] = [
    ("wind", &[]),
    ("dynamics", &["wind"]),
    ("texture", &[]),
    ("terrain", &["texture", "render"]),
    ("scatter", &[]),
    ("cells", &["scatter"]),
    ("tree", &["dynamics", "texture"]),
    ("lod", &["tree", "texture", "dynamics"]),
    ("sway", &["tree", "wind", "dynamics"]),
    ("query", &["sway", "tree", "wind", "dynamics"]),
    ("render", &["sway", "lod", "tree", "texture", "wind", "dynamics"]),
    ("export", &["sway", "lod", "tree", "texture", "dynamics"]),
    ("grass", &["sway", "render", "dynamics"]),
    ("fire", &["sway", "wind", "render"]),
    ("forest", &["scatter", "cells", "terrain", "tree", "lod", "sway", "wind", "render"]),
    (
        "editor",
        &[
            "forest", "scatter", "terrain", "tree", "lod", "sway", "wind", "render", "dynamics", "texture", "query",
            "export",
        ],
    ),
];

/// Rooms that are all entities and systems.
const ENGINE_ROOMS: [&str; 3] = ["sway", "render", "forest"];

/// Names of files that join a room to the engine.
const ENGINE_FILES: [&str; 6] = ["plugin.rs", "components.rs", "mesh.rs", "material.rs", "draw.rs", "gizmos.rs"];

/// What all files may take from the engine: mathematics, reflection, collections, tasks, and the mark of an asset.
const PURE_ENGINE: [&str; 5] = ["math", "reflect", "asset", "tasks", "platform"];

/// Whether rule 3 lets a file use the whole engine. `path` is relative to `src`.
fn may_use_engine(path: &str) -> bool {
    let mut folders: Vec<&str> = path.split('/').collect();
    let name = folders.pop().unwrap_or_default();
    let room = folders.first();
    room.is_none_or(|room| ENGINE_ROOMS.contains(room)) || ENGINE_FILES.contains(&name) || folders.contains(&"ecs")
}

/// The first folder of a path, for a file that is in one.
fn room(file: &File) -> Option<&str> {
    file.path.split_once('/').map(|(room, _)| room)
}

#[test]
fn rooms_import_only_rooms_they_may_know() {
    let source = Crate::read();
    let mut wrong = Vec::new();
    for file in &source.files {
        let Some((room, allowed)) = MAY_KNOW.iter().find(|(name, _)| Some(*name) == room(file)) else { continue };
        for import in source.imports(file) {
            let Some(other) = import.split("::").next() else { continue };
            let is_room = MAY_KNOW.iter().any(|(name, _)| *name == other);
            if is_room && other != *room && !allowed.contains(&other) {
                wrong.push(format!("{}: crate::{import}", file.path));
            }
        }
    }
    assert!(wrong.is_empty(), "forbidden imports:\n{}", wrong.join("\n"));
}

#[test]
fn every_folder_of_the_source_is_a_room_of_the_table() {
    for file in &Crate::read().files {
        let known = room(file).is_none_or(|room| MAY_KNOW.iter().any(|(name, _)| *name == room));
        assert!(known, "the folder of `{}` is not in `MAY_KNOW`", file.path);
    }
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let source = Crate::read();
    let found = circles(&source.edges());
    let told: Vec<String> = found
        .iter()
        .map(|circle| {
            let arrows = circle.arrows.iter().map(|arrow| format!("  {} -> {}", arrow.0, arrow.1)).collect::<Vec<_>>();
            format!("{} files:\n{}", circle.files.len(), arrows.join("\n"))
        })
        .collect();
    assert!(found.is_empty(), "circles of files:\n{}", told.join("\n"));
}

#[test]
fn only_engine_files_import_the_engine() {
    let source = Crate::read();
    let mut wrong = Vec::new();
    for file in source.files.iter().filter(|file| !may_use_engine(&file.path)) {
        let outside = file.engine_imports().into_iter().filter(|import| !PURE_ENGINE.contains(&import.as_str()));
        wrong.extend(outside.map(|import| format!("{}: bevy::{import}", file.path)));
    }
    assert!(wrong.is_empty(), "engine in plain code:\n{}", wrong.join("\n"));
}

#[test]
fn engine_files_are_told_by_their_path() {
    for path in ["lib.rs", "sway/active.rs", "wind/plugin.rs", "tree/ecs/season.rs", "render/draw/bounds.rs"] {
        assert!(may_use_engine(path), "{path}");
    }
    for path in ["wind/field.rs", "tree/growth/age.rs", "tree/growth/plugins.rs"] {
        assert!(!may_use_engine(path), "{path}");
    }
}
