//! `etendue inspect`: what is in a file, with units; a picture of it.

use crate::args;
use crate::output::{print, print_message};
use etendue::{Error, Existing, inspect, write_file};
use std::path::Path;

pub fn run(arguments: &args::Inspect) -> Result<(), Error> {
    let report = inspect(&arguments.file).map_err(Error::input)?;
    if let Some(path) = &arguments.png {
        if same(path, &arguments.file) {
            let told = format!("--png {}: this is the file itself; choose another name", path.display());
            return Err(Error::input(told));
        }
        let Some(preview) = &report.preview else {
            return Err(Error::input(format!("{}: no picture can be made of it", arguments.file.display())));
        };
        let bytes = preview.to_png().map_err(|error| Error::Run(error.to_string()))?;
        write_file(path, &bytes, Existing::Replace)?;
        print_message(&format!("wrote {}\n", path.display()));
    }
    print(&report.to_string());
    Ok(())
}

/// Whether two names are of one file that is there.
fn same(a: &Path, b: &Path) -> bool {
    a.canonicalize().ok().zip(b.canonicalize().ok()).is_some_and(|(a, b)| a == b)
}
