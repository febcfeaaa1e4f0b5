//! Material slots of a mesh: the materials that its faces use, looked up in its libraries.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use etendue_scene::asset::SlotMaterial;

use super::mtl::{parse, sibling_path};
use super::{obj::Obj, texture_option::UvLayout};
use crate::source::{decode_text, read_description_bytes};
use crate::{Error, Sandbox};

/// Slots, their texture layouts, notes on unused content of the libraries, and the libraries' bytes in order.
#[derive(Default)]
pub(super) struct MaterialSlots {
    pub(super) materials: Vec<SlotMaterial>,
    pub(super) layouts: Vec<UvLayout>,
    pub(super) report: Vec<String>,
    pub(super) library_bytes: Vec<Vec<u8>>,
    pub(super) missing_libraries: Vec<String>,
}

/// Reads the libraries that `obj` (read from `file`) names and finds the materials that it uses.
pub(super) fn slots(file: &Path, obj: &Obj, sandbox: &Sandbox) -> Result<MaterialSlots, Error> {
    let mut slots = MaterialSlots::default();
    let mut known = BTreeMap::new();
    let (paths, missing) = library_paths(file, obj, sandbox)?;
    slots.missing_libraries = missing;
    for path in paths {
        let bytes = read_description_bytes(&path, "material library")?;
        let library = parse(&path, decode_text(&path, &bytes)?)?;
        for (name, material) in library.materials {
            known.entry(name).or_insert(material); // the first library takes precedence
        }
        slots.report.extend(library.report);
        slots.library_bytes.push(bytes);
    }
    for name in &obj.materials {
        let (material, layout) = if let Some(library_entry) = known.get(name) {
            let (material, notes) = library_entry.slot(name);
            slots.report.extend(notes);
            (material, library_entry.layout)
        } else {
            // The scene states the material, or reports that it is missing.
            (SlotMaterial { name: name.clone(), surface: None }, UvLayout::PLAIN)
        };
        slots.materials.push(material);
        slots.layouts.push(layout);
    }
    Ok(slots)
}

/// Library files, each once, and a sentence for each that does not exist. A name may contain blanks, and one statement may name several files: the whole is
/// tried as one name first.
fn library_paths(file: &Path, obj: &Obj, sandbox: &Sandbox) -> Result<(Vec<PathBuf>, Vec<String>), Error> {
    let (mut paths, mut missing): (Vec<PathBuf>, Vec<String>) = (Vec::new(), Vec::new());
    let (mut statements, mut known) = (BTreeSet::new(), BTreeSet::new());
    for (rest, line) in obj.libraries.iter().filter(|(rest, _)| statements.insert(rest.clone())) {
        let full_path = sibling_path(file, rest);
        let several: Vec<PathBuf> = rest.split_whitespace().map(|name| sibling_path(file, name)).collect();
        for path in several.iter().chain([&full_path]) {
            sandbox
                .check(path)
                .map_err(|problem| Error::at(file, *line, problem.within(format_args!("`mtllib {rest}`"))))?;
        }
        let one = full_path.exists() || !several.iter().any(|path| path.exists());
        let named = if one && !several.is_empty() { vec![full_path] } else { several };
        if named.is_empty() {
            return Err(Error::at(file, *line, "`mtllib` without a file name"));
        }
        let new: Vec<PathBuf> = named.into_iter().filter(|path| known.insert(path.clone())).collect();
        let (there, absent): (Vec<_>, Vec<_>) = new.into_iter().partition(|path| path.exists());
        let message = |path: &PathBuf| format!("line {line}: the material library `{}` does not exist", path.display());
        missing.extend(absent.iter().map(message));
        paths.extend(there);
    }
    Ok((paths, missing))
}
