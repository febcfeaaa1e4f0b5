//! The view of a lens from the centre of its entrance pupil.

use etendue_core::plane::{Plane, SpectralCube};
use etendue_core::quantity::{Length, Radiance};
use etendue_projection::Raster;

use crate::{error::OpticsError, lens::Lens};

/// The view of a lens from the centre of its entrance pupil.
#[derive(Clone, Copy, Debug)]
pub struct PinholeView<'a> {
    pub(super) lens: &'a Lens,
    pub(super) raster: &'a Raster,
    pub(super) margin_px: usize,
    pub(super) radiance: &'a SpectralCube<Radiance>,
    pub(super) distance: &'a Plane<Length>,
}

impl<'a> PinholeView<'a> {
    /// Creates a view of an image: `radiance` and `distance` have `margin_px` more pixels than `raster` on each side.
    ///
    /// # Errors
    /// If the images are not of that size, or the radiance of a pixel with a distance is not finite.
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
        let view = Self { lens, raster, margin_px, radiance, distance };
        view.check_finite()?;
        Ok(view)
    }

    /// Pixels per row, margin included.
    pub(super) fn width(&self) -> usize {
        self.distance.width()
    }

    /// Rows, margin included.
    pub(super) fn height(&self) -> usize {
        self.distance.height()
    }

    /// Inverse distance of a pixel, 1/m: 0 for the sky; `None` if it has no ray.
    pub(super) fn inverse_per_m(&self, pixel: usize) -> Option<f32> {
        let distance = self.distance.samples()[pixel];
        (distance > 0.0).then(|| 1.0 / distance)
    }

    fn check_finite(&self) -> Result<(), OpticsError> {
        let visible = |pixel: &usize| self.distance.samples()[*pixel] > 0.0;
        for plane in self.radiance.planes() {
            let wrong = |pixel: &usize| !plane.samples()[*pixel].is_finite();
            if let Some(pixel) = (0..plane.samples().len()).find(|p| wrong(p) && visible(p)) {
                return Err(OpticsError::RadianceNotFinite { x: pixel % self.width(), y: pixel / self.width() });
            }
        }
        Ok(())
    }

    /// The unblurred image without its margin.
    pub(super) fn cropped(&self) -> SpectralCube<Radiance> {
        let mut image = SpectralCube::new(self.raster.width(), self.raster.height(), self.radiance.bands());
        for (from, to) in self.radiance.planes().iter().zip(image.planes_mut()) {
            for (y, row) in to.samples_mut().chunks_exact_mut(self.raster.width()).enumerate() {
                let start = (y + self.margin_px) * self.width() + self.margin_px;
                row.copy_from_slice(&from.samples()[start..start + self.raster.width()]);
            }
        }
        image
    }
}
