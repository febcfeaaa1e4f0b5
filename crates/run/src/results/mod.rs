//! What a camera delivers: its light, its frames, ground truth and rays, in memory and as files.

mod annotations;
mod boxes;
mod camera;
mod cryptomatte;
mod done_frames;
mod file_names;
pub(crate) mod frames;
pub(crate) mod levels;
pub(crate) mod metadata;
mod products;
mod save;
mod sequence;
mod tracks;
mod video;
pub(crate) mod writer;

pub use camera::CameraResults;
pub(crate) use camera::SensorHistory;
pub(crate) use done_frames::DoneFrames;
pub(crate) use file_names::file_names;
pub(crate) use products::{FileEntries, PRODUCT_FILES};
pub use save::Results;
pub(crate) use sequence::Sequence;
