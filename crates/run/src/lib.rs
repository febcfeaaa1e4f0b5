//! Runs jobs: plans, renders, exposures, delivery, shards, and the verbs that render or expose (charts, laboratories, flat fields).
//!
//! Nothing here prints, reads a clock, starts threads (work runs on the caller's rayon pool) or ends the process.

pub mod chart;
mod descriptions;
mod develop;
mod expose;
mod film_file;
mod flat;
mod job;
mod job_request;
mod laboratory;
mod memory;
mod memory_limits;
mod result_files;
mod results;
mod rig;
mod run;
mod sampled_light;
mod shard;
mod weather;

pub use descriptions::{JobRenderSettings, datasheet, open_variations};
pub use develop::{DevelopRequest, RawLevels, develop};
pub use etendue_arguments::MAX_FRAMES;
pub use etendue_core::{Accelerator, Integrator, Quality, Word};
pub use etendue_pipeline::plan::{CameraPlan, Settings};
pub use etendue_tracer::integrator::PathSettings;
pub use expose::{ExposeRequest, expose};
pub use flat::{FlatRequest, FlatSource, flat};
pub use job::Job;
pub use job_request::{JobRequest, RenderOptions};
pub use laboratory::{LaboratoryRequest, laboratory};
pub use memory::{MemoryFiles, MeshTriangles};
pub use memory_limits::{FilmMemory, MemoryLimit, MemoryLimits};
pub use result_files::{ResultFiles, write_file};
pub use results::{CameraResults, Results, display_jpeg};
pub use rig::{PinholeView, RosView, camera_mount, pinhole_view, ros_view};
pub use sampled_light::{LightSampling, LightSignal, SampledLight, SampledPixel};
pub use shard::{ShardRequest, ShardSpec, merge};
pub use weather::{WeatherRequest, weather};
