//! Scene files of Mitsuba 3, as a tree of elements.
//!
//! Source: "Scene XML file format" of mitsuba.readthedocs.io, and the parser of Mitsuba 3 where the page leaves a rule open. The caller interprets the
//! elements. Here parameters (`<default>`, `$name`) are substituted, included files are inserted, folders of `<path>` are resolved, and names of files older
//! than version 2 are converted to the current spelling.
//!
//! Limits: a file and all that it includes have at most `description-mib`; elements are nested at most 64 deep, included files 16 deep; parameter names have at
//! most 64 bytes, and there are at most 64 search folders.

mod element;
mod folders;
mod parameters;
mod parse;

use std::path::Path;

use etendue_io::{Error, Sandbox};

pub use element::{MitsubaElement, MitsubaPlace, MitsubaScene};

/// Reads a scene file with all included files, which must lie in `sandbox`. `given` are values of parameters by name, as in Mitsuba's `-D`: they override
/// `<default>`.
///
/// # Errors
/// The first syntax error, with its file and line; a value for a parameter that the files do not name.
pub fn read_mitsuba(file: &Path, values: &[(String, String)], sandbox: &Sandbox) -> Result<MitsubaScene, Error> {
    parse::MitsubaReader::new(file, values, sandbox).map_err(|problem| Error::new(file, problem))?.scene(file)
}
