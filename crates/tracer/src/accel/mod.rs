//! The accelerator: which primitive a ray meets first.
//!
//! A [`World`] holds meshes, each with a tree in its own frame, and instances of them. It is built once; a
//! [`crate::view::View`] places the instances about one camera.

mod world;

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
