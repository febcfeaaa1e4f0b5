//! Étendue as a library: from a job file to results, and every verb of the program as a function with typed arguments and reports.
//!
//! ```no_run
//! use etendue::{Existing, Job, RenderOptions, Unobserved};
//!
//! # fn main() -> Result<(), etendue::Error> {
//! let job = Job::open("scenes/street/street.toml")?;
//! let results = job.render(&RenderOptions::default(), &Unobserved)?;
//! let camera = &results.cameras()[0];
//! let depth = camera.ground_truth().depth;
//! assert_eq!(depth.width(), camera.camera().body.raster.width());
//! results.save("out/street".as_ref(), Existing::Refuse, &Unobserved)?;
//! # Ok(())
//! # }
//! ```
//!
//! | from | to | by |
//! | --- | --- | --- |
//! | a job file | its plan, radiance, electrons, raw, picture, ground truth | [`Job`] |
//! | a job file | what it will model and cost, effect by effect, and what each could be left out for | [`Job::report`], [`Job::effects`] |
//! | a scene from arrays, a camera in code | the same | [`MemoryFiles`] |
//! | a job file | where its cameras stand and how they project, for ROS, Kalibr and COLMAP | [`Job::save_calibration_files`] |
//! | shards of a job | the files of the whole | [`merge()`] |
//! | stored radiance and a camera file | what that camera would have taken | [`expose()`] |
//! | stored radiance and a weather file | the same seen through fog | [`weather()`] |
//! | stored raws and a camera file | pictures by its processing | [`develop()`] |
//! | even light and a camera file | raws of the bare sensor | [`flat()`] |
//! | an EMVA 1288 data sheet | a camera file | [`datasheet()`] |
//! | a scene of another program | a scene and a job of the format | [`import()`] |
//! | a camera file | a chart as a scene, with its truth | [`chart`] |
//! | pictures | parameters of the camera with their uncertainty | [`measure`] |
//! | a camera file | a laboratory folder photographed by it | [`laboratory()`] |
//! | a laboratory folder of pictures | the camera that took them, as a camera file and a report | [`characterise`] |
//! | two results | whether they differ, and by how much | [`compare()`] |
//! | any file that Étendue knows | what is in it | [`inspect()`] |
//!
//! Nothing here prints, reads a clock, starts threads (work runs on the caller's rayon pool) or ends the process. What the caller should
//! know and is no error goes to its [`Observer`].

mod calibration;
mod camera_file;
pub mod characterise;
pub mod chart;
mod compare;
mod compare_pictures;
mod datasheet;
mod delivery;
mod develop;
mod display;
mod display_picture;
mod expose;
mod exposures;
mod film_file;
mod film_memory;
mod flat;
mod integrator;
mod job;
mod laboratory;
mod markup;
pub mod measure;
mod memory;
mod memory_check;
mod memory_limits;
mod merge;
mod named_file;
pub mod page;
pub mod plan_report;
pub mod plot;
mod quality;
mod ranges;
mod raw_file;
mod refine;
mod render_options;
mod render_settings;
pub mod report;
mod results;
mod rig;
mod sampled_light;
mod shard;
mod shard_spec;
mod stated_render;
mod stored_radiance;
mod terminal_text;
mod tone_curve;
mod variations;
mod weather;

pub use camera_file::open_camera;
pub use compare::{ChannelComparison, Comparison, compare};
pub use datasheet::datasheet;
pub use develop::{DevelopRequest, develop};
pub use display_picture::display_jpeg;
pub use etendue_core::observer::{FramePlace, ImageTile, Message, Observer, Progress, Unit, Unobserved};
pub use etendue_import::{ImportRequest, import};
pub use etendue_io::failure::{Error, Fault};
pub use etendue_io::inspect::{Shown, inspect, inspect_showing};
pub use etendue_io::paths::relative_path;
pub use etendue_io::{CacheUse, Existing, FileDigest, OutputFolder, TextureMemory, is_decoding};
pub use etendue_pipeline::boxes::WorldObject;
pub use etendue_pipeline::motion::{MotionTruth, NeighbourTruth};
pub use etendue_pipeline::photograph::{Frame, Light};
pub use etendue_pipeline::plan::effects::{EffectGroup, PlannedEffect};
pub use etendue_pipeline::rays::RayTable;
pub use etendue_pipeline::truth::GroundTruth;
pub use etendue_sensor::TemporalNoise;
pub use etendue_tracer::accel::Simd;
pub use expose::{ExposeRequest, expose};
pub use film_memory::FilmMemory;
pub use flat::{FlatRequest, FlatSource, flat};
pub use integrator::Integrator;
pub use job::{Job, JobRequest};
pub use laboratory::{LaboratoryRequest, laboratory};
pub use markup::escaped;
pub use memory::{MemoryFiles, Triangles};
pub use memory_limits::{MemoryLimit, MemoryLimits};
pub use merge::merge;
pub use named_file::write_file;
pub use plan_report::PlanReport;
pub use quality::Quality;
pub use raw_file::Levels;
pub use render_options::{MAX_FRAMES, RenderOptions};
pub use render_settings::RenderSettings;
pub use results::{CameraResults, Files, Results};
pub use rig::{PinholeView, camera_mount, pinhole_view};
pub use sampled_light::{LightSampling, LightSignal, SampledLight, SampledPixel};
pub use shard_spec::{ShardRequest, ShardSpec};
pub use stated_render::StatedRender;
pub use terminal_text::{terminal_json, terminal_text};
pub use variations::open_variations;
pub use weather::{WeatherRequest, weather};
