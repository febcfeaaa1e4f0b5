//! Depth of field in image space: the fast route's defocus.
//!
//! # Contract
//!
//! - Input ([`Sight`]): radiance as seen from the centre of the entrance pupil, in the raster of the picture with a margin
//!   of pixels around it, and the distance (m, along each pixel's ray from the pupil's centre; +∞ the sky, NaN no ray).
//! - Output: radiance in the raster of the picture, each pixel the mean over its pupil, which [`crate::irradiance()`]
//!   then multiplies by the étendue.
//! - A uniform radiance stays uniform to rounding. Blurs smaller than a pixel leave the picture as it is.
//! - The same bits at any number of threads: rows are made independently of each other.
//!
//! | method | what it does | left out |
//! | --- | --- | --- |
//! | [`DepthOfField::None`] | crops the margin | defocus |
//! | [`DepthOfField::Physical`] | `physical.rs`: the pupil's outline of each field point, spread in the order of depth | what no pixel sees is guessed from its neighbours; radiance that changes with the direction |
//! | [`DepthOfField::Fast`] | `fast.rs`: blend with one blurred copy by distance | everything but the look |
//!
//! A pixel has one distance, that of what its centre sees: what is finer than a pixel moves with it.

mod fast;
mod footprint;
mod hidden;
mod layers;
mod physical;
mod scan;
mod strip;

use crate::error::OpticsError;
use crate::lens::Lens;
use etendue_core::plane::{Plane, SpectralCube};
use etendue_core::quantity::{Length, Radiance};
use etendue_projection::Raster;

pub use fast::{FastBlend, FastParameters};
pub use physical::Physical;

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

/// What a lens looks at, as seen from the centre of its entrance pupil.
#[derive(Clone, Copy, Debug)]
pub struct Sight<'a> {
    lens: &'a Lens,
    raster: &'a Raster,
    margin_px: usize,
    radiance: &'a SpectralCube<Radiance>,
    distance: &'a Plane<Length>,
}

impl<'a> Sight<'a> {
    /// A sight of a picture: `radiance` and `distance` have `margin_px` more pixels than `raster` on each side.
    ///
    /// # Errors
    /// Where the images are not of that size, or the radiance of a pixel with a distance is no finite number.
    pub fn new(
        lens: &'a Lens,
        raster: &'a Raster,
        margin_px: usize,
        radiance: &'a SpectralCube<Radiance>,
        distance: &'a Plane<Length>,
    ) -> Result<Self, OpticsError> {
        let (width, height) = (raster.width() + 2 * margin_px, raster.height() + 2 * margin_px);
        for (got_width, got_height) in [(radiance.width(), radiance.height()), (distance.width(), distance.height())] {
            if (got_width, got_height) != (width, height) {
                return Err(OpticsError::Size { got_width, got_height, width, height });
            }
        }
        let sight = Self { lens, raster, margin_px, radiance, distance };
        sight.check_finite()?;
        Ok(sight)
    }

    /// Pixels a row, margin included.
    fn width(&self) -> usize {
        self.distance.width()
    }

    /// Rows, margin included.
    fn height(&self) -> usize {
        self.distance.height()
    }

    /// Inverse distance of a pixel, 1/m: 0 for the sky; `None` where it has no ray.
    fn inverse_per_m(&self, pixel: usize) -> Option<f32> {
        let distance = self.distance.samples()[pixel];
        (distance > 0.0).then(|| 1.0 / distance)
    }

    fn check_finite(&self) -> Result<(), OpticsError> {
        let seen = |pixel: &usize| self.distance.samples()[*pixel] > 0.0;
        for plane in self.radiance.planes() {
            let wrong = |pixel: &usize| !plane.samples()[*pixel].is_finite();
            if let Some(pixel) = (0..plane.samples().len()).find(|p| wrong(p) && seen(p)) {
                return Err(OpticsError::RadianceNotFinite { x: pixel % self.width(), y: pixel / self.width() });
            }
        }
        Ok(())
    }

    /// The picture without its margin, as it is.
    fn cropped(&self) -> SpectralCube<Radiance> {
        let mut picture = SpectralCube::new(self.raster.width(), self.raster.height(), self.radiance.bands());
        for (from, to) in self.radiance.planes().iter().zip(picture.planes_mut()) {
            for (y, row) in to.samples_mut().chunks_exact_mut(self.raster.width()).enumerate() {
                let start = (y + self.margin_px) * self.width() + self.margin_px;
                row.copy_from_slice(&from.samples()[start..start + self.raster.width()]);
            }
        }
        picture
    }
}

impl DepthOfField {
    /// The picture of a sight, on the caller's thread. ([`Physical`] makes rows on several.)
    #[must_use]
    pub fn apply(&self, sight: &Sight<'_>) -> SpectralCube<Radiance> {
        match self {
            Self::None => sight.cropped(),
            Self::Physical => Physical::new(*sight).picture(),
            Self::Fast(blend) => blend.picture(sight),
        }
    }

    /// Pixels around the picture that its blurs reach beyond it, of things at `nearest_m` and farther: the margin that a
    /// sight needs so that nothing is missing at the picture's edges.
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
