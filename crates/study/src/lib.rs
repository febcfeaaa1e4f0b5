//! Cost of each choice of rendering in time and error, for a user's own job.
//!
//! A study renders parts of a job's frame repeatedly, with few samples and in many configurations ([`Configuration`]). For each it measures the time and noise
//! of a sample (pilots), and the distance of its mean from that of the exact form (bias separate from variance). From these it estimates time and error of
//! any number of samples. It then names the configurations that no other beats (the Pareto front), with three recommendations: draft, standard image and
//! reference.
//!
//! No clock is read here: the caller supplies one ([`Clock`]).

mod ablation;
mod budget;
mod change;
mod configuration;
mod edge;
mod error;
mod frame_render;
mod front;
mod job_file;
mod light_distribution;
mod measured;
mod pictures;
mod pilot;
mod pixels;
mod plan;
mod report;
mod study;
mod trial;
mod variation;
mod work_timer;

pub use ablation::{Ablation, DroppedEffect, RetainedEffect, ablation, ablation_table};
pub use change::FrameChange;
pub use configuration::Configuration;
pub use edge::Mtf50;
pub use error::{ErrorMetrics, Estimate};
pub use front::{ErrorTarget, FrontPoint, Recommendation};
pub use job_file::job_file;
pub use measured::{Bias, ConfigurationMeasurement, PowerLaw, Role};
pub use pictures::{ImageComparison, pictures};
pub use report::{plot, table};
pub use study::{Study, StudyRequest, study};
pub use variation::{VariationResult, VariationStudy, variation_table, variations};

/// A monotonic clock.
pub trait Clock: Sync {
    /// Seconds since an arbitrary origin.
    fn seconds(&self) -> f64;

    /// CPU time of all threads of this process since an arbitrary origin, s; `None` if the machine does not report it.
    fn processor_seconds(&self) -> Option<f64>;

    /// Number of render threads.
    fn threads(&self) -> usize;
}
