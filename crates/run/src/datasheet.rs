//! A camera file of an EMVA 1288 data sheet.

use etendue_core::observer::{Message, Observer};
use etendue_io::failure::Error;
use etendue_io::paths::camera_stem;
use etendue_io::source::read_text;
use etendue_io::{Existing, OutputFolder};
use etendue_pipeline::datasheet::imported;
use etendue_scene::load_datasheet;
use std::path::{Path, PathBuf};

/// Makes a camera file, with its tables beside it, of a data sheet (TOML); answers with their paths.
///
/// # Errors
/// Where figures are missing, illegal or contradict each other, or the folder cannot be written.
pub fn datasheet(
    sheet: &Path,
    folder: &Path,
    existing: Existing,
    observer: &dyn Observer,
) -> Result<Vec<PathBuf>, Error> {
    let record = load_datasheet(sheet, &read_text).map_err(|f| Error::inputs(f.list()))?;
    let stem = camera_stem(sheet);
    let made = imported(&record, &stem).map_err(Error::inputs)?;
    let camera = (format!("{stem}.toml"), made.camera);
    let files: Vec<_> = std::iter::once(camera).chain(made.tables).collect();
    let mut folder = OutputFolder::open_beside(folder, existing).map_err(Error::input)?;
    folder.claim(files.iter().map(|(name, _)| name.as_str())).map_err(Error::input)?;
    for (name, text) in &files {
        folder.write(name, text.as_bytes()).map_err(Error::run)?;
    }
    made.warnings.iter().for_each(|warning| observer.message(Message::Warning(warning)));
    folder.commit().map_err(Error::run)
}
