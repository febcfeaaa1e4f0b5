//! Inspection of text files: meshes, side-cars, spectra.

use std::path::Path;

use etendue_scene::asset::{MeshAsset, SlotMaterial, SlotReflectance, SlotSurface, is_gltf};
use serde_json::Value;

use super::{FileReport, report::ChannelReport};
use crate::mesh::{is_ply, is_stl, read_mesh};
use crate::table::{read_complex_index, read_retro_table};
use crate::{Error, spectrum::read_spectrum};

pub(super) fn mesh(file: &Path) -> Result<FileReport, Error> {
    let mesh = read_mesh(file)?;
    let kind = if is_gltf(file) {
        "mesh, glTF 2.0"
    } else if is_ply(file) {
        "mesh, PLY"
    } else if is_stl(file) {
        "mesh, STL"
    } else {
        "mesh, Wavefront OBJ"
    };
    let mut report = FileReport::new(file, kind);
    report.state("triangles", mesh.triangles.len());
    report.state("vertices", mesh.positions.len());
    report.state("normals", if mesh.normals.is_empty() { "none (faceted)" } else { "per vertex" });
    report.state("texture coordinates", if mesh.uvs.is_empty() { "none" } else { "per vertex" });
    for (slot, material) in mesh.slot_materials.iter().enumerate() {
        report.state(&format!("material slot {slot}"), slot_text(&mesh, slot, material));
    }
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let values = mesh.positions.iter().map(|p| f64::from(p[axis]) + mesh.origin[axis]);
        report.channels.push(ChannelReport::new(&format!("{name} (file units)"), "float", values));
    }
    report.notes.extend(mesh.report.into_iter().chain(mesh.warnings).chain(mesh.missing_libraries));
    Ok(report)
}

fn slot_text(mesh: &MeshAsset, slot: usize, material: &SlotMaterial) -> String {
    let count = mesh.slots.iter().filter(|s| usize::from(**s) == slot).count();
    let surface = match &material.surface {
        None => "no material".to_owned(),
        Some(SlotSurface::Diffuse { reflectance }) => format!("diffuse, {}", reflectance_text(reflectance)),
        Some(SlotSurface::Coated { reflectance, index, alpha }) => {
            format!("coated, index {index}, alpha {alpha:.4}, {}", reflectance_text(reflectance))
        }
        Some(SlotSurface::Layers(layers)) => layers.describe(),
    };
    format!("\"{}\": {surface}, {count} triangles", material.name)
}

fn reflectance_text(reflectance: &SlotReflectance) -> String {
    match reflectance {
        SlotReflectance::LinearSrgb(rgb) => format!("linear sRGB {rgb:?}"),
        SlotReflectance::Image(path) => format!("image {}", path.display()),
    }
}

pub(super) fn sidecar(file: &Path, bytes: &[u8]) -> Result<FileReport, Error> {
    let value: Value = serde_json::from_slice(bytes)
        .map_err(|cause| Error::at(file, cause.line(), format!("not readable as JSON: {cause}")))?;
    let mut report = FileReport::new(file, "side-car, JSON");
    match value {
        Value::Object(facts) => facts.iter().for_each(|(name, fact)| report.state(name, fact_text(fact))),
        other => report.state("value", other),
    }
    Ok(report)
}

fn fact_text(fact: &Value) -> String {
    fact.as_str().map_or_else(|| fact.to_string(), str::to_owned)
}

/// Table. Two columns: a spectrum. Three columns whose last row begins above 180, a wavelength and no angle: n and k. Otherwise: coefficients of
/// retro-reflection, except that a table of one entrance angle looks like a spectrum.
pub(super) fn table(file: &Path, bytes: &[u8]) -> Result<FileReport, Error> {
    let text = String::from_utf8_lossy(bytes);
    let row = text.lines().filter_map(first_and_count).next_back();
    match row {
        Some((first, 3)) if first > 180.0 => index(file),
        Some((_, 3..)) => retro(file),
        _ => spectrum(file),
    }
}

/// First number of a row, and the number of columns.
fn first_and_count(line: &str) -> Option<(f64, usize)> {
    let content = line.split('#').next()?;
    let first = content.split(',').next()?.trim().parse().ok()?;
    Some((first, content.split(',').count()))
}

fn index(file: &Path) -> Result<FileReport, Error> {
    let table = read_complex_index(file)?;
    let mut report = FileReport::new(file, "complex refractive index, CSV");
    if let (Some(first), Some(last)) = (table.points.first(), table.points.last()) {
        report.state("wavelengths", format!("{} to {} nm, {} points", first.0, last.0, table.points.len()));
    }
    report.channels.push(ChannelReport::new("n", "text", table.points.iter().map(|p| p.1)));
    report.channels.push(ChannelReport::new("k", "text", table.points.iter().map(|p| p.2)));
    Ok(report)
}

fn retro(file: &Path) -> Result<FileReport, Error> {
    let table = read_retro_table(file)?;
    let mut report = FileReport::new(file, "coefficients of retroreflection, CSV");
    report.state("observation angles", format!("{:?}°", table.observation_deg));
    report.state("entrance angles", format!("{:?}°", table.entrance_deg));
    report.channels.push(ChannelReport::new("R_A (cd/lx/m2)", "text", table.coefficients.iter().copied()));
    Ok(report)
}

fn spectrum(file: &Path) -> Result<FileReport, Error> {
    let spectrum = read_spectrum(file)?;
    let mut report = FileReport::new(file, "spectrum, CSV");
    let (first, last) = (spectrum.points.first(), spectrum.points.last());
    if let (Some((low, _)), Some((high, _))) = (first, last) {
        report.state("wavelengths", format!("{low} to {high} nm, {} points", spectrum.points.len()));
    }
    report.channels.push(ChannelReport::new("value", "text", spectrum.points.iter().map(|(_, v)| *v)));
    Ok(report)
}
