//! One run: its request, its state, and its next step.
//!
//! A [`Run`] is the whole state of a run: its plan, its films with their passes, the states of the sensors, its progress. [`Run::next`] derives from it the
//! next [`RunStep`]. The step changes the state. This repeats until the results of a camera, or the film of a shard, are ready. All runs are this loop:
//!
//! | run | differs by |
//! | --- | --- |
//! | plain, noise-limited, frames of a data set | nothing: passes and samples are the plan's |
//! | progressive | light is stored and images are refined after each pass ([`RunStore`]) |
//! | of a given time | passes of all films in turn until the time is up ([`timed`]), then results |
//! | resumed | films start with stored light, complete frames are skipped |
//! | shard, one film of a shard | some tiles, some films, and films in place of results |
//! | merged from shards | the stored light is complete |
//!
//! - [`films`] are the films in the order of their frames; [`pass`] renders one pass of one.
//! - [`rounds`] are the steps of a run of a given time, whose passes [`timed`] determines with the sizes of [`pace`], and the storage after passes.
//! - [`store`] is the interface to the stored state of a run, and its output folder.

pub(crate) mod films;
mod pace;
mod pass;
mod rounds;
pub(crate) mod store;
mod timed;

use crate::film_file::FilmOrigin;
use crate::job_request::RenderOptions;
use crate::results::{CameraResults, SensorHistory};
use etendue_core::observer::{FramePlace, Observer};
use etendue_io::failure::Error;
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::{CameraPlan, NumberedPass, TimeDependence};
use etendue_pipeline::render::{FilmStorage, FrameCapture, LightRequest};
use etendue_pipeline::tile::Shard;
use etendue_sensor::SensorState;
use films::{FilmPlace, FilmStage, RunFilms, check_finite, check_frames, check_textures, tile_count};
use pass::{TileCount, WatchedPass, report_noise};
use std::sync::Arc;
use store::{RunStore, StoredLight};
use timed::TimedPasses;

/// An action of a run.
enum RunStep {
    /// Restores the stored light of a film.
    Open(FilmPlace),
    /// Measures the sample rate, in a run of a given time.
    Pilot,
    /// Ends a round, one pass of all films, and starts the next, if any.
    Round,
    /// Renders a pass of a film.
    Pass(FilmPlace, NumberedPass),
    /// Completes a film.
    Complete(FilmPlace),
    /// Finds the frames whose results an earlier run has written.
    FindDone,
    /// Skips such a frame.
    Skip,
    /// Delivers the results of the next camera of a frame, or its film.
    Deliver,
    /// The run is complete.
    End,
}

/// The state of a run.
pub(crate) struct Run<'a> {
    /// The plan, with the passes done so far in a run of a given time.
    plan: Arc<Plan>,
    /// Groups of cameras of equal light, by their indices in the plan; the light is that of the first.
    groups: Vec<Vec<usize>>,
    options: RenderOptions,
    shard: Shard,
    observer: &'a dyn Observer,
    films: RunFilms,
    /// Passes of a run of a given time; otherwise they are the plan's.
    timed: Option<TimedPasses<'a>>,
    /// True once the frames written by an earlier run are known.
    knows_done: bool,
    /// Frame of the next results, by its index among the films, and the camera within its group.
    entry: usize,
    camera: usize,
    /// Light of that frame, once the results of one camera have been delivered.
    light: Vec<Film>,
    /// By group: states of the sensors before their next frame.
    states: Vec<Vec<SensorState>>,
    /// States after the frame of the next results, of the cameras before the next.
    states_after: Vec<SensorState>,
    /// Number of finished tiles, and of all tiles, if the plan states the passes.
    done_tiles: usize,
    total_tiles: usize,
}

