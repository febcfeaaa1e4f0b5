//! Ghosts of an image: a layer of irradiance from light that a prescription's surfaces reflect twice.
//!
//! **Equation.** Every pixel of an image is a source at infinity in its principal ray's direction, of radiance L and solid angle Ω. A beam
//! cross-section dA that enters in that direction contributes L Ω w dA where its ray lands after two reflections ([`crate::prescription::ghost`]),
//! with w the product of all transmittances and both reflectances. The layer is the sum over sources, pairs and wavelengths. Size, clipping and
//! colour of ghosts thus follow from the surfaces, clear apertures and coatings.
//!
//! **Method.** Everything is deterministic; no random numbers.
//!
//! - *Sources.* The image is split into blocks until no block of more than one pixel sends more than 1/300 of all light (`source.rs`). A block acts
//!   from the centroid of its light: light moves by half a block at most, single bright pixels do not move.
//! - *Beams.* For 48 field angles a grid of 32 × 32 rays over the passing region of each pair is traced at wavelengths 100 nm apart (`footprint.rs`).
//!   Between them positions, weights and edges are interpolated, and the product of the reflectances is evaluated at each band itself.
//! - *Pairs* that together contribute at most 0.5 % of the ghost light of an angle are omitted there (`response.rs`).
//! - *Splatting.* Each cell of a beam is spread over the sensor between its corners, its light preserved (`splat.rs`), on a grid as coarse as 32
//!   cells across the ghost for a source of 1/300 of the light, finer for brighter ones.
//!
//! Ghosts are out of focus: the layer is not convolved with the point-spread function or the glare kernel (scatter of ghosts is of second order) and
//! is added to the irradiance after both.
//!
//! **Left out**: sources outside the image's field; the distance of near sources (each counts as infinitely far); see also the limitations in the
//! module of pairs.

mod footprint;
mod layer;
mod report;
mod response;
mod source;
mod splat;

use etendue_core::EffectStatus;

use crate::{error::OpticsError, lens::PrescriptionLens};

pub use layer::layer;
pub use report::{GhostReport, strongest};
pub use response::{GhostOperationCounts, operation_counts};

/// Settings of a layer of ghosts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GhostSettings {
    sensor_reflectance: f64,
}

impl GhostSettings {
    /// Settings for the ghosts of a lens with a sensor of this reflectance, the same at all wavelengths; 0 for none.
    ///
    /// # Errors
    /// If the reflectance is not in [0, 1).
    pub fn new(sensor_reflectance: f64) -> Result<Self, OpticsError> {
        if (0.0..1.0).contains(&sensor_reflectance) {
            Ok(Self { sensor_reflectance })
        } else {
            Err(OpticsError::SensorReflectance { value: sensor_reflectance })
        }
    }

    /// Status of ghosts (needed or not) with the reason.
    pub(crate) fn status(settings: Option<&Self>) -> EffectStatus {
        match settings {
            None => EffectStatus::LeftOut("not requested".to_owned()),
            Some(Self { sensor_reflectance: 0.0 }) => EffectStatus::Modelled(
                "two-reflection ghosts of all pairs of lens surfaces, from their coatings; the sensor reflects nothing"
                    .to_owned(),
            ),
            Some(Self { sensor_reflectance }) => {
                let why = format!(
                    "two-reflection ghosts of all pairs of lens surfaces, from their coatings; the sensor reflects \
                     {sensor_reflectance}"
                );
                EffectStatus::Modelled(why)
            }
        }
    }

    /// Reflectance of the sensor.
    #[must_use]
    pub fn sensor_reflectance(&self) -> f64 {
        self.sensor_reflectance
    }
}

/// Reflectance factor of a pair in addition to the traced surfaces: that of the sensor, if it is one of the pair.
fn mirrored(lens: &PrescriptionLens, rear: usize, settings: GhostSettings) -> f64 {
    if rear == lens.prescription().surfaces().len() { settings.sensor_reflectance } else { 1.0 }
}
