//! Request of a viewer page.

use std::{ops::Range, path::PathBuf};

use clap::Args;
use etendue_arguments::{frames, integer};

/// A result to view.
#[derive(Args, Clone, Debug, Eq, PartialEq)]
pub struct ViewRequest {
    /// A folder of results: all cameras of a run, or one
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
    /// Second result, shown side by side, by a wipe, and as the difference; of the same sizes
    #[arg(long, value_name = "FOLDER")]
    pub beside: Option<PathBuf>,
    /// Frames to show, first to last (the last excluded) [default: all]
    #[arg(long, value_name = "A..B", value_parser = frames)]
    pub frames: Option<Range<u32>>,
    /// Maximum size of the numbers of one layer, MB; larger layers are downsampled by a whole factor
    #[arg(long, value_name = "MB", default_value_t = ViewRequest::MAX_MB, value_parser = integer(1..=1000))]
    pub max_mb: u32,
}

impl ViewRequest {
    /// Default of [`ViewRequest::max_mb`].
    pub const MAX_MB: u32 = 32;

    /// Request for all of a result, without a second one.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), beside: None, frames: None, max_mb: Self::MAX_MB }
    }
}
