//! Material slots of a mesh: the materials that its faces use, looked up in its libraries.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use etendue_scene::asset::{ImageAsset, MtlPictures, SlotMaterial};

use super::mtl::{LibraryMaterial, parse};
use super::mtl_images::MtlImages;
use super::{obj::Obj, texture_option::UvLayout};
use crate::named_file::{NamedFile, find_named_file};
use crate::source::{name_notes, read_description_bytes};
use crate::{Error, Sandbox};

/// Slots, their texture layouts, notes on unused content of the libraries, and the libraries' bytes in order.
#[derive(Default)]
pub(super) struct MaterialSlots {
    pub(super) materials: Vec<SlotMaterial>,
    pub(super) layouts: Vec<UvLayout>,
    pub(super) report: Vec<String>,
    /// Bytes of the libraries, and hashes of the images that were read.
    pub(super) library_bytes: Vec<Vec<u8>>,
    pub(super) missing_libraries: Vec<String>,
    /// Images made for the materials.
    pub(super) images: Vec<(PathBuf, ImageAsset)>,
}

/// Reads the libraries that `obj` (read from `file`) names and finds the materials that it uses.
pub(super) fn slots(file: &Path, obj: &Obj, sandbox: &Sandbox) -> Result<MaterialSlots, Error> {
    let mut slots = MaterialSlots::default();
    let mut known = BTreeMap::new();
    let LibraryPaths { paths, missing, mut notes } = library_paths(file, obj, sandbox)?;
    name_notes(file, &mut notes);
    slots.report.extend(notes);
    slots.missing_libraries = missing;
    for path in paths {
        let bytes = read_description_bytes(&path, "material library")?;
        let library = parse(&path, &bytes)?;
        for (name, material) in library.materials {
            known.entry(name).or_insert(material); // the first library takes precedence
        }
        slots.report.extend(library.report);
        slots.library_bytes.push(bytes);
    }
    let mut images = MtlImages::new(file.parent().unwrap_or(Path::new("")), sandbox);
    for name in &obj.materials {
        let (material, layout) = if let Some(library_entry) = known.get(name) {
            let (material, notes) = slot(library_entry, name, &mut images)?;
            slots.report.extend(notes.into_iter().map(|note| format!("{}: {note}", library_entry.place)));
            (material, library_entry.layout())
        } else {
            // The scene states the material, or reports that it is missing.
            (SlotMaterial { name: name.clone(), surface: None }, UvLayout::PLAIN)
        };
        slots.materials.push(material);
        slots.layouts.push(layout);
    }
    slots.library_bytes.extend(images.hashes().map(|hash| hash.to_vec()));
    slots.images = images.derived.into_iter().collect();
    Ok(slots)
}

/// A material in terms of a scene, and notes on what it cannot represent.
fn slot(
    material: &LibraryMaterial,
    name: &str,
    images: &mut MtlImages<'_>,
) -> Result<(SlotMaterial, Vec<String>), Error> {
    let mut notes = Vec::new();
    let mut fields = material.fields.clone();
    let maps = &material.maps;
    fields.diffuse_map = maps.diffuse.as_ref().map(|texture| images.find(&material.folder, texture, &mut notes));
    let pictures = pictures(material, images, &mut notes)?;
    if fields.diffuse_map.is_some() && fields.diffuse.is_some_and(|kd| kd != [1.0; 3]) {
        notes.push("Kd is not used with map_Kd".to_owned());
    }
    if material.has_other_layouts() {
        notes.push("the textures have several layouts (-s, -o); that of the first is used for all".to_owned());
    }
    let notes = notes.into_iter().map(|note| format!("material \"{name}\": {note}"));
    let (slot, mut report) = match fields.needs_layers(&pictures) {
        true => fields.to_layers(name, pictures),
        false => fields.to_slot(name),
    };
    report.extend(notes);
    Ok((slot, report))
}

/// Textures of numbers and normals of a material.
fn pictures(
    material: &LibraryMaterial,
    images: &mut MtlImages<'_>,
    notes: &mut Vec<String>,
) -> Result<MtlPictures, Error> {
    let (maps, folder, mut pictures) = (&material.maps, &material.folder, MtlPictures::default());
    if let Some(texture) = &maps.opacity {
        let path = images.find(folder, texture, notes);
        if material.fields.opacity == Some(0.0) {
            notes.push("d 0 is not used with map_d".to_owned());
        }
        pictures.opacity = Some(images.opacity(&path, texture, material.fields.opacity)?);
    }
    if let Some(texture) = &maps.roughness {
        let path = images.find(folder, texture, notes);
        pictures.alpha = Some(images.alpha(&path, texture)?);
    }
    if let Some(texture) = &maps.metalness {
        let path = images.find(folder, texture, notes);
        pictures.metal = Some(images.metal(&path, texture)?);
    }
    if let Some(texture) = &maps.normals {
        let path = images.find(folder, texture, notes);
        pictures.normals = Some(MtlImages::normals(&path, texture));
    }
    if let Some(texture) = &maps.bump {
        let path = images.find(folder, texture, notes);
        match images.bump(&path, texture)? {
            _ if pictures.normals.is_some() => notes.push("the bump map is not used with `norm`".to_owned()),
            Some(normals) => {
                notes.push("the bump map is used as a normal map: its mean colour is that of one".to_owned());
                pictures.normals = Some(normals);
            }
            None => notes.push("the bump map is not used: the unit of its heights is unknown".to_owned()),
        }
    }
    Ok(pictures)
}

/// Library files, each once, sentences on those that do not exist, and notes on those at other paths.
#[derive(Default)]
struct LibraryPaths {
    paths: Vec<PathBuf>,
    missing: Vec<String>,
    notes: Vec<String>,
}

/// Library files. A name may contain blanks, and one statement may name several files: the whole is tried as one name first.
fn library_paths(file: &Path, obj: &Obj, sandbox: &Sandbox) -> Result<LibraryPaths, Error> {
    let mut result = LibraryPaths::default();
    let (mut statements, mut known) = (BTreeSet::new(), BTreeSet::new());
    let folder = file.parent().unwrap_or(Path::new(""));
    for (rest, line) in obj.libraries.iter().filter(|(rest, _)| statements.insert(rest.clone())) {
        let find = |name: &str| {
            let problem =
                |problem: crate::Problem| Error::at(file, *line, problem.within(format_args!("`mtllib {rest}`")));
            find_named_file(&[folder], name, sandbox).map_err(problem)
        };
        let several: Vec<NamedFile> = rest.split_whitespace().map(find).collect::<Result<_, _>>()?;
        let full = find(rest)?;
        let one = full.exists || !several.iter().any(|library| library.exists);
        for library in if one { vec![full] } else { several } {
            if !known.insert(library.path.clone()) {
                continue;
            }
            result.notes.extend(library.note.map(|note| format!("line {line}: {note}")));
            match library.exists {
                true => result.paths.push(library.path),
                false => result
                    .missing
                    .push(format!("line {line}: the material library `{}` does not exist", library.path.display())),
            }
        }
    }
    Ok(result)
}
