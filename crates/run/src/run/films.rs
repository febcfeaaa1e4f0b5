//! Films of a run in the order of their frames, with their progress.
//!
//! Constant light has one film, which serves all frames. Time-dependent light has one for each frame and for each capture with a different exposure.

use crate::film_file::StoredPasses;
use etendue_io::failure::{Error, ErrorCode};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::{CameraPlan, TimeDependence};
use etendue_pipeline::render::FrameCapture;
use etendue_pipeline::tile::{Shard, tiles};
use etendue_sensor::SensorState;
use std::ops::Range;

/// Progress of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FilmStage {
    /// Not opened yet; light of it may be stored.
    New,
    /// Holds some of its passes, or none.
    Open,
    /// Holds all of its light.
    Complete,
}

/// A film and its passes.
#[derive(Debug)]
pub(super) struct RunFilm {
    /// Frame and capture.
    pub(super) frame_capture: FrameCapture,
    pub(super) stage: FilmStage,
    /// Number of passes in the film, including that of an unfinished round.
    pub(super) passes: usize,
    /// Light of the passes; `None` before the first.
    pub(super) light: Option<Film>,
    /// Light including the pass of an unfinished round.
    pub(super) with_round: Option<Film>,
}

impl RunFilm {
    fn new(frame_capture: FrameCapture) -> Self {
        Self { frame_capture, stage: FilmStage::New, passes: 0, light: None, with_round: None }
    }

    /// Continues from stored light.
    pub(super) fn resume(&mut self, film: Film, stored: &StoredPasses) {
        (self.light, self.passes) = (Some(film), stored.passes.list().len());
    }
}

/// Films whose results are delivered together: those of a frame, or the single one of all frames; of a shard always a single one.
#[derive(Debug)]
pub(super) struct FrameFilms {
    /// Index of the group of cameras of equal light, in the order of [`Plan::by_light`].
    pub(super) group: usize,
    /// Frames that they serve.
    pub(super) frames: Range<u32>,
    /// One per capture.
    pub(super) films: Vec<RunFilm>,
    /// States of the sensors after the frame, if an earlier run has written the results.
    pub(super) done: Option<Vec<SensorState>>,
}

impl FrameFilms {
    /// Returns the index of the first incomplete film.
    pub(super) fn first_incomplete(&self) -> Option<usize> {
        self.films.iter().position(|film| film.stage != FilmStage::Complete)
    }

    /// Takes the light of all films.
    ///
    /// # Errors
    /// A film has no light.
    pub(super) fn take_light(&mut self, camera: &CameraPlan) -> Result<Vec<Film>, Error> {
        let no_pass = || Error::Run(format!("camera {}: no pass was rendered", camera.name));
        self.films.iter_mut().map(|film| film.light.take().ok_or_else(no_pass)).collect()
    }
}

/// Position of a film: index of the entry, and index within it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FilmPlace {
    pub(super) entry: usize,
    pub(super) film: usize,
}

/// All films of a run in the order of delivery.
#[derive(Debug)]
pub(super) struct RunFilms {
    pub(super) entries: Vec<FrameFilms>,
}

impl RunFilms {
    /// Returns the films of all cameras over frames, by groups of cameras of equal light. Groups of constant light are last: their files are published at the
    /// end of the run, not with the frames of others.
    pub(super) fn for_frames(plan: &Plan, frames: &Range<u32>) -> Self {
        let mut moving = Vec::new();
        let mut steady = Vec::new();
        for (group, cameras) in plan.by_light().into_iter().enumerate() {
            let camera = cameras[0];
            if camera.time == TimeDependence::None {
                steady.push(FrameFilms::new(group, frames.clone(), vec![FrameCapture::default()]));
                continue;
            }
            moving.extend(frames.clone().map(|k| FrameFilms::new(group, k..k + 1, shots(camera, k))));
        }
        moving.extend(steady);
        Self { entries: moving }
    }

