//! Geometry, accelerator, materials, lights and integrators: rays in, spectral radiance out.
//!
//! The tracer knows no lens, no pixel and no file. A world is built once; a render space places it about a camera; a path
//! tracer answers rays of the render frame with spectral radiance.

pub mod accel;
pub mod geometry;
pub mod integrator;
pub mod lights;
pub mod materials;
pub mod media;
pub mod render_space;
pub mod textures;

/// A material's place in the tracer's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);
