//! A stored radiance image, and what a camera sees of it.

use crate::plan::CameraBody;
use etendue_core::quantity::{Length, Radiance};
use etendue_core::{Plane, SpectralCube};
use etendue_optics::{OpticsError, PupilProjection, Resampling};

/// A stored radiance image: what the route at the pupil begins with.
#[derive(Clone, Copy, Debug)]
pub struct Stored<'a> {
    /// Its geometry.
    pub projection: &'a PupilProjection,
    /// Radiance as seen from the centre of the entrance pupil.
    pub radiance: &'a SpectralCube<Radiance>,
    /// Distance of what each of its pixels sees, where it is known.
    pub distance: Option<&'a Plane<Length>>,
}

impl Stored<'_> {
    /// Radiance and distance in the raster of a camera's picture, with `margin_px` more columns and rows on all sides.
    ///
    /// # Errors
    /// Where the picture needs directions that the image does not hold.
    pub fn seen(&self, body: &CameraBody, margin_px: [usize; 2]) -> Result<PinholeImages, OpticsError> {
        let (lens, bands) = (&body.lens, self.radiance.bands());
        let resampling = Resampling::new(*self.projection, lens, &body.raster, margin_px, bands)?;
        let radiance = resampling.apply(self.radiance)?;
        let distance = self.distance.map(|plane| resampling.nearest(plane, f32::NAN)).transpose()?;
        Ok(PinholeImages { radiance, distance })
    }
}

/// What a camera's pixels see from the centre of the entrance pupil.
#[derive(Clone, Debug)]
pub struct PinholeImages {
    /// Mean radiance of each pixel.
    pub radiance: SpectralCube<Radiance>,
    /// Distance of what each pixel's centre sees, m; +∞ for the sky, NaN where no ray is.
    pub distance: Option<Plane<Length>>,
}
