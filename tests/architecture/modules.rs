//! The files of a crate as modules, and which file each path leads to.

use super::imports::{Code, Import, read};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// A file of the source, with its place in the tree of modules.
pub struct File {
    /// Path below `src`, with `/`.
    pub path: String,
    /// Its module, such as `["tree", "growth"]` for `tree/growth/mod.rs`.
    pub module: Vec<String>,
    code: Code,
}

/// All files of product code.
pub struct Crate {
    /// The files, sorted by path.
    pub files: Vec<File>,
    by_module: BTreeMap<Vec<String>, usize>,
}

/// What a path leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Target {
    /// An item of this file.
    Item(usize),
    /// The module of this file as a whole.
    Module(usize),
}

/// Re-exports that lead through more files than this lead nowhere.
const LONGEST_CHAIN: usize = 16;

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

fn module_of(path: &str) -> Vec<String> {
    let stem = path.trim_end_matches(".rs");
    let mut module: Vec<String> = stem.split('/').map(String::from).collect();
    if module.last().is_some_and(|last| last == "mod") || stem == "lib" {
        module.pop();
    }
    module
}

impl File {
    /// The parts of Bevy that a file names: `math` for `bevy::math::Vec3`.
    pub fn engine_imports(&self) -> BTreeSet<String> {
        let imports = self.code.imports.iter().map(|import| &import.path);
        let all = imports.chain(&self.code.paths).filter(|path| path.len() > 1 && path[0] == "bevy");
        all.map(|path| path[1].clone()).collect()
    }
}

impl Crate {
    /// Reads this crate's own source.
    pub fn read() -> Self {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let files = rust_files(&source).into_iter().map(|file| {
            let path = file.strip_prefix(&source).expect("inside the source").to_string_lossy().replace('\\', "/");
            (path, fs::read_to_string(&file).expect("readable"))
        });
        Self::from_files(files)
    }

    /// A crate of paths below `src`, each with its text. Files of tests are left out.
    pub fn from_files(files: impl IntoIterator<Item = (String, String)>) -> Self {
        let is_test = |path: &str| path.split('/').any(|part| part == "tests" || part == "tests.rs");
        let files: Vec<File> = files
            .into_iter()
            .filter(|(path, _)| !is_test(path))
            .map(|(path, text)| File { module: module_of(&path), code: read(&text), path })
            .collect();
        let by_module = files.iter().enumerate().map(|(index, file)| (file.module.clone(), index)).collect();
        Self { files, by_module }
    }

    /// The paths that a file imports from the crate, each as `room::file::Item`.
    pub fn imports(&self, file: &File) -> Vec<String> {
        let imports = file.code.imports.iter().map(|import| &import.path);
        imports
            .chain(&file.code.paths)
            .filter_map(|path| self.absolute(file, path))
            .map(|path| path.join("::"))
            .collect()
    }

    /// For each file the files that it imports.
    pub fn edges(&self) -> BTreeMap<String, BTreeSet<String>> {
        let edges = self.files.iter().enumerate().map(|(index, file)| {
            let others = self.targets(file).into_iter().filter(|&other| other != index);
            (file.path.clone(), others.map(|other| self.files[other].path.clone()).collect())
        });
        edges.collect()
    }

    /// The files whose items a file uses: those of its private imports, and those of its paths.
    fn targets(&self, file: &File) -> BTreeSet<usize> {
        let mut targets = BTreeSet::new();
        for import in file.code.imports.iter().filter(|import| !import.is_public) {
            let path = self.absolute(file, &import.path).unwrap_or_else(|| self.beside(file, &import.path));
            match self.resolve(&path, 0) {
                Some(Target::Item(index)) => drop(targets.insert(index)),
                // A module's name alone is no use of what is in it; a glob is.
                Some(Target::Module(index)) if import.name == "*" => drop(targets.insert(index)),
                _ => {}
            }
        }
        for path in &file.code.paths {
            let path = self.absolute(file, path).unwrap_or_else(|| self.beside(file, path));
            if let Some(Target::Item(index)) = self.resolve(&path, 0) {
                targets.insert(index);
            }
        }
        targets
    }

