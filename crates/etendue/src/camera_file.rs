//! A camera file by itself.

use etendue_io::failure::Error;
use etendue_io::{load_assets, read_regular};
use etendue_pipeline::compile_camera;
use etendue_pipeline::plan::CameraBody;
use etendue_scene::limits::DESCRIPTION;
use etendue_scene::{Overrides, asset, load_camera};
use std::path::Path;

/// Reads, checks and compiles a camera file, with changes `key=value` of its keys.
///
/// # Errors
/// All faults of the file and of the files that it names.
pub fn open_camera(file: &Path, set: &[String]) -> Result<CameraBody, Error> {
    let overrides = Overrides::new(set);
    let camera = load_camera(file, &read_text, &overrides).map_err(|f| Error::inputs(f.list()))?;
    let assets = load_assets(&asset::of_camera(&camera)).map_err(Error::inputs)?;
    compile_camera(&camera, &assets).map_err(Error::inputs)
}

/// The file's stem: the name of the results' folder.
pub(crate) fn stem(file: &Path) -> String {
    file.file_stem().map_or_else(|| "camera".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// The text of a file that the caller names.
pub(crate) fn text_of(path: &Path) -> Result<String, Error> {
    read_text(path).map_err(|why| Error::input(format!("{}: {why}", path.display())))
}

/// Reads a text file; the error says in a few words why it cannot.
pub(crate) fn read_text(path: &Path) -> Result<String, String> {
    let bytes = read_regular(path, &DESCRIPTION).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::IsADirectory => "it is a folder; name a file in it".to_owned(),
        _ => error.to_string(),
    })?;
    String::from_utf8(bytes).map_err(|_| "it is no text (UTF-8)".to_owned())
}
