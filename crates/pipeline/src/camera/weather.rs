//! Fog laid over a stored radiance image: L = L₀ T + L_air (1 − T), T = exp(−∫β dt) (Koschmieder 1924).
//!
//! Right where the fog is lit evenly from all around, and otherwise as far as one airlight stands for it. Left out: cones of lamps, haloes,
//! shadows in the fog, and that the scene's own light is dimmed by it.

use crate::camera::stored::Stored;
use core::f64::consts::FRAC_PI_2;
use etendue_core::maths::f64::{asin, exp};
use etendue_core::quantity::{Length, Radiance, Transmittance};
use etendue_core::{CameraPose, Plane, Ray, SpectralCube, TimeInterval};
use etendue_spectra::Spectrum;
use etendue_tracer::media::{Media, Medium};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// The radiance of fog without end.
#[derive(Clone, Debug, PartialEq)]
pub enum Airlight {
    /// The same everywhere, W·m⁻²·sr⁻¹·nm⁻¹.
    Uniform(Spectrum),
    /// The mean of what the image shows of the sky, from the horizon up to a height, rad.
    Sky {
        /// The height.
        elevation_rad: f64,
    },
}

/// What is laid over an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Weather {
    /// The radiance of fog without end.
    pub airlight: Airlight,
    /// Fog; only its extinction counts.
    pub fog: Vec<Medium>,
}

/// An image with fog before it.
#[derive(Clone, Debug)]
pub struct Weathered {
    /// What is seen.
    pub radiance: SpectralCube<Radiance>,
    /// The share of the scene's light that comes through, by band.
    pub transmittance: SpectralCube<Transmittance>,
    /// What the fog adds.
    pub airlight: SpectralCube<Radiance>,
    /// Distance of the scene along the axis, m; +∞ the sky, NaN no ray.
    pub depth: Plane<Length>,
}

/// Why fog cannot be laid over an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WeatherError {
    /// No distances.
    #[error("it has no distances (channel distance.Z), by which fog is laid over it; render it anew")]
    Distance,
    /// No sky.
    #[error(
        "no pixel shows the sky between the horizon and {elevation_deg}° above it; give an airlight of type \"uniform\""
    )]
    Sky {
        /// The height, rounded.
        elevation_deg: u32,
    },
}

impl Weather {
    /// Lays the fog over an image that a camera at `pose` took at a moment.
    ///
    /// # Errors
    /// Where the image has no distances, or none of the sky that the airlight is to be taken from.
    pub fn over(
        &self,
        stored: &Stored<'_>,
        pose: &CameraPose,
        moment: TimeInterval,
    ) -> Result<Weathered, WeatherError> {
        let distance = stored.distance.ok_or(WeatherError::Distance)?;
        let image = Image { stored, distance, pose };
        let airlight = self.airlight(&image)?;
        let bands = stored.radiance.bands();
        let extinctions: Vec<_> = self.fog.iter().map(|fog| fog.extinction().band_means(bands)).collect();
        let media = Media::new(&self.fog, pose.position_m, moment);
        let columns_m: Vec<_> =
            (0..distance.samples().len()).into_par_iter().map(|i| media.columns_m(&image.ray(i))).collect();
        let transmittance = |i: usize, band: usize| {
            // No fog, no depth, however far.
            let terms = extinctions.iter().zip(&columns_m[i]).map(|(of, column_m)| (of[band], *column_m));
            exp(-terms.filter(|(of, _)| *of > 0.0).map(|(of, column_m)| of * column_m).sum::<f64>())
        };
        let mut seen = Weathered {
            radiance: stored.radiance.clone(),
            transmittance: SpectralCube::new(distance.width(), distance.height(), bands),
            airlight: SpectralCube::new(distance.width(), distance.height(), bands),
            depth: image.depth(),
        };
        let planes = seen.radiance.planes_mut().iter_mut().zip(seen.transmittance.planes_mut());
        for (band, ((radiance, share), added)) in planes.zip(seen.airlight.planes_mut()).enumerate() {
            let pixels = radiance.samples_mut().par_iter_mut().zip(share.samples_mut()).zip(added.samples_mut());
            pixels.enumerate().for_each(|(i, ((radiance, share), added))| {
                let through = transmittance(i, band);
                let air = airlight[band] * (1.0 - through);
                (*share, *added) = (through as f32, air as f32);
                *radiance = (f64::from(*radiance) * through + air) as f32;
            });
        }
        Ok(seen)
    }

