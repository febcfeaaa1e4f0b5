//! The scene that an import makes, piece by piece: what readers of other programs' scenes have in common.

mod area_light;
mod axes;
mod environment;
mod known;
mod light_picture;
mod media;
mod numbers;
mod objects;
mod report;
mod round;
mod share;
mod spectra;
mod stage;
mod surfaces;
mod triangles;

pub(super) use area_light::AreaLight;
pub(super) use axes::to_ours;
pub(super) use environment::linear_pixels;
#[cfg(test)]
pub(super) use environment::resampled;
pub(super) use known::{Homogeneous, INTERFACE, KnownTexture};
pub(super) use light_picture::LightPicture;
#[cfg(feature = "usd")]
pub(super) use light_picture::is_upright;
#[cfg(feature = "usd")]
pub(super) use numbers::stored_pixels;
pub(super) use objects::above_zero;
pub(super) use report::Report;
pub(super) use share::grey;
pub(super) use spectra::{LightUnit, coefficient_of_rgb, illuminant_of};
pub(super) use stage::{Graphics, Scenery};
pub(super) use surfaces::plain;
pub(super) use triangles::Triangles;
