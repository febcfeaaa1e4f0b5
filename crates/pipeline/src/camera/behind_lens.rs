//! Stored radiance, in memory, seen through a lens.

use crate::camera::defocus;
use crate::camera::effects::{EffectsOutput, behind};
use crate::camera::light::Light;
use crate::camera::stored::StoredRadianceImage;
use crate::plan::CameraBody;
use etendue_core::quantity::{Irradiance, MeanElectrons};
use etendue_core::{Plane, SpectralCube, StoredCube};
use etendue_optics::front::Front;
use etendue_optics::{DepthOfField, OpticsError, irradiance};
use glam::DVec2;
use rayon::prelude::*;

impl Light {
    /// Light behind a lens of a stored radiance image (without the radiance itself), with all rows exposed equally.
    ///
    /// # Errors
    /// The image does not contain directions that the camera needs, or the radiance is not finite.
    pub(super) fn from_stored(
        body: &CameraBody,
        stored: &StoredRadianceImage<'_>,
        depth_of_field: &DepthOfField,
    ) -> Result<Self, OpticsError> {
        body.check_front_on_picture()?;
        let radiance = defocus::pupil_mean_radiance(stored, body, depth_of_field)?;
        let mut irradiance = irradiance(&radiance, &body.lens, &body.film())?;
        if let Some(transmittances) = dirt_shades(body) {
            irradiance.planes_mut().iter_mut().for_each(|plane| shaded(plane, &transmittances));
        }
        let EffectsOutput { irradiance, ghosts, .. } = behind(body, body.effects.film_part(false), irradiance, None);
        Ok(Self {
            radiance: None,
            electrons: electrons(body, &irradiance),
            irradiance: Some(irradiance.into()),
            irradiance_variance: None,
            ghosts: ghosts.map(StoredCube::from),
            further_electrons: Vec::new(),
            electrons_variance: None,
        })
    }
}

/// Mean transmittance of the dirt over the footprint of each pixel of a camera's film; `None` without dirt.
pub(super) fn dirt_shades(body: &CameraBody) -> Option<Vec<f64>> {
    let dirt = body.front.as_ref().and_then(Front::dirt)?;
    let raster = body.film();
    let width = raster.width();
    let centre = |i: usize| raster.sensor_mm(DVec2::new((i % width) as f64, (i / width) as f64) + 0.5);
    let pixels = (0..width * raster.height()).into_par_iter();
    Some(pixels.map(|i| dirt.shade(&body.lens, centre(i))).collect())
}

/// Multiplies each pixel by its dirt.
pub(super) fn shaded(plane: &mut Plane<Irradiance>, transmittances: &[f64]) {
    plane.samples_mut().iter_mut().zip(transmittances).for_each(|(e, shade)| *e = (f64::from(*e) * shade) as f32);
}

/// Electrons of an irradiance; `None` for a camera without electronics.
pub(super) fn electrons(body: &CameraBody, irradiance: &SpectralCube<Irradiance>) -> Option<Plane<MeanElectrons>> {
    body.sensor.as_ref().map(|sensor| sensor.electrons(irradiance))
}
