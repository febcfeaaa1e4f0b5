//! A camera file by itself.

use crate::failure::Failure;
use crate::job::read_text;
use etendue_io::load_assets;
use etendue_pipeline::compile_camera;
use etendue_pipeline::plan::CameraBody;
use etendue_scene::{Overrides, asset, load_camera};
use std::path::Path;

/// Reads, checks and compiles a camera file with the changes of `--set`.
pub fn load(file: &Path, set: &[String]) -> Result<CameraBody, Failure> {
    let overrides = Overrides::new(set);
    let camera = load_camera(file, &read_text, &overrides).map_err(|f| Failure::inputs(f.list()))?;
    let assets = load_assets(&asset::of_camera(&camera)).map_err(Failure::inputs)?;
    compile_camera(&camera, &assets).map_err(Failure::inputs)
}

/// The camera file's stem: the name of the results' folder.
pub fn name(file: &Path) -> String {
    file.file_stem().map_or_else(|| "camera".to_owned(), |stem| stem.to_string_lossy().into_owned())
}
