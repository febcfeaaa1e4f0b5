//! `etendue inspect`: what is in a file, with units; a picture of it.

use crate::args;
use crate::failure::Failure;
use crate::say;
use etendue_io::inspect::inspect;
use etendue_io::{Existing, OutputFolder};
use std::path::Path;

pub fn run(arguments: &args::Inspect) -> Result<(), Failure> {
    let report = inspect(&arguments.file).map_err(Failure::input)?;
    if let Some(path) = &arguments.png {
        let Some(preview) = &report.preview else {
            return Err(Failure::input(format!("{}: no picture can be made of it", arguments.file.display())));
        };
        let bytes = preview.to_png().map_err(|error| Failure::Run(error.to_string()))?;
        write(path, &bytes)?;
        crate::tell(&format!("wrote {}\n", path.display()));
    }
    say(&report.to_string());
    Ok(())
}

/// Writes a file that the user named, replacing what was there; never half of it.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| Failure::input(format!("{}: expected the name of a file", path.display())))?;
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut folder = OutputFolder::open(parent, Existing::Replace).map_err(Failure::input)?;
    folder.write(name, bytes).map_err(Failure::input)?;
    folder.commit().map_err(|error| Failure::Run(error.to_string())).map(|_| ())
}