    /// Returns those films of cameras over frames that are `wanted`, each in its own entry, in the order of [`shots_of`].
    pub(super) fn one_film_each(
        plan: &Plan,
        frames: &Range<u32>,
        is_wanted: impl Fn(&CameraPlan, FrameCapture) -> bool,
    ) -> Self {
        let mut entries = Vec::new();
        for (group, cameras) in plan.by_light().into_iter().enumerate() {
            let shots =
                shots_of(cameras[0], frames).into_iter().filter(|frame_capture| is_wanted(cameras[0], *frame_capture));
            entries.extend(shots.map(|frame_capture| {
                FrameFilms::new(group, frame_capture.frame..frame_capture.frame + 1, vec![frame_capture])
            }));
        }
        Self { entries }
    }

    /// Positions of all films in the order of the groups.
    pub(super) fn by_light(&self) -> Vec<FilmPlace> {
        let mut entries: Vec<usize> = (0..self.entries.len()).collect();
        entries.sort_by_key(|entry| self.entries[*entry].group);
        let of_entry = |entry: usize| (0..self.entries[entry].films.len()).map(move |film| FilmPlace { entry, film });
        entries.into_iter().flat_map(of_entry).collect()
    }

    pub(super) fn at(&self, place: FilmPlace) -> &RunFilm {
        &self.entries[place.entry].films[place.film]
    }

    pub(super) fn at_mut(&mut self, place: FilmPlace) -> &mut RunFilm {
        &mut self.entries[place.entry].films[place.film]
    }

    pub(super) fn all_mut(&mut self) -> impl Iterator<Item = &mut RunFilm> {
        self.entries.iter_mut().flat_map(|entry| &mut entry.films)
    }
}

impl FrameFilms {
    fn new(group: usize, frames: Range<u32>, shots: Vec<FrameCapture>) -> Self {
        Self { group, frames, films: shots.into_iter().map(RunFilm::new).collect(), done: None }
    }
}

/// Captures of a frame that have their own film.
fn shots(camera: &CameraPlan, frame: u32) -> Vec<FrameCapture> {
    match camera.time {
        TimeDependence::None => vec![FrameCapture::default()],
        TimeDependence::Lights | TimeDependence::Motion => {
            let captures = camera.body.exposure.distinct_captures();
            captures.into_iter().map(|capture| FrameCapture { frame, capture: capture as u32 }).collect()
        }
    }
}

/// All captures of some frames.
pub(crate) fn shots_of(camera: &CameraPlan, frames: &Range<u32>) -> Vec<FrameCapture> {
    match camera.time {
        TimeDependence::None => shots(camera, 0),
        TimeDependence::Lights | TimeDependence::Motion => frames.clone().flat_map(|k| shots(camera, k)).collect(),
    }
}

/// Number of tiles of a camera's film.
pub(super) fn tile_count(camera: &CameraPlan, shard: Shard) -> usize {
    let (width, height) = camera.film_size();
    tiles(width, height, camera.settings.tile_px, shard).len()
}

/// Checks that a frame rate is stated if frames after the first have time-dependent light.
pub(crate) fn check_frames(plan: &Plan, frames: &Range<u32>) -> Result<(), Error> {
    let needs = |camera: &&CameraPlan| camera.time != TimeDependence::None && camera.timing.period_s.is_none();
    match plan.cameras.iter().find(needs) {
        Some(camera) if frames.end > 1 => Err(Error::coded(
            ErrorCode::MissingKey,
            format!(
                "camera {}: its light depends on time, and the times of the frames after frame 0 are unknown; add \
             [sequence] with \"frame_rate_hz\" to the job, or render `frames` 0..1",
                camera.name
            ),
        )),
        _ => Ok(()),
    }
}

/// Refuses rendered light for which a tile of a texture could not be read.
pub(crate) fn check_textures(plan: &Plan) -> Result<(), Error> {
    plan.material_table.texture_failure().map_or(Ok(()), |failure| Err(Error::run(failure)))
}

/// Refuses a film with numbers that are not finite.
pub(crate) fn check_finite(camera: &CameraPlan, film: &Film) -> Result<(), Error> {
    match film.not_finite_samples() {
        0 => Ok(()),
        count => Err(Error::Run(format!(
            "camera {}: some samples of its light are not finite ({count}), so no results are written; a light is too \
             bright or too near for 32-bit floats: lower it or move it",
            camera.name
        ))),
    }
}
