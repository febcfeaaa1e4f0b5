//! Sampling of an image: samples of each pixel, the resulting variance, and the variance of the sensor's noise.

use crate::camera::effects::crop_to_image;
use crate::plan::{CameraPlan, Route};
use crate::render::film::Film;
use crate::render::gather::stored_variance;
use etendue_core::Plane;
use etendue_core::quantity::{Identity, Quantity, Variance};
use etendue_sensor::Sensor;

/// Planes of the image; at the pupil of the stored view.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplingPlanes {
    /// Samples of each pixel.
    pub samples: Plane<Identity>,
    /// Variance of each pixel's mean from its samples, e⁻² of the described exposure; (W/m²)² of irradiance without electrons, (W·m⁻²·sr⁻¹)² of radiance at
    /// the pupil. `None` if neither electrons are accumulated nor noise is monitored, and for a single replicate, which has no variance.
    pub monte_carlo: Option<Plane<Variance>>,
    /// Variance of a pixel's signal from frame to frame by the sensor ([`etendue_sensor::TemporalNoise`]), e⁻² of the described exposure. `None` if no
    /// electrons are accumulated.
    pub sensor: Option<Plane<Variance>>,
}

impl SamplingPlanes {
    /// Planes of a camera's film.
    #[must_use]
    pub fn new(camera: &CameraPlan, film: &Film) -> Self {
        let noise = camera.body.sensor.as_ref().filter(|_| camera.settings.route == Route::Lens);
        let noise = noise.map(Sensor::temporal_noise);
        let exposure_s = noise.as_ref().map_or(1.0, |noise| noise.exposure_s());
        let rate = film.electron_rate.as_ref().map(|rate| (rate.mean.samples(), &rate.variance));
        let watched = || film.watched.as_ref().map(|watched| (watched.mean.samples(), &watched.variance));
        let known = rate.or_else(watched);
        let is_known = film.replicates > 1;
        let monte_carlo = known.filter(|_| is_known).map(|(_, variance)| scaled(variance, exposure_s * exposure_s));
        let sensor = noise.zip(known).map(|(noise, (means, variance))| {
            let of = |mean: &f32| stored_variance(noise.variance_e2(f64::from(*mean) * exposure_s));
            Plane::from_samples(variance.width(), variance.height(), means.iter().map(of).collect())
                .expect("one sample a pixel")
        });
        Self {
            samples: shown(camera, &film.samples),
            monte_carlo: monte_carlo.map(|plane| shown(camera, &plane)),
            sensor: sensor.map(|plane| shown(camera, &plane)),
        }
    }
}

fn scaled(variance: &Plane<Variance>, by: f64) -> Plane<Variance> {
    variance.map(|value| stored_variance(f64::from(value) * by))
}

/// Removes the film's margin if the planes are those of the image.
fn shown<Q: Quantity>(camera: &CameraPlan, plane: &Plane<Q>) -> Plane<Q> {
    match camera.settings.route {
        Route::Lens => crop_to_image(&camera.body, plane),
        Route::Pupil(_) => plane.clone(),
    }
}
