//! Who may know whom: the rooms of the crate, and the pure code inside them.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// A room and the rooms it may import. A room that is not here may not exist.
const MAY_KNOW: [(&str, &[&str]); 12] = [
    ("wind", &[]),
    ("dynamics", &[]),
    ("texture", &[]),
    ("terrain", &["texture"]),
    ("scatter", &[]),
    ("cells", &["scatter", "lod"]),
    ("tree", &["dynamics", "texture"]),
    ("lod", &["tree", "texture", "dynamics"]),
    ("sway", &["tree", "wind", "dynamics", "texture", "lod"]),
    ("grass", &["sway"]),
    ("fire", &["sway", "wind"]),
    ("forest", &["scatter", "cells", "terrain", "tree", "lod", "sway", "wind"]),
];

/// Files that glue a room to the engine. All others but those of `sway` are pure: they can be read beside the
/// paper, and know no entities, systems or apps.
const GLUE: [&str; 40] = [
    "wind/cells.rs",
    "wind/clock.rs",
    "wind/current.rs",
    "wind/gizmos.rs",
    "wind/plugin.rs",
    "tree/components.rs",
    "tree/grove.rs",
    "tree/grow.rs",
    "tree/loader.rs",
    "tree/plugin.rs",
    "tree/season.rs",
    "grass/grow.rs",
    "grass/plugin.rs",
    "grass/draw.rs",
    "grass/material.rs",
    "grass/mesh.rs",
    "fire/burn.rs",
    "fire/plugin.rs",
    "fire/draw.rs",
    "fire/material.rs",
    "fire/mesh.rs",
    "forest/components.rs",
    "forest/far/blocks.rs",
    "forest/far/looks.rs",
    "forest/far/material.rs",
    "forest/far/mesh.rs",
    "forest/far/near.rs",
    "forest/far/plugin.rs",
    "forest/loader.rs",
    "forest/plugin.rs",
    "forest/serve.rs",
    "forest/cells.rs",
    "forest/cull.rs",
    "forest/diagnose.rs",
    "forest/near.rs",
    "terrain/components.rs",
    "terrain/material.rs",
    "terrain/plugin.rs",
    "terrain/stream.rs",
    "lib.rs",
];

/// What pure code may take from the engine: mathematics, reflection, collections, and the mark of an asset.
const PURE_ENGINE: [&str; 5] = ["math", "reflect", "asset", "tasks", "platform"];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder is readable").map(|entry| entry.expect("readable").path()) {
        if entry.is_dir() {
            files.extend(rust_files(&entry));
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            files.push(entry);
        }
    }
    files.sort();
    files
}

/// The paths that a file imports from `root` (`crate` or `bevy`), flattened: `use crate::{a::B, c}` gives `a::B` and `c`.
fn imports(text: &str, root: &str) -> Vec<String> {
    let code: String = text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join(" ");
    let mut found = Vec::new();
    for (start, _) in code.match_indices(&format!("{root}::")) {
        let boundary = code[..start].chars().next_back().is_none_or(|c| !c.is_alphanumeric() && c != '_');
        if boundary {
            flatten(&code[start + root.len() + 2..], String::new(), &mut found);
        }
    }
    found
}

/// Reads one path, or a braced list of paths, from the start of `text`.
fn flatten(text: &str, prefix: String, found: &mut Vec<String>) {
    let text = text.trim_start();
    let Some(list) = text.strip_prefix('{') else {
        let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
        found.push(prefix + &text[..end]);
        return;
    };
    let (mut depth, mut item) = (0, String::new());
    for c in list.chars() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                flatten(&std::mem::take(&mut item), prefix.clone(), found);
                continue;
            }
            _ => {}
        }
        item.push(c);
    }
    if !item.trim().is_empty() {
        flatten(&item, prefix, found);
    }
}

#[test]
fn imports_are_read_out_of_nested_lists() {
    let text = "use crate::{dynamics::{a, b::C}, wind::D}; // use crate::sway\nlet x = crate::tree::f();";
    assert_eq!(imports(text, "crate"), ["dynamics", "wind", "tree"]);
}

#[test]
fn rooms_know_only_whom_they_may() {
    let mut wrong = Vec::new();
    for (room, allowed) in MAY_KNOW {
        for file in rust_files(&source().join(room)) {
            let text = fs::read_to_string(&file).expect("readable");
            for import in imports(&text, "crate") {
                let is_room = MAY_KNOW.iter().any(|(other, _)| *other == import);
                if is_room && import != room && !allowed.contains(&import.as_str()) {
                    wrong.push(format!("{}: crate::{import}", file.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "forbidden imports:\n{}", wrong.join("\n"));
}

#[test]
fn every_folder_of_the_source_is_a_room_that_is_named_here() {
    for entry in fs::read_dir(source()).expect("readable").map(|entry| entry.expect("readable").path()) {
        let name = entry.file_name().expect("a name").to_string_lossy().into_owned();
        let known = MAY_KNOW.iter().any(|(room, _)| *room == name);
        assert!(!entry.is_dir() || known, "`{name}` is no room of the architecture");
    }
}

#[test]
fn pure_code_knows_no_entities() {
    let mut wrong = Vec::new();
    for (room, _) in MAY_KNOW.iter().filter(|(room, _)| *room != "sway") {
        for file in rust_files(&source().join(room)) {
            let name = file.strip_prefix(source()).expect("inside the source").to_string_lossy().replace('\\', "/");
            if GLUE.contains(&name.as_str()) {
                continue;
            }
            let text = fs::read_to_string(&file).expect("readable");
            let outside = imports(&text, "bevy").into_iter().filter(|import| !PURE_ENGINE.contains(&import.as_str()));
            wrong.extend(outside.map(|import| format!("{name}: bevy::{import}")));
        }
    }
    assert!(wrong.is_empty(), "engine in pure code:\n{}", wrong.join("\n"));
}

#[test]
fn glue_that_is_excused_exists() {
    for file in GLUE {
        assert!(source().join(file).is_file(), "src/{file} is gone; take it off the list");
    }
}
