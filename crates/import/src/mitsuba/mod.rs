//! Scenes of Mitsuba 3.
//!
//! Source: the documentation of the program (mitsuba.readthedocs.io) and, where it leaves a rule open, the behaviour of version 3.9.1 (docs/import.md lists the
//! rules; tests/oracles/mitsuba_scenes.py).
//!
//! Mitsuba's space is right-handed without an up axis: ours is the same, rotated so that the axis nearest to the first camera's up points upwards. A length of
//! 1 is a metre; a radiance of 1 of white light is 1 cd/m².

mod access;
mod bsdf;
mod camera;
mod emitter;
mod importer;
mod plastic;
mod shape;
mod texture;
mod transform;
mod value;

use std::path::Path;

use etendue_io::{Sandbox, failure::Error};

use super::written::ImportFiles;
use crate::syntax::mitsuba::read_mitsuba;
use importer::Importer;

pub(super) fn convert(file: &Path, folder: &Path, values: &[(String, String)]) -> Result<ImportFiles, Error> {
    let scene = read_mitsuba(file, values, &Sandbox::NONE).map_err(Error::input)?;
    Importer::new(file, folder, &scene).and_then(|importer| importer.finish(file)).map_err(Error::input)
}
