//! Light of a whole frame: f32 means and variances; each tile is filled by one owner.

use crate::render::band_views::divide;
use crate::render::gather::{PixelLight, stored_variance};
use crate::render::tile_bands::TileBands;
use crate::render::tiled_cube::TiledCube;
use crate::sizes::film::FilmLayout;
use crate::sizes::tile::Tile;
use etendue_core::quantity::{
    ElectronRate, Identity, Irradiance, MeanElectrons, Quantity, Radiance, SolidAngle, Variance, WatchedSignal,
};
use etendue_core::random::Pixel;
use etendue_core::storage::BandReader;
use etendue_core::{Bands, Plane, SpectralCube};

/// A plane of means and, if the replicates give it, the variance of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate<Q: Quantity> {
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
    /// Electrons over an exposure, s, and the variance of their mean.
    #[must_use]
    pub fn electrons(&self, exposure_s: f64) -> Estimate<MeanElectrons> {
        Estimate {
            mean: scaled_plane(self.mean.clone(), exposure_s),
            variance: self.variance.map(|value| stored_variance(f64::from(value) * exposure_s * exposure_s)),
        }
    }
}

/// Scales values per second by a factor of the exposure, in place.
pub(crate) fn scaled_plane<Q, R>(plane: Plane<Q>, by: f64) -> Plane<R>
where
    Q: Quantity<Sample = f32>,
    R: Quantity<Sample = f32>,
{
    let (width, height) = (plane.width(), plane.height());
    let mut samples = plane.into_samples();
    samples.iter_mut().for_each(|value| *value = (f64::from(*value) * by) as f32);
    Plane::from_samples(width, height, samples).expect("the plane's own samples")
}

/// A spectral cube of means and their variances.
#[derive(Clone, Debug, PartialEq)]
pub struct CubeEstimate<Q: Quantity> {
    /// Band means.
    pub mean: SpectralCube<Q>,
    /// Variances of the band means.
    pub variance: SpectralCube<Variance>,
}

/// Bands of a film, in memory or on disk.
#[derive(Clone, Debug, PartialEq)]
pub enum FilmCube {
    /// In memory.
    Memory(CubeEstimate<Irradiance>),
    /// In a scratch file.
    Disk(TiledCube),
}

impl FilmCube {
    /// Returns the bands if they are in memory.
    #[must_use]
    pub fn into_memory(self) -> Option<CubeEstimate<Irradiance>> {
        match self {
            Self::Memory(cube) => Some(cube),
            Self::Disk(_) => None,
        }
    }
}

/// Light of one camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Spectral irradiance on the sensor plane (through the lens), if a cube is stored. At the pupil, where every weight is 1, the values are radiance.
    pub cube: Option<FilmCube>,
    /// Mean weight of the pupil.
    pub weight: Plane<SolidAngle>,
    /// Electrons per second of light.
    pub electron_rate: Option<Estimate<ElectronRate>>,
    /// Signal monitored by a noise limit; `None` without a limit.
    pub watched: Option<Estimate<WatchedSignal>>,
    /// Number of samples of each pixel.
    pub samples: Plane<Identity>,
    /// Number of samples that were not finite.
    pub not_finite: Plane<Identity>,
    /// Replicates behind each variance.
    pub replicates: u32,
}

impl Film {
    /// An empty film in memory.
    #[must_use]
    pub fn new(width: usize, height: usize, layout: &FilmLayout, replicates: u32) -> Self {
        let cube = |bands| CubeEstimate {
            mean: SpectralCube::new(width, height, bands),
            variance: SpectralCube::new(width, height, bands),
        };
        Self::with(layout.bands.map(cube).map(FilmCube::Memory), width, height, layout, replicates)
    }

    /// An empty film with bands on disk.
    #[must_use]
    pub fn on_disk(cube: TiledCube, layout: &FilmLayout, replicates: u32) -> Self {
        let (width, height) = cube.size();
        Self::with(Some(FilmCube::Disk(cube)), width, height, layout, replicates)
    }

    /// Copies the film with other bands, those of `cube`.
    pub(super) fn copy_with_cube(&self, cube: TiledCube) -> Self {
        Self {
            cube: Some(FilmCube::Disk(cube)),
            weight: self.weight.clone(),
            electron_rate: self.electron_rate.clone(),
            watched: self.watched.clone(),
            samples: self.samples.clone(),
            not_finite: self.not_finite.clone(),
            replicates: self.replicates,
        }
    }

    fn with(cube: Option<FilmCube>, width: usize, height: usize, layout: &FilmLayout, replicates: u32) -> Self {
        Self {
            cube,
            weight: Plane::new(width, height),
            electron_rate: layout.accumulates_electrons.then(|| Estimate::new(width, height)),
            watched: layout.watched.then(|| Estimate::new(width, height)),
            samples: Plane::new(width, height),
            not_finite: Plane::new(width, height),
            replicates,
        }
    }

    /// Returns the bands if they are in memory.
    #[must_use]
    pub fn cube(&self) -> Option<&CubeEstimate<Irradiance>> {
        match &self.cube {
            Some(FilmCube::Memory(cube)) => Some(cube),
            Some(FilmCube::Disk(_)) | None => None,
        }
    }

