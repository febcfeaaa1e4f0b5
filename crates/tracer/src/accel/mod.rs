//! The accelerator: finds the primitive that a ray hits first.
//!
//! A [`World`] holds meshes, each with a tree in its own frame, and instances of them. It is built once; a [`crate::render_space::RenderSpace`]
//! places the instances relative to one camera and adds a tree over them.
//!
//! - `build`: trees from the top down by the surface area heuristic, in blocks.
//! - `collapse`: binary to eight-wide, at least cost.
//! - `node`, `packet`: boxes and triangles, tested eight at a time.
//! - `swept`: meshes whose vertices move.
//! - `merged`: small instances merged into one mesh.
//! - `reach`: maximum distance of a ray's start from a mesh.
//! - `streaks`: drops and flakes about a camera, with a tree of their own.
//! - `walk`: tree traversal, near to far for the first hit, or largest boxes first for any hit.
//!
//! Everything is written once over eight lanes (`lanes`) and compiled twice, with AVX2 and without: the same operations in the same order, so the
//! same bits.

mod blas;
pub(crate) mod boxes;
mod build;
mod collapse;
pub(crate) mod lanes;
mod merged;
mod node;
mod packet;
pub(crate) mod ray;
mod reach;
#[cfg(target_arch = "x86_64")]
mod simd;
mod streaks;
mod swept;
pub(crate) mod tlas;
mod visits;
mod walk;
mod world;

pub use streaks::{Streak, Streaks};
pub use visits::Visits;
pub use world::{World, WorldBuilder, WorldError};

/// Instruction set of the accelerator. Every choice gives the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Simd {
    /// The fastest of this machine.
    #[default]
    Auto,
    /// Plain code without vector intrinsics.
    Scalar,
}

#[cfg(test)]
pub(crate) mod tests {
    mod agreement;
    mod deforming;
    mod degenerate;
    mod motion;
    mod needles;
    pub(crate) mod shapes;
    mod ties;
    mod watertight;
}
