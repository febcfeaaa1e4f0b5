//! Scenes of Universal Scene Description.
//!
//! Source: openusd.org, the schemas UsdGeom, UsdLux and UsdShade, and "UsdPreviewSurface Specification" 2.6; docs/import.md lists the rules.
//!
//! A stage is right-handed with y or z upwards: y is converted as for glTF (+z is forward), z stays. Lengths are in the stage's unit. A luminance of 1 is 1
//! cd/m², as in UsdLux. Values are those at the stage's start.

mod access;
mod binding;
mod camera;
mod dome;
mod importer;
mod light;
mod light_unit;
mod material;
mod mesh;
mod network;
mod polygons;
mod shape;
#[cfg(test)]
mod tests;
mod texture;
mod transform;

use std::path::Path;

use etendue_io::Sandbox;
use etendue_io::failure::{Error, ErrorCode};

use super::written::ImportFiles;
use crate::syntax::usd::read_usd;
use importer::Importer;

pub(super) fn convert(file: &Path, folder: &Path) -> Result<ImportFiles, Error> {
    let stage = read_usd(file, &Sandbox::NONE).map_err(Error::input)?;
    let result = Importer::new(file, folder, &stage).finish(file);
    result.map_err(|problem| Error::coded(ErrorCode::MalformedFile, format!("{}: {problem}", file.display())))
}
