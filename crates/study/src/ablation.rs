//! Effect by effect: the frame with it and without it.

use crate::Clock;
use crate::error::Estimate;
use crate::pictures::{QUALITY, side_by_side};
use crate::pilot::seed;
use crate::study::Request;
use crate::way::{SAMPLE_KEYS, is_of, without_keys};
use etendue::EffectGroup;
use etendue::{CameraResults, Error, Job, JobRequest, Observer, Progress, RenderOptions, Unit, display_jpeg};
use etendue_core::Plane;
use etendue_core::maths::f64::acos;
use etendue_core::quantity::{Display, Quantity};
use glam::DVec3;
use serde::Serialize;

/// Samples of the second look over those of the first.
const MORE: u32 = 3;
/// Samples of the first look, at most.
const MOST_SPP: f64 = 64.0;
/// Side of the tiles that err alike, px, and of the cells by whose light errors are measured.
const TILE_PX: usize = 16;

/// What is found where an effect is left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dropped {
    /// The effect, as `etendue plan` names it.
    pub effect: &'static str,
    /// Its name in files.
    pub id: String,
    /// The changes of keys that leave it out.
    pub set: Vec<String>,
    /// Processor time of all threads (time, where the machine does not tell that) that is saved of loading the job and making one frame with its samples, s; below 0 where it takes longer without.
    pub cpu_saved_s: f64,
    /// Root mean square change of a pixel's mean light, over the mean light of the 16 × 16 px about it; of electrons where there are any. `None` where the light has another size.
    pub light: Option<Estimate>,
    /// Root mean square change of the digital numbers of one frame, DN, the random numbers of both alike; `None` where there are none, or of another size.
    pub raw_dn: Option<f64>,
    /// Root mean square change of the encoded picture, 0 to 1; `None` where there is none, or of another size.
    pub picture: Option<f64>,
    /// Part of the pixels that see another instance.
    pub instances: Option<f64>,
    /// Root mean square change of the distance of what a pixel sees, relative, of pixels that see the same instance.
    pub distance: Option<f64>,
    /// Root mean square change of the direction of a pixel's ray, in pixels of the middle of the picture.
    pub direction_px: Option<f64>,
    /// Its picture beside that with the effect, as of [`crate::pictures()`]; `None` where there is no picture of the same size.
    #[serde(skip)]
    pub jpeg: Option<Vec<u8>>,
}

/// An effect that no key leaves out, or whose keys the job does not take.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Kept {
    /// The effect.
    pub effect: &'static str,
    /// Why.
    pub reason: String,
}

/// A frame with and without each of its effects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ablation {
    /// The camera.
    pub camera: String,
    /// Samples a pixel that the errors are found with.
    pub spp: u32,
    /// Processor time of loading and of making one frame as the job says, s.
    pub cpu_s: f64,
    /// What was left out, in the order of the light.
    pub dropped: Vec<Dropped>,
    /// What was not.
    pub kept: Vec<Kept>,
}

