//! Light for a given time: passes of all films of a run in turn, as many as the time allows.
//!
//! The films of all cameras and frames get the same passes, so that a list of them makes the same bits again; they are held in memory together.
//! A pilot, a part of the pixels whose light is not kept, tells the rate first. Time counts from its first sample. A round that
//! is not done when the time is well over is given up.

use super::pace::{Pace, Rate};
use super::progress::Progress;
use super::state::KeptFilm;
use crate::delivery::{SoFar, shots_of};
use crate::display;
use crate::render_options::RenderOptions;
use etendue_core::maths::integer::least_common_multiple;
use etendue_core::observer::{Message, Observer, Progress as Told, Unit};
use etendue_io::failure::{Error, ErrorCode};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::{CameraPlan, MAX_PASSES, PARTS, Pass, PassAt, Passes};
use etendue_pipeline::render::{Request, Shot, pass};
use etendue_pipeline::tile::Tile;
use etendue_sensor::SensorState;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

/// The least time that can be kept, s.
pub(crate) const MIN_TIME_S: f64 = 10.0;

/// A round is given up at this part of the time.
const GIVE_UP_RATIO: f64 = 1.05;

/// Part of the time that the pilot is to take at least, and the most parts of the pixels for it.
const PILOT_FRACTION: f64 = 0.01;
const MAX_PILOT_PARTS: u32 = PARTS / 4;

/// All light of a run, and the plan that makes it again.
#[derive(Debug)]
pub(crate) struct TimedLight {
    /// With the passes that were done.
    pub(crate) plan: Arc<Plan>,
    films: Vec<(u32, Shot, Film)>,
}

impl TimedLight {
    /// The film of a camera, once.
    pub(crate) fn take(&mut self, camera: &CameraPlan, shot: Shot) -> Result<Film, Error> {
        let of = |(light, s, _): &(u32, Shot, Film)| (*light, *s) == (camera.light.index, shot);
        let place = self.films.iter().position(of);
        let place = place.ok_or_else(|| Error::Run(format!("camera {}: its light was taken already", camera.name)))?;
        Ok(self.films.swap_remove(place).2)
    }
}

/// Renders all films of a run for `total_s`.
///
/// # Errors
/// Where the observer has no clock or cancels, or the state cannot be kept.
pub(crate) fn light(
    plan: &Arc<Plan>,
    total_s: f64,
    options: &RenderOptions,
    observer: &dyn Observer,
    progress: &mut Progress,
) -> Result<TimedLight, Error> {
    let mut run = Run::new(plan, total_s, options, observer)?;
    let kept = run.kept(progress)?;
    let resumed = kept.iter().flatten().max_by_key(|kept| kept.passes.list().len()).cloned();
    run.watch.before_s = resumed.as_ref().map_or(0.0, |kept| kept.elapsed_s);
    let mut rate = run.pilot()?;
    let replicates = match (run.plan.open_replicates(), &resumed) {
        (None, _) => None,
        (Some(_), Some(kept)) => Some(kept.replicates),
        (Some(most), None) => Some(run.replicates(most, rate.sample_s)),
    };
    let mut passes = resumed.map_or_else(Passes::default, |kept| kept.passes);
    run.plan = run.plan.with_passes(&passes, replicates);
    run.catch_up(kept, &passes)?;
    let pace = run.pace();
    run.warn(pace, rate);
    while passes.list().len() < MAX_PASSES {
        let Some(next) = pace.next(run.watch.elapsed_s(), rate, passes.spp()) else { break };
        let mut with_next = passes.clone();
        with_next.push(next);
        let at = with_next.at(passes.list().len());
        let Some(measured) = run.round(at, !passes.list().is_empty())? else { break };
        (rate, passes) = (measured, with_next);
        let from_s = run.watch.elapsed_s();
        run.keep(&passes, progress)?;
        // The next round is kept as well.
        rate.beside_s += run.watch.elapsed_s() - from_s;
    }
    run.tell(&passes);
    let plan = Arc::new(run.plan.with_passes(&passes, replicates));
    let films = run.films.into_iter().map(|film| Ok((film.light, film.shot, film.film.ok_or_else(no_pass)?)));
    Ok(TimedLight { plan, films: films.collect::<Result<_, Error>>()? })
}

