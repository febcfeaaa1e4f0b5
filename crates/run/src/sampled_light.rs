//! Light of a subset of a camera's pixels, with sampling that differs from the job's: the basis of a study of time and error.

use crate::job::Job;
use crate::run::films::{check_finite, check_textures};
use crate::shard::ShardSpec;
use etendue_core::observer::Observer;
use etendue_core::random::Pixel;
use etendue_io::failure::{Error, ErrorCode};
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::{CameraPlan, Route};
use etendue_pipeline::render::{FilmStorage, FrameCapture, LightRequest, light};
use etendue_pipeline::tile::{Tile, tiles};
use etendue_sensor::{Sensor, TemporalNoise};
use etendue_tracer::accel::Simd;

/// Sample density and the sampled part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightSampling {
    /// Samples per pixel, a multiple of the replicates.
    pub spp: u32,
    /// Independently scrambled replicates, 1 or more.
    pub replicates: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Side of a tile, px; increased to the next size that does not split blocks of pixels with shared paths.
    pub tile_px: u32,
    /// The tiles.
    pub shard: ShardSpec,
}

/// Quantity of a pixel's signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightSignal {
    /// Mean electrons of the described exposure, before effects behind the lens.
    Electrons,
    /// Irradiance on the sensor, mean over the bands, W·m⁻²·nm⁻¹.
    Irradiance,
    /// Radiance at the entrance pupil, mean over the bands, W·m⁻²·sr⁻¹·nm⁻¹.
    Radiance,
}

/// One pixel of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampledPixel {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Index of its tile, from 0, among the rendered tiles.
    pub tile: u32,
    /// Position in the tile of the colour filter, row by row; 0 without a filter.
    pub colour: u32,
}

/// The light of the pixels of some tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledLight {
    /// The pixels, tile by tile.
    pub pixels: Vec<SampledPixel>,
    /// Signal of each pixel.
    pub signal: Vec<f32>,
    /// Variance of each pixel's mean, from the scatter of the replicates, in the square of the signal's unit; NaN for one replicate, and for electrons
    /// computed from bands.
    pub variance: Vec<f32>,
}

impl Job {
    /// Returns the quantity of the signal of a camera's pixels.
    ///
    /// # Errors
    /// The job has no such camera.
    pub fn light_signal(&self, camera: &str) -> Result<LightSignal, Error> {
        Ok(signal_of(self.camera_plan(camera)?))
    }

    /// Returns the noise that a camera's sensor adds to its electrons in one frame; `None` if its signal is not electrons.
    ///
    /// # Errors
    /// The job has no such camera.
    pub fn temporal_noise(&self, camera: &str) -> Result<Option<TemporalNoise>, Error> {
        let camera = self.camera_plan(camera)?;
        Ok(sensor_of(camera).map(Sensor::temporal_noise))
    }

    /// Renders the light of a shard's pixels in frame 0, each with the requested number of samples, whatever the job states. Runs on the caller's thread
    /// pool.
    ///
    /// # Errors
    /// The job has no such camera, the observer cancels, or light is not finite.
    pub fn sampled_light(
        &self,
        camera: &str,
        sampling: LightSampling,
        simd: Simd,
        observer: &dyn Observer,
    ) -> Result<SampledLight, Error> {
        let mut camera = self.camera_plan(camera)?.clone();
        let settings = &mut camera.settings;
        settings.adaptive = None;
        (settings.spp, settings.replicates, settings.seed) = (sampling.spp, sampling.replicates, sampling.seed);
        settings.tile_px = settings.blocks.tile_px(sampling.tile_px);
        // Only of a few tiles; the others take no memory.
        let keeping = FilmStorage::Memory;
        let request =
            LightRequest { frame_capture: FrameCapture::default(), simd, shard: sampling.shard.shard()?, keeping };
        let film = light(self.plan(), &camera, request, &SilentObserver(observer));
        let film = film.map_err(|cancelled| Error::Run(cancelled.to_string()))?;
        check_textures(self.plan())?;
        check_finite(&camera, &film)?;
        let (width, height) = camera.film_size();
        let tiles = tiles(width, height, camera.settings.tile_px, request.shard);
        Ok(SampledLight::from_film(&camera, &film, &tiles))
    }

    /// Returns the number of tiles of a camera's film for this side, columns and rows: an upper limit of useful shards.
    ///
    /// # Errors
    /// The job has no such camera.
    pub fn tile_grid(&self, camera: &str, tile_px: u32) -> Result<[u32; 2], Error> {
        let camera = self.camera_plan(camera)?;
        let ((width, height), side) = (camera.film_size(), camera.settings.blocks.tile_px(tile_px));
        Ok([width.div_ceil(side), height.div_ceil(side)])
    }

