//! One observed pass of a film: progress, cancellation, and tiles of light for display.
//!
//! If a spectrum is stored, tiles are radiance in linear sRGB, (1, 1, 1) at 1 cd/m², equal to the channels `R`, `G`, `B` of `radiance.exr`. If pixels
//! accumulate electrons directly, tiles are `Y`, the mean electrons of the exposure, each pixel in the colour of its filter.

use super::films::check_textures;
use super::timed::RenderClock;
use etendue_core::observer::{FramePlace, ImageTile, Message, Observer, Progress, ProgressUnit};
use etendue_io::failure::Error;
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::noise_reached::NoiseLimitResult;
use etendue_pipeline::plan::{CameraPlan, NumberedPass, TimeDependence};
use etendue_pipeline::render::{FrameCapture, LightRequest, pass};
use etendue_pipeline::tile::Tile;
use etendue_spectra::colour::linear_srgb_from_xyz;
use etendue_spectra::observer::xyz_weights;

/// Position of a pass's tiles in the total count.
#[derive(Clone, Copy, Debug)]
pub(super) enum TileCount {
    /// Within the whole run: tiles before it, and all tiles.
    OfRun { before: usize, total: usize },
    /// Within one pass of all films: films before it, and all films.
    OfRound { before: usize, films: usize },
}

/// A pass of a film with its observer.
pub(super) struct WatchedPass<'a> {
    pub(super) plan: &'a Plan,
    /// The first of the cameras that share the light.
    pub(super) camera: &'a CameraPlan,
    /// Raster and tiles to render.
    pub(super) request: LightRequest,
    pub(super) observer: &'a dyn Observer,
    /// Heading of the progress display.
    pub(super) heading: String,
    pub(super) frame: Option<FramePlace>,
    pub(super) count: TileCount,
    /// Clock of a run of a given time; `None` if the plan states the passes.
    pub(super) watch: Option<&'a RenderClock<'a>>,
    /// False for a pilot: its tiles are not shown.
    pub(super) is_shown: bool,
}

impl WatchedPass<'_> {
    /// Renders the pass and adds it to the light of the passes before it; `None` if the time is far exceeded.
    ///
    /// # Errors
    /// The observer cancels, or a texture cannot be read.
    pub(super) fn render(&self, at: NumberedPass, before: Option<&Film>) -> Result<Option<Film>, Error> {
        let film = pass(self.plan, self.camera, self.request, at, before, self);
        if let Some(watch) = self.watch {
            watch.end_pass();
        }
        check_textures(self.plan)?;
        match film {
            Ok(film) => Ok(Some(film)),
            Err(_) if self.watch.is_some_and(RenderClock::was_pass_discarded) => Ok(None),
            Err(cause) => Err(Error::Run(cause.to_string())),
        }
    }
}

impl etendue_pipeline::Observer for WatchedPass<'_> {
    fn begins(&self) {
        if let Some(watch) = self.watch {
            watch.begin_pass();
        }
    }

    fn tile(&self, tile: Tile, film: &Film) {
        if self.is_shown {
            show(self.observer, self.camera, self.request.frame_capture, tile, film);
        }
    }

    fn tiles(&self, done: usize, of_film: usize) {
        let (done, total) = match self.count {
            TileCount::OfRun { before, total } => (before + done, total),
            TileCount::OfRound { before, films } => (before * of_film + done, films * of_film),
        };
        self.observer.progress(Progress {
            heading: &self.heading,
            frame: self.frame,
            unit: ProgressUnit::Tiles,
            done,
            total,
        });
    }

    fn cancelled(&self) -> bool {
        self.observer.cancelled()
            || self.watch.is_some_and(RenderClock::is_pass_discarded)
            || self.plan.material_table.texture_failure().is_some()
    }
}

