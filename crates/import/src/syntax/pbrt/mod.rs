//! Scene files of pbrt-v4, as a stream of directives.
//!
//! Source: "Input file format (v4)" of pbrt.org, and the parser of pbrt-v4. The caller interprets the directives; here their syntax is checked, and included
//! files are read in their place.
//!
//! Limits: a file has at most `file-mib`, included files are nested at most 16 deep, and all text together has at most `mesh-mib`.

mod parse;
mod token;

use std::path::{Path, PathBuf};

use etendue_io::named_file::{NamedFile, find_named_file};
use etendue_io::source::{decode_text, read_bytes};
use etendue_io::{Error, Sandbox};
use etendue_scene::limits;

use self::parse::Parser;

pub use token::{PbrtDirective, PbrtParameter, PbrtPlace, PbrtValues};

/// Maximum depth of included files.
const MAX_DEPTH: usize = 16;

/// Receiver of directives, each with its place: an error that it returns ends the reading.
pub type TakeDirective<'a> = dyn FnMut(PbrtDirective, PbrtPlace<'_>) -> Result<(), String> + 'a;

/// Reads a scene file with all included files, which must lie in `sandbox`; passes each directive to `take`.
///
/// # Errors
/// The first error, with its file and line: a syntax error, or that of `take`.
pub fn read_pbrt(file: &Path, sandbox: &Sandbox, take: &mut TakeDirective<'_>) -> Result<(), Error> {
    let folder = file.parent().unwrap_or(Path::new("")).to_owned();
    PbrtReader { folder, sandbox, bytes: 0, take }.file(file, 0)
}

struct PbrtReader<'a, 'b> {
    /// Folder of the first file: paths of included files are relative to it.
    folder: PathBuf,
    sandbox: &'a Sandbox,
    /// Bytes of all files so far.
    bytes: u64,
    take: &'a mut TakeDirective<'b>,
}

impl PbrtReader<'_, '_> {
    fn file(&mut self, file: &Path, depth: usize) -> Result<(), Error> {
        let bytes = read_bytes(file, "scene")?;
        self.bytes += bytes.len() as u64;
        limits::MESH.check_unpacked(self.bytes).map_err(|problem| Error::new(file, problem))?;
        let mut parser = Parser::new(decode_text(file, &bytes)?);
        while let Some((line, directive)) = parser.next().map_err(|(line, problem)| Error::at(file, line, problem))? {
            match directive {
                PbrtDirective::Include(name) => self.include(file, line, &name, depth)?,
                directive => {
                    (self.take)(directive, PbrtPlace { file, line })
                        .map_err(|problem| Error::at(file, line, problem))?;
                }
            }
        }
        Ok(())
    }

    fn include(&mut self, file: &Path, line: usize, name: &str, depth: usize) -> Result<(), Error> {
        let message = |what: String| Error::at(file, line, what);
        let NamedFile { path, note, .. } = find_named_file(&[&self.folder], name, self.sandbox)
            .map_err(|why| message(format!("`Include \"{name}\"`: {why}")))?;
        if note.is_some() {
            let shown = path.strip_prefix(&self.folder).unwrap_or(&path).display().to_string();
            (self.take)(PbrtDirective::Include(shown), PbrtPlace { file, line }).map_err(message)?;
        }
        if depth + 1 >= MAX_DEPTH {
            return Err(message(format!(
                "includes are nested more than {MAX_DEPTH} levels deep; check for files that include each other"
            )));
        }
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz")) {
            return Err(message(format!(
                "`Include \"{name}\"`: compressed files are not supported; decompress it and change the name"
            )));
        }
        // An empty included file has no directives.
        if std::fs::metadata(&path).is_ok_and(|data| data.is_file() && data.len() == 0) {
            return Ok(());
        }
        self.file(&path, depth + 1)
    }
}
