//! How a picture was sampled: samples of each pixel, the variance that they leave, and that of the sensor's noise beside it.

use crate::camera::effects::plane_of_picture;
use crate::plan::{CameraPlan, Route};
use crate::render::film::Film;
use crate::render::gather::stored_variance;
use etendue_core::Plane;
use etendue_core::quantity::{Identity, Quantity, Variance};
use etendue_sensor::Sensor;

/// Planes of the picture; at the pupil of the stored view.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplingPlanes {
    /// Samples of each pixel.
    pub samples: Plane<Identity>,
    /// Variance of each pixel's mean by its samples, e⁻² of the described exposure; (W/m²)² of irradiance where no electrons are made, (W·m⁻²·sr⁻¹)² of radiance at the pupil. `None` where neither
    /// electrons are summed nor noise is monitored, and for a single replicate, which has no variance.
    pub monte_carlo: Option<Plane<Variance>>,
    /// Variance of a pixel's signal from frame to frame by the sensor ([`etendue_sensor::TemporalNoise`]), e⁻² of the described exposure. `None`
    /// where no electrons are summed.
    pub sensor: Option<Plane<Variance>>,
}

impl SamplingPlanes {
    /// Those of a camera's film.
    #[must_use]
    pub fn of(camera: &CameraPlan, film: &Film) -> Self {
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

/// Without the film's margin, where it is the picture's.
fn shown<Q: Quantity>(camera: &CameraPlan, plane: &Plane<Q>) -> Plane<Q> {
    match camera.settings.route {
        Route::Lens => plane_of_picture(&camera.body, plane),
        Route::Pupil(_) => plane.clone(),
    }
}