impl<'a> Run<'a> {
    /// Starts a run of all cameras of a plan; of a given time, s, if one is stated.
    ///
    /// # Errors
    /// Frames have no times, or the observer has no clock for a time.
    pub(crate) fn new(
        plan: &Arc<Plan>,
        options: &RenderOptions,
        time_s: Option<f64>,
        observer: &'a dyn Observer,
    ) -> Result<Self, Error> {
        check_frames(plan, &options.frames)?;
        let timed = time_s.map(|time_s| TimedPasses::new(plan, time_s, observer)).transpose()?;
        let films = RunFilms::for_frames(plan, &options.frames);
        Ok(Self { timed, ..Self::for_films(plan, options, films, observer) })
    }

    /// Starts a run of a shard: its films that are `wanted`.
    ///
    /// # Errors
    /// Frames have no times.
    pub(crate) fn for_shard(
        plan: &Arc<Plan>,
        options: &RenderOptions,
        shard: Shard,
        is_wanted: impl Fn(&CameraPlan, FrameCapture) -> bool,
        observer: &'a dyn Observer,
    ) -> Result<Self, Error> {
        check_frames(plan, &options.frames)?;
        let films = RunFilms::one_film_each(plan, &options.frames, is_wanted);
        Ok(Self { shard, ..Self::for_films(plan, options, films, observer) })
    }

    fn for_films(plan: &Arc<Plan>, options: &RenderOptions, films: RunFilms, observer: &'a dyn Observer) -> Self {
        let place = |camera: &CameraPlan| plan.cameras.iter().position(|c| c.name == camera.name);
        let places = |group: Vec<&CameraPlan>| group.into_iter().filter_map(place).collect::<Vec<_>>();
        let groups: Vec<_> = plan.by_light().into_iter().map(places).collect();
        let states = groups.iter().map(|group| vec![SensorState::default(); group.len()]).collect();
        Self {
            plan: Arc::clone(plan),
            groups,
            options: options.clone(),
            shard: Shard::WHOLE,
            observer,
            films,
            timed: None,
            knows_done: false,
            entry: 0,
            camera: 0,
            light: Vec::new(),
            states,
            states_after: Vec::new(),
            done_tiles: 0,
            total_tiles: 0,
        }
    }

    /// Continues until the results of the next camera are ready: the cameras of a group of equal light one after the other, and, where light depends on time,
    /// frame after frame. Returns `None` at the end.
    ///
    /// # Errors
    /// The observer cancels, light is not finite, or the store fails.
    pub(crate) fn next_camera_results(&mut self, store: &mut dyn RunStore) -> Result<Option<CameraResults>, Error> {
        match self.execute_until_delivery(store)? {
            true => self.results().map(Some),
            false => Ok(None),
        }
    }

    /// Continues until the next film of a shard is ready; `None` at the end.
    ///
    /// # Errors
    /// The observer cancels, or light is not finite.
    pub(crate) fn next_film(&mut self, store: &mut dyn RunStore) -> Result<Option<(FilmOrigin<'_>, Film)>, Error> {
        if !self.execute_until_delivery(store)? {
            return Ok(None);
        }
        let place = FilmPlace { entry: self.entry, film: 0 };
        let light = self.take_light()?;
        self.entry += 1;
        Ok(light.into_iter().next().map(|film| (self.origin(place), film)))
    }

    /// Executes steps until something can be delivered; returns false at the end.
    fn execute_until_delivery(&mut self, store: &mut dyn RunStore) -> Result<bool, Error> {
        loop {
            match self.next() {
                RunStep::Open(place) => self.open(place, store)?,
                RunStep::Pilot => self.pilot()?,
                RunStep::Round => self.round(store)?,
                RunStep::Pass(place, at) => self.pass(place, at, store)?,
                RunStep::Complete(place) => self.complete(place),
                RunStep::FindDone => self.find_complete(store)?,
                RunStep::Skip => self.skip(),
                RunStep::Deliver => return Ok(true),
                RunStep::End => return Ok(false),
            }
        }
    }

