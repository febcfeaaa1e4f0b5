//! Files that import each other in a circle can only be read together: each crate's files stand in layers, and no import leads up. What is
//! shared by two files stands in a third below them.

mod components;
mod folders;
mod house;
mod source;
pub(crate) mod tokens;

use std::collections::BTreeMap;

use house::{House, ImportedNames};

/// The only circles: files, and why they may stand in one. Those of folders are circles of these files alone.
const EXCEPTIONS: &[(&[&str], &str)] = &[
    (&["crates/scene/src/load/base.rs", "crates/scene/src/load/files.rs"], "a file names its base, which is a file"),
    (
        &["crates/scene/src/reader/rule.rs", "crates/scene/src/reader/table.rs", "crates/scene/src/reader/word.rs"],
        "a table is read by rules of its keys, and a rule may ask for a table",
    ),
];

/// Every crate's files by the folder `…/src/`: paths from there, with their text.
fn crates() -> BTreeMap<String, Vec<(String, String)>> {
    let mut crates: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
    for (name, text) in crate::texts(&[".rs"]) {
        let Some((folder, path)) = name.split_once("/src/") else { continue };
        crates.entry(format!("{folder}/src/")).or_default().push((path.to_owned(), text));
    }
    crates
}

fn is_allowed(circle: &[String]) -> bool {
    EXCEPTIONS.iter().any(|(paths, _)| circle.iter().all(|file| paths.iter().any(|path| file.starts_with(path))))
}

/// What ties the files of a circle.
fn ties(circle: &[String], arrows: &ImportedNames) -> String {
    let mut text = String::new();
    for from in circle {
        for (to, names) in arrows[from].iter().filter(|(to, _)| circle.contains(to)) {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            text.push_str(&format!("\n  {from} -> {to}: {}", names.join(", ")));
        }
    }
    text
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let mut violations = String::new();
    for (folder, files) in crates() {
        let arrows = House::new(&folder, &files).arrows();
        for (n, circle) in components::circles(&arrows).iter().filter(|circle| !is_allowed(circle)).enumerate() {
            violations.push_str(&format!(
                "\n{folder} circle {}: {} files{}",
                n + 1,
                circle.len(),
                ties(circle, &arrows)
            ));
        }
    }
    assert!(violations.is_empty(), "files that import each other in a circle:{violations}");
}

#[test]
fn no_folders_import_each_other_in_a_circle() {
    let mut violations = String::new();
    for (folder, files) in crates() {
        let arrows = House::new(&folder, &files).arrows();
        for (parent, arrows) in folders::arrows_by_folder(&arrows) {
            for circle in components::circles(&arrows) {
                let files: Vec<String> = circle.iter().map(|child| format!("{parent}{child}.rs")).collect();
                if !is_allowed(&files) {
                    violations.push_str(&format!("\n{parent} {}:{}", circle.join(" and "), ties(&circle, &arrows)));
                }
            }
        }
    }
    assert!(violations.is_empty(), "folders that import each other in a circle:{violations}");
}

/// Arrows of a small crate, to see that the test sees.
fn small(files: &[(&str, &str)]) -> ImportedNames {
    let files: Vec<(String, String)> = files.iter().map(|(p, t)| ((*p).to_owned(), (*t).to_owned())).collect();
    House::new("", &files).arrows()
}

#[test]
fn a_child_that_imports_its_parent_which_uses_it_is_a_circle() {
    let parent = "mod child; pub use child::Leaf; pub struct Shared; fn grow(leaf: Leaf) {}";
    let arrows = small(&[("lib.rs", "mod tree;"), ("tree/mod.rs", parent), ("tree/child.rs", "use super::Shared;")]);
    assert_eq!(components::circles(&arrows), [["tree/child.rs", "tree/mod.rs"]]);
}

#[test]
fn a_module_that_only_hands_on_is_no_part_of_a_circle() {
    let parent =
        "mod child; mod stem; pub use child::Leaf; pub use stem::Stem; #[cfg(test)] mod tests { use super::Leaf; }";
    let child = "/// As [`crate::tree::Leaf`].\nuse crate::tree::Stem; pub struct Leaf;";
    let files = [("lib.rs", "mod tree;"), ("tree/mod.rs", parent), ("tree/child.rs", child), ("tree/stem.rs", "")];
    let files = files.map(|(path, text)| if text.is_empty() { (path, "pub struct Stem;") } else { (path, text) });
    let arrows = small(&files);
    assert!(components::circles(&arrows).is_empty(), "{arrows:?}");
    assert!(arrows["tree/child.rs"].contains_key("tree/stem.rs"), "{arrows:?}");
}

/// The circles of a small crate's folders, each after the folder that it stands in.
fn small_folder_circles(files: &[(&str, &str)]) -> Vec<(String, Vec<String>)> {
    let folders = folders::arrows_by_folder(&small(files));
    let circles = |(folder, arrows): (String, ImportedNames)| {
        components::circles(&arrows).into_iter().map(move |circle| (folder.clone(), circle))
    };
    folders.into_iter().flat_map(circles).collect()
}

/// No two files import each other, but one file of each folder uses one of the other.
#[test]
fn folders_whose_files_use_each_other_are_a_circle() {
    let files = [
        ("lib.rs", "mod plan; mod render;"),
        ("plan/mod.rs", "pub mod data; mod cost;"),
        ("plan/data.rs", "pub struct Data;"),
        ("plan/cost.rs", "use crate::render::Film;"),
        ("render/mod.rs", "use crate::plan::data::Data; pub struct Film(Data);"),
    ];
    assert!(components::circles(&small(&files)).is_empty());
    let names = ["plan", "render"].map(str::to_owned).to_vec();
    assert_eq!(small_folder_circles(&files), [(String::new(), names)]);
}

#[test]
fn folders_within_a_folder_and_a_file_beside_its_folder_are_seen() {
    let files = [
        ("lib.rs", "mod camera;"),
        ("camera/mod.rs", "mod lens; mod front;"),
        ("camera/lens.rs", "pub mod error; use super::front::Front;"),
        ("camera/lens/error.rs", "pub struct LensError;"),
        ("camera/front.rs", "use super::lens::error::LensError; pub struct Front;"),
    ];
    let names = ["front", "lens"].map(str::to_owned).to_vec();
    assert_eq!(small_folder_circles(&files), [("camera/".to_owned(), names)]);
}
