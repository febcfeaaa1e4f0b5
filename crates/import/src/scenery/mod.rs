//! Construction of the imported scene: code shared by the readers of other programs' scenes.

mod bake;
mod environment;
mod infinite_light;
mod objects;
mod projection;
mod round;
mod spectra;
mod stage;
mod stored;
mod surfaces;
mod texture;

pub(super) use environment::LightImage;
#[cfg(feature = "usd")]
pub(super) use environment::is_upright;
#[cfg(test)]
pub(super) use environment::resampled;
pub(super) use environment::{linear_pixels, to_ours};
pub(super) use infinite_light::{ImageLight, InfiniteLight, UniformLight};
pub(super) use objects::above_zero;
pub(super) use projection::{ProjectionKind, TextureBase, TextureProjection};
pub(super) use round::Triangles;
pub(super) use spectra::{LightUnit, coefficient_from_rgb, illuminant_of};
pub(super) use stage::AreaLight;
pub(super) use stage::{Graphics, ImportReport, SceneBuilder};
pub(super) use stage::{Homogeneous, INTERFACE};
#[cfg(feature = "usd")]
pub(super) use stored::stored_pixels;
pub(super) use surfaces::{grey, plain};
pub(super) use texture::{
    ImageEncoding, ImageFile, ImageFormat, ImageLeaf, ImageUse, ImageWrap, KnownTexture, MARBLE_MEAN, Pattern,
    Placement, TextureTree, TextureUse, mean_of_turbulence, read_light_image,
};