    /// Returns the next step.
    fn next(&self) -> RunStep {
        if let Some(timed) = self.timed.as_ref().filter(|timed| !timed.is_over) {
            return self.next_timed(timed);
        }
        if !self.knows_done {
            return RunStep::FindDone;
        }
        let Some(entry) = self.films.entries.get(self.entry) else { return RunStep::End };
        if entry.done.is_some() {
            return RunStep::Skip;
        }
        let Some(film) = entry.first_incomplete() else { return RunStep::Deliver };
        let place = FilmPlace { entry: self.entry, film };
        let film = self.films.at(place);
        match film.stage {
            FilmStage::New => RunStep::Open(place),
            FilmStage::Open if film.passes < self.first_camera(place).pass_count() => {
                RunStep::Pass(place, self.first_camera(place).pass(film.passes))
            }
            FilmStage::Open | FilmStage::Complete => RunStep::Complete(place),
        }
    }

    /// Returns the next step before the time is up.
    fn next_timed(&self, timed: &TimedPasses<'_>) -> RunStep {
        let places = self.films.by_light();
        if let Some(new) = places.iter().find(|place| self.films.at(**place).stage == FilmStage::New) {
            return RunStep::Open(*new);
        }
        if !timed.has_rate() {
            return RunStep::Pilot;
        }
        // Films that were behind when their run ended receive their missing passes.
        let pass_targets = timed.requested_passes();
        match places.into_iter().find(|place| self.films.at(*place).passes < pass_targets.list().len()) {
            Some(behind) => RunStep::Pass(behind, pass_targets.at(self.films.at(behind).passes)),
            None => RunStep::Round,
        }
    }

    fn open(&mut self, place: FilmPlace, store: &mut dyn RunStore) -> Result<(), Error> {
        let stored = store.light(&self.origin(place))?;
        let tiles = tile_count(self.first_camera(place), self.shard);
        let film = self.films.at_mut(place);
        film.stage = FilmStage::Open;
        match stored {
            StoredLight::None => {}
            StoredLight::Passes(light, passes) => {
                film.resume(light, &passes);
                self.done_tiles += film.passes * tiles;
                if let Some(timed) = &mut self.timed {
                    timed.resume(&passes);
                }
            }
            StoredLight::Complete(light) => {
                (film.light, film.stage) = (Some(light), FilmStage::Complete);
            }
        }
        Ok(())
    }

    fn pass(&mut self, place: FilmPlace, at: NumberedPass, store: &mut dyn RunStore) -> Result<(), Error> {
        let merged_film = self.watched_pass(place).render(at, self.films.at(place).light.as_ref())?;
        let Some(merged_film) = merged_film else {
            self.give_up_round();
            return Ok(());
        };
        let is_in_round = self.timed.as_ref().is_some_and(TimedPasses::is_in_round);
        let film = self.films.at_mut(place);
        film.passes += 1;
        if is_in_round {
            film.with_round = Some(merged_film);
        } else {
            film.light = Some(merged_film);
        }
        if self.timed.is_some() {
            return Ok(());
        }
        self.done_tiles += tile_count(self.first_camera(place), self.shard);
        self.store_pass(place, store)
    }

    fn complete(&mut self, place: FilmPlace) {
        let film = self.films.at_mut(place);
        film.stage = FilmStage::Complete;
        let frame_capture = film.frame_capture;
        if let Some(light) = &self.films.at(place).light {
            report_noise(self.first_camera(place), frame_capture, light, self.observer);
        }
    }

    fn find_complete(&mut self, store: &mut dyn RunStore) -> Result<(), Error> {
        let done = store.done_frames(&self.plan)?;
        self.knows_done = true;
        for entry in &mut self.films.entries {
            let group: Vec<&CameraPlan> = self.groups[entry.group].iter().map(|c| &self.plan.cameras[*c]).collect();
            if group[0].time != TimeDependence::None {
                entry.done = done.states(&group, entry.frames.start);
            }
            if entry.done.is_none() {
                self.total_tiles += entry.films.len() * group[0].pass_count() * tile_count(group[0], self.shard);
            }
        }
        Ok(())
    }