fn no_pass() -> Error {
    Error::Run("no pass was rendered".into())
}

/// A film of the run.
struct TimedFilm {
    /// The place of the group of cameras among those by light.
    group: usize,
    /// The camera whose light it is, by its place in the job.
    light: u32,
    shot: Shot,
    film: Option<Film>,
}

struct Run<'a> {
    /// The plan as it was compiled, which knows no passes.
    open: Arc<Plan>,
    plan: Plan,
    films: Vec<TimedFilm>,
    total_s: f64,
    options: &'a RenderOptions,
    observer: &'a dyn Observer,
    watch: Watch<'a>,
}

impl<'a> Run<'a> {
    fn new(
        plan: &Arc<Plan>,
        total_s: f64,
        options: &'a RenderOptions,
        observer: &'a dyn Observer,
    ) -> Result<Self, Error> {
        let groups = plan.by_light();
        let of_group = |(group, cameras): (usize, &Vec<&CameraPlan>)| {
            let light = cameras[0].light.index;
            let shots = shots_of(cameras[0], &options.frames);
            shots.into_iter().map(move |shot| TimedFilm { group, light, shot, film: None }).collect::<Vec<_>>()
        };
        let films = groups.iter().enumerate().flat_map(of_group).collect();
        let watch = Watch::new(observer)?;
        Ok(Self { open: Arc::clone(plan), plan: (**plan).clone(), films, total_s, options, observer, watch })
    }

    /// The films that an interrupted run left.
    fn kept(&self, progress: &Progress) -> Result<Vec<Option<KeptFilm>>, Error> {
        let groups = self.plan.by_light();
        self.films.iter().map(|film| progress.kept(&self.plan, groups[film.group][0], film.shot)).collect()
    }

    /// Takes over what is kept; films that were behind when their run ended get the passes that they lack.
    fn catch_up(&mut self, kept: Vec<Option<KeptFilm>>, passes: &Passes) -> Result<(), Error> {
        for (place, kept) in kept.into_iter().enumerate() {
            let (mut film, done) = kept.map_or((None, 0), |kept| (Some(kept.film), kept.passes.list().len()));
            for number in done..passes.list().len() {
                film = self.pass(place, (passes.at(number), film.as_ref()), true)?;
            }
            self.films[place].film = film;
        }
        Ok(())
    }

    /// The samples that all cameras can share.
    fn least(&self) -> u32 {
        self.plan.replicates().fold(1, least_common_multiple)
    }

    fn pace(&self) -> Pace {
        let least = self.least();
        Pace { total_s: self.total_s, least, has_parts: self.plan.replicates().all(|replicates| replicates == least) }
    }

    /// The rate by some of the pixels, more until they take long enough.
    fn pilot(&mut self) -> Result<Rate, Error> {
        let mut part = 1;
        loop {
            let at = PassAt { pass: Pass { samples: self.least(), part }, ..PassAt::only(0) };
            let (begin_s, before_light_s) = (self.watch.now_s(), self.watch.light_s());
            for place in 0..self.films.len() {
                self.pass(place, (at, None), false)?;
            }
            let rate = self.watch.rate(at.pass, begin_s, before_light_s);
            if rate.sample_s * at.pass.number() >= PILOT_FRACTION * self.total_s || part >= MAX_PILOT_PARTS {
                return Ok(rate);
            }
            part *= 4;
        }
    }

