//! Checks that names are unique among their kind.

use crate::document::{Node, Table};
use crate::fault::{DescriptionErrors, ErrorCode};

/// Lists of a scene whose entries have names.
const LISTS: [&str; 7] = ["meshes", "textures", "materials", "frames", "objects", "lights", "media"];

/// Reports every duplicate name.
pub(super) fn check(document: &Node, errors: &mut DescriptionErrors) {
    let Some(job) = document.as_table() else { return };
    unique(job.get("cameras"), errors);
    let Some(scene) = job.get("scene").and_then(Node::as_table) else { return };
    for list in LISTS {
        unique(scene.get(list), errors);
    }
    unique_numbers(scene, errors);
}

fn unique(list: Option<&Node>, errors: &mut DescriptionErrors) {
    let mut first_places = std::collections::BTreeMap::new();
    for node in list.map_or(&[][..], Node::as_list).iter().filter_map(|n| n.as_table()?.get("name")) {
        let Some(name) = node.as_text() else { continue };
        match first_places.get(name) {
            None => {
                first_places.insert(name, &node.place);
            }
            Some(first) => note_duplicate(&format!("the name \"{name}\""), node, first, errors),
        }
    }
}

fn unique_numbers(scene: &Table, errors: &mut DescriptionErrors) {
    let Some(classes) = scene.get("classes").and_then(Node::as_table) else { return };
    let mut first_places = std::collections::BTreeMap::new();
    for entry in &classes.entries {
        match first_places.get(&entry.node.describe()) {
            None => drop(first_places.insert(entry.node.describe(), &entry.place)),
            Some(first) => {
                note_duplicate(&format!("the class number {}", entry.node.describe()), &entry.node, first, errors);
            }
        }
    }
}

fn note_duplicate(what: &str, node: &Node, first: &crate::Place, errors: &mut DescriptionErrors) {
    let at = first.line_column().map_or(first.to_string(), |(line, _)| format!("line {line}"));
    errors.add(ErrorCode::Duplicate, &node.place, format!("{what} is already used at {at}"), "choose a different one");
}

/// Returns the names in a list of the scene, also of entries with other errors.
pub(super) fn names_in_list<'d>(document: &'d Node, list: &str) -> Vec<&'d str> {
    let scene = document.as_table().and_then(|job| job.get("scene")).and_then(Node::as_table);
    scene.and_then(|s| s.get(list)).map_or(&[][..], Node::as_list).iter().filter_map(Node::name).collect()
}

/// The names of the scene's classes.
pub(super) fn class_names(document: &Node) -> Vec<&str> {
    let scene = document.as_table().and_then(|job| job.get("scene")).and_then(Node::as_table);
    let classes = scene.and_then(|s| s.get("classes")).and_then(Node::as_table);
    classes.map_or(Vec::new(), |t| t.entries.iter().map(|e| e.key.as_str()).collect())
}
