//! A variations file by itself, and whether a job takes what it changes.

use crate::job_request::JobRequest;
use crate::memory::MemoryFiles;
use etendue_io::failure::Error;
use etendue_io::source::read_text;
use etendue_scene::record::variations::Variations;
use etendue_scene::{Description, Place, load_variations};
use std::path::Path;

/// Reads and checks a variations file; the keys that it names are checked by [`JobRequest::check_changes`].
///
/// # Errors
/// All faults of the file.
pub fn open_variations(file: &Path) -> Result<Variations, Error> {
    load_variations(file, &read_text).map_err(|faults| Error::inputs(faults.list()))
}

impl JobRequest {
    /// Whether the description takes changes `key=value` after those of the request: a fault of one is told where a file states it. The files that
    /// the description names are not read but for scenes, cameras and bases, and nothing is compiled.
    ///
    /// # Errors
    /// All faults of the description with the changes.
    pub fn check_changes(&self, changes: &[(String, Place)]) -> Result<(), Error> {
        let (files, sandbox) = (MemoryFiles::new(), self.folders()?);
        let mut overrides = self.overrides();
        changes.iter().for_each(|(change, place)| overrides.push_stated(change, place));
        let description = Description::load(&self.job, &|path| files.read(path, &sandbox), &overrides);
        description.map(|_| ()).map_err(|faults| Error::inputs(faults.list()))
    }
}
