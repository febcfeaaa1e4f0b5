//! Étendue as a library: from a job file to results, and every verb of the program as a function with typed arguments and reports.
//!
//! ```no_run
//! use etendue::{ExistingFiles, Job, RenderOptions, NullObserver};
//!
//! # fn main() -> Result<(), etendue::Error> {
//! let job = Job::open("scenes/street/street.toml")?;
//! let results = job.render(&RenderOptions::default(), &NullObserver)?;
//! let camera = &results.cameras()[0];
//! let depth = camera.ground_truth().depth;
//! assert_eq!(depth.width(), camera.camera().body.raster.width());
//! results.save("out/street".as_ref(), ExistingFiles::Refuse, &NullObserver)?;
//! # Ok(())
//! # }
//! ```
//!
//! | from | to | by |
//! | --- | --- | --- |
//! | a job file | its plan, radiance, electrons, raw image, developed image, ground truth | [`Job`] |
//! | a job file | modelled effects and their cost, and the changes that disable each | [`Job::report`], [`Job::effects`] |
//! | a scene from arrays, a camera in code | the same | [`MemoryFiles`] |
//! | a job file | poses and projections of its cameras, for ROS, Kalibr and COLMAP | [`Job::save_calibration_files`] |
//! | shards of a job | the files of the whole | [`merge()`] |
//! | stored radiance and a camera file | the capture of that camera | [`expose()`] |
//! | stored radiance and a weather file | the same seen through fog | [`weather()`] |
//! | stored raws and a camera file | images developed by its processing | [`develop()`] |
//! | uniform illumination and a camera file | raws of the bare sensor | [`flat()`] |
//! | an EMVA 1288 data sheet | a camera file | [`datasheet()`] |
//! | a scene of another program | a scene and a job of the format | [`import()`] |
//! | a camera file | a chart as a scene, with reference data | [`chart`] |
//! | images | parameters of the camera with their uncertainty | [`measure`] |
//! | a camera file | a laboratory folder captured by it | [`laboratory()`] |
//! | a laboratory folder of images | the camera that captured them, as a camera file and a report | [`characterise`] |
//! | two results | whether they differ, and by how much | [`compare()`] |
//! | any supported file | its content | [`inspect()`] |
//!
//! Nothing here prints, reads a clock, starts threads (work runs on the caller's rayon pool) or ends the process. Notes and warnings for the caller go to its
//! [`Observer`].

#![warn(missing_docs)]

pub use etendue_core::observer::{FramePlace, ImageTile, Message, NullObserver, Observer, Progress, ProgressUnit};
pub use etendue_import::{ImportRequest, import};
pub use etendue_io::escape::{escaped, terminal_json, terminal_text};
pub use etendue_io::failure::{Error, ErrorCode, ExampleContext, InputError};
pub use etendue_io::inspect::{PreviewSelection, inspect, inspect_showing};
pub use etendue_io::paths::relative_path;
pub use etendue_io::{CacheUse, ExistingFiles, FileDigest, OutputFolder, TextureMemory, is_decoding};
pub use etendue_measurement::*;
pub use etendue_pipeline::boxes::WorldObject;
pub use etendue_pipeline::motion::{MotionTruth, NeighbourTruth};
pub use etendue_pipeline::photograph::{Frame, Light};
pub use etendue_pipeline::rays::RayTable;
pub use etendue_pipeline::report::effects::{EffectGroup, PlannedEffect};
pub use etendue_pipeline::truth::GroundTruth;
pub use etendue_plan_report::{self as plan_report, PlanReport, open_camera};
pub use etendue_run::*;
pub use etendue_sensor::TemporalNoise;
pub use etendue_tracer::accel::Simd;
