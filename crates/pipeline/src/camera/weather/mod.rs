//! Weather applied to a stored radiance image.
//!
//! - Here: fog and far precipitation, L = L₀ T + L_air (1 − T), T = exp(−∫β dt) (Koschmieder 1924). Exact if the air is lit uniformly from all
//!   sides, otherwise as far as one airlight represents it. Not included: light cones of lamps, haloes, shadows in the fog, and the dimming of the scene's
//!   own
//!   illumination by the fog.
//! - `streaks`: near drops and flakes, the same as in traced weather, as fractions of pixels that they cover during an exposure.
//! - `shown_light`: radiance of a drop or flake, from the radiance in the image.
//! - `image`: pixels as rays of the world.

mod image;
mod shown_light;
#[cfg(test)]
mod streak_tests;
mod streaks;
#[cfg(test)]
mod tests;

use crate::camera::stored::StoredRadianceImage;
use crate::plan::{Airlight, Weather};
use etendue_core::maths::f64::exp;
use etendue_core::quantity::{Cover, Length, Radiance, Transmittance};
use etendue_core::{Bands, CameraPose, Plane, Ray, SpectralCube, TimeInterval};
use etendue_tracer::media::Media;
use image::PosedImage;
use rayon::prelude::*;

/// An image seen through weather.
#[derive(Clone, Debug)]
pub struct WeatheredImage {
    /// Radiance seen through the weather.
    pub radiance: SpectralCube<Radiance>,
    /// Fraction of the scene's light that is transmitted, by band.
    pub transmittance: SpectralCube<Transmittance>,
    /// Radiance that the weather adds.
    pub airlight: SpectralCube<Radiance>,
    /// Fraction of each pixel and of the exposure that near drops or flakes cover; `None` without precipitation.
    pub cover: Option<Plane<Cover>>,
    /// Distance of the scene along the axis, m; +∞ for the sky, NaN without a ray.
    pub depth: Plane<Length>,
}

/// Reasons for which weather cannot be applied to an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WeatherError {
    /// The image has no distances.
    #[error("it has no distances (channel distance.Z), which weather requires; render it again")]
    Distance,
    /// The image has no sky.
    #[error(
        "no pixel shows the sky between the horizon and {elevation_deg}° above it; give an airlight of type \"uniform\""
    )]
    Sky {
        /// Elevation, rounded.
        elevation_deg: u32,
    },
}

impl Weather {
    /// Applies the weather to an image of a camera at `pose` at a time.
    ///
    /// # Errors
    /// The image has no distances, or none of the sky from which the airlight is to be computed.
    pub fn apply(
        &self,
        stored: &StoredRadianceImage<'_>,
        pose: &CameraPose,
        moment: TimeInterval,
    ) -> Result<WeatheredImage, WeatherError> {
        let distance = stored.distance.ok_or(WeatherError::Distance)?;
        let image = PosedImage { stored, distance, pose };
        let airlight = self.airlight(&image)?;
        let media = Media::new(&self.media, pose.position_m, moment);
        let Some(falling) = &self.falling else { return Ok(self.through_media(&image, &media, &airlight)) };
        let streaks = falling.streaks(&image, moment.start_s());
        let media = streaks.without_near_particles(media);
        let mut weathered = self.through_media(&image, &media, &airlight);
        streaks.compose(&mut weathered, &image, &self.foreground(&media, &airlight, stored.radiance.bands()));
        Ok(weathered)
    }

    /// Applies Koschmieder's law.
    fn through_media(&self, image: &PosedImage<'_>, media: &Media<'_>, airlight: &[f64]) -> WeatheredImage {
        let (distance, bands) = (image.distance, image.stored.radiance.bands());
        let before = self.foreground(media, airlight, bands);
        let columns_m: Vec<_> =
            (0..distance.samples().len()).into_par_iter().map(|i| media.columns_m(&image.ray(i))).collect();
        let mut weathered = WeatheredImage {
            radiance: image.stored.radiance.clone(),
            transmittance: SpectralCube::new(distance.width(), distance.height(), bands),
            airlight: SpectralCube::new(distance.width(), distance.height(), bands),
            cover: None,
            depth: image.depth(),
        };
        let planes = weathered.radiance.planes_mut().iter_mut().zip(weathered.transmittance.planes_mut());
        for (band, ((radiance, scene_transmittance), added)) in planes.zip(weathered.airlight.planes_mut()).enumerate()
        {
            let pixels =
                radiance.samples_mut().par_iter_mut().zip(scene_transmittance.samples_mut()).zip(added.samples_mut());
            pixels.enumerate().for_each(|(i, ((radiance, scene_transmittance), added))| {
                let through = before.transmittance(&columns_m[i], band);
                let air = airlight[band] * (1.0 - through);
                (*scene_transmittance, *added) = (through as f32, air as f32);
                *radiance = (f64::from(*radiance) * through + air) as f32;
            });
        }
        weathered
    }

    fn foreground<'a>(&self, media: &'a Media<'a>, airlight: &'a [f64], bands: Bands) -> ForegroundMedia<'a> {
        let extinctions = self.media.iter().map(|medium| medium.extinction().band_means(bands)).collect();
        ForegroundMedia { media, extinctions, airlight }
    }

    /// Airlight by band.
    fn airlight(&self, image: &PosedImage<'_>) -> Result<Vec<f64>, WeatherError> {
        let radiance = image.stored.radiance;
        match &self.airlight {
            Airlight::Uniform(spectrum) => Ok(spectrum.band_means(radiance.bands())),
            Airlight::Sky { elevation_rad } => {
                let sky = image.sky(*elevation_rad);
                if sky.is_empty() {
                    return Err(WeatherError::Sky { elevation_deg: elevation_rad.to_degrees().round() as u32 });
                }
                let mean = |plane: &Plane<Radiance>| {
                    sky.iter().map(|i| f64::from(plane.samples()[*i])).sum::<f64>() / sky.len() as f64
                };
                Ok(radiance.planes().iter().map(mean).collect())
            }
        }
    }
}

/// Weather before a surface: media, and the radiance of the air in them.
struct ForegroundMedia<'a> {
    media: &'a Media<'a>,
    /// Extinction by medium and band, 1/m.
    extinctions: Vec<Vec<f64>>,
    /// Radiance by band.
    airlight: &'a [f64],
}

impl ForegroundMedia<'_> {
    /// Transmittance in a band over path lengths in each medium, m.
    fn transmittance(&self, columns_m: &[f64], band: usize) -> f64 {
        // Zero extinction gives zero depth, even over an infinite length.
        let terms = self.extinctions.iter().zip(columns_m).map(|(of, column_m)| (of[band], *column_m));
        exp(-terms.filter(|(of, _)| *of > 0.0).map(|(of, column_m)| of * column_m).sum::<f64>())
    }

    /// Radiance by band as seen along a ray from its `t_max`.
    fn radiance_along(&self, radiance: &[f64], ray: &Ray) -> Vec<f64> {
        let columns_m = self.media.columns_m(ray);
        let of = |(band, radiance): (usize, &f64)| {
            let transmittance = self.transmittance(&columns_m, band);
            radiance * transmittance + self.airlight[band] * (1.0 - transmittance)
        };
        radiance.iter().enumerate().map(of).collect()
    }
}
