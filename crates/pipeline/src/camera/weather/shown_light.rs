//! Radiance of a drop or flake: the mean of the surrounding world weighted by its phase function.
//!
//! Rays to a drop continue by its mean scattering over its disc (for a falling drop a field of 165°, Garg and Nayar, "Vision and rain", IJCV 75, 2007). They
//! reach pixels of the image if it contains their direction, otherwise the mean of its sky or of its part below the horizon. The drop is assumed to be at the
//! camera: near objects are seen from there.

use super::image::PosedImage;
use etendue_core::Wavelengths;
use etendue_core::quantity::Radiance;
use etendue_tracer::media::Phase;
use glam::{DVec2, DVec3, Vec2};
use rayon::prelude::*;

/// Cells along the image's longer side; particles within a cell have the same radiance.
const CELLS: usize = 32;

/// Number of directions for a cell's mean.
const DIRECTIONS: u32 = 1024;

/// Step between azimuths as a fraction of a full turn: the golden ratio's.
const TURN: f32 = 0.618_034;

/// Radiance of drops or flakes, by the pixel that they are in front of.
pub(super) struct ParticleRadiance {
    cell_px: usize,
    columns: usize,
    width: usize,
    /// By cell and band, W·m⁻²·sr⁻¹·nm⁻¹.
    cells: Vec<Vec<f64>>,
}

/// Target of a continued ray.
#[derive(Clone, Copy)]
enum ContinuedRay {
    Pixel(usize),
    Above,
    Below,
}

impl ParticleRadiance {
    /// For an image, with `airlight` by band where its sky is not visible.
    pub(super) fn new(image: &PosedImage<'_>, phase: &Phase, airlight: &[f64]) -> Self {
        let (width, height) = (image.distance.width(), image.distance.height());
        let cell_px = width.max(height).div_ceil(CELLS);
        let (columns, rows) = (width.div_ceil(cell_px), height.div_ceil(cell_px));
        let surroundings = SurroundingMeans::new(image, airlight);
        let cell = |i: usize| {
            let first = DVec2::new((i % columns) as f64, (i / columns) as f64) * cell_px as f64;
            let middle = first + 0.5 * cell_px as f64;
            let direction = image.direction_at(middle).or_else(|| image.direction_at(first + 0.5));
            direction.map_or_else(|| airlight.to_vec(), |direction| surroundings.mean(image, phase, direction))
        };
        Self { cell_px, columns, width, cells: (0..columns * rows).into_par_iter().map(cell).collect() }
    }

    /// Radiance by band, in front of a pixel.
    pub(super) fn in_front_of(&self, pixel: usize) -> &[f64] {
        let (x, y) = (pixel % self.width / self.cell_px, pixel / self.width / self.cell_px);
        &self.cells[y * self.columns + x]
    }
}

/// Means of the radiance in the image, by band.
struct SurroundingMeans {
    /// Mean of the sky.
    above: Vec<f64>,
    /// Mean below the horizon.
    below: Vec<f64>,
}

impl SurroundingMeans {
    fn new(image: &PosedImage<'_>, airlight: &[f64]) -> Self {
        let sightings: Vec<(usize, f64, bool)> = (0..image.distance.samples().len())
            .filter_map(|i| {
                let direction = image.direction(i)?;
                Some((i, image.solid_angle(i), (image.pose.rotation * direction).z >= 0.0))
            })
            .collect();
        let is_sky = |i: usize| image.distance.samples()[i] == f32::INFINITY;
        let mean = |of: &dyn Fn(usize, bool) -> bool| {
            let chosen = || sightings.iter().filter(|(i, _, is_above)| of(*i, *is_above));
            let total_weight: f64 = chosen().map(|(_, weight, _)| weight).sum();
            let planes = image.stored.radiance.planes().iter();
            let weighted =
                planes.map(|plane| chosen().map(|(i, weight, _)| f64::from(plane.samples()[*i]) * weight).sum());
            let weighted: Vec<f64> = weighted.collect();
            (total_weight > 0.0).then(|| weighted.into_iter().map(|sum| sum / total_weight).collect::<Vec<f64>>())
        };
        let above = mean(&|i, is_above| is_above && is_sky(i)).unwrap_or_else(|| airlight.to_vec());
        let below =
            mean(&|_, is_above| !is_above).or_else(|| mean(&|i, _| !is_sky(i))).unwrap_or_else(|| above.clone());
        Self { above, below }
    }

    /// Radiance by band of a particle that is seen along a direction of the camera's frame.
    fn mean(&self, image: &PosedImage<'_>, phase: &Phase, direction: DVec3) -> Vec<f64> {
        let rotation = image.pose.rotation;
        let direction_to = (rotation * direction).as_vec3();
        let wavelengths = Wavelengths::<1> { nm: [550.0], pdf: [1.0] };
        let continued = |k: u32| {
            let u = Vec2::new((k as f32 + 0.5) / DIRECTIONS as f32, (k as f32 * TURN).fract());
            let towards = phase.sample(direction_to, 0.5, u, &wavelengths).as_dvec3();
            match image.pixel(rotation.transpose() * towards) {
                Some(pixel) => ContinuedRay::Pixel(pixel),
                None if towards.z >= 0.0 => ContinuedRay::Above,
                None => ContinuedRay::Below,
            }
        };
        let continued_rays: Vec<ContinuedRay> = (0..DIRECTIONS).map(continued).collect();
        let radiance = |plane: &etendue_core::Plane<Radiance>, band: usize, continued: &ContinuedRay| match continued {
            ContinuedRay::Pixel(i) => f64::from(plane.samples()[*i]),
            ContinuedRay::Above => self.above[band],
            ContinuedRay::Below => self.below[band],
        };
        let planes = image.stored.radiance.planes().iter().enumerate();
        let weighted = planes
            .map(|(band, plane)| continued_rays.iter().map(|continued| radiance(plane, band, continued)).sum::<f64>());
        weighted.map(|sum| sum / f64::from(DIRECTIONS)).collect()
    }
}