    /// How many replicates there are: `most`, or fewer where the time does not allow so many.
    fn replicates(&self, most: u32, sample_s: f64) -> u32 {
        let fewest = if self.plan.cameras.iter().any(|camera| camera.products.variance) { 2 } else { 1 };
        let choice: Vec<u32> = (fewest..=most).rev().filter(|replicates| most.is_multiple_of(*replicates)).collect();
        let replicates = self.pace().replicates(sample_s, &choice);
        if replicates < most {
            let note =
                format!("`time_s` {} does not allow passes of {most} replicates; they have {replicates}", self.total_s);
            self.observer.message(Message::Note(&note));
        }
        replicates
    }

    /// One pass of all films; `None`, and nothing is changed, where the time is well over and `may_end`.
    fn round(&mut self, at: PassAt, may_end: bool) -> Result<Option<Rate>, Error> {
        let (begin_s, before_light_s) = (self.watch.now_s(), self.watch.light_s());
        self.watch.limit_s = may_end.then_some(GIVE_UP_RATIO * self.total_s);
        let mut joined = Vec::with_capacity(self.films.len());
        for place in 0..self.films.len() {
            match self.pass(place, (at, self.films[place].film.as_ref()), true)? {
                Some(film) => joined.push(film),
                None => return Ok(None),
            }
        }
        self.films.iter_mut().zip(joined).for_each(|(film, joined)| film.film = Some(joined));
        Ok(Some(self.watch.rate(at.pass, begin_s, before_light_s)))
    }

    /// One pass of a film; `None` where the time is well over.
    fn pass(&self, place: usize, (at, before): (PassAt, Option<&Film>), is_kept: bool) -> Result<Option<Film>, Error> {
        let film = &self.films[place];
        let groups = self.plan.by_light();
        let camera = groups[film.group][0];
        let place = (place, self.films.len());
        let watched = Watched { watch: &self.watch, camera, shot: film.shot, place, is_kept };
        let request = Request { shot: film.shot, simd: self.options.simd, ..Request::default() };
        let joined = pass(&self.plan, camera, request, at, before, &watched);
        self.watch.ends();
        match joined {
            Ok(film) => Ok(Some(film)),
            Err(_) if self.watch.is_over.load(Ordering::Relaxed) => Ok(None),
            Err(cancelled) => Err(Error::Run(cancelled.to_string())),
        }
    }

    /// Keeps the state and refines the pictures.
    fn keep(&self, passes: &Passes, progress: &mut Progress) -> Result<(), Error> {
        if !progress.is_kept() {
            return Ok(());
        }
        let elapsed_s = self.watch.elapsed_s();
        let plan = Arc::new(self.plan.with_passes(passes, None));
        let groups = plan.by_light();
        for film in &self.films {
            let camera = groups[film.group][0];
            let done = (passes, camera.settings.replicates, elapsed_s);
            progress.keep(&self.open, (camera, film.shot), film.film.as_ref().ok_or_else(no_pass)?, done)?;
        }
        for of_frame in self.films.chunk_by(|a, b| (a.group, a.shot.frame) == (b.group, b.shot.frame)) {
            let films: Vec<Film> = of_frame.iter().filter_map(|film| film.film.clone()).collect();
            let (Some(last), Some((film, before))) = (of_frame.last(), films.split_last()) else { continue };
            let group = &groups[last.group];
            let states = vec![SensorState::default(); group.len()];
            let so_far = SoFar { films: before, count: films.len(), states: (&states, last.shot.frame) };
            progress.refine(&plan, (group, last.shot), film, so_far, self.options)?;
        }
        Ok(())
    }

    fn warn(&self, pace: Pace, rate: Rate) {
        let needed_s = rate.sample_s * f64::from(pace.least);
        if needed_s > GIVE_UP_RATIO * self.total_s {
            let samples = if pace.least == 1 { "one sample".to_owned() } else { format!("{} samples", pace.least) };
            self.observer.message(Message::Warning(&format!(
                "{samples} of every pixel, the least that can be delivered, take about {needed_s:.0} s here, more than `time_s` {}; \
                 give more time, smaller pictures, or fewer frames, cameras or replicates",
                self.total_s
            )));
        }
    }