    /// Returns columns and rows of a camera's film: its image with the margin that effects behind the lens need; at the pupil the stored view.
    ///
    /// # Errors
    /// The job has no such camera.
    pub fn film_px(&self, camera: &str) -> Result<[u32; 2], Error> {
        let (width, height) = self.camera_plan(camera)?.film_size();
        Ok([width, height])
    }

    /// Returns the plan of a camera.
    ///
    /// # Errors
    /// The job has no such camera.
    pub fn camera_plan(&self, name: &str) -> Result<&CameraPlan, Error> {
        self.plan()
            .camera(name)
            .ok_or_else(|| Error::coded(ErrorCode::UnknownName, format!("the job has no camera {name}")))
    }
}

/// Forwards cancellation only.
struct SilentObserver<'a>(&'a dyn Observer);

impl etendue_pipeline::Observer for SilentObserver<'_> {
    fn tiles(&self, _: usize, _: usize) {}

    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

fn sensor_of(camera: &CameraPlan) -> Option<&Sensor> {
    camera.body.sensor.as_ref().filter(|_| camera.settings.route == Route::Lens)
}

fn signal_of(camera: &CameraPlan) -> LightSignal {
    match camera.settings.route {
        Route::Pupil(_) => LightSignal::Radiance,
        Route::Lens if camera.body.sensor.is_some() => LightSignal::Electrons,
        Route::Lens => LightSignal::Irradiance,
    }
}

impl SampledLight {
    fn from_film(camera: &CameraPlan, film: &Film, tiles: &[Tile]) -> Self {
        let reading = SignalReader::new(camera);
        let mut sampled = Self { pixels: Vec::new(), signal: Vec::new(), variance: Vec::new() };
        for (number, tile) in tiles.iter().enumerate() {
            for at in tile.pixels() {
                let colour = reading.colour(at);
                let (signal, variance) = reading.read(film, at, colour);
                sampled.pixels.push(SampledPixel { x: at.x, y: at.y, tile: number as u32, colour: colour as u32 });
                sampled.signal.push(signal as f32);
                sampled.variance.push(variance as f32);
            }
        }
        sampled
    }
}

/// Computes a pixel's signal from a film.
struct SignalReader {
    exposure_s: f64,
    /// Columns and rows of the colour filter's tile, and of the film's margin before the image.
    filter: [u32; 2],
    margin_px: [u32; 2],
    /// For each position of the filter: electrons per second by the bands' irradiances. Empty without such positions.
    band_response: Vec<Vec<f64>>,
}

impl SignalReader {
    fn new(camera: &CameraPlan) -> Self {
        let margin_px = match camera.settings.route {
            Route::Lens => camera.body.effects.margin_px().map(|px| px as u32),
            Route::Pupil(_) => [0, 0],
        };
        let Some(sensor) = sensor_of(camera) else {
            return Self { exposure_s: 1.0, filter: [1, 1], margin_px, band_response: Vec::new() };
        };
        let p = sensor.parameters();
        let width = p.cfa.width();
        let filter = [width as u32, (p.cfa.channels().len() / width) as u32];
        let of_bands =
            camera.settings.bands.filter(|_| !camera.settings.accumulates_electrons).map_or_else(Vec::new, |bands| {
                let rates = sensor.rate_responsivities();
                let of = |channel: &usize| {
                    rates[*channel].band_means(bands).iter().map(|mean| mean * bands.width_nm()).collect()
                };
                p.cfa.channels().iter().map(of).collect()
            });
        Self { exposure_s: p.exposure.exposure_s, filter, margin_px, band_response: of_bands }
    }

    fn colour(&self, at: Pixel) -> usize {
        let place = |pixel: u32, margin: u32, side: u32| (pixel + side - margin % side) % side;
        let [columns, rows] = self.filter;
        (place(at.y, self.margin_px[1], rows) * columns + place(at.x, self.margin_px[0], columns)) as usize
    }

    /// Signal of a pixel, and its variance.
    fn read(&self, film: &Film, at: Pixel, colour: usize) -> (f64, f64) {
        let (x, y) = (at.x as usize, at.y as usize);
        if let Some(rate) = &film.electron_rate {
            let of = |value: f32, by: f64| f64::from(value) * by;
            return (
                of(rate.mean.at(x, y), self.exposure_s),
                of(rate.variance.at(x, y), self.exposure_s * self.exposure_s),
            );
        }
        let Some(cube) = film.cube() else { return (0.0, f64::NAN) };
        let bands = cube.mean.planes().iter().map(|plane| f64::from(plane.at(x, y)));
        match self.band_response.get(colour) {
            Some(weights) => {
                (bands.zip(weights).map(|(value, weight)| value * weight).sum::<f64>() * self.exposure_s, f64::NAN)
            }
            None => (bands.sum::<f64>() / cube.mean.planes().len() as f64, f64::NAN),
        }
    }
}
