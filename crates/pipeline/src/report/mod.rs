//! What a plan will take and what it leaves out, in figures and in words.
//!
//! - [`effects`]: everything that can cost or change a frame, each with its reason and its price.
//! - [`FrameCost`]: processor time of a frame; [`RunMemory`]: the peak memory of a run.
//! - [`mesh_sizes()`]: the size of meshes as they stand in the scene.
//! - [`summary`]: the plan as text; `warnings`: why the picture may not be what was meant.

mod cpu_time;
pub mod effects;
mod frame_cost;
mod memory;
mod mesh_sizes;
pub mod summary;
mod warnings;

pub use cpu_time::Share;
pub use frame_cost::FrameCost;
pub use memory::{CameraMemory, FilmBytes, ROWS_WAITING_BYTES, RunMemory, StageMemory};
pub use mesh_sizes::{MeshSize, mesh_sizes};
