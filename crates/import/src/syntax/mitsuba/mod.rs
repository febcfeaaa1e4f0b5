//! Scene files of Mitsuba 3, as a tree of elements.
//!
//! Source: "Scene XML file format" of mitsuba.readthedocs.io, and the parser of Mitsuba 3 where the page leaves a rule open. What elements mean is for
//! whoever takes them; here parameters (`<default>`, `$name`) are put in, files that are included stand in their place, folders of `<path>` are found, and
//! names of files older than version 2 are spelt as today.
//!
//! Limits: a file and all that it includes have at most `description-mib`; elements stand at most 64 deep, files that include one another 16 deep; names of
//! parameters have at most 64 bytes, and files are sought in at most 64 folders.

mod element;
mod folders;
mod parameters;
mod parse;

use std::path::Path;

use etendue_io::{Error, Sandbox};

pub use element::{MitsubaElement, MitsubaPlace, MitsubaScene};

/// Reads a scene file with all files that it includes, which must lie in `sandbox`. Values are given to parameters by their names, as by Mitsuba's `-D`: they
/// hold in place of what a `<default>` says.
///
/// # Errors
/// The first fault of the form, with its file and line; a value of a parameter that the files do not name.
pub fn read_mitsuba(file: &Path, given: &[(String, String)], sandbox: &Sandbox) -> Result<MitsubaScene, Error> {
    parse::Reading::new(file, given, sandbox).map_err(|told| Error::new(file, told))?.scene(file)
}