    fn tell(&self, passes: &Passes) {
        let mut replicates: Vec<u32> = self.plan.replicates().collect();
        replicates.dedup();
        let replicates = match replicates[..] {
            [one] => format!("`set` render.replicates={one} "),
            _ => String::new(),
        };
        self.observer.message(Message::Note(&format!(
            "{:.2} s of light (`time_s` {}): {} samples a pixel; {replicates}`set` \"render.passes={}\" gives the same bytes",
            self.watch.elapsed_s(),
            self.total_s,
            passes.mean_spp(),
            passes.text()
        )));
    }
}

/// What time the light takes.
struct Watch<'a> {
    observer: &'a dyn Observer,
    /// Time that an interrupted run has taken, s.
    before_s: f64,
    /// When the first sample was begun.
    start_s: OnceLock<f64>,
    /// When the pass was begun that is under way, and the time of samples before it, s.
    pass: Mutex<(f64, f64)>,
    /// When a pass is given up, s.
    limit_s: Option<f64>,
    /// Whether one was.
    is_over: AtomicBool,
}

impl<'a> Watch<'a> {
    fn new(observer: &'a dyn Observer) -> Result<Self, Error> {
        if observer.now_s().is_none() {
            return Err(Error::coded(
                ErrorCode::InvalidArgument,
                "a time is asked for, and the caller has no clock; give samples in its place",
            ));
        }
        Ok(Self {
            observer,
            before_s: 0.0,
            start_s: OnceLock::new(),
            pass: Mutex::default(),
            limit_s: None,
            is_over: AtomicBool::new(false),
        })
    }

    fn now_s(&self) -> f64 {
        self.observer.now_s().unwrap_or_default()
    }

    /// Since the first sample.
    fn elapsed_s(&self) -> f64 {
        self.before_s + self.start_s.get().map_or(0.0, |start_s| self.now_s() - start_s)
    }

    /// Time of samples alone.
    fn light_s(&self) -> f64 {
        self.pass.lock().expect("no clock panics").1
    }

    fn begins(&self) {
        let now_s = self.now_s();
        self.start_s.get_or_init(|| now_s);
        self.pass.lock().expect("no clock panics").0 = now_s;
    }

    fn ends(&self) {
        let mut pass = self.pass.lock().expect("no clock panics");
        pass.1 += self.now_s() - pass.0;
    }

    /// The rate of a round of this pass that began when the time of samples was `before_light_s`.
    fn rate(&self, pass: Pass, begin_s: f64, before_light_s: f64) -> Rate {
        let light_s = self.light_s() - before_light_s;
        let beside_s = (self.now_s() - begin_s - light_s).max(0.0);
        Rate { sample_s: (light_s / pass.number()).max(f64::MIN_POSITIVE), beside_s }
    }

    fn is_over(&self) -> bool {
        let is_over = self.limit_s.is_some_and(|limit_s| self.elapsed_s() > limit_s);
        if is_over {
            self.is_over.store(true, Ordering::Relaxed);
        }
        is_over
    }
}

/// A pass of a film, as the pipeline sees the watch.
struct Watched<'a> {
    watch: &'a Watch<'a>,
    camera: &'a CameraPlan,
    shot: Shot,
    /// Which film of how many.
    place: (usize, usize),
    /// Whether its light is kept.
    is_kept: bool,
}

impl etendue_pipeline::Observer for Watched<'_> {
    fn begins(&self) {
        self.watch.begins();
    }

    fn tile(&self, tile: Tile, film: &Film) {
        if self.is_kept {
            display::show(self.watch.observer, (self.camera, self.shot), tile, film);
        }
    }

    fn tiles(&self, done: usize, total: usize) {
        let (place, films) = self.place;
        let (done, total) = (place * total + done, films * total);
        let told = Told { heading: &self.camera.name, frame: None, unit: Unit::Tiles, done, total };
        self.watch.observer.progress(told);
    }

    fn cancelled(&self) -> bool {
        self.watch.observer.cancelled() || self.watch.is_over()
    }
}
