//! Opens a single camera file.

use etendue_io::failure::Error;
use etendue_io::load_assets;
use etendue_io::source::read_text;
use etendue_pipeline::compile_camera;
use etendue_pipeline::plan::CameraBody;
use etendue_scene::{Overrides, load_camera, named_files};
use std::path::Path;

/// Reads, checks and compiles a camera file, with changes `key=value` of its keys.
///
/// # Errors
/// All errors of the file and of the files that it names.
pub fn open_camera(file: &Path, set: &[String]) -> Result<CameraBody, Error> {
    let overrides = Overrides::new(set);
    let camera = load_camera(file, &read_text, &overrides).map_err(|f| Error::inputs(f.as_slice()))?;
    let assets = load_assets(&named_files::camera_files(&camera)).map_err(Error::inputs)?;
    compile_camera(&camera, &assets).map_err(Error::inputs)
}
