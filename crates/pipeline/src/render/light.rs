//! Light of a frame: sends every pixel's samples into a radiance field and accumulates them on the film.

use crate::plan::NumberedPass;
use crate::render::exposure::{FilmExposure, FrameCapture};
use crate::render::film::Film;
use crate::render::gather::{PixelLight, ReplicateMoments, ReplicateSums};
use crate::render::mosaic::{Mosaic, Site};
use crate::render::observer::Observer;
use crate::render::tile_bands::TileBands;
use crate::render::tiled_cube::TiledCube;
use crate::render::wavelength_numbers::{ReplicateNumbers, WavelengthNumbers};
use crate::sizes::block::Blocks;
use crate::sizes::film::{FilmLayout, has_variance};
use crate::sizes::spectrum_spread::SpectrumSpread;
use crate::sizes::tile::{Shard, Tile, tiles};
use crate::sizes::tolerance::Tolerance;
use etendue_core::random::{Draw, FrameAddress, PathStream, Pixel, PixelAddress};
use etendue_core::storage::ScratchStore;
use etendue_core::{FieldRay, PupilRay, RadianceField, Spectral, Wavelengths};
use etendue_optics::effects::{SampleSpread, SpreadRandomNumbers};
use glam::DVec2;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

/// Conversion of a raster point to a ray: through a lens, or from the centre of the entrance pupil.
pub trait RaySource: Sync {
    /// Ray of a raster point (px) through the pupil sample (in [0, 1)²) at `wavelength_nm`, in the camera frame. `None` if the lens blocks it.
    fn ray(&self, raster_px: DVec2, pupil: DVec2, wavelength_nm: f64) -> Option<PupilRay>;
}

/// Sampling density, and the random addresses of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Pass: its samples per pixel are those of all replicates; with noise-limited sampling the maximum.
    pub pass: NumberedPass,
    /// Independently scrambled replicates of a pass; divides its samples.
    pub replicates: u32,
    /// The job's seed.
    pub seed: u64,
    /// Index in the job of the camera that owns the light.
    pub camera: u32,
    /// Frame and capture; the first for light that serves all of them.
    pub frame_capture: FrameCapture,
    /// Shortest sampled wavelength, nm.
    pub low_nm: f32,
    /// Longest sampled wavelength, nm.
    pub high_nm: f32,
    /// Distribution of wavelengths over the spectrum.
    pub spread: SpectrumSpread,
}

impl Sampling {
    /// Samples per pixel, over all replicates; with noise-limited sampling the maximum.
    #[must_use]
    pub fn spp(&self) -> u32 {
        self.pass.pass.samples
    }

    /// Number of the first replicate of the pass.
    #[must_use]
    pub fn first_replicate(&self) -> u32 {
        self.pass.number * self.replicates
    }
}

/// Inputs and layout of the rendering of a frame's light.
pub struct RenderJob<'a> {
    /// Source of the rays.
    pub source: &'a dyn RaySource,
    /// Camera pose over time.
    pub exposure: FilmExposure<'a>,
    /// Columns of the film.
    pub width: u32,
    /// Rows of the film.
    pub height: u32,
    /// Side of a pixel's photosensitive area, in pixels (the root of the fill factor).
    pub aperture_px: f64,
    /// Values to store.
    pub layout: FilmLayout,
    /// Responsivities, if electrons are accumulated or monitored for their noise.
    pub mosaic: Option<&'a Mosaic>,
    /// Samples and addresses.
    pub sampling: Sampling,
    /// Tolerance of noise-limited sampling; `None` without it.
    pub tolerance: Option<Tolerance>,
    /// Blocks of pixels whose paths share their tails.
    pub blocks: Blocks,
    /// Side of a tile, px, that splits no block. It does not change the result.
    pub tile_px: u32,
    /// Tiles to render; the others remain zero.
    pub shard: Shard,
    /// Displacement of samples on the film.
    pub sample_spread: Option<&'a SampleSpread>,
    /// Storage of bands that are not in memory. It does not change the result.
    pub scratch: Option<&'a Arc<dyn ScratchStore>>,
}

