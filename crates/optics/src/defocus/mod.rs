//! Depth of field in image space: the fast route's defocus.
//!
//! # Contract
//!
//! - Input ([`PinholeView`]): radiance as seen from the centre of the entrance pupil, in the raster of the image with a margin
//!   of pixels around it, and the distance (m, along each pixel's ray from the pupil's centre; +∞ the sky, NaN no ray).
//! - Output: radiance in the raster of the image, each pixel the mean over its pupil, which [`crate::irradiance()`]
//!   then multiplies by the étendue.
//! - A uniform radiance stays uniform to rounding. Blurs smaller than a pixel leave the image as it is.
//! - The result has the same bits at any number of threads: rows are computed independently of each other.
//!
//! | method | operation | left out |
//! | --- | --- | --- |
//! | [`DepthOfField::None`] | crops the margin | defocus |
//! | [`DepthOfField::Physical`] | `physical.rs`: the pupil's outline of each field point, spread in the order of depth | hidden points (estimated from their neighbours); radiance that changes with the direction |
//! | [`DepthOfField::Fast`] | `fast.rs`: blend with one blurred copy by distance | physical accuracy |
//!
//! A pixel has one distance, that of the point at its centre: details finer than a pixel move with it.

mod fast;
mod footprint;
mod hidden;
mod physical;
mod pinhole_view;
mod scan;
mod strip;

use etendue_core::{plane::SpectralCube, quantity::Radiance};
use etendue_projection::Raster;

use crate::lens::Lens;

pub use fast::{FastBlend, FastParameters};
pub use physical::PhysicalDefocus;
pub use pinhole_view::PinholeView;

/// The methods: the closed list.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DepthOfField {
    /// Everything as sharp as it was rendered.
    #[default]
    None,
    /// Circles of confusion of the real pupil, spread in the order of depth.
    Physical,
    /// A blend with a blurred copy by distance.
    Fast(FastBlend),
}

impl DepthOfField {
    /// The image of a view, on the caller's thread. ([`PhysicalDefocus`] computes rows on several.)
    #[must_use]
    pub fn apply(&self, view: &PinholeView<'_>) -> SpectralCube<Radiance> {
        match self {
            Self::None => view.cropped(),
            Self::Physical => PhysicalDefocus::new(*view).image(),
            Self::Fast(blend) => blend.image(view),
        }
    }

    /// Maximum reach of blurs, px, for objects at `nearest_m` and beyond: the margin of a view so that no light is missing at the image's edges.
    #[must_use]
    pub fn reach_px(&self, lens: &Lens, raster: &Raster, nearest_m: f64) -> usize {
        match self {
            Self::None => 0,
            Self::Physical => {
                let circle_mm = lens.circle_of_confusion_mm(nearest_m).max(lens.circle_of_confusion_mm(f64::INFINITY));
                (0.5 * circle_mm / raster.pitch_mm().min_element()).ceil() as usize
            }
            Self::Fast(blend) => blend.reach_px(),
        }
    }
}