    /// A path that starts with `crate`, `self` or `super`, from the crate's root.
    fn absolute(&self, file: &File, path: &[String]) -> Option<Vec<String>> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => Some(rest.to_vec()),
            "self" => Some([&file.module, rest].concat()),
            "super" => {
                let ups = path.iter().take_while(|part| *part == "super").count();
                let kept = file.module.len().checked_sub(ups)?;
                Some([&file.module[..kept], &path[ups..]].concat())
            }
            _ => None,
        }
    }

    /// A path that starts with a name in the file's scope.
    fn beside(&self, file: &File, path: &[String]) -> Vec<String> {
        [&file.module[..], path].concat()
    }

    /// Follows a path from the root through modules and re-exports to where its item is defined.
    fn resolve(&self, path: &[String], links: usize) -> Option<Target> {
        if links > LONGEST_CHAIN {
            return None;
        }
        let mut module: Vec<String> = Vec::new();
        let mut index = *self.by_module.get(&module)?;
        for (at, part) in path.iter().enumerate() {
            let child = [&module[..], std::slice::from_ref(part)].concat();
            if let Some(&found) = self.by_module.get(&child) {
                (module, index) = (child, found);
                continue;
            }
            let file = &self.files[index];
            if part == "*" {
                return Some(Target::Module(index));
            }
            if file.code.items.contains(part) {
                return Some(Target::Item(index));
            }
            return self.follow(file, part, &path[at + 1..], links);
        }
        Some(Target::Module(index))
    }

    /// Where `name` in `file`, which brings it in with `use`, comes from.
    fn follow(&self, file: &File, name: &str, rest: &[String], links: usize) -> Option<Target> {
        let full = |import: &Import, path: &[String]| {
            let path = self.absolute(file, path).unwrap_or_else(|| self.beside(file, path));
            // `use noise::Noise` in a file `noise`: the crate of that name is meant.
            (path != self.beside(file, std::slice::from_ref(&import.name))).then_some(path)
        };
        let named = file.code.imports.iter().filter(|import| import.name == name && import.name != "*");
        for import in named {
            let Some(path) = full(import, &import.path) else { continue };
            if let Some(target) = self.resolve(&[&path, rest].concat(), links + 1) {
                return Some(target);
            }
        }
        for import in file.code.imports.iter().filter(|import| import.name == "*") {
            let parent = &import.path[..import.path.len() - 1];
            let Some(path) = full(import, parent) else { continue };
            let path = [&path, &[name.to_string()][..], rest].concat();
            if let Some(target @ Target::Item(_)) = self.resolve(&path, links + 1) {
                return Some(target);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::circles::circles;

    fn edges(files: &[(&str, &str)]) -> BTreeMap<String, BTreeSet<String>> {
        let owned = files.iter().map(|(path, text)| (path.to_string(), text.to_string()));
        Crate::from_files(owned).edges()
    }

    fn imports_of(edges: &BTreeMap<String, BTreeSet<String>>, file: &str) -> Vec<String> {
        edges[file].iter().cloned().collect()
    }

    #[test]
    fn an_import_through_reexports_leads_to_the_file_that_defines_the_item() {
        let edges = edges(&[
            ("lib.rs", "mod room; mod user;"),
            ("room/mod.rs", "mod inner; pub use inner::Item; pub struct Own;"),
            ("room/inner/mod.rs", "mod item; pub use item::*;"),
            ("room/inner/item.rs", "pub struct Item; pub fn call() {}"),
            ("user.rs", "use crate::room::{self, Item, Own}; fn f() { room::inner::call(); }"),
        ]);
        assert_eq!(imports_of(&edges, "user.rs"), ["room/inner/item.rs", "room/mod.rs"]);
        assert!(imports_of(&edges, "room/mod.rs").is_empty(), "a re-export is no import");
        assert!(circles(&edges).is_empty());
    }

    #[test]
    fn a_parent_that_only_declares_its_child_is_in_no_circle_with_it() {
        let child = ("room/child.rs", "use super::Own; pub fn call() {}");
        let declares = ("room/mod.rs", "mod child; pub use child::call; pub struct Own;");
        assert!(circles(&edges(&[("lib.rs", "mod room;"), declares, child])).is_empty());
        let uses = ("room/mod.rs", "mod child; pub struct Own; fn f() { child::call() }");
        let found = circles(&edges(&[("lib.rs", "mod room;"), uses, child]));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].files, ["room/child.rs", "room/mod.rs"]);
        let uses_a_reexport = ("room/mod.rs", "mod child; pub use child::call; pub struct Own; fn f() { call() }");
        assert_eq!(circles(&edges(&[("lib.rs", "mod room;"), uses_a_reexport, child])).len(), 1);
    }

    #[test]
    fn a_circle_by_way_of_others_is_found() {
        let found = circles(&edges(&[
            ("lib.rs", "mod a; mod b; mod c; mod d;"),
            ("a.rs", "use crate::b::B; pub struct A;"),
            ("b.rs", "use super::c; pub struct B; fn f() { c::d(); }"),
            ("c.rs", "pub fn d() { crate::a::A; }"),
            ("d.rs", "use crate::a::A;"),
        ]));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].files, ["a.rs", "b.rs", "c.rs"]);
    }

    #[test]
    fn code_that_only_tests_compile_makes_no_circle() {
        let found = circles(&edges(&[
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "use crate::b::B; pub struct A;"),
            ("b.rs", "pub struct B; #[cfg(test)] mod tests { use super::*; use crate::a::A; }"),
            ("b/tests.rs", "use crate::a::A;"),
        ]));
        assert!(found.is_empty());
    }
}