    /// Returns the bands to fill if they are in memory.
    pub fn cube_mut(&mut self) -> Option<&mut CubeEstimate<Irradiance>> {
        match &mut self.cube {
            Some(FilmCube::Memory(cube)) => Some(cube),
            Some(FilmCube::Disk(_)) | None => None,
        }
    }

    /// Returns the bands if they are on disk.
    #[must_use]
    pub fn disk(&self) -> Option<&TiledCube> {
        match &self.cube {
            Some(FilmCube::Disk(cube)) => Some(cube),
            Some(FilmCube::Memory(_)) | None => None,
        }
    }

    /// Wavelength bands, with readers of their means and variances, in memory or on disk.
    #[must_use]
    pub fn bands(&self) -> Option<(Bands, [&dyn BandReader; 2])> {
        match self.cube.as_ref()? {
            FilmCube::Memory(cube) => Some((cube.mean.bands(), [&cube.mean, &cube.variance])),
            FilmCube::Disk(cube) => Some((cube.bands(), [&**cube.mean(), &**cube.variance()])),
        }
    }

    /// Bands of a tile of the film's grid; `None` for a film without bands.
    ///
    /// # Errors
    /// They cannot be read.
    pub fn tile_bands(&self, tile: Tile) -> Result<Option<TileBands>, String> {
        match &self.cube {
            None => Ok(None),
            Some(FilmCube::Memory(cube)) => Ok(Some(TileBands::from_cubes(tile, &cube.mean, &cube.variance))),
            Some(FilmCube::Disk(cube)) => cube.tile(tile).map(Some),
        }
    }

    /// Stores the light of one pixel in the planes that are in memory.
    pub fn store(&mut self, pixel: Pixel, light: &PixelLight) {
        let (x, y) = (pixel.x as usize, pixel.y as usize);
        if let Some(FilmCube::Memory(cube)) = &mut self.cube {
            for (plane, mean) in cube.mean.planes_mut().iter_mut().zip(light.bands()) {
                plane.set(x, y, *mean as f32);
            }
            for (plane, variance) in cube.variance.planes_mut().iter_mut().zip(light.band_variances()) {
                plane.set(x, y, stored_variance(*variance));
            }
        }
        if let (Some(estimate), Some((mean, variance))) = (&mut self.electron_rate, light.electrons()) {
            estimate.mean.set(x, y, mean as f32);
            estimate.variance.set(x, y, stored_variance(variance));
        }
        if let (Some(estimate), Some((mean, variance))) = (&mut self.watched, light.watched()) {
            estimate.mean.set(x, y, mean as f32);
            estimate.variance.set(x, y, stored_variance(variance));
        }
        self.weight.set(x, y, light.weight_sr() as f32);
        self.samples.set(x, y, light.samples());
        let means = light.bands().iter().copied().chain(light.electrons().map(|(mean, _)| mean));
        let is_lost = means.into_iter().any(|mean| !(mean as f32).is_finite());
        let not_finite = light.not_finite().max(u32::from(is_lost));
        // Unwritten memory is not allocated by the system.
        if not_finite != self.not_finite.at(x, y) {
            self.not_finite.set(x, y, not_finite);
        }
    }

    /// Light of one pixel, as stored; `layout` is the film's, `bands` are those of its tile.
    #[must_use]
    pub fn light(&self, pixel: Pixel, layout: &FilmLayout, bands: Option<&TileBands>) -> PixelLight {
        let (x, y) = (pixel.x as usize, pixel.y as usize);
        let (mut means, mut variances) = (Vec::new(), Vec::new());
        if let Some(bands) = bands {
            means.extend(bands.means(pixel).map(f64::from));
            variances.extend(bands.variances(pixel).map(f64::from));
        }
        means.push(f64::from(self.weight.at(x, y)));
        variances.push(0.0);
        let accumulates_electrons =
            self.electron_rate.as_ref().map(|rate| (rate.mean.at(x, y), rate.variance.at(x, y)));
        let watched = self.watched.as_ref().map(|light| (light.mean.at(x, y), light.variance.at(x, y)));
        if let Some((mean, variance)) = accumulates_electrons.or(watched) {
            means.push(f64::from(mean));
            variances.push(f64::from(variance));
        }
        PixelLight::new(layout, means, variances, self.samples.at(x, y), self.not_finite.at(x, y))
    }

    /// Copies `tile` from a film of the same size and layout; bands only from memory to memory.
    pub fn copy_tile(&mut self, tile: Tile, from: &Self) {
        if let (Some(to), Some(from)) = (self.cube_mut(), from.cube()) {
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

    /// Radiance seen by each pixel, mean over its pupil: irradiance over the pupil's weight; 0 where no light passes the lens. The variance treats the weight
    /// as exact. `None` if no bands are in memory.
    #[must_use]
    pub fn radiance(&self) -> Option<CubeEstimate<Radiance>> {
        let cube = self.cube()?;
        let mean = divided(&cube.mean, &self.weight, |weight| weight);
        let variance = divided(&cube.variance, &self.weight, |weight| weight * weight);
        Some(CubeEstimate { mean, variance })
    }

    /// Number of samples of the whole film that were not finite.
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
        plane.map(|value| weights.next().map_or(0.0, |weight| divide(value, *weight, divisor)))
    };
    SpectralCube::from_planes(cube.bands(), cube.planes().iter().map(plane).collect()).expect("planes of one cube")
}
