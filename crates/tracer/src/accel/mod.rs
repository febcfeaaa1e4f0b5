//! The accelerator: which primitive a ray meets first.
//!
//! A [`World`] holds meshes, each with a tree in its own frame, and instances of them. It is built once; a
//! [`crate::render_space::RenderSpace`] places the instances about one camera and adds a tree over them.
//!
//! - `build`: trees from the top down by the surface area heuristic, in blocks.
//! - `collapse`: binary to eight-wide, at least cost.
//! - `node`, `packet`: what is tested eight at a time: boxes and triangles.
//! - `swept`: meshes whose vertices move.
//! - `merged`: small instances written out as one mesh.
//! - `reach`: how far rays may start from a mesh.
//! - `streaks`: drops and flakes about a camera, with a tree of their own.
//! - `walk`: near to far through a tree for the first hit, or through the largest boxes for any.
//!
//! Everything is written once over eight lanes (`lanes`) and compiled twice, with AVX2 and without: the same
//! operations in the same order, so the same bits.

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

/// Which instruction set the accelerator uses. Every choice gives the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Simd {
    /// The fastest that this machine has.
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
