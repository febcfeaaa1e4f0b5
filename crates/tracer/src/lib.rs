//! Geometry, accelerator, materials, lights and integrators: from rays to spectral radiance.
//!
//! The tracer has no lenses, pixels or files. A world is built once; a render space places it relative to a camera; a path tracer returns spectral
//! radiance along rays of the render frame.

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

/// True if the program has the effects that a closed box of diffuse triangles does not need. The feature `minimal` builds a tracer without
/// them, which panics on scenes that need them. It serves to measure the cost of these effects where they are not used.
pub(crate) const ALL_EFFECTS: bool = !cfg!(feature = "minimal");

/// Maximum radiance, irradiance or intensity of a light at any wavelength, in its unit: products of it with weights and sums over many
/// lights stay finite in f32.
pub const MAX_LIGHT_VALUE: f32 = 1e30;

/// Panics in a tracer without optional effects: the code that follows is one.
#[inline(always)]
pub(crate) fn is_optional() {
    if !ALL_EFFECTS {
        unreachable!("a tracer of the feature `minimal` shows closed boxes of diffuse triangles alone");
    }
}

/// Index of a material in the tracer's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);
