//! Material slots of a mesh: the materials that its faces use, looked up in its libraries.

use std::path::{Path, PathBuf};

use etendue_scene::asset::SlotMaterial;

use super::mtl::{Library, LibraryMaterial, UvLayout, beside, parse};
use super::obj::{MaterialUse, Obj};
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
    let mut libraries = Vec::new();
    for path in library_paths(file, obj)? {
        let bytes = read_bytes(&path, "material library")?;
        libraries.push(parse(&path, decode_text(&path, &bytes)?)?);
        slots.library_bytes.push(bytes);
    }
    for library in &libraries {
        slots.report.extend(library.report.iter().cloned());
    }
    for wanted in &obj.materials {
        slots.add(file, wanted, &libraries);
    }
    Ok(slots)
}

impl Slots {
    fn add(&mut self, file: &Path, wanted: &MaterialUse, libraries: &[Library]) {
        let found = libraries.iter().find_map(|library| library.materials.get(&wanted.name));
        let (material, layout) = match found {
            Some(found) => self.take_from_library(&wanted.name, found),
            None => (SlotMaterial { name: wanted.name.clone(), surface: None }, UvLayout::PLAIN),
        };
        if let (None, Some(line)) = (found, wanted.line) {
            let obj = file.file_name().unwrap_or_default().to_string_lossy();
            self.report.push(format!(
                "{obj}:{line}: material \"{}\" is in no material library; say it in the scene",
                wanted.name
            ));
        }
        self.materials.push(material);
        self.layouts.push(layout);
    }

    fn take_from_library(&mut self, name: &str, found: &LibraryMaterial) -> (SlotMaterial, UvLayout) {
        let (material, notes) = found.fields.to_slot(name);
        self.report.extend(notes.into_iter().map(|note| format!("{}: {note}", found.place)));
        if found.fields.diffuse_map.is_some() && found.fields.diffuse.is_some_and(|kd| kd != [1.0; 3]) {
            self.report.push(format!("{}: material \"{name}\": Kd is not used beside map_Kd", found.place));
        }
        (material, found.layout)
    }
}

/// The library files, each once. A name may hold blanks, and one statement may name several files: the whole is tried
/// as one name first.
fn library_paths(file: &Path, obj: &Obj) -> Result<Vec<PathBuf>, Error> {
    let mut paths: Vec<PathBuf> = Vec::new();
    for (rest, line) in &obj.libraries {
        let whole = beside(file, rest);
        let named: Vec<PathBuf> = if whole.exists() {
            vec![whole]
        } else {
            rest.split_ascii_whitespace().map(|name| beside(file, name)).collect()
        };
        if named.is_empty() {
            return Err(Error::at(file, *line, "`mtllib` without a file name"));
        }
        if let Some(missing) = named.iter().find(|path| !path.exists()) {
            let told =
                format!("the material library `{}` does not exist; put it there or remove the line", missing.display());
            return Err(Error::at(file, *line, told));
        }
        paths.extend(named);
    }
    let mut seen = std::collections::BTreeSet::new();
    paths.retain(|path| seen.insert(path.clone()));
    Ok(paths)
}
