//! Checks that names are unique among their kind.

use crate::document::{Node, Table};
use crate::fault::{ErrorCode, Faults};

/// Lists of a scene whose entries have names.
const LISTS: [&str; 7] = ["meshes", "textures", "materials", "frames", "objects", "lights", "media"];

/// Reports every duplicate name.
pub(super) fn check(document: &Node, faults: &mut Faults) {
    let Some(job) = document.as_table() else { return };
    unique(job.get("cameras"), faults);
    let Some(scene) = job.get("scene").and_then(Node::as_table) else { return };
    for list in LISTS {
        unique(scene.get(list), faults);
    }
    unique_numbers(scene, faults);
}

fn unique(list: Option<&Node>, faults: &mut Faults) {
    let mut seen = std::collections::BTreeMap::new();
    for node in list.map_or(&[][..], Node::as_list).iter().filter_map(|n| n.as_table()?.get("name")) {
        let Some(name) = node.as_text() else { continue };
        match seen.get(name) {
            None => {
                seen.insert(name, &node.place);
            }
            Some(first) => note_twice(&format!("the name \"{name}\""), node, first, faults),
        }
    }
}

fn unique_numbers(scene: &Table, faults: &mut Faults) {
    let Some(classes) = scene.get("classes").and_then(Node::as_table) else { return };
    let mut seen = std::collections::BTreeMap::new();
    for entry in &classes.entries {
        match seen.get(&entry.node.describe()) {
            None => drop(seen.insert(entry.node.describe(), &entry.place)),
            Some(first) => {
                note_twice(&format!("the class number {}", entry.node.describe()), &entry.node, first, faults);
            }
        }
    }
}

fn note_twice(what: &str, node: &Node, first: &crate::Place, faults: &mut Faults) {
    let at = first.line_column().map_or(first.to_string(), |(line, _)| format!("line {line}"));
    faults.add(ErrorCode::Duplicate, &node.place, format!("{what} is already used at {at}"), "choose a different one");
}

/// Returns the names in a list of the scene, also of entries with other errors.
pub(super) fn of<'d>(document: &'d Node, list: &str) -> Vec<&'d str> {
    let scene = document.as_table().and_then(|job| job.get("scene")).and_then(Node::as_table);
    scene.and_then(|s| s.get(list)).map_or(&[][..], Node::as_list).iter().filter_map(Node::name).collect()
}

/// The names of the scene's classes.
pub(super) fn of_classes(document: &Node) -> Vec<&str> {
    let scene = document.as_table().and_then(|job| job.get("scene")).and_then(Node::as_table);
    let classes = scene.and_then(|s| s.get("classes")).and_then(Node::as_table);
    classes.map_or(Vec::new(), |t| t.entries.iter().map(|e| e.key.as_str()).collect())
}
