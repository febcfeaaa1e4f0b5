//! Geometry, accelerator, materials, lights and integrators: rays in, spectral radiance out.
//!
//! The tracer knows no lens, no pixel and no file. A world is built once; a render space places it about a camera; a path
//! tracer answers rays of the render frame with spectral radiance.

pub mod accel;
pub mod geometry;
pub mod guiding;
pub mod integrator;
pub mod lights;
pub mod materials;
pub mod media;
pub mod precipitation;
pub mod render_space;
pub mod textures;

/// Whether the program has the effects that a closed box of diffuse triangles does not need. The feature `minimal` makes a tracer without
/// them, which refuses by a panic what it cannot show: it serves to count what they cost where they are not used.
pub(crate) const ALL_EFFECTS: bool = !cfg!(feature = "minimal");

/// The greatest radiance, irradiance or intensity of a light at any wavelength, in its unit: products of it with weights and
/// sums over many lights stay finite in f32.
pub const BRIGHTEST: f32 = 1e30;

/// Panics in a tracer without optional effects: what follows is one.
#[inline(always)]
pub(crate) fn is_optional() {
    if !ALL_EFFECTS {
        unreachable!("a tracer of the feature `minimal` shows closed boxes of diffuse triangles alone");
    }
}

/// A material's place in the tracer's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);
