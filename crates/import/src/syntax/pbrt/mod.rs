//! Scene files of pbrt-v4, as a stream of directives.
//!
//! Source: "Input file format (v4)" of pbrt.org, and the parser of pbrt-v4. What directives mean is for whoever takes them; here they are checked for
//! their form, and files that they include are read in their place.
//!
//! Limits: a file has at most `file-mib`, files that include one another go 16 deep, and all text together has at most `mesh-mib`.

mod parse;
mod token;

use std::path::{Path, PathBuf};

use etendue_io::source::{decode_text, read_bytes};
use etendue_io::{Error, Sandbox};
use etendue_scene::limits;

use self::parse::Parser;

pub use token::{PbrtDirective, PbrtParameter, PbrtPlace, PbrtValues};

/// Files that include one another.
const MAX_DEPTH: usize = 16;

/// Where directives go, each with the place where it stands: a fault that is answered ends the reading.
pub type TakeDirective<'a> = dyn FnMut(PbrtDirective, PbrtPlace<'_>) -> Result<(), String> + 'a;

/// Reads a scene file with all files that it includes, which must lie in `sandbox`; gives each directive to `take`.
///
/// # Errors
/// The first fault, with its file and line: of the form, or what `take` answers.
pub fn read_pbrt(file: &Path, sandbox: &Sandbox, take: &mut TakeDirective<'_>) -> Result<(), Error> {
    let folder = file.parent().unwrap_or(Path::new("")).to_owned();
    Reading { folder, sandbox, bytes: 0, take }.file(file, 0)
}

struct Reading<'a, 'b> {
    /// That of the first file: paths of included files are relative to it.
    folder: PathBuf,
    sandbox: &'a Sandbox,
    /// Of all files so far.
    bytes: u64,
    take: &'a mut TakeDirective<'b>,
}

impl Reading<'_, '_> {
    fn file(&mut self, file: &Path, depth: usize) -> Result<(), Error> {
        let bytes = read_bytes(file, "scene")?;
        self.bytes += bytes.len() as u64;
        limits::MESH.check_unpacked(self.bytes).map_err(|told| Error::new(file, told))?;
        let mut parser = Parser::new(decode_text(file, &bytes)?);
        while let Some((line, directive)) = parser.next().map_err(|(line, told)| Error::at(file, line, told))? {
            match directive {
                PbrtDirective::Include(name) => self.include(file, line, &name, depth)?,
                directive => {
                    (self.take)(directive, PbrtPlace { file, line }).map_err(|told| Error::at(file, line, told))?;
                }
            }
        }
        Ok(())
    }

    fn include(&mut self, file: &Path, line: usize, name: &str, depth: usize) -> Result<(), Error> {
        let told = |what: String| Error::at(file, line, what);
        let path = self.folder.join(name);
        self.sandbox.check(&path).map_err(|why| told(format!("`Include \"{name}\"`: {why}")))?;
        if depth + 1 >= MAX_DEPTH {
            return Err(told(format!(
                "files include one another more than {MAX_DEPTH} deep; include less, or each once"
            )));
        }
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz")) {
            return Err(told(format!(
                "`Include \"{name}\"`: compressed files are not read; unpack it and change the name"
            )));
        }
        self.file(&path, depth + 1)
    }
}
