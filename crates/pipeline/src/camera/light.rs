//! Light of a camera, by quantity.

use crate::plan::RowExposure;
use crate::render::film::CubeEstimate;
use etendue_core::quantity::{Irradiance, MeanElectrons, Quantity, Radiance, Variance};
use etendue_core::{Plane, StoredCube};
use etendue_optics::OpticsError;
use etendue_sensor::CaptureLight;

/// A spectral cube of means and their variances, in memory or on disk.
#[derive(Clone, Debug)]
pub struct StoredEstimate<Q: Quantity> {
    /// Band means.
    pub mean: StoredCube<Q>,
    /// Variances of the band means.
    pub variance: StoredCube<Variance>,
}

impl<Q: Quantity> From<CubeEstimate<Q>> for StoredEstimate<Q> {
    fn from(estimate: CubeEstimate<Q>) -> Self {
        Self { mean: estimate.mean.into(), variance: estimate.variance.into() }
    }
}

/// Light of a camera, by quantity. Of a film on disk it contains only what the camera's files require.
#[derive(Clone, Debug, Default)]
pub struct Light {
    /// Spectral radiance: through the lens, the mean over each pixel's pupil; at the pupil, as seen from its centre in the stored projection.
    pub radiance: Option<StoredEstimate<Radiance>>,
    /// Spectral irradiance on the sensor plane.
    pub irradiance: Option<StoredCube<Irradiance>>,
    /// Its variance; `None` on the pupil route, where only the radiance's is known.
    pub irradiance_variance: Option<StoredCube<Variance>>,
    /// Ghosts, as part of the irradiance, if the camera has them.
    pub ghosts: Option<StoredCube<Irradiance>>,
    /// Mean electrons of each pixel in the first capture.
    pub electrons: Option<Plane<MeanElectrons>>,
    /// Mean electrons of the further captures, each in the exposure of the first; empty if all captures see the same light.
    pub further_electrons: Vec<Plane<MeanElectrons>>,
    /// Variance of the electrons; `None` if they come from a cube.
    pub electrons_variance: Option<Plane<Variance>>,
}

impl Light {
    /// Applies each row's own exposure, and adds the electrons of `further` captures with rows exposed equally; without any, all captures see the light of
    /// the first.
    pub(super) fn with_row_exposures(mut self, rows: &RowExposure, mut further: Vec<Plane<MeanElectrons>>) -> Self {
        if !rows.is_even() {
            let Some(first) = &mut self.electrons else { return self };
            if further.is_empty() {
                further = vec![first.clone(); rows.captures.len() - 1];
            }
            scale_rows(first, |row| rows.exposure_ratio(0, row));
            if let Some(variance) = &mut self.electrons_variance {
                scale_rows(variance, |row| rows.exposure_ratio(0, row) * rows.exposure_ratio(0, row));
            }
            for (i, plane) in further.iter_mut().enumerate() {
                scale_rows(plane, |row| rows.exposure_ratio(i + 1, row));
            }
        }
        Self { further_electrons: further, ..self }
    }

    /// Light of a frame's captures; `None` for a camera without electronics.
    #[must_use]
    pub fn captures(&self) -> Option<CaptureLight<'_>> {
        self.electrons.as_ref().map(|first| CaptureLight { first, further: &self.further_electrons })
    }
}

/// Multiplies each row by a factor.
fn scale_rows<Q: Quantity<Sample = f32>>(plane: &mut Plane<Q>, by: impl Fn(usize) -> f64) {
    let width = plane.width();
    for (row, values) in plane.samples_mut().chunks_mut(width).enumerate() {
        let by = by(row);
        values.iter_mut().for_each(|value| *value = (f64::from(*value) * by) as f32);
    }
}

/// Reasons for which a film cannot be converted to light.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LightError {
    /// The lens cannot be applied to the film.
    #[error(transparent)]
    Optics(#[from] OpticsError),
    /// A scratch file cannot be written or read.
    #[error("{0}")]
    Scratch(String),
}
