//! The light of a whole frame: f32 means and variances, filled tile by tile by one owner each.

use crate::render::gather::{Layout, PixelLight};
use crate::render::tile::Tile;
use etendue_core::quantity::{
    ElectronRate, Identity, Irradiance, MeanElectrons, Quantity, Radiance, SolidAngle, Variance, WatchedSignal,
};
use etendue_core::random::Pixel;
use etendue_core::{Bands, Plane, SpectralCube};

/// A plane of means and, where replicates know it, the variance of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate<Q: Quantity> {
    /// Means.
    pub mean: Plane<Q>,
    /// Variances of the means; NaN everywhere for a single replicate.
    pub variance: Plane<Variance>,
}

impl<Q: Quantity> Estimate<Q> {
    fn new(width: usize, height: usize) -> Self {
        Self { mean: Plane::new(width, height), variance: Plane::new(width, height) }
    }
}

impl Estimate<ElectronRate> {
    /// Electrons of an exposure, s, and the variance of their mean.
    #[must_use]
    pub fn exposed(&self, exposure_s: f64) -> Estimate<MeanElectrons> {
        let scaled = |by: f64| move |value: f32| (f64::from(value) * by) as f32;
        Estimate {
            mean: self.mean.map(scaled(exposure_s)),
            variance: self.variance.map(scaled(exposure_s * exposure_s)),
        }
    }
}

/// A spectral cube of means and their variances.
#[derive(Clone, Debug, PartialEq)]
pub struct CubeEstimate<Q: Quantity> {
    /// Band means.
    pub mean: SpectralCube<Q>,
    /// Variances of the band means.
    pub variance: SpectralCube<Variance>,
}

/// The light that one camera gathered.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Spectral irradiance on the sensor plane (through the lens) where a cube is kept. At the pupil, where every
    /// weight is 1, the same numbers are radiance.
    pub cube: Option<CubeEstimate<Irradiance>>,
    /// Mean weight of the pupil.
    pub weight: Plane<SolidAngle>,
    /// Folded electrons of a second of light.
    pub electron_rate: Option<Estimate<ElectronRate>>,
    /// What a limit of noise watches; `None` where there is no limit.
    pub watched: Option<Estimate<WatchedSignal>>,
    /// Samples of each pixel.
    pub samples: Plane<Identity>,
    /// Samples that were not finite.
    pub not_finite: Plane<Identity>,
    /// Replicates behind each variance.
    pub replicates: u32,
}

impl Film {
    /// An empty film.
    #[must_use]
    pub fn new(width: usize, height: usize, layout: &Layout, replicates: u32) -> Self {
        let cube = |bands| CubeEstimate {
            mean: SpectralCube::new(width, height, bands),
            variance: SpectralCube::new(width, height, bands),
        };
        Self {
            cube: layout.bands.map(cube),
            weight: Plane::new(width, height),
            electron_rate: layout.folded.then(|| Estimate::new(width, height)),
            watched: layout.watched.then(|| Estimate::new(width, height)),
            samples: Plane::new(width, height),
            not_finite: Plane::new(width, height),
            replicates,
        }
    }

    /// Bytes that a film of this size and layout takes; a float, for a picture too large to be made must not overflow.
    #[must_use]
    pub fn bytes(width: usize, height: usize, layout: &Layout) -> f64 {
        let planes = 2 * layout.bands.map_or(0, Bands::count)
            + 2 * (usize::from(layout.folded) + usize::from(layout.watched))
            + 3;
        width as f64 * height as f64 * (planes * size_of::<f32>()) as f64
    }

    /// Stores the light of one pixel, of which it keeps what it has planes for.
    pub fn store(&mut self, pixel: Pixel, light: &PixelLight) {
        let (x, y) = (pixel.x as usize, pixel.y as usize);
        if let Some(cube) = &mut self.cube {
            for (plane, mean) in cube.mean.planes_mut().iter_mut().zip(light.bands()) {
                plane.set(x, y, *mean as f32);
            }
            for (plane, variance) in cube.variance.planes_mut().iter_mut().zip(light.band_variances()) {
                plane.set(x, y, *variance as f32);
            }
        }
        if let (Some(estimate), Some((mean, variance))) = (&mut self.electron_rate, light.electrons()) {
            estimate.mean.set(x, y, mean as f32);
            estimate.variance.set(x, y, variance as f32);
        }
        if let (Some(estimate), Some((mean, variance))) = (&mut self.watched, light.watched()) {
            estimate.mean.set(x, y, mean as f32);
            estimate.variance.set(x, y, variance as f32);
        }
        self.weight.set(x, y, light.weight_sr() as f32);
        self.samples.set(x, y, light.samples());
        let means = light.bands().iter().copied().chain(light.electrons().map(|(mean, _)| mean));
        let is_lost = means.into_iter().any(|mean| !(mean as f32).is_finite());
        self.not_finite.set(x, y, light.not_finite().max(u32::from(is_lost)));
    }