    fn skip(&mut self) {
        let entry = &mut self.films.entries[self.entry];
        if let Some(states) = entry.done.take() {
            self.states[entry.group] = states;
        }
        self.entry += 1;
    }

    /// Computes the results of the next camera of the next frame.
    fn results(&mut self) -> Result<CameraResults, Error> {
        if self.camera == 0 {
            self.light = self.take_light()?;
        }
        let entry = &self.films.entries[self.entry];
        let group = &self.groups[entry.group];
        let is_last = self.camera + 1 == group.len();
        let light = if is_last { std::mem::take(&mut self.light) } else { self.light.clone() };
        let state = self.states[entry.group][self.camera].clone();
        let before = SensorHistory { state, since: self.options.frames.start };
        let options = RenderOptions { frames: entry.frames.clone(), ..self.options.clone() };
        let camera = &self.plan.cameras[group[self.camera]];
        let results = CameraResults::from_films(&self.plan, camera, light, before, &options)?;
        check_textures(&self.plan)?;
        let after = results.state_after().map(|after| after.state.clone());
        self.states_after.push(after.unwrap_or_default());
        self.camera += 1;
        if is_last {
            self.states[entry.group] = std::mem::take(&mut self.states_after);
            (self.camera, self.entry) = (0, self.entry + 1);
        }
        Ok(results)
    }

    /// Takes the light of the next frame; refuses light that is not finite.
    fn take_light(&mut self) -> Result<Vec<Film>, Error> {
        let entry = &mut self.films.entries[self.entry];
        let camera = &self.plan.cameras[self.groups[entry.group][0]];
        let light = entry.take_light(camera)?;
        light.iter().try_for_each(|film| check_finite(camera, film))?;
        Ok(light)
    }

    /// The first of the cameras that share a film.
    fn first_camera(&self, place: FilmPlace) -> &CameraPlan {
        &self.plan.cameras[self.groups[self.films.entries[place.entry].group][0]]
    }

    fn origin(&self, place: FilmPlace) -> FilmOrigin<'_> {
        let frame_capture = self.films.at(place).frame_capture;
        FilmOrigin { plan: &self.plan, camera: self.first_camera(place), frame_capture, shard: self.shard }
    }

    /// A pass of a film, with its tile count within the run or the round.
    fn watched_pass(&self, place: FilmPlace) -> WatchedPass<'_> {
        let (camera, frame_capture) = (self.first_camera(place), self.films.at(place).frame_capture);
        let request =
            LightRequest { frame_capture, simd: self.options.simd, shard: self.shard, keeping: FilmStorage::Planned };
        let (plan, observer) = (&*self.plan, self.observer);
        if let Some(timed) = &self.timed {
            let places = self.films.by_light();
            let before = places.iter().take_while(|before| **before != place).count();
            let count = TileCount::OfRound { before, films: places.len() };
            let (heading, watch) = (camera.name.clone(), Some(&timed.watch));
            return WatchedPass { plan, camera, request, observer, heading, frame: None, count, watch, is_shown: true };
        }
        let heading = match self.groups[self.films.entries[place.entry].group].len() {
            1 => camera.name.clone(),
            n => format!("{} and {} more", camera.name, n - 1),
        };
        let frames = &self.options.frames;
        let frame = (camera.time != TimeDependence::None).then(|| FramePlace {
            number: frame_capture.frame,
            place: frame_capture.frame - frames.start + 1,
            count: frames.len() as u32,
        });
        let count = TileCount::OfRun { before: self.done_tiles, total: self.total_tiles };
        WatchedPass { plan, camera, request, observer, heading, frame, count, watch: None, is_shown: true }
    }
}
