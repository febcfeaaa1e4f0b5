//! The films of a run, one after the other, and how far the whole run is.

use crate::delivery::check_textures;
use crate::display;
use etendue_core::observer::{FramePlace, Message, Observer, Progress, Unit};
use etendue_io::failure::Error;
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::noise_reached::NoiseReached;
use etendue_pipeline::plan::{CameraPlan, PassAt, TimeDependence};
use etendue_pipeline::render::{FilmKeeping, Request, Shot, pass};
use etendue_pipeline::tile::{Shard, Tile, tiles};
use etendue_tracer::accel::Simd;
use std::ops::Range;

/// Gathers the films of a run. Progress counts the tiles of all of them.
pub(crate) struct Exposures<'a> {
    plan: &'a Plan,
    frames: Range<u32>,
    shard: Shard,
    simd: Simd,
    observer: &'a dyn Observer,
    /// Tiles of the passes that are finished.
    done: usize,
    /// Tiles of all passes of all films.
    total: usize,
}

impl<'a> Exposures<'a> {
    /// The films of `frames`, each of which the first camera of a group says.
    pub(crate) fn new<'b>(
        (plan, frames): (&'a Plan, &Range<u32>),
        films: impl Iterator<Item = &'b CameraPlan>,
        (shard, simd): (Shard, Simd),
        observer: &'a dyn Observer,
    ) -> Self {
        let total = films.map(|camera| camera.pass_count() * tile_count(camera, shard)).sum();
        Self { plan, frames: frames.clone(), shard, simd, observer, done: 0, total }
    }

    /// The light of cameras that have the same, in all its passes: from `kept` on, a film and how many passes it holds. `after` takes the
    /// film after each further pass, with their number.
    pub(crate) fn film(
        &mut self,
        (group, shot): (&[&CameraPlan], Shot),
        kept: Option<(Film, usize)>,
        mut after: impl FnMut(&Film, usize) -> Result<(), Error>,
    ) -> Result<Film, Error> {
        let camera = group[0];
        let (mut film, first) = kept.map_or((None, 0), |(film, passes)| (Some(film), passes));
        self.done += first * tile_count(camera, self.shard);
        for number in first..camera.pass_count() {
            let joined = self.pass((group, shot), (camera.pass(number), film.as_ref()))?;
            after(&joined, number + 1)?;
            film = Some(joined);
        }
        let film = film.ok_or_else(|| Error::Run(format!("camera {}: no pass was rendered", camera.name)))?;
        self.tell_noise(&place(camera, shot), camera, &film);
        Ok(film)
    }

    /// One pass, joined with what the passes before it gathered.
    fn pass(
        &mut self,
        (group, shot): (&[&CameraPlan], Shot),
        (number, before): (PassAt, Option<&Film>),
    ) -> Result<Film, Error> {
        let camera = group[0];
        let heading = match group.len() {
            1 => camera.name.clone(),
            n => format!("{} and {} more", camera.name, n - 1),
        };
        let frame = (camera.time != TimeDependence::None).then(|| FramePlace {
            number: shot.frame,
            place: shot.frame - self.frames.start + 1,
            count: self.frames.len() as u32,
        });
        let tiles = Tiles { heading: &heading, frame, film: (camera, shot), before: self.done, run: self };
        let request = Request { shot, simd: self.simd, shard: self.shard, keeping: FilmKeeping::Planned };
        let film = pass(self.plan, camera, request, number, before, &tiles);
        self.done += tile_count(camera, self.shard);
        check_textures(self.plan)?;
        film.map_err(|cause| Error::Run(cause.to_string()))
    }

    /// Where noise decided the samples: how many it took, and whether the limit was reached.
    fn tell_noise(&self, place: &str, camera: &CameraPlan, film: &Film) {
        let Some((limit, tolerance)) = camera.settings.adaptive.zip(camera.tolerance()) else { return };
        let Some(reached) = NoiseReached::of(film, &tolerance, camera.settings.spp) else { return };
        let of = if tolerance.sensor().is_some() { "the sensor's noise" } else { "the pixel's mean" };
        let (fewest, most) = reached.range_spp;
        self.observer.message(Message::Note(&format!(
            "{place}: {:.1} samples a pixel ({fewest} to {most}); standard error {:.3} of {of} (root mean square; asked for {})",
            reached.mean_spp,
            limit.threshold * reached.error,
            limit.threshold
        )));
        if reached.short > 0.0 {
            self.observer.message(Message::Warning(&format!(
                "{place}: {:.2} % of the pixels are still noisier than {} of {of} with at most {most} samples; give a larger \"max_spp\"",
                100.0 * reached.short,
                limit.threshold
            )));
        }
    }
}

/// Which film, in words.
fn place(camera: &CameraPlan, shot: Shot) -> String {
    match camera.time {
        TimeDependence::None => format!("camera {}", camera.name),
        _ => format!("camera {}, frame {}, capture {}", camera.name, shot.frame, shot.capture),
    }
}

/// Tiles of a camera's film.
fn tile_count(camera: &CameraPlan, shard: Shard) -> usize {
    let (width, height) = camera.film_size();
    tiles(width, height, camera.settings.tile_px, shard).len()
}

/// The tiles of one film among those of a run, as the pipeline counts them.
struct Tiles<'a> {
    heading: &'a str,
    frame: Option<FramePlace>,
    film: (&'a CameraPlan, Shot),
    before: usize,
    run: &'a Exposures<'a>,
}

impl etendue_pipeline::Observer for Tiles<'_> {
    fn tiles(&self, done: usize, _: usize) {
        let Self { heading, frame, before, run, .. } = *self;
        run.observer.progress(Progress { heading, frame, unit: Unit::Tiles, done: before + done, total: run.total });
    }

    fn tile(&self, tile: Tile, film: &Film) {
        display::show(self.run.observer, self.film, tile, film);
    }

    fn cancelled(&self) -> bool {
        self.run.observer.cancelled() || self.run.plan.material_table.texture_failure().is_some()
    }
}
