//! What a camera delivers: its light, its frames, ground truth and rays, in memory and as files.

mod annotations;
mod boxes;
mod camera;
mod done_frames;
pub(crate) mod files;
pub(crate) mod frames;
pub(crate) mod metadata;
mod save;
mod sequence;
pub(crate) mod writer;

pub use camera::CameraResults;
pub(crate) use done_frames::DoneFrames;
pub use files::Files;
pub(crate) use files::file_names;
pub use save::Results;
pub(crate) use sequence::Sequence;
