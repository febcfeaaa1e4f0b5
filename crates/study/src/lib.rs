//! What each choice of rendering costs in time and in error, for a job of one's own.
//!
//! A study renders parts of a job's frame again and again, with few samples and in many ways ([`WayToRender`]); tells of each how long a sample takes and how noisy it is
//! (pilots), and how far its mean lies from that of the exact form (bias and variance apart); foretells from these the time and error of any
//! number of samples; and names the ways that no other beats (the front), with three settings of them for drafts, standard pictures and references.
//!
//! No clock is read here: the caller gives one ([`Clock`]).

mod ablation;
mod budget;
mod change;
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
mod stint;
mod study;
mod trial;
mod variation;
mod way;

pub use ablation::{Ablation, Dropped, Kept, ablation, ablation_table};
pub use change::Change;
pub use edge::Mtf50;
pub use error::{Currencies, Estimate};
pub use front::{FrontPoint, Recommendation, Target};
pub use job_file::job_file;
pub use measured::{Bias, Measured, PowerLaw, Role};
pub use pictures::{Comparison, pictures};
pub use report::{plot, table};
pub use study::{Request, Study, study};
pub use variation::{Variations, Varied, variation_table, variations};
pub use way::WayToRender;

/// Clocks that only go forward.
pub trait Clock: Sync {
    /// Seconds since any moment.
    fn seconds(&self) -> f64;

    /// Processor time of all threads of this process since any moment, s; `None` where the machine does not tell it.
    fn processor_seconds(&self) -> Option<f64>;

    /// Threads that gather light.
    fn threads(&self) -> usize;
}
