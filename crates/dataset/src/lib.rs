//! Data sets: a job, varied sample after sample, written in the formats of training and test data sets.
//!
//! ```no_run
//! use etendue::{ExistingFiles, JobRequest, NullObserver};
//! use etendue_dataset::{DatasetRequest, dataset};
//!
//! # fn main() -> Result<(), etendue::Error> {
//! let job = JobRequest::new("scenes/cornell/cornell.toml");
//! let variations = "scenes/cornell/variations.toml".into();
//! let request = DatasetRequest { variations: Some(variations), samples: 0..100, ..DatasetRequest::new(job) };
//! dataset(&request, "out/boxes".as_ref(), ExistingFiles::Refuse, &NullObserver)?;
//! # Ok(())
//! # }
//! ```
//!
//! A *sample* is the job with one choice of all variations; its images are those of all cameras and frames. Sample 70 000 is the same alone or among all: the
//! choice is a function of seed, key and number ([`etendue_core::random::stream_of_name`]).
//!
//! | folder | holds |
//! | --- | --- |
//! | `dataset.json` | facts of the set; a resumed run must agree with them |
//! | `samples/NNNNNN.json` | a sample: its changes, and the ground truth of its images; with this file it is complete |
//! | `coco`, `kitti`, … | one format each, complete by itself |
//!
//! Masks, boxes, poses and depth are those of the pipeline's ground truth; nothing is recomputed here.

mod done_samples;
mod draw;
mod format;
mod observer;
mod picture;
mod record;
mod records;
mod request;
mod run;
mod set;

pub use etendue_scene::record::variations::SetFormat;

pub use request::DatasetRequest;
pub use run::dataset;
