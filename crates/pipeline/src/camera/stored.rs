//! A stored radiance image, and a camera's view of it.

use crate::plan::CameraBody;
use etendue_core::quantity::{Length, Radiance};
use etendue_core::{Plane, SpectralCube};
use etendue_optics::{OpticsError, PupilProjection, Resampling};

/// A stored radiance image: the input of the pupil route.
#[derive(Clone, Copy, Debug)]
pub struct StoredRadianceImage<'a> {
    /// Its geometry.
    pub projection: &'a PupilProjection,
    /// Radiance as seen from the centre of the entrance pupil.
    pub radiance: &'a SpectralCube<Radiance>,
    /// Distance seen by each of its pixels, if known.
    pub distance: Option<&'a Plane<Length>>,
}

impl StoredRadianceImage<'_> {
    /// Radiance and distance in the raster of a camera's image, with `margin_px` additional columns and rows on each side.
    ///
    /// # Errors
    /// The stored image does not contain directions that the camera needs.
    pub fn resample(&self, body: &CameraBody, margin_px: [usize; 2]) -> Result<PinholeImages, OpticsError> {
        let (lens, bands) = (&body.lens, self.radiance.bands());
        let resampling = Resampling::new(*self.projection, lens, &body.raster, margin_px, bands)?;
        let radiance = resampling.apply(self.radiance)?;
        let distance = self.distance.map(|plane| resampling.nearest(plane, f32::NAN)).transpose()?;
        Ok(PinholeImages { radiance, distance })
    }
}

/// View of a camera's pixels from the centre of the entrance pupil.
#[derive(Clone, Debug)]
pub struct PinholeImages {
    /// Mean radiance of each pixel.
    pub radiance: SpectralCube<Radiance>,
    /// Distance along the ray of each pixel's centre, m; +∞ for the sky, NaN without a ray.
    pub distance: Option<Plane<Length>>,
}
