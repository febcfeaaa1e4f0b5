//! A stored radiance image, read.

use crate::results::metadata;
use etendue_core::quantity::{Length, Radiance, Variance};
use etendue_core::{Plane, SpectralCube};
use etendue_io::Provenance;
use etendue_io::exr::{SpectralImage, read_spectral};
use etendue_io::failure::{Error, ErrorCode};
use etendue_optics::PupilProjection;
use std::path::Path;

/// A stored radiance image with its geometry.
pub(crate) struct StoredRadiance {
    pub(crate) radiance: SpectralCube<Radiance>,
    /// Variance of its band means, where it is stored.
    pub(crate) variance: Option<SpectralCube<Variance>>,
    /// Distance of what each pixel sees; `None` in files of former versions.
    pub(crate) distance: Option<Plane<Length>>,
    pub(crate) projection: PupilProjection,
    pub(crate) provenance: Provenance,
}

impl StoredRadiance {
    /// Reads it.
    ///
    /// # Errors
    /// Where the file is no radiance that etendue rendered at the pupil.
    pub(crate) fn open(path: &Path) -> Result<Self, Error> {
        let refuse = |why: &str| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {why}", path.display()));
        let file = read_spectral(path).map_err(Error::input)?;
        let SpectralImage::Radiance(image) = file.image else {
            return Err(refuse("this is irradiance behind a lens; expected radiance, rendered with route = \"pupil\""));
        };
        let remedy = "its geometry is not stated; expected radiance that etendue rendered with route = \"pupil\"";
        let provenance = file.provenance.ok_or_else(|| refuse(remedy))?;
        let radiance = image.cube;
        let through_lens = "it was rendered through a lens; render it with `set` render.route=pupil to expose it";
        let geometry = metadata::pupil_geometry(&provenance, radiance.width(), radiance.height());
        let projection = geometry.ok_or_else(|| refuse(through_lens))?.map_err(|why| refuse(&why))?;
        Ok(Self { radiance, variance: image.variance, distance: file.distance, projection, provenance })
    }

    /// The place of the camera that rendered it in its job; 0 in files of former versions.
    pub(crate) fn camera_index(&self) -> u32 {
        self.provenance.further.get("camera_index").and_then(|i| i.parse().ok()).unwrap_or(0)
    }

    /// The exposure time over which light that depends on time was gathered; `None` where it does not.
    pub(crate) fn exposure_s(&self) -> Option<f64> {
        self.provenance.further.get(metadata::EXPOSURE_S).and_then(|s| s.parse().ok())
    }

    /// Pixels whose errors may be equal.
    pub(crate) fn correlated_block_px(&self) -> u32 {
        self.provenance.further.get("correlated_block_px").and_then(|n| n.parse().ok()).unwrap_or(1)
    }
}
