//! What is asked for.

use etendue::{JobRequest, Simd};
use etendue_scene::record::variations::SetFormat;
use std::ops::Range;
use std::path::PathBuf;

/// A data set of a job.
#[derive(Clone, Debug)]
pub struct DatasetRequest {
    /// The job and what is changed in it for all samples. Its seed stands in the place of that of the variations.
    pub job: JobRequest,
    /// The file of what varies; `None`: nothing does but light's and sensor's noise.
    pub variations: Option<PathBuf>,
    /// The formats, one or more; none: those of the variations, or COCO.
    pub formats: Vec<SetFormat>,
    /// The numbers of the samples that are made.
    pub samples: Range<u32>,
    /// The frames of each sample.
    pub frames: Range<u32>,
    /// The instruction set; the result does not depend on it.
    pub simd: Simd,
}

impl DatasetRequest {
    /// One sample of one frame, in the format that the variations name.
    #[must_use]
    pub fn new(job: JobRequest) -> Self {
        Self { job, variations: None, formats: Vec::new(), samples: 0..1, frames: 0..1, simd: Simd::Auto }
    }
}
