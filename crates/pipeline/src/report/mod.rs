//! Cost and omissions of a plan, in figures and as text.
//!
//! - [`effects`]: everything that can cost time or change a frame, each with its reason and its cost.
//! - [`FrameCost`]: CPU time of a frame; [`RunMemory`]: the peak memory of a run.
//! - [`mesh_sizes()`]: the size of meshes in the scene.
//! - [`summary`]: the plan as text; `warnings`: reasons for which the image may differ from the user's intent.

mod cpu_time;
pub mod effects;
mod frame_cost;
mod memory;
mod mesh_sizes;
pub mod summary;
mod warnings;

pub use cpu_time::FilmWork;
pub use frame_cost::FrameCost;
pub use memory::{CameraMemory, FilmBytes, ROWS_WAITING_BYTES, RunMemory, StageMemory};
pub use mesh_sizes::{MeshSize, mesh_sizes};
