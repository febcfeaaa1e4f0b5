//! Stored radiance, in memory, behind a lens.

use crate::camera::defocus;
use crate::camera::effects::{EffectsOutput, behind};
use crate::camera::light::Light;
use crate::camera::stored::Stored;
use crate::plan::CameraBody;
use etendue_core::quantity::{Irradiance, MeanElectrons};
use etendue_core::{KeptCube, Plane, SpectralCube};
use etendue_optics::front::Front;
use etendue_optics::{DepthOfField, OpticsError, irradiance};
use glam::DVec2;
use rayon::prelude::*;

impl Light {
    /// The light behind a lens of a stored radiance image (its radiance itself is not repeated), rows exposed alike.
    ///
    /// # Errors
    /// Where the picture needs directions that the image does not hold, or the radiance is no finite number.
    pub(super) fn of_stored(
        body: &CameraBody,
        stored: &Stored<'_>,
        depth_of_field: &DepthOfField,
    ) -> Result<Self, OpticsError> {
        body.check_front_on_picture()?;
        let seen = defocus::seen(stored, body, depth_of_field)?;
        let mut irradiance = irradiance(&seen, &body.lens, &body.film())?;
        if let Some(shades) = dirt_shades(body) {
            irradiance.planes_mut().iter_mut().for_each(|plane| shaded(plane, &shades));
        }
        let EffectsOutput { irradiance, ghosts, .. } = behind(body, body.effects.film_part(false), irradiance, None);
        Ok(Self {
            radiance: None,
            electrons: electrons(body, &irradiance),
            irradiance: Some(irradiance.into()),
            irradiance_variance: None,
            ghosts: ghosts.map(KeptCube::from),
            further_electrons: Vec::new(),
            electrons_variance: None,
        })
    }
}

/// The mean of the dirt over the footprint of each pixel of a camera's film; `None` where there is none.
pub(super) fn dirt_shades(body: &CameraBody) -> Option<Vec<f64>> {
    let dirt = body.front.as_ref().and_then(Front::dirt)?;
    let raster = body.film();
    let width = raster.width();
    let centre = |i: usize| raster.sensor_mm(DVec2::new((i % width) as f64, (i / width) as f64) + 0.5);
    let pixels = (0..width * raster.height()).into_par_iter();
    Some(pixels.map(|i| dirt.shade(&body.lens, centre(i))).collect())
}

/// Each pixel by its dirt.
pub(super) fn shaded(plane: &mut Plane<Irradiance>, shades: &[f64]) {
    plane.samples_mut().iter_mut().zip(shades).for_each(|(e, shade)| *e = (f64::from(*e) * shade) as f32);
}

/// Electrons of an irradiance; `None` where the camera has no electronics.
pub(super) fn electrons(body: &CameraBody, irradiance: &SpectralCube<Irradiance>) -> Option<Plane<MeanElectrons>> {
    body.sensor.as_ref().map(|sensor| sensor.electrons(irradiance))
}
