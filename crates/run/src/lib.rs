//! From a job to its results: plans, renders, exposures, delivery, shards, and the verbs that render or expose: charts, laboratories, flat fields.
//!
//! Nothing here prints, reads a clock, starts threads (work runs on the caller's rayon pool) or ends the process.

pub mod chart;
mod datasheet;
mod depth_of_field;
mod develop;
mod display_picture;
mod expose;
mod film_file;
mod film_memory;
mod flat;
mod job;
mod job_request;
mod laboratory;
mod memory;
mod memory_check;
mod memory_limits;
mod merge;
mod named_file;
mod raw_file;
mod result_files;
mod results;
mod rig;
mod run;
mod sampled_light;
mod shard;
mod stated_render;
mod stored_radiance;
mod variations;
mod weather;

pub use datasheet::datasheet;
pub use develop::{DevelopRequest, develop};
pub use display_picture::display_jpeg;
pub use etendue_arguments::MAX_FRAMES;
pub use etendue_core::{Accelerator, Integrator, Quality, Word};
pub use etendue_pipeline::plan::{CameraPlan, Settings};
pub use etendue_tracer::integrator::PathSettings;
pub use expose::{ExposeRequest, expose};
pub use film_memory::FilmMemory;
pub use flat::{FlatRequest, FlatSource, flat};
pub use job::Job;
pub use job_request::{JobRequest, RenderOptions};
pub use laboratory::{LaboratoryRequest, laboratory};
pub use memory::{MemoryFiles, Triangles};
pub use memory_limits::{MemoryLimit, MemoryLimits};
pub use merge::merge;
pub use named_file::write_file;
pub use raw_file::Levels;
pub use result_files::Files;
pub use results::{CameraResults, Results};
pub use rig::{PinholeView, camera_mount, pinhole_view};
pub use sampled_light::{LightSampling, LightSignal, SampledLight, SampledPixel};
pub use shard::{ShardRequest, ShardSpec};
pub use stated_render::StatedRender;
pub use variations::open_variations;
pub use weather::{WeatherRequest, weather};
