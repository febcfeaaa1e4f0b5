//! Ghosts of an image: a layer of irradiance, light that a prescription's surfaces reflect twice.
//!
//! **Equation.** Every pixel of an image is a far source in its principal ray's direction, of radiance L and solid angle Ω.
//! A beam cross-section dA that enters by that direction brings L Ω w dA to where its ray lands after two reflections
//! ([`crate::prescription::ghost`]), with w the product of all transmittances and both reflectances; the layer is the sum over sources, pairs and
//! wavelengths. Ghosts are thus as large, as cut off and as coloured as the surfaces, rims and coatings make them.
//!
//! **How.** All is deterministic; no random numbers.
//! - *Sources.* The image is split into blocks as long as a block of more than one pixel sends more than 1/300 of
//!   all light (`source.rs`). A block acts from the centroid of its light: light moves by half a block at most,
//!   bright lamps by none.
//! - *Beams.* For 48 field angles a grid of 32 × 32 rays over what each pair lets pass is traced at wavelengths 100 nm
//!   apart (`footprint.rs`); between them places, weights and edges are interpolated, and the reflectances' product is taken at
//!   each band itself.
//! - *Pairs* that together bring at most 0.5 % of the ghost light of an angle are left out there (`response.rs`).
//! - *Laying down.* Each cell of a beam is spread over the sensor between its corners, its light kept (`splat.rs`), on a grid
//!   as coarse as 32 cells across the ghost for a source of 1/300 of the light, finer for brighter ones.
//!
//! Ghosts are not in focus: the layer neither passes the point-spread function nor the glare kernel (scatter of ghosts is of
//! second order) and is added to the irradiance behind both.
//!
//! **Left out**: sources outside the image's field; the nearness of near sources (each counts as far); see the pairs'
//! own list.

mod footprint;
mod layer;
mod report;
mod response;
mod source;
mod splat;

use etendue_core::EffectStatus;

use crate::{error::OpticsError, lens::Prescribed};

pub use layer::layer;
pub use report::{GhostReport, strongest};
pub use response::{GhostOperationCounts, operation_counts};

/// What a layer of ghosts is requested.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GhostSettings {
    sensor_reflectance: f64,
}

impl GhostSettings {
    /// Ghosts of a lens before a sensor that mirrors this fraction of light, whatever its wavelength; 0 for none.
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

    /// Whether a camera needs ghosts, and why.
    pub(crate) fn status(settings: Option<&Self>) -> EffectStatus {
        match settings {
            None => EffectStatus::LeftOut("not asked for".to_owned()),
            Some(Self { sensor_reflectance: 0.0 }) => EffectStatus::Modelled(
                "every two surfaces of the lens, by their coatings; the sensor mirrors nothing".to_owned(),
            ),
            Some(Self { sensor_reflectance }) => {
                let why = format!(
                    "every two surfaces of the lens, by their coatings; the sensor mirrors {sensor_reflectance}"
                );
                EffectStatus::Modelled(why)
            }
        }
    }

    /// The fraction of light that the sensor mirrors.
    #[must_use]
    pub fn sensor_reflectance(&self) -> f64 {
        self.sensor_reflectance
    }
}

/// The fraction of a pair's light that its mirrors leave besides the traced surfaces: the sensor's, where it is one.
fn mirrored(lens: &Prescribed, rear: usize, settings: GhostSettings) -> f64 {
    if rear == lens.prescription().surfaces().len() { settings.sensor_reflectance } else { 1.0 }
}
