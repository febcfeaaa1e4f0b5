//! What a job's file says of rendering, for programs that write a job over it.

use crate::job_request::JobRequest;
use crate::memory::MemoryFiles;
use etendue_io::failure::{Error, ErrorCode};
use etendue_scene::record::render::Accelerator;
use etendue_scene::{Description, stated_render_keys};
use std::path::Path;

/// How a job's file says that a camera renders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatedRender {
    /// Its keys, as dotted keys of the job: `render.spp`, `cameras.front.render.spp`.
    pub keys: Vec<String>,
    /// Cameras of the job.
    pub cameras: usize,
    /// The word of the key `accelerator` in force, the request's changes included.
    pub accelerator: &'static str,
}

impl JobRequest {
    /// What the job's file says of how a camera renders.
    ///
    /// # Errors
    /// All faults of the job, and where it has no such camera.
    pub fn stated_render(&self, camera: &str) -> Result<StatedRender, Error> {
        let files = MemoryFiles::new();
        let sandbox = self.folders()?;
        let read = |path: &Path| files.read(path, &sandbox);
        let description = Description::load(&self.job, &read, &self.overrides());
        let description = description.map_err(|faults| Error::inputs(faults.list()))?;
        let entry = description.cameras.iter().find(|entry| entry.name.value == camera);
        let entry = entry.ok_or_else(|| {
            Error::coded(ErrorCode::UnknownName, format!("{}: no camera {camera}", self.job.display()))
        })?;
        let accelerator = match entry.render.accelerator.as_ref().map(|key| key.value) {
            Some(Accelerator::Fast) => "fast",
            Some(Accelerator::Default) | None => "default",
            Some(Accelerator::Best) => "best",
        };
        let cameras = description.cameras.len();
        Ok(StatedRender { cameras, keys: stated_render_keys(&self.job, camera, &read), accelerator })
    }
}
