//! `etendue inspect`: what is in a file, with units; a picture of it.

use crate::args;
use crate::failure::Failure;
use crate::named_file;
use crate::say;
use etendue_io::Existing;
use etendue_io::inspect::inspect;

pub fn run(arguments: &args::Inspect) -> Result<(), Failure> {
    let report = inspect(&arguments.file).map_err(Failure::input)?;
    if let Some(path) = &arguments.png {
        if named_file::same(path, &arguments.file) {
            return Err(Failure::input(format!(
                "--png {}: this is the file itself; choose another name",
                path.display()
            )));
        }
        let Some(preview) = &report.preview else {
            return Err(Failure::input(format!("{}: no picture can be made of it", arguments.file.display())));
        };
        let bytes = preview.to_png().map_err(|error| Failure::Run(error.to_string()))?;
        named_file::write(path, &bytes, Existing::Replace)?;
        crate::tell(&format!("wrote {}\n", path.display()));
    }
    say(&report.to_string());
    Ok(())
}