    /// By band.
    fn airlight(&self, image: &Image<'_>) -> Result<Vec<f64>, WeatherError> {
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

/// A stored image of a camera in the world.
struct Image<'a> {
    stored: &'a Stored<'a>,
    distance: &'a Plane<Length>,
    pose: &'a CameraPose,
}

impl Image<'_> {
    /// Where a pixel looks, in the camera's frame.
    fn direction(&self, i: usize) -> Option<DVec3> {
        let (x, y) = (i % self.distance.width(), i / self.distance.width());
        self.stored.projection.direction(DVec2::new(x as f64 + 0.5, y as f64 + 0.5))
    }

    /// From the camera to what a pixel sees; of no length where there is no ray.
    fn ray(&self, i: usize) -> Ray {
        let (direction, distance) = (self.direction(i), self.distance.samples()[i]);
        let towards = self.pose.rotation * direction.unwrap_or(DVec3::Z);
        let mut ray = Ray::new(glam::Vec3::ZERO, towards.as_vec3(), 0.0);
        ray.t_max = if direction.is_none() || distance.is_nan() { 0.0 } else { distance };
        ray
    }

    /// Pixels that show the sky up to a height, rad.
    fn sky(&self, elevation_rad: f64) -> Vec<usize> {
        let shows = |i: &usize| {
            self.distance.samples()[*i] == f32::INFINITY
                && self.direction(*i).is_some_and(|direction| {
                    let z = (self.pose.rotation * direction).z.clamp(-1.0, 1.0);
                    (0.0..=elevation_rad.min(FRAC_PI_2)).contains(&asin(z))
                })
        };
        (0..self.distance.samples().len()).filter(shows).collect()
    }

    fn depth(&self) -> Plane<Length> {
        let mut depth = self.distance.clone();
        for (i, depth) in depth.samples_mut().iter_mut().enumerate() {
            if depth.is_finite() {
                *depth = self.direction(i).map_or(f32::NAN, |direction| (f64::from(*depth) * direction.z) as f32);
            }
        }
        depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::{Bands, Motion};
    use etendue_optics::PupilProjection;
    use etendue_tracer::media::{Noise, Phase, Shape, Unevenness};
    use glam::{DAffine3, DMat3};

    /// Four pixels 45° wide in all, the axis along +x of the world: of the upper row one sees the sky.
    fn seen(fog: Medium, airlight: Airlight) -> Result<Weathered, WeatherError> {
        let bands = Bands::new(400.0, 100.0, 2).expect("bands");
        let projection = PupilProjection::rectilinear(2, 2, 0.4, DVec2::ONE).expect("a view");
        let mut radiance = SpectralCube::new(2, 2, bands);
        for (i, plane) in radiance.planes_mut().iter_mut().enumerate() {
            plane.samples_mut().copy_from_slice(&[5.0 + i as f32, 2.0, 3.0, 0.0]);
        }
        let distance = Plane::from_samples(2, 2, vec![f32::INFINITY, 20.0, 50.0, f32::NAN]).expect("filled");
        let stored = Stored { projection: &projection, radiance: &radiance, distance: Some(&distance) };
        let rotation = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X);
        let pose = CameraPose { position_m: DVec3::new(3.0, 0.0, 1.0), rotation };
        Weather { airlight, fog: vec![fog] }.over(&stored, &pose, TimeInterval::default())
    }

    fn fog(extinction_per_m: f64, shape: Shape) -> Medium {
        let optics = (Spectrum::constant(extinction_per_m), Spectrum::constant(1.0));
        Medium::new(optics, Phase::Isotropic, shape, Motion::still(DAffine3::IDENTITY)).expect("legal")
    }

