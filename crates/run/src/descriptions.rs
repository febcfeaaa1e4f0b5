//! Descriptions that are read without compiling a plan: render settings of a job, variations of a job, and the data sheet of a camera.

use crate::job_request::JobRequest;
use crate::memory::MemoryFiles;
use etendue_core::Accelerator;
use etendue_core::observer::{Message, Observer};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::paths::camera_stem;
use etendue_io::source::read_text;
use etendue_io::{ExistingFiles, OutputFolder};
use etendue_pipeline::datasheet::imported;
use etendue_scene::record::variations::Variations;
use etendue_scene::{Description, Place, load_datasheet, load_variations, stated_render_keys};
use std::path::{Path, PathBuf};

/// Render settings of a camera as the job's file states them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JobRenderSettings {
    /// Its keys, as dotted keys of the job: `render.spp`, `cameras.front.render.spp`.
    pub keys: Vec<String>,
    /// Cameras of the job.
    pub cameras: usize,
    /// The value of the key `accelerator`, the request's changes included.
    pub accelerator: Accelerator,
}

impl JobRequest {
    /// Returns the render settings of a camera as the job's file states them.
    ///
    /// # Errors
    /// The job is invalid (all errors), or has no such camera.
    pub fn stated_render(&self, camera: &str) -> Result<JobRenderSettings, Error> {
        let files = MemoryFiles::new();
        let sandbox = self.folders()?;
        let read = |path: &Path| files.read(path, &sandbox);
        let description = Description::load(&self.job, &read, &self.overrides());
        let description = description.map_err(|errors| Error::inputs(errors.as_slice()))?;
        let entry = description.cameras.iter().find(|entry| entry.name.value == camera);
        let entry = entry.ok_or_else(|| {
            Error::coded(ErrorCode::UnknownName, format!("{}: no camera {camera}", self.job.display()))
        })?;
        let accelerator = entry.render.accelerator.as_ref().map(|key| key.value).unwrap_or_default();
        let cameras = description.cameras.len();
        Ok(JobRenderSettings { cameras, keys: stated_render_keys(&self.job, camera, &read), accelerator })
    }
}

/// Reads and checks a variations file; its keys are checked by [`JobRequest::check_changes`].
///
/// # Errors
/// All errors of the file.
pub fn open_variations(file: &Path) -> Result<Variations, Error> {
    load_variations(file, &read_text).map_err(|errors| Error::inputs(errors.as_slice()))
}

impl JobRequest {
    /// Checks that the description accepts changes `key=value` after those of the request. An error is reported at the place that states the change. Of the
    /// files that the description names only scenes, cameras and bases are read, and nothing is compiled.
    ///
    /// # Errors
    /// All errors of the description with the changes.
    pub fn check_changes(&self, changes: &[(String, Place)]) -> Result<(), Error> {
        let (files, sandbox) = (MemoryFiles::new(), self.folders()?);
        let mut overrides = self.overrides();
        changes.iter().for_each(|(change, place)| overrides.add_stated(change, place));
        let description = Description::load(&self.job, &|path| files.read(path, &sandbox), &overrides);
        description.map(|_| ()).map_err(|errors| Error::inputs(errors.as_slice()))
    }
}

/// Makes a camera file and its tables from a data sheet (TOML); returns their paths.
///
/// # Errors
/// Figures are missing, illegal or contradict each other, or the folder cannot be written.
pub fn datasheet(
    sheet: &Path,
    folder: &Path,
    existing: ExistingFiles,
    observer: &dyn Observer,
) -> Result<Vec<PathBuf>, Error> {
    let record = load_datasheet(sheet, &read_text).map_err(|f| Error::inputs(f.as_slice()))?;
    let stem = camera_stem(sheet);
    let imported = imported(&record, &stem).map_err(Error::inputs)?;
    let camera = (format!("{stem}.toml"), imported.camera);
    let files: Vec<_> = std::iter::once(camera).chain(imported.tables).collect();
    let mut folder = OutputFolder::open_beside(folder, existing).map_err(Error::input)?;
    folder.claim(files.iter().map(|(name, _)| name.as_str())).map_err(Error::input)?;
    for (name, text) in &files {
        folder.write(name, text.as_bytes()).map_err(Error::run)?;
    }
    imported.warnings.iter().for_each(|warning| observer.message(Message::Warning(warning)));
    folder.commit().map_err(Error::run)
}
