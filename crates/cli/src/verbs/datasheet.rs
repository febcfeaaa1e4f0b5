//! `etendue datasheet`: a camera file of an EMVA 1288 data sheet.

use super::render::{claim, commit, open};
use crate::camera_file;
use crate::failure::Failure;
use crate::job::read_text;
use crate::sensor_args;
use crate::tell;
use etendue_pipeline::datasheet::imported;
use etendue_scene::load_datasheet;

pub fn run(arguments: &sensor_args::DataSheet) -> Result<(), Failure> {
    let sheet = load_datasheet(&arguments.sheet, &read_text).map_err(|f| Failure::inputs(f.list()))?;
    let stem = camera_file::name(&arguments.sheet);
    let made = imported(&sheet, &stem).map_err(Failure::inputs)?;
    let camera = (format!("{stem}.toml"), made.camera);
    let files: Vec<_> = std::iter::once(camera).chain(made.tables).collect();
    let mut folder = open(&arguments.output)?;
    claim(&folder, files.iter().map(|(name, _)| name.clone()))?;
    for (name, text) in &files {
        folder.write(name, text.as_bytes()).map_err(Failure::run)?;
    }
    made.warnings.iter().for_each(|warning| tell(&format!("warning: {warning}\n")));
    commit(folder)
}
