//! Results of a camera: its light, frames, ground truth and rays, in memory and as files.

mod annotations;
mod camera;
mod done_frames;
pub(crate) mod frames;
pub(crate) mod levels;
pub(crate) mod metadata;
mod products;
mod save;
mod sequence;
pub(crate) mod writer;

pub(crate) use camera::SensorHistory;
pub use camera::{CameraResults, display_jpeg};
pub(crate) use done_frames::DoneFrames;
pub(crate) use sequence::FrameSequence;

use etendue_core::observer::Observer;
use etendue_io::failure::Error;
use etendue_io::{ExistingFiles, OutputFolder};
use std::path::{Path, PathBuf};

/// The results of a job's cameras.
#[derive(Clone, Debug)]
pub struct Results {
    cameras: Vec<CameraResults>,
}

impl Results {
    pub(crate) fn new(cameras: Vec<CameraResults>) -> Self {
        Self { cameras }
    }

    /// The cameras, those of equal light one after the other; where light depends on time, one entry per frame.
    #[must_use]
    pub fn cameras(&self) -> &[CameraResults] {
        &self.cameras
    }

    /// A camera by its name; where light depends on time, its first frame.
    #[must_use]
    pub fn camera(&self, name: &str) -> Option<&CameraResults> {
        self.cameras.iter().find(|camera| camera.name() == name)
    }

    /// Writes all requested files into a folder, with a subfolder for each camera, and returns their paths. Files receive their final names when all are
    /// complete. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// The folder cannot be written, or files exist that must not be replaced.
    pub fn save(&self, folder: &Path, existing: ExistingFiles, observer: &dyn Observer) -> Result<Vec<PathBuf>, Error> {
        let mut folder = OutputFolder::open(folder, existing).map_err(Error::input)?;
        for camera in &self.cameras {
            let names = FrameSequence::new(&camera.plan, camera.frame_numbers()).file_names(&camera.plan);
            let own = names.iter().filter(|name| name.starts_with(&format!("{}/", camera.name())));
            folder.claim(own.map(String::as_str)).map_err(Error::input)?;
        }
        if let Some(first) = self.cameras.first() {
            let frames = self.cameras.iter().map(CameraResults::frame_numbers);
            let frames = frames.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end)).unwrap_or_default();
            let mut sequence = FrameSequence::new(&first.plan, frames);
            self.cameras.iter().try_for_each(|camera| sequence.write(camera, &mut folder, observer))?;
            sequence.finish(&mut folder, observer)?;
        }
        folder.commit().map_err(Error::run)
    }
}
