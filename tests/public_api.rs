//! What is public stands in `docs/public_api.txt`, so that a change of it is seen where changes are reviewed.
//!
//! The list is read off the sources: every `pub` item, field and re-export, file by file. An item of a private module is public only if
//! it is re-exported, which the list shows as well. Variants of enums and methods of traits are not listed.

use std::{
    fmt::Write,
    fs,
    path::{Path, PathBuf},
};

const LIST: &str = "docs/public_api.txt";
const RENEW: &str = "RENEW_PUBLIC_API=1 cargo test --test public_api";

fn rust_files(folder: &Path, out: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder).expect("a folder of the sources").map(|entry| entry.expect("an entry").path()).collect();
    entries.sort();
    for path in entries {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir() && name != "tests" {
            rust_files(&path, out);
        } else if name.ends_with(".rs") && name != "tests.rs" {
            out.push(path);
        }
    }
}

/// The public items of a file, each on one line, without bodies.
fn public_items(source: &str) -> Vec<String> {
    let mut items = Vec::new();
    let mut lines = source.lines();
    while let Some(line) = lines.next() {
        // Tests come last in a file.
        if line == "mod tests {" {
            break;
        }
        let mut item = line.trim().to_string();
        if !item.starts_with("pub ") {
            continue;
        }
        let is_field = !item.contains('{') && item.ends_with(',');
        let is_open = |item: &str| {
            let is_import = item.starts_with("pub use");
            let ends = if is_import { item.ends_with(';') } else { item.ends_with([';', '{', '}']) };
            !ends && !item.starts_with("pub mod")
        };
        while !is_field && is_open(&item) {
            let Some(more) = lines.next() else { break };
            let more = more.trim();
            if !item.ends_with(['(', '<', '{']) {
                item.push(' ');
            }
            item += more;
        }
        let is_import = item.starts_with("pub use");
        let head = if is_import { item.as_str() } else { item.split(" {").next().unwrap_or_default() };
        items.push(head.trim_end_matches([';', ',', ' ']).to_string());
    }
    items
}

fn list() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&root, &mut files);
    let mut list = format!("# What is public, by file. Renewed by `{RENEW}`.\n");
    for file in files {
        let items = public_items(&fs::read_to_string(&file).expect("a source file"));
        if items.is_empty() {
            continue;
        }
        let path = file.strip_prefix(&root).expect("below the sources").display().to_string().replace('\\', "/");
        let _ = write!(list, "\n{path}\n");
        items.iter().for_each(|item| {
            let _ = writeln!(list, "    {item}");
        });
    }
    list
}

#[test]
fn what_is_public_is_what_was_reviewed() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(LIST);
    let list = list();
    if std::env::var_os("RENEW_PUBLIC_API").is_some() {
        fs::write(&file, &list).expect("the list can be written");
    }
    let reviewed = fs::read_to_string(&file).unwrap_or_default();
    let difference = |of: &str, without: &str, sign: char| {
        let other: Vec<&str> = without.lines().collect();
        let lines = of.lines().filter(|line| !other.contains(line)).map(|line| format!("\n{sign} {}", line.trim()));
        lines.collect::<String>()
    };
    let changes = difference(&reviewed, &list, '-') + &difference(&list, &reviewed, '+');
    assert!(
        reviewed == list,
        "what is public has changed. If that is meant, run `{RENEW}` and commit `{LIST}`.{changes}"
    );
}

#[test]
fn items_are_read_off_sources() {
    let source = "pub(crate) fn hidden() {}\npub struct A {\n    /// Doc.\n    pub b: f32,\n    c: u8,\n}\nimpl A {\n    \
                  pub fn long(\n        a: u8,\n    ) -> u8 {\n        a\n    }\n}\npub use b::{\n    C,\n};\npub const D: u8 = \
                  3;\npub mod e;\npub struct F(pub u8);\nmod tests {\n    pub fn no() {}\n}\n";
    let items = [
        "pub struct A",
        "pub b: f32",
        "pub fn long(a: u8, ) -> u8",
        "pub use b::{C, }",
        "pub const D: u8 = 3",
        "pub mod e",
        "pub struct F(pub u8)",
    ];
    assert_eq!(public_items(source), items);
}
