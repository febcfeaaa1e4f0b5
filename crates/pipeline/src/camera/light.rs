//! A camera's light, sorted by what it is.

use crate::plan::RowExposure;
use crate::render::film::CubeEstimate;
use etendue_core::quantity::{Irradiance, MeanElectrons, Quantity, Radiance, Variance};
use etendue_core::{KeptCube, Plane};
use etendue_optics::OpticsError;
use etendue_sensor::CaptureLight;

/// A spectral cube of means and their variances, in memory or on the disk.
#[derive(Clone, Debug)]
pub struct KeptEstimate<Q: Quantity> {
    /// Band means.
    pub mean: KeptCube<Q>,
    /// Variances of the band means.
    pub variance: KeptCube<Variance>,
}

impl<Q: Quantity> From<CubeEstimate<Q>> for KeptEstimate<Q> {
    fn from(estimate: CubeEstimate<Q>) -> Self {
        Self { mean: estimate.mean.into(), variance: estimate.variance.into() }
    }
}

/// A camera's light, sorted by what it is. Of a film on the disk there is only what the camera's files are made of.
#[derive(Clone, Debug, Default)]
pub struct Light {
    /// Spectral radiance: through the lens, the mean over each pixel's pupil; at the pupil, as seen from its centre
    /// in the stored geometry.
    pub radiance: Option<KeptEstimate<Radiance>>,
    /// Spectral irradiance on the sensor plane.
    pub irradiance: Option<KeptCube<Irradiance>>,
    /// Its variance; `None` on the route at the pupil, where only the radiance's is known.
    pub irradiance_variance: Option<KeptCube<Variance>>,
    /// The part of the irradiance that is ghosts, where the camera has them.
    pub ghosts: Option<KeptCube<Irradiance>>,
    /// Mean electrons of each pixel in the first capture.
    pub electrons: Option<Plane<MeanElectrons>>,
    /// Those of the captures after it, each in the exposure of the first; empty where all captures see the same light.
    pub further_electrons: Vec<Plane<MeanElectrons>>,
    /// Their variance; `None` where they come from a cube.
    pub electrons_variance: Option<Plane<Variance>>,
}

impl Light {
    /// The same with each row's own exposure, and with the electrons of `further` captures of rows exposed alike; where there are none, all see
    /// the light of the first.
    pub(super) fn exposed(mut self, rows: &RowExposure, mut further: Vec<Plane<MeanElectrons>>) -> Self {
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

    /// What the captures of a frame see; `None` where the camera has no electronics.
    #[must_use]
    pub fn captures(&self) -> Option<CaptureLight<'_>> {
        self.electrons.as_ref().map(|first| CaptureLight { first, further: &self.further_electrons })
    }
}

/// Multiplies each row.
fn scale_rows<Q: Quantity<Sample = f32>>(plane: &mut Plane<Q>, by: impl Fn(usize) -> f64) {
    let width = plane.width();
    for (row, values) in plane.samples_mut().chunks_mut(width).enumerate() {
        let by = by(row);
        values.iter_mut().for_each(|value| *value = (f64::from(*value) * by) as f32);
    }
}

/// Why a film does not become light.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LightError {
    /// The lens cannot be put on the film.
    #[error(transparent)]
    Optics(#[from] OpticsError),
    /// A scratch file cannot be written or read.
    #[error("{0}")]
    Scratch(String),
}
