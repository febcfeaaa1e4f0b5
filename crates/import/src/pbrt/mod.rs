//! Scenes of pbrt-v4.
//!
//! Source: "Input file format (v4)" of pbrt.org and the program's own code where the page leaves a rule open (docs/import.md lists the rules).
//!
//! pbrt's space is left-handed without an up axis: ours is its mirror image, with the axis nearest to the camera's up upwards, so that images are the same. A
//! length of 1 is a metre; a radiance of 1 of white light is 1 cd/m², by which pbrt's `power` and `illuminance` are lm and lx.

mod attributes;
mod camera;
mod colour;
mod environment;
mod infinite;
mod interpreter;
mod lens_table;
mod light;
mod material;
mod mesh_parameters;
mod parameters;
mod patch;
mod shape;
mod spectrum;
mod texture;

#[cfg(test)]
mod tests;

use std::path::Path;

use etendue_io::Sandbox;
use etendue_io::failure::{Error, ErrorCode};

use super::written::ImportFiles;
use crate::syntax::pbrt::read_pbrt;
use interpreter::Interpreter;

pub(super) fn convert(file: &Path, folder: &Path) -> Result<ImportFiles, Error> {
    let mut interpreter = Interpreter::new(file, folder);
    read_pbrt(file, &Sandbox::NONE, &mut |directive, place| interpreter.take(directive, place))
        .map_err(Error::input)?;
    interpreter
        .finish(file)
        .map_err(|problem| Error::coded(ErrorCode::MalformedFile, format!("{}: {problem}", file.display())))
}
