//! What a page is asked to show.

use std::ops::Range;
use std::path::PathBuf;

/// A result to look at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ViewRequest {
    /// A folder that `render`, `expose`, `develop`, `flat`, `weather` or another verb wrote: files of layers in it and in its folders, one for
    /// each camera.
    pub folder: PathBuf,
    /// Another result, shown beside it: layers of the same camera, frame and file are compared, and must have the same size.
    pub beside: Option<PathBuf>,
    /// Frames of numbered files; `None` for all. Files without a number are always shown.
    pub frames: Option<Range<u32>>,
    /// What the numbers of a layer take at most before they are packed, MB (10⁶ bytes), at least 1; larger layers have fewer pixels, by a whole
    /// factor.
    pub max_mb: u32,
}

impl ViewRequest {
    /// [`ViewRequest::max_mb`] where nothing else is asked for.
    pub const MAX_MB: u32 = 32;

    /// All of a result, alone.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), beside: None, frames: None, max_mb: Self::MAX_MB }
    }
}