/// Reports the samples taken by noise-limited sampling, and whether the limit was reached.
pub(super) fn report_noise(camera: &CameraPlan, frame_capture: FrameCapture, film: &Film, observer: &dyn Observer) {
    let Some((limit, tolerance)) = camera.settings.adaptive.zip(camera.tolerance()) else { return };
    let Some(reached) = NoiseLimitResult::new(film, &tolerance, camera.settings.spp) else { return };
    let place = match camera.time {
        TimeDependence::None => format!("camera {}", camera.name),
        _ => format!("camera {}, frame {}, capture {}", camera.name, frame_capture.frame, frame_capture.capture),
    };
    let of = if tolerance.sensor().is_some() { "the sensor's noise" } else { "the pixel's mean" };
    let (min_spp, max_spp) = reached.range_spp;
    observer.message(Message::Note(&format!(
        "{place}: {:.1} samples per pixel ({min_spp} to {max_spp}); standard error {:.3} of {of} (root mean square; requested {})",
        reached.mean_spp,
        limit.threshold * reached.error,
        limit.threshold
    )));
    if reached.beyond_limit_fraction > 0.0 {
        observer.message(Message::Warning(&format!(
            "{place}: {:.2} % of the pixels are still noisier than {} of {of} with at most {max_spp} samples; give a larger \"max_spp\"",
            100.0 * reached.beyond_limit_fraction,
            limit.threshold
        )));
    }
}

/// Shows a tile of a film to an observer that requests tiles.
fn show(observer: &dyn Observer, camera: &CameraPlan, frame_capture: FrameCapture, tile: Tile, film: &Film) {
    if !observer.wants_tiles() {
        return;
    }
    let (channels, values) = match (&film.cube, &film.electron_rate) {
        (Some(_), _) => match radiance(film, tile) {
            Ok(values) => (&["R", "G", "B"][..], values),
            // The run reports the error when it reads the film.
            Err(_) => return,
        },
        (None, Some(_)) => (&["Y"][..], electrons(film, tile, camera.body.exposure.exposure_s)),
        (None, None) => return,
    };
    let size_px = [film.weight.width() as u32, film.weight.height() as u32];
    let image = &image_name(camera, frame_capture);
    let (first_px, tile_px) = ([tile.x0, tile.y0], [tile.x1 - tile.x0, tile.y1 - tile.y0]);
    observer.tile(&ImageTile { image, size_px, first_px, tile_px, channels, values: &values });
}

/// Name of a film in an image viewer.
fn image_name(camera: &CameraPlan, frame_capture: FrameCapture) -> String {
    match (camera.time, frame_capture.capture) {
        (TimeDependence::None, _) => camera.name.clone(),
        (_, 0) => format!("{}, frame {}", camera.name, frame_capture.frame),
        (_, capture) => format!("{}, frame {}, capture {capture}", camera.name, frame_capture.frame),
    }
}

/// Planes of linear sRGB, one after the other.
fn radiance(film: &Film, tile: Tile) -> Result<Vec<f32>, String> {
    let Some(((of, _), bands)) = film.bands().zip(film.tile_bands(tile)?) else { return Ok(Vec::new()) };
    let weights: Vec<[f64; 3]> = xyz_weights(of).into_iter().map(linear_srgb_from_xyz).collect();
    let mut rgb_sums = vec![0.0_f64; 3 * tile.len()];
    for (place, pixel) in tile.pixels().enumerate() {
        let pupil_sr = film.weight.at(pixel.x as usize, pixel.y as usize);
        if pupil_sr > 0.0 {
            for (mean, weight) in bands.means(pixel).zip(&weights) {
                let radiance = f64::from(mean / pupil_sr);
                (0..3).for_each(|channel| rgb_sums[channel * tile.len() + place] += weight[channel] * radiance);
            }
        }
    }
    Ok(rgb_sums.into_iter().map(|sum| sum as f32).collect())
}

/// Mean electrons over an exposure, s.
fn electrons(film: &Film, tile: Tile, exposure_s: f64) -> Vec<f32> {
    let Some(rate) = &film.electron_rate else { return Vec::new() };
    let of = |x: u32, y: u32| (f64::from(rate.mean.at(x as usize, y as usize)) * exposure_s) as f32;
    tile.pixels().map(|pixel| of(pixel.x, pixel.y)).collect()
}
