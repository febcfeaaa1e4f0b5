//! Reading a job and the files it names into one tree, and changing it by the overrides.

use std::path::Path;
use std::sync::Arc;

use super::ReadText;
use crate::document::{Node, Value, parse};
use crate::fault::Faults;
use crate::overrides::Overrides;
use crate::place::Place;
use crate::reader::{Rule as _, path};

/// The tree of a job, its scene and its cameras; in place of each file's name stands its tree.
pub(super) fn job(file: &Path, read: &ReadText<'_>, overrides: &Overrides, faults: &mut Faults) -> Option<Node> {
    let mut document = document(file, read, &Place::file_head(file), faults)?;
    overrides.apply(&mut document, true, faults);
    let table = document.as_table_mut()?;
    if let Some(scene) = table.get_mut("scene") {
        splice(scene, read, faults);
    }
    if let Some(Node { value: Value::List(cameras), .. }) = table.get_mut("cameras") {
        for camera in cameras {
            if let Some(file) = camera.as_table_mut().and_then(|t| t.get_mut("file")) {
                splice(file, read, faults);
            }
        }
    }
    overrides.apply(&mut document, false, faults);
    Some(document)
}

/// Puts the tree of a file in place of its name.
fn splice(node: &mut Node, read: &ReadText<'_>, faults: &mut Faults) {
    if node.as_text().is_none() {
        return;
    }
    let file = path(&["toml"]).read(node, faults);
    let tree = file.and_then(|file| document(&file, read, &node.place, faults));
    *node = tree.unwrap_or(Node { place: node.place.clone(), value: Value::Unreadable });
}

/// The tree of a file, which is named at `named`; its format is checked and taken out.
pub(super) fn document(file: &Path, read: &ReadText<'_>, named: &Place, faults: &mut Faults) -> Option<Node> {
    let text = match read(file) {
        Ok(text) => text,
        Err(why) => {
            let problem = format!("cannot read \"{}\": {why}", file.display());
            let remedy = match named.file() == file {
                true => "correct the path",
                false => "correct the path, which is relative to the file that names it",
            };
            faults.add(named, problem, remedy);
            return None;
        }
    };
    let before = faults.count();
    let mut tree = parse(&Arc::from(file), &text, faults);
    if faults.count() > before {
        return None;
    }
    check_format(&mut tree, faults);
    Some(tree)
}

/// Every file says its format; this program reads format 1.
fn check_format(tree: &mut Node, faults: &mut Faults) {
    let head = tree.place.clone();
    match tree.as_table_mut().and_then(|t| t.remove("format")) {
        None => faults.add(&head, "the key \"format\" is missing", "add \"format = 1\" at the head of the file"),
        Some(entry) if !matches!(entry.node.value, Value::Whole(1)) => {
            let problem = format!("found format {}, and this program reads format 1", entry.node.describe());
            faults.add(
                &entry.node.place,
                problem,
                "write the file in format 1, or use a program that reads this format",
            );
        }
        Some(_) => {}
    }
}