/// Renders a frame of a job without each effect that its plan says a key leaves out. Runs on the caller's thread pool.
///
/// # Errors
/// Where the job has faults or no such camera, the observer cancels, or light is not finite.
pub fn ablation(request: &Request, clock: &dyn Clock, observer: &dyn Observer) -> Result<Ablation, Error> {
    let job = request.job.clone().open()?;
    let camera = request.camera.clone().unwrap_or_else(|| job.plan().cameras[0].name.clone());
    let settings = job.render_settings(&camera)?;
    let effects = job.effects().into_iter().find(|(plan, _)| plan.name == camera);
    let effects = effects.map(|(_, effects)| effects).unwrap_or_default();
    let mut trials = Vec::new();
    let mut kept = Vec::new();
    for effect in effects {
        match effect.if_dropped.as_ref().map(|dropped| dropped.set.clone()) {
            // What is written changes no frame.
            _ if effect.group == EffectGroup::Output => {}
            Some(Some(set)) if set.iter().any(|change| is_of(change, &camera, &SAMPLE_KEYS)) => {
                kept.push(Kept { effect: effect.name, reason: "every look has samples of its own".to_owned() });
            }
            Some(Some(set)) => trials.push((effect.name, effect.id(), set)),
            Some(None) => kept.push(Kept { effect: effect.name, reason: "no key leaves it out".to_owned() }),
            None => {}
        }
    }
    let mut own = without_keys(&request.job, &camera, &SAMPLE_KEYS);
    if let Some(integrator) = own.integrator.take() {
        // As a change among others, so that a trial's comes after it.
        own.set.push(format!("cameras.{camera}.render.integrator={:?}", integrator.name()));
    }
    let looks = Looks { request, camera: &camera, clock, observer, own_seed: settings.seed };
    let from_s = clock.seconds();
    looks.look(&own, 1, 3)?;
    let runs = f64::from(1 + MORE) * (trials.len() + 1) as f64;
    let spp = (request.budget_s / (runs * (clock.seconds() - from_s))).clamp(1.0, MOST_SPP) as u32;
    let with = looks.pair(&own, spp)?;
    let mut dropped = Vec::new();
    let total = trials.len();
    for (done, (effect, id, set)) in trials.into_iter().enumerate() {
        observer.progress(Progress { heading: effect, frame: None, unit: Unit::Pilots, done, total });
        let mut changed = own.clone();
        changed.set.extend(set.iter().cloned());
        match looks.pair(&changed, spp) {
            Ok(without) => dropped.push(compared((effect, id, set), (&with, &without), f64::from(settings.spp))?),
            Err(Error::Input(reason)) => {
                kept.push(Kept { effect, reason: Error::Input(reason).to_string().trim().to_owned() });
            }
            Err(other) => return Err(other),
        }
    }
    observer.progress(Progress { heading: "done", frame: None, unit: Unit::Pilots, done: total, total });
    let cpu_s = with.seconds(f64::from(settings.spp));
    Ok(Ablation { spp: spp * (1 + MORE), cpu_s, camera, dropped, kept })
}

/// Renders looks at a frame.
struct Looks<'a> {
    request: &'a Request,
    camera: &'a str,
    clock: &'a dyn Clock,
    observer: &'a dyn Observer,
    own_seed: u64,
}

/// Passes on the wish to stop, and no message: frames without this or that have much to warn of.
struct Quiet<'a>(&'a dyn Observer);

impl Observer for Quiet<'_> {
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

/// One look: the frame with so many samples, and how long it took.
struct Look {
    seconds: f64,
    light: Option<Plane<etendue_core::quantity::MeanElectrons>>,
    raw: Option<Vec<u32>>,
    picture: Option<Plane<Display>>,
    results: CameraResults,
}

/// Two looks by different random numbers.
struct Pair {
    few: Look,
    many: Look,
    spp: u32,
}

impl Pair {
    /// The whole frame with so many samples, s.
    fn seconds(&self, spp: f64) -> f64 {
        let slope = (self.many.seconds - self.few.seconds) / f64::from((MORE - 1) * self.spp);
        (self.few.seconds + slope.max(0.0) * (spp - f64::from(self.spp))).max(0.0)
    }
}

