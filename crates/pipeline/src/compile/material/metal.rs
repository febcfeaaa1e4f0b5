//! Complex refractive indices of metals, by name or from a file.

use super::super::context::{Context, ErrorCode};
use etendue_core::WavelengthRange;
use etendue_scene::Placed;
use etendue_scene::record::material::Metal;
use etendue_spectra::metal::{self, ComplexIndex};
use etendue_spectra::{Extrapolation, Spectrum};
use std::path::PathBuf;

/// Complex refractive index of a metal.
pub(in super::super) fn complex_index(metal: &Metal, context: &mut Context<'_>) -> Option<ComplexIndex> {
    match metal {
        Metal::Named(name) => named(name, context),
        Metal::File(file) => from_table(file, context),
    }
}

/// A metal of the library.
pub(super) fn named(name: &Placed<String>, context: &mut Context<'_>) -> Option<ComplexIndex> {
    let metal_index = metal::by_name(&name.value).cloned();
    if metal_index.is_none() {
        let remedy = format!("give one of {}", metal::names().join(", "));
        context.error(ErrorCode::UnknownName, &name.place, format!("there is no metal \"{}\"", name.value), remedy);
    }
    metal_index
}

/// A table of n and k.
pub(super) fn from_table(file: &Placed<PathBuf>, context: &mut Context<'_>) -> Option<ComplexIndex> {
    let Some(asset) = context.assets.indices.get(&file.value) else {
        context.error(ErrorCode::UnreadableFile, &file.place, "the table was not loaded", "give a readable file");
        return None;
    };
    if let (Some(first), Some(last)) = (asset.points.first(), asset.points.last()) {
        context.coverage.add(&file.value, WavelengthRange::new(first.0, last.0), Extrapolation::Hold);
    }
    let n: Vec<_> = asset.points.iter().map(|(nm, n, _)| (*nm, *n)).collect();
    let k: Vec<_> = asset.points.iter().map(|(nm, _, k)| (*nm, *k)).collect();
    let n = context.accept(&file.place, Spectrum::from_points(&n, Extrapolation::Hold))?;
    let k = context.accept(&file.place, Spectrum::from_points(&k, Extrapolation::Hold))?;
    Some(ComplexIndex { n, k })
}
