//! Steps of a run in addition to the passes of its plan: rounds of passes until a time is up, and storage after passes.

use super::Run;
use super::films::{FilmPlace, FilmStage};
use super::pass::WatchedPass;
use super::store::RunStore;
use crate::film_file::{FilmOrigin, StoredPasses};
use crate::job_request::RenderOptions;
use crate::results::{CameraResults, SensorHistory};
use etendue_io::failure::Error;
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::Passes;
use etendue_sensor::SensorState;
use std::sync::Arc;

impl Run<'_> {
    /// Renders a subset of the pixels of all films; the light is discarded.
    pub(super) fn pilot(&mut self) -> Result<(), Error> {
        let Some(timed) = &self.timed else { return Ok(()) };
        let (pilot, begin) = (timed.pilot(&self.plan), timed.watch.time_point());
        for place in self.films.by_light() {
            WatchedPass { is_shown: false, ..self.watched_pass(place) }.render(pilot, None)?;
        }
        let Some(timed) = &mut self.timed else { return Ok(()) };
        if let Some(plan) = timed.end_pilot(&self.plan, pilot, begin) {
            self.plan = Arc::new(plan);
        }
        Ok(())
    }

    pub(super) fn round(&mut self, store: &mut dyn RunStore) -> Result<(), Error> {
        let Some(timed) = &mut self.timed else { return Ok(()) };
        if timed.is_in_round() {
            self.films.all_mut().for_each(|film| film.light = film.with_round.take());
            timed.end_round();
            let from_s = timed.watch.elapsed_s();
            self.store_round(store)?;
            if let Some(timed) = &mut self.timed {
                // Includes the time of storage after the next round.
                timed.add_overhead(timed.watch.elapsed_s() - from_s);
            }
        }
        match self.timed.as_mut().is_some_and(|timed| timed.begin_round(&self.plan)) {
            true => Ok(()),
            false => {
                self.end_time();
                Ok(())
            }
        }
    }

    /// Marks all films as complete.
    fn end_time(&mut self) {
        let Some(timed) = &mut self.timed else { return };
        timed.is_over = true;
        timed.report(&self.plan);
        self.plan = Arc::new(timed.plan_of_done(&self.plan));
        self.films.all_mut().for_each(|film| film.stage = FilmStage::Complete);
    }

    pub(super) fn give_up_round(&mut self) {
        let Some(timed) = &mut self.timed else { return };
        timed.give_up_round();
        let passes = timed.completed_passes().list().len();
        self.films.all_mut().for_each(|film| (film.with_round, film.passes) = (None, passes));
        self.end_time();
    }

    /// Stores a film after a pass of the plan.
    pub(super) fn store_pass(&self, place: FilmPlace, store: &mut dyn RunStore) -> Result<(), Error> {
        let (camera, film) = (self.first_camera(place), self.films.at(place));
        let Some(light) = film.light.as_ref().filter(|_| store.stores_passes()) else { return Ok(()) };
        let passes = Passes::new((0..film.passes).map(|number| camera.pass(number).pass).collect());
        let stored = StoredPasses { passes, replicates: camera.settings.replicates, elapsed_s: 0.0 };
        store.store(&self.origin(place), light, &stored)?;
        let entry = &self.films.entries[place.entry];
        let is_last = place.film + 1 == entry.films.len();
        match is_last && film.passes < camera.pass_count() {
            true => self.refine(&self.plan, place.entry, &self.states[entry.group], store),
            false => Ok(()),
        }
    }

    /// Stores all films after a round.
    fn store_round(&self, store: &mut dyn RunStore) -> Result<(), Error> {
        let Some(timed) = self.timed.as_ref().filter(|_| store.stores_passes()) else { return Ok(()) };
        let elapsed_s = timed.watch.elapsed_s();
        let plan = Arc::new(timed.plan_of_done(&self.plan));
        let places = self.films.by_light();
        for place in &places {
            let film = self.films.at(*place);
            let camera = &plan.cameras[self.groups[self.films.entries[place.entry].group][0]];
            let replicates = camera.settings.replicates;
            let stored = StoredPasses { passes: timed.completed_passes().clone(), replicates, elapsed_s };
            let origin =
                FilmOrigin { plan: &timed.compiled, camera, frame_capture: film.frame_capture, shard: self.shard };
            if let Some(light) = &film.light {
                store.store(&origin, light, &stored)?;
            }
        }
        for place in places.iter().filter(|place| place.film == 0) {
            let cameras = self.groups[self.films.entries[place.entry].group].len();
            self.refine(&plan, place.entry, &vec![SensorState::default(); cameras], store)?;
        }
        Ok(())
    }

    /// Refines the images of a frame; `states` are the sensors' states before it.
    fn refine(
        &self,
        plan: &Arc<Plan>,
        entry: usize,
        states: &[SensorState],
        store: &mut dyn RunStore,
    ) -> Result<(), Error> {
        let entry = &self.films.entries[entry];
        let (first, since) = (entry.frames.start, self.options.frames.start);
        let options = RenderOptions { frames: first..first + 1, ..self.options.clone() };
        let light: Vec<Film> = entry.films.iter().filter_map(|film| film.light.clone()).collect();
        let mut results = self.groups[entry.group].iter().zip(states).map(|(camera, state)| {
            let before = SensorHistory { state: state.clone(), since };
            CameraResults::from_films(plan, &plan.cameras[*camera], light.clone(), before, &options)
        });
        store.refine(&mut results)
    }
}