impl Looks<'_> {
    fn now_s(&self) -> f64 {
        self.clock.processor_seconds().unwrap_or_else(|| self.clock.seconds())
    }

    fn pair(&self, job: &JobRequest, spp: u32) -> Result<Pair, Error> {
        Ok(Pair { few: self.look(job, spp, 1)?, many: self.look(job, MORE * spp, 2)?, spp })
    }

    fn look(&self, job: &JobRequest, spp: u32, k: u32) -> Result<Look, Error> {
        let mut request = JobRequest { spp: Some(spp.into()), noise: None, ..job.clone() };
        (request.camera, request.seed) = (Some(self.camera.to_owned()), Some(seed(self.own_seed, 3000 + k)));
        let from_s = self.now_s();
        let job: Job = request.open()?;
        let options = RenderOptions { simd: self.request.simd, ..RenderOptions::default() };
        let mut cameras = Vec::new();
        job.render_each(&options, &Quiet(self.observer), |camera| {
            cameras.push(camera);
            Ok(())
        })?;
        let results = cameras.pop().expect("the job's only camera");
        let frame = results.frames().next();
        let seconds = self.now_s() - from_s;
        let (raw, picture) = frame.map_or((None, None), |frame| {
            (Some(frame.raw.plane.samples().to_vec()), frame.picture.map(|developed| developed.display))
        });
        Ok(Look { seconds, light: results.electrons().cloned(), raw, picture, results })
    }
}

/// What two pairs of looks differ by.
fn compared(
    (effect, id, set): (&'static str, String, Vec<String>),
    (with, without): (&Pair, &Pair),
    spp: f64,
) -> Result<Dropped, Error> {
    let truths = [with, without].map(|pair| pair.many.results.ground_truth());
    let same = |a: &Pair, b: &Pair| a.many.results.camera().body.raster == b.many.results.camera().body.raster;
    let is_same = same(with, without);
    let numbers = with.many.raw.as_ref().zip(without.many.raw.as_ref()).filter(|(a, b)| a.len() == b.len());
    let pictures = with.many.picture.as_ref().zip(without.many.picture.as_ref());
    let pictures = pictures.filter(|(a, b)| (a.width(), a.height()) == (b.width(), b.height()));
    Ok(Dropped {
        effect,
        id,
        set,
        cpu_saved_s: with.seconds(spp) - without.seconds(spp),
        light: change_of_light(with, without),
        raw_dn: numbers.map(|(a, b)| root_mean_square(a.iter().zip(b).map(|(a, b)| f64::from(*a) - f64::from(*b)))),
        picture: pictures.map(|(a, b)| {
            let channels = a.samples().iter().flatten().zip(b.samples().iter().flatten());
            root_mean_square(channels.map(|(a, b)| f64::from(*a) - f64::from(*b)))
        }),
        instances: is_same.then(|| changed(&truths[0].instance, &truths[1].instance)),
        distance: is_same.then(|| change_of_distance(&truths)),
        direction_px: is_same.then(|| change_of_direction(with, without)),
        jpeg: pictures.map(|(a, b)| display_jpeg(&side_by_side(a, b), QUALITY)).transpose()?,
    })
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        (sum, count) = (sum + value * value, count + 1.0);
    }
    if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
}

/// The root of the mean product of two independent differences, each over the light about it: free of the noise of either.
fn change_of_light(with: &Pair, without: &Pair) -> Option<Estimate> {
    let planes = [&with.few, &without.few, &with.many, &without.many].map(|look| look.light.as_ref());
    let [Some(a), Some(b), Some(c), Some(d)] = planes else { return None };
    let (width, height) = (a.width(), a.height());
    if [b, c, d].iter().any(|plane| (plane.width(), plane.height()) != (width, height)) {
        return None;
    }
    let mean_of = |plane: &Plane<_>, x0: usize, y0: usize| {
        let cell = (y0..(y0 + TILE_PX).min(height)).flat_map(|y| (x0..(x0 + TILE_PX).min(width)).map(move |x| (x, y)));
        let (sum, count) = cell.fold((0.0, 0.0), |(sum, n), (x, y)| (sum + f64::from(at(plane, x, y)), n + 1.0));
        sum / count
    };
    let whole: f64 = c.samples().iter().map(|v| f64::from(*v)).sum::<f64>() / c.samples().len() as f64;
    let mut groups = Vec::new();
    for y0 in (0..height).step_by(TILE_PX) {
        for x0 in (0..width).step_by(TILE_PX) {
            let light = mean_of(c, x0, y0).max(1e-3 * whole);
            let (mut sum, mut count) = (0.0, 0);
            for y in y0..(y0 + TILE_PX).min(height) {
                for x in x0..(x0 + TILE_PX).min(width) {
                    let difference = |p, q| f64::from(at(p, x, y)) - f64::from(at(q, x, y));
                    (sum, count) = (sum + difference(a, b) * difference(c, d), count + 1);
                }
            }
            if light > 0.0 {
                groups.push((sum / (light * light), count));
            }
        }
    }
    Some(Estimate::of_groups(&groups).root())
}

