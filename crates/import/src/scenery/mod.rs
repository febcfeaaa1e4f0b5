//! Construction of the imported scene: code shared by the readers of other programs' scenes.

mod environment;
mod lookup;
mod objects;
mod projection;
mod round;
mod spectra;
mod stage;
mod surfaces;

pub(super) use environment::LightImage;
#[cfg(feature = "usd")]
pub(super) use environment::is_upright;
#[cfg(test)]
pub(super) use environment::resampled;
pub(super) use environment::{linear_pixels, to_ours};
pub(super) use objects::above_zero;
pub(super) use projection::{ProjectionKind, TextureBase, TextureProjection};
pub(super) use round::Triangles;
pub(super) use spectra::stored_pixels;
pub(super) use spectra::{LightUnit, coefficient_from_rgb, illuminant_of};
pub(super) use stage::AreaLight;
pub(super) use stage::{Graphics, ImportReport, SceneBuilder};
pub(super) use stage::{Homogeneous, INTERFACE, KnownTexture};
pub(super) use surfaces::{grey, plain};
