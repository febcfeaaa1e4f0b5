//! Materials and textures: from records and from the meshes' own files to the tracer's material table.

mod builder;
mod compiler;
mod large_picture;
mod layers;
mod metal;
mod picture;
mod reflectance;
mod road;
mod slot;
mod surface;
mod texels;

pub(super) use builder::MaterialTableBuilder;
pub(super) use metal::complex_index;
pub(super) use reflectance::reflectance_spectrum;
pub(super) use slot::has_picture;