fn at<Q: Quantity>(plane: &Plane<Q>, x: usize, y: usize) -> Q::Sample {
    plane.at(x, y)
}

/// The part of samples that differ.
fn changed<Q: Quantity>(a: &Plane<Q>, b: &Plane<Q>) -> f64
where
    Q::Sample: PartialEq,
{
    let count = a.samples().iter().zip(b.samples()).filter(|(a, b)| a != b).count();
    count as f64 / a.samples().len().max(1) as f64
}

fn change_of_distance([a, b]: &[etendue::GroundTruth; 2]) -> f64 {
    let pairs = a.distance.samples().iter().zip(b.distance.samples());
    let ids = a.instance.samples().iter().zip(b.instance.samples());
    let alike = pairs.zip(ids).filter(|((a, b), (i, j))| a.is_finite() && b.is_finite() && **a > 0.0 && i == j);
    root_mean_square(alike.map(|((a, b), _)| f64::from(*b) / f64::from(*a) - 1.0))
}

/// Angles between the rays of pixels' centres, over that between neighbours in the middle.
fn change_of_direction(with: &Pair, without: &Pair) -> f64 {
    let [a, b] = [with, without].map(|pair| pair.many.results.rays().direction);
    let vector = |v: [f32; 3]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
    let angle = |a: DVec3, b: DVec3| {
        // Of small angles the chord is exact where the cosine has no digits left.
        let chord = (a - b).length();
        if chord < 0.1 { chord } else { acos(a.dot(b).clamp(-1.0, 1.0)) }
    };
    let (x, y) = (a.width() / 2, a.height() / 2);
    let pixel = angle(vector(a.at(x, y)), vector(a.at(x.saturating_sub(1), y)));
    let pairs = a.samples().iter().zip(b.samples()).map(|(a, b)| angle(vector(*a), vector(*b)));
    let known = pairs.filter(|angle| angle.is_finite());
    if pixel > 0.0 { root_mean_square(known) / pixel } else { 0.0 }
}

/// The table of an ablation.
#[must_use]
pub fn ablation_table(ablation: &Ablation) -> String {
    use std::fmt::Write as _;
    let mut out = format!(
        "camera {}: one frame takes {:.1} s of processor time; found with {} samples a pixel\n\n\
         {:<30} {:>10} {:>14} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
        ablation.camera,
        ablation.cpu_s,
        ablation.spp,
        "without",
        "saved",
        "light (rms)",
        "raw, DN",
        "picture",
        "other ids",
        "distance",
        "rays, px"
    );
    let percent = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{:.2} %", 100.0 * v));
    let number = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.2}"));
    for d in &ablation.dropped {
        let light = d.light.map_or_else(|| "–".to_owned(), crate::report::percent);
        let _ = writeln!(
            out,
            "{:<30} {:>8.1} s {light:>14} {:>9} {:>9} {:>9} {:>9} {:>9}",
            d.effect,
            d.cpu_saved_s,
            number(d.raw_dn),
            percent(d.picture),
            percent(d.instances),
            percent(d.distance),
            number(d.direction_px)
        );
    }
    if !ablation.kept.is_empty() {
        let names: Vec<_> = ablation.kept.iter().map(|kept| kept.effect).collect();
        let _ =
            writeln!(out, "\nnot left out (no key does, or the job does not take the change): {}", names.join(", "));
    }
    out
}