/// A pixel of a block that receives light.
struct LitPixel<const N: usize> {
    /// Index in the block.
    index: usize,
    /// The weight of its ray.
    weight_sr: f64,
    /// Weights of the wavelengths, if the sample was displaced.
    spread: Option<Spectral<N>>,
}

/// One sample of each pixel of a block, during evaluation.
#[derive(Default)]
pub(super) struct BlockSample<const N: usize> {
    /// Pixels that receive light.
    pixels: Vec<LitPixel<N>>,
    rays: Vec<FieldRay>,
    radiance: Vec<Spectral<N>>,
}

impl<const N: usize> BlockSample<N> {
    fn clear(&mut self) {
        self.pixels.clear();
        self.rays.clear();
        self.radiance.clear();
    }
}

/// Reasons for which a film is incomplete.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RenderError {
    /// The caller cancelled.
    #[error("the rendering was cancelled")]
    Cancelled,
    /// The bands could not be written to the scratch file, or read from it.
    #[error("{0}")]
    Scratch(String),
}

impl RenderJob<'_> {
    /// Renders the shard's tiles in parallel on the caller's thread pool, and adds them to the light of the passes before, if any.
    ///
    /// # Errors
    /// The observer cancels, or bands cannot be stored on disk.
    pub fn gather<const N: usize>(
        &self,
        field: &dyn RadianceField<N>,
        before: Option<&Film>,
        observer: &dyn Observer,
    ) -> Result<Film, RenderError> {
        let film = self.new_film(before).map_err(RenderError::Scratch)?;
        let (disk, film) = (film.disk().cloned(), Mutex::new(film));
        let (tiles, done) = (tiles(self.width, self.height, self.tile_px, self.shard), AtomicUsize::new(0));
        observer.begins();
        // One tile at a time; otherwise the last tiles of a thread are a row that no other thread can take over.
        tiles.par_iter().with_max_len(1).try_for_each(|tile| {
            let pixels = self.gather_tile(field, *tile, observer)?;
            let pixels = self.joined(pixels, *tile, before, disk.as_ref()).map_err(RenderError::Scratch)?;
            // The film is locked once per tile.
            let mut film = film.lock().expect("no tile panicked");
            pixels.iter().for_each(|(pixel, light)| film.store(*pixel, light));
            observer.tile(*tile, &film);
            drop(film);
            observer.tiles(done.fetch_add(1, Ordering::Relaxed) + 1, tiles.len());
            Ok(())
        })?;
        Ok(film.into_inner().expect("no tile panicked"))
    }

    /// The film before the first tile. A film on disk has its own file, so that the previous film remains unchanged.
    fn new_film(&self, before: Option<&Film>) -> Result<Film, String> {
        let disk = self.scratch.zip(self.layout.bands).map(|(store, bands)| {
            let has_variance = has_variance(self.sampling.replicates, self.shard);
            TiledCube::new(store, bands, [self.width, self.height, self.tile_px], has_variance)
        });
        match (disk.transpose()?, before) {
            // A copy would share the file, and write into it.
            (None, Some(before)) if before.disk().is_some() => {
                Err("a film on disk requires its own scratch file, but none is available".to_owned())
            }
            (None, Some(before)) => Ok(before.clone()),
            (None, None) => Ok(self.empty_film()),
            (Some(cube), Some(before)) => Ok(before.copy_with_cube(cube)),
            (Some(cube), None) => Ok(Film::on_disk(cube, &self.layout, self.sampling.replicates)),
        }
    }

    fn empty_film(&self) -> Film {
        Film::new(self.width as usize, self.height as usize, &self.layout, self.sampling.replicates)
    }

    /// Light of the pixels of a tile that are in this pass.
    fn gather_tile<const N: usize>(
        &self,
        field: &dyn RadianceField<N>,
        tile: Tile,
        observer: &dyn Observer,
    ) -> Result<Vec<(Pixel, PixelLight)>, RenderError> {
        let check_cancelled = || if observer.cancelled() { Err(RenderError::Cancelled) } else { Ok(()) };
        if let Some(tolerance) = &self.tolerance {
            return check_cancelled().map(|()| self.gather_to_tolerance(field, tile, tolerance));
        }
        let blocks = self.blocks.in_tile(tile).filter(|block| self.sampling.pass.takes(block[0]));
        let lights = blocks.map(|block| check_cancelled().map(|()| self.gather_block(field, &block)));
        Ok(lights.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
    }

    /// Adds the light of the passes before; writes the bands of the tile if they are on disk.
    fn joined(
        &self,
        pixels: Vec<(Pixel, PixelLight)>,
        tile: Tile,
        before: Option<&Film>,
        disk: Option<&TiledCube>,
    ) -> Result<Vec<(Pixel, PixelLight)>, String> {
        let bands_before = before.map_or(Ok(None), |before| before.tile_bands(tile))?;
        let join = |(pixel, light): (Pixel, PixelLight)| match before {
            Some(before) => (pixel, light.joined(&before.light(pixel, &self.layout, bands_before.as_ref()))),
            None => (pixel, light),
        };
        let pixels: Vec<_> = pixels.into_iter().map(join).collect();
        if let Some(disk) = disk {
            let mut bands = bands_before.unwrap_or_else(|| TileBands::new(tile, disk.bands().count()));
            pixels.iter().for_each(|(pixel, light)| bands.store(*pixel, light));
            disk.write(&bands)?;
        }
        Ok(pixels)
    }

    /// Values accumulated for each pixel: those that the film stores, and electrons if their noise is monitored.
    pub(super) fn gathered_layout(&self) -> FilmLayout {
        FilmLayout { accumulates_electrons: self.mosaic.is_some(), ..self.layout }
    }

    /// Renders the pixels of a block, sample by sample.
    fn gather_block<const N: usize>(&self, field: &dyn RadianceField<N>, block: &[Pixel]) -> Vec<(Pixel, PixelLight)> {
        let layout = self.gathered_layout();
        let mut pixel_sums = vec![ReplicateSums::new(layout); block.len()];
        let mut gathers = vec![ReplicateMoments::new(&layout); block.len()];
        let mut block_sample = BlockSample::default();
        let samples = self.sampling.spp() / self.sampling.replicates;
        for replicate in 0..self.sampling.replicates {
            self.add_replicate(field, block, replicate, 0..samples, &mut block_sample, &mut pixel_sums);
            gathers
                .iter_mut()
                .zip(&mut pixel_sums)
                .for_each(|(gather, pixel_sums)| gather.end_replicate(pixel_sums, samples));
        }
        let of = |(gather, pixel_sums): (ReplicateMoments, &ReplicateSums)| {
            gather.light(&layout, self.sampling.spp(), pixel_sums.not_finite())
        };
        block.iter().copied().zip(gathers.into_iter().zip(&pixel_sums).map(of)).collect()
    }

    /// Adds samples of one replicate of the pixels of a block.
    pub(super) fn add_replicate<const N: usize>(
        &self,
        field: &dyn RadianceField<N>,
        block: &[Pixel],
        replicate: u32,
        samples: Range<u32>,
        block_sample: &mut BlockSample<N>,
        pixel_sums: &mut [ReplicateSums],
    ) {
        let streams = block.iter().map(|p| PathStream::new(&self.address(*p, replicate), 0)).collect();
        let numbers = ReplicateNumbers { streams, wavelength_numbers: self.wavelength_numbers(block[0], replicate) };
        for sample in samples {
            self.add_samples(field, block, &numbers, sample, block_sample, pixel_sums);
        }
    }

    pub(super) fn address(&self, pixel: Pixel, replicate: u32) -> PixelAddress {
        let Sampling { seed, camera, frame_capture: FrameCapture { frame, capture }, .. } = self.sampling;
        let replicate = self.sampling.first_replicate() + replicate;
        PixelAddress { frame: FrameAddress { seed, camera, frame, capture }, pixel, replicate }
    }

    /// Wavelengths of a replicate of a block: those of its first pixel.
    fn wavelength_numbers(&self, pixel: Pixel, replicate: u32) -> WavelengthNumbers {
        let Sampling { replicates, spread, .. } = self.sampling;
        let samples = self.sampling.spp() / replicates;
        WavelengthNumbers::new(
            spread,
            &self.address(pixel, replicate),
            samples,
            self.sampling.first_replicate(),
            replicates,
        )
    }

    /// Adds one sample of each pixel of a block.
    fn add_samples<const N: usize>(
        &self,
        field: &dyn RadianceField<N>,
        block: &[Pixel],
        numbers: &ReplicateNumbers,
        sample: u32,
        block_sample: &mut BlockSample<N>,
        pixel_sums: &mut [ReplicateSums],
    ) {
        let ReplicateNumbers { streams, wavelength_numbers } = numbers;
        block_sample.clear();
        let site = self.mosaic.map(|mosaic| mosaic.at(block[0]));
        let wavelengths = self.wavelengths::<N>(site, wavelength_numbers.number(&streams[0].with_sample(sample), N));
        let time_u = self.time_number(&streams[0].with_sample(sample));
        for (index, (stream, pixel)) in streams.iter().zip(block).enumerate() {
            let stream = stream.with_sample(sample);
            let (displaced_px, spread) = self.displacement(*pixel, &stream, &wavelengths);
            if let Some(pupil_ray) = self.pupil_ray(*pixel, displaced_px, &stream, wavelengths.nm[0]) {
                block_sample.pixels.push(LitPixel { index, weight_sr: pupil_ray.weight_sr, spread });
                let moment_s = self.exposure.sample_time_s(pixel.y, time_u);
                let (ray, light_interval) =
                    (self.exposure.to_render(&pupil_ray, moment_s), self.exposure.light_interval(pixel.y, moment_s));
                block_sample.rays.push(FieldRay { ray, stream, light_interval });
            }
        }
        field.radiance_of_group(&block_sample.rays, &wavelengths, &mut block_sample.radiance);
        for (LitPixel { index, weight_sr, spread }, radiance) in block_sample.pixels.iter().zip(&block_sample.radiance)
        {
            let radiance = spread.map_or(*radiance, |spread| *radiance * spread);
            pixel_sums[*index].add(*weight_sr, radiance, &wavelengths, site.map(|s| &s.responsivity));
        }
    }

    /// Displacement of a sample by the point spread, px, and the weights of its wavelengths.
    pub(super) fn displacement<const N: usize>(
        &self,
        pixel: Pixel,
        stream: &PathStream,
        wavelengths: &Wavelengths<N>,
    ) -> (DVec2, Option<Spectral<N>>) {
        let Some(spread) = self.sample_spread else { return (DVec2::ZERO, None) };
        let choice = stream.one(Draw::PointSpread, 1).into();
        let place = stream.two(Draw::PointSpread, 0).as_dvec2();
        let (offset_px, weights) = spread.sample_offset(pixel, &wavelengths.nm, SpreadRandomNumbers { choice, place });
        (offset_px, Some(Spectral(weights)))
    }

    /// Ray of a sample; `None` if the lens blocks it.
    pub(super) fn pupil_ray(&self, pixel: Pixel, off_px: DVec2, stream: &PathStream, nm: f32) -> Option<PupilRay> {
        let area = stream.two(Draw::PixelArea, 0).as_dvec2() - 0.5;
        let raster = DVec2::new(f64::from(pixel.x), f64::from(pixel.y)) + 0.5 + area * self.aperture_px;
        self.source.ray(raster - off_px, stream.two(Draw::Pupil, 0).as_dvec2(), f64::from(nm))
    }

    /// Wavelengths of a sample; a pixel that accumulates electrons samples them by its responsivity.
    pub(super) fn wavelengths<const N: usize>(&self, site: Option<&Site>, u: f32) -> Wavelengths<N> {
        let Sampling { low_nm, high_nm, .. } = self.sampling;
        match site {
            Some(site) => site.density.sample(u),
            None => Wavelengths::uniform(low_nm, high_nm, u),
        }
    }

    /// Random number in [0, 1) of the time of a sample, from the stream of the block's first pixel, so that all pixels of a block share it; 0 if samples
    /// have no individual times.
    pub(super) fn time_number(&self, stream: &PathStream) -> f32 {
        if self.exposure.has_sample_times() { stream.one(Draw::Time, 0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests;