    /// The light of one pixel, as it is stored; `layout` is the film's.
    #[must_use]
    pub fn light(&self, pixel: Pixel, layout: &Layout) -> PixelLight {
        let (x, y) = (pixel.x as usize, pixel.y as usize);
        let (mut means, mut variances) = (Vec::new(), Vec::new());
        if let Some(cube) = &self.cube {
            means.extend(cube.mean.planes().iter().map(|plane| f64::from(plane.at(x, y))));
            variances.extend(cube.variance.planes().iter().map(|plane| f64::from(plane.at(x, y))));
        }
        means.push(f64::from(self.weight.at(x, y)));
        variances.push(0.0);
        let folded = self.electron_rate.as_ref().map(|rate| (rate.mean.at(x, y), rate.variance.at(x, y)));
        let watched = self.watched.as_ref().map(|light| (light.mean.at(x, y), light.variance.at(x, y)));
        if let Some((mean, variance)) = folded.or(watched) {
            means.push(f64::from(mean));
            variances.push(f64::from(variance));
        }
        PixelLight::of(layout, means, variances, (self.samples.at(x, y), self.not_finite.at(x, y)))
    }

    /// Copies `tile` from a film of the same size and layout.
    pub fn copy_tile(&mut self, tile: Tile, from: &Self) {
        if let (Some(to), Some(from)) = (&mut self.cube, &from.cube) {
            copy_planes(to.mean.planes_mut(), from.mean.planes(), tile);
            copy_planes(to.variance.planes_mut(), from.variance.planes(), tile);
        }
        if let (Some(to), Some(from)) = (&mut self.electron_rate, &from.electron_rate) {
            copy_plane(&mut to.mean, &from.mean, tile);
            copy_plane(&mut to.variance, &from.variance, tile);
        }
        if let (Some(to), Some(from)) = (&mut self.watched, &from.watched) {
            copy_plane(&mut to.mean, &from.mean, tile);
            copy_plane(&mut to.variance, &from.variance, tile);
        }
        copy_plane(&mut self.weight, &from.weight, tile);
        copy_plane(&mut self.samples, &from.samples, tile);
        copy_plane(&mut self.not_finite, &from.not_finite, tile);
    }

    /// The radiance that each pixel sees, mean over its pupil: irradiance over the pupil's weight; 0 where no light
    /// passes the lens. The weight is taken as exact in the variance.
    #[must_use]
    pub fn radiance(&self) -> Option<CubeEstimate<Radiance>> {
        let cube = self.cube.as_ref()?;
        let mean = divided(&cube.mean, &self.weight, |weight| weight);
        let variance = divided(&cube.variance, &self.weight, |weight| weight * weight);
        Some(CubeEstimate { mean, variance })
    }

    /// Samples of the whole film that were not finite.
    #[must_use]
    pub fn not_finite_samples(&self) -> u64 {
        self.not_finite.samples().iter().map(|n| u64::from(*n)).sum()
    }
}

fn copy_planes<Q: Quantity>(to: &mut [Plane<Q>], from: &[Plane<Q>], tile: Tile) {
    to.iter_mut().zip(from).for_each(|(to, from)| copy_plane(to, from, tile));
}

fn copy_plane<Q: Quantity>(to: &mut Plane<Q>, from: &Plane<Q>, tile: Tile) {
    for pixel in tile.pixels() {
        let (x, y) = (pixel.x as usize, pixel.y as usize);
        to.set(x, y, from.at(x, y));
    }
}

fn divided<Q, R>(cube: &SpectralCube<Q>, weight: &Plane<SolidAngle>, divisor: fn(f32) -> f32) -> SpectralCube<R>
where
    Q: Quantity<Sample = f32>,
    R: Quantity<Sample = f32>,
{
    let plane = |plane: &Plane<Q>| {
        let mut weights = weight.samples().iter();
        plane.map(|value| match weights.next() {
            Some(w) if *w > 0.0 => value / divisor(*w),
            _ => 0.0,
        })
    };
    SpectralCube::from_planes(cube.bands(), cube.planes().iter().map(plane).collect()).expect("planes of one cube")
}
