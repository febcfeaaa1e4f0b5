//! Material slots of a mesh: the materials that its faces use, looked up in its libraries.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use etendue_scene::asset::SlotMaterial;

use super::mtl::{beside, parse};
use super::obj::Obj;
use super::texture_option::UvLayout;
use crate::Error;
use crate::source::{decode_text, read_bytes};

/// The slots, their texture layouts, what of the libraries is not used, and the libraries' bytes in order.
#[derive(Default)]
pub(super) struct Slots {
    pub(super) materials: Vec<SlotMaterial>,
    pub(super) layouts: Vec<UvLayout>,
    pub(super) report: Vec<String>,
    pub(super) library_bytes: Vec<Vec<u8>>,
}

/// Reads the libraries that `obj` (read from `file`) names and finds the materials that it uses.
pub(super) fn slots(file: &Path, obj: &Obj) -> Result<Slots, Error> {
    let mut slots = Slots::default();
    let mut known = BTreeMap::new();
    for path in library_paths(file, obj)? {
        let bytes = read_bytes(&path, "material library")?;
        let library = parse(&path, decode_text(&path, &bytes)?)?;
        for (name, material) in library.materials {
            known.entry(name).or_insert(material); // the first library counts
        }
        slots.report.extend(library.report);
        slots.library_bytes.push(bytes);
    }
    for name in &obj.materials {
        let (material, layout) = if let Some(found) = known.get(name) {
            let (material, notes) = found.slot(name);
            slots.report.extend(notes);
            (material, found.layout)
        } else {
            // The scene says what it is, or is told that nobody does.
            (SlotMaterial { name: name.clone(), surface: None }, UvLayout::PLAIN)
        };
        slots.materials.push(material);
        slots.layouts.push(layout);
    }
    Ok(slots)
}

/// The library files, each once. A name may hold blanks, and one statement may name several files: the whole is tried
/// as one name first.
fn library_paths(file: &Path, obj: &Obj) -> Result<Vec<PathBuf>, Error> {
    let mut paths: Vec<PathBuf> = Vec::new();
    let (mut statements, mut known) = (BTreeSet::new(), BTreeSet::new());
    for (rest, line) in obj.libraries.iter().filter(|(rest, _)| statements.insert(rest.clone())) {
        let whole = beside(file, rest);
        let named: Vec<PathBuf> =
            if whole.exists() { vec![whole] } else { rest.split_whitespace().map(|name| beside(file, name)).collect() };
        if named.is_empty() {
            return Err(Error::at(file, *line, "`mtllib` without a file name"));
        }
        for path in named.into_iter().filter(|path| known.insert(path.clone())) {
            if !path.exists() {
                let told = format!(
                    "the material library `{}` does not exist; put it there or remove the line",
                    path.display()
                );
                return Err(Error::at(file, *line, told));
            }
            paths.push(path);
        }
    }
    Ok(paths)
}