    fn of(seen: &Weathered, i: usize) -> [f32; 3] {
        let band = 1;
        let at = |planes: &[f32]| planes[i];
        [
            at(seen.radiance.planes()[band].samples()),
            at(seen.transmittance.planes()[band].samples()),
            at(seen.airlight.planes()[band].samples()),
        ]
    }

    fn agrees(seen: [f32; 3], expected: [f64; 3]) {
        seen.iter().zip(expected).for_each(|(seen, expected)| {
            // f32, and the distance within it.
            assert!((f64::from(*seen) - expected).abs() < 1e-5 * expected.abs().max(1.0), "{seen} {expected}");
        });
    }

    #[test]
    fn the_law_of_koschmieder() {
        let uniform = Airlight::Uniform(Spectrum::constant(4.0));
        let everywhere = seen(fog(0.02, Shape::Everywhere), uniform.clone()).expect("fog");
        let through = exp(-0.02 * 20.0);
        agrees(of(&everywhere, 1), [2.0 * through + 4.0 * (1.0 - through), through, 4.0 * (1.0 - through)]);
        agrees(of(&everywhere, 0), [4.0, 0.0, 4.0]);
        agrees(of(&everywhere, 3), [0.0, 1.0, 0.0]);
        // Half inside a box: 7 m of it before the camera, along x; a pixel's ray is aslant by tan 0.2 twice.
        let within = seen(fog(0.1, Shape::Box { half_m: DVec3::splat(10.0) }), uniform).expect("fog");
        let through = exp(-0.1 * 7.0 * 1.08_f64.sqrt());
        agrees(of(&within, 1), [2.0 * through + 4.0 * (1.0 - through), through, 4.0 * (1.0 - through)]);
        assert!((within.depth.samples()[1] - 20.0 / 1.08_f32.sqrt()).abs() < 1e-4);
    }

    #[test]
    fn the_sky_gives_the_airlight() {
        let sky = |elevation_deg: f64| Airlight::Sky { elevation_rad: elevation_deg.to_radians() };
        let layer = || fog(0.02, Shape::Below { top_m: 500.0 });
        // The sky's pixel looks up by atan(0.2/√1.04) = 11.1°.
        assert_eq!(seen(layer(), sky(10.0)).expect_err("no sky"), WeatherError::Sky { elevation_deg: 10 });
        let through = exp(-0.02 * 20.0);
        agrees(
            of(&seen(layer(), sky(20.0)).expect("fog"), 1),
            [2.0 * through + 6.0 * (1.0 - through), through, 6.0 * (1.0 - through)],
        );
    }

    /// Over 50 m of 3 m eddies the mean density is near 1, and where noise is summed it is the same as by finer steps.
    #[test]
    fn noise_is_summed_along_the_ray() {
        let noise = Noise { scale_m: 3.0, octaves: 3, gain: 0.5, seed: 5 };
        let uneven = Unevenness { noise, amplitude: 0.9, wind_mps: DVec3::ZERO };
        let medium = fog(0.02, Shape::Everywhere).with_unevenness(uneven);
        let through = of(&seen(medium, Airlight::Uniform(Spectrum::constant(4.0))).expect("fog"), 2)[1];
        let direction = DVec3::new(1.0, 0.2, -0.2).normalize();
        let n = 200_000;
        let step_m = 50.0 / f64::from(n);
        let at = |i: i32| DVec3::new(3.0, 0.0, 1.0) + direction * (f64::from(i) + 0.5) * step_m;
        let column_m: f64 = (0..n).map(|i| (1.0 + 0.9 * noise.at(at(i))) * step_m).sum();
        // The midpoint rule's error at 100 steps of a smallest eddy's sixth.
        assert!((f64::from(through) - exp(-0.02 * column_m)).abs() < 1e-3, "{through} {}", exp(-0.02 * column_m));
        assert!((column_m / 50.0 - 1.0).abs() > 1e-4, "uneven");
    }
}
