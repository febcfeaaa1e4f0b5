//! A frame rendered twice, with different random numbers and different numbers of samples.

use crate::Clock;
use crate::configuration::{SAMPLE_KEYS, without_keys};
use crate::pilot::seed;
use crate::study::StudyRequest;
use etendue::{CameraResults, Error, Job, JobRequest, Observer, PlannedEffect, RenderOptions, Word as _};
use etendue_core::quantity::{Display, Quantity, WatchedSignal};
use etendue_core::{Plane, StoredCube};

/// Ratio of samples of the second render to those of the first.
pub(crate) const SECOND_SAMPLES_RATIO: u32 = 3;
/// Maximum samples of the first render.
const MAX_SPP: f64 = 64.0;

/// A job whose samples and render settings are stated by changes of keys, so that a trial's changes can override them.
fn settings_as_changes(job: &JobRequest, camera: &str) -> JobRequest {
    let mut own = without_keys(job, camera, &SAMPLE_KEYS);
    if let Some(integrator) = own.integrator.take() {
        own.set.push(format!("cameras.{camera}.render.integrator={:?}", integrator.word()));
    }
    own
}

/// Renders the first frame of one of a job's cameras, unchanged or with changes.
pub(crate) struct FrameRenderer<'a> {
    pub(crate) request: &'a StudyRequest,
    clock: &'a dyn Clock,
    observer: &'a dyn Observer,
    /// The unchanged job.
    pub(crate) job: Job,
    pub(crate) camera: String,
    /// The job's samples per pixel.
    pub(crate) job_spp: f64,
    seed: u64,
    /// The job to which changes are added.
    pub(crate) own: JobRequest,
}

/// Forwards cancellation but no messages: frames without some effects would warn of much.
pub(crate) struct QuietObserver<'a>(&'a dyn Observer);

impl Observer for QuietObserver<'_> {
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

/// A frame with a given number of samples, and its render times.
pub(crate) struct FrameRender {
    seconds: f64,
    /// Mean electrons; for a camera without electronics its irradiance over all wavelengths, at the pupil the radiance.
    pub(crate) light: Option<(&'static str, Plane<WatchedSignal>)>,
    pub(crate) raw: Option<Vec<u32>>,
    pub(crate) picture: Option<Plane<Display>>,
    pub(crate) results: CameraResults,
}

/// A frame rendered twice, with different random numbers.
pub(crate) struct RenderPair {
    pub(crate) few_samples: FrameRender,
    pub(crate) many: FrameRender,
    spp: u32,
}

impl RenderPair {
    /// Estimated time of the whole frame with `spp` samples, s.
    pub(crate) fn seconds(&self, spp: f64) -> f64 {
        let slope = (self.many.seconds - self.few_samples.seconds) / f64::from((SECOND_SAMPLES_RATIO - 1) * self.spp);
        (self.few_samples.seconds + slope.max(0.0) * (spp - f64::from(self.spp))).max(0.0)
    }
}

impl<'a> FrameRenderer<'a> {
    /// Opens the job with the requested camera, by default the first.
    ///
    /// # Errors
    /// The job is invalid or has no such camera.
    pub(crate) fn open(
        request: &'a StudyRequest,
        clock: &'a dyn Clock,
        observer: &'a dyn Observer,
    ) -> Result<Self, Error> {
        let job = request.job.clone().open()?;
        let camera = request.camera.clone().unwrap_or_else(|| job.plan().cameras[0].name.clone());
        let settings = job.camera_plan(&camera)?.settings;
        let own = settings_as_changes(&request.job, &camera);
        Ok(Self { request, clock, observer, job, camera, job_spp: settings.spp.into(), seed: settings.seed, own })
    }

    /// The effects of the camera's plan.
    pub(crate) fn effects(&self) -> Vec<PlannedEffect> {
        let effects = self.job.effects().into_iter().find(|(plan, _)| plan.name == self.camera);
        effects.map(|(_, effects)| effects).unwrap_or_default()
    }

    /// Samples of the first render at which `pairs` pairs fill the study's time, extrapolated from one render.
    pub(crate) fn affordable_spp(&self, pairs: usize) -> Result<u32, Error> {
        let from_s = self.clock.seconds();
        self.render(&self.own, 1, 3)?;
        let runs = f64::from(1 + SECOND_SAMPLES_RATIO) * pairs as f64;
        Ok((self.request.budget_s / (runs * (self.clock.seconds() - from_s))).clamp(1.0, MAX_SPP) as u32)
    }

    /// The observer without its messages.
    pub(crate) fn without_messages(&self) -> QuietObserver<'_> {
        QuietObserver(self.observer)
    }

    fn now_s(&self) -> f64 {
        self.clock.processor_seconds().unwrap_or_else(|| self.clock.seconds())
    }

    /// Renders a frame of `job` with `spp` and with [`SECOND_SAMPLES_RATIO`] times as many samples per pixel.
    ///
    /// # Errors
    /// The job is invalid, the observer cancels, or bands on disk cannot be read.
    pub(crate) fn render_pair(&self, job: &JobRequest, spp: u32) -> Result<RenderPair, Error> {
        Ok(RenderPair {
            few_samples: self.render(job, spp, 1)?,
            many: self.render(job, SECOND_SAMPLES_RATIO * spp, 2)?,
            spp,
        })
    }

    fn render(&self, job: &JobRequest, spp: u32, k: u32) -> Result<FrameRender, Error> {
        let mut request = JobRequest { spp: Some(spp.into()), noise: None, ..job.clone() };
        (request.camera, request.seed) = (Some(self.camera.clone()), Some(seed(self.seed, 3000 + k)));
        let from_s = self.now_s();
        let job: Job = request.open()?;
        let options = RenderOptions { simd: self.request.simd, ..RenderOptions::default() };
        let mut cameras = Vec::new();
        job.render_each(&options, &self.without_messages(), |camera| {
            cameras.push(camera);
            Ok(())
        })?;
        let results = cameras.pop().expect("the job's only camera");
        let frame = results.frames().next();
        let seconds = self.now_s() - from_s;
        let (raw, image) = frame.map_or((None, None), |frame| {
            (Some(frame.raw.plane.samples().to_vec()), frame.picture.map(|developed| developed.display))
        });
        Ok(FrameRender { seconds, light: light(&results)?, raw, picture: image, results })
    }
}

/// A signal, and the name of its quantity.
type Signal = (&'static str, Plane<WatchedSignal>);

/// The signal of a camera's pixels.
///
/// # Errors
/// Bands on disk cannot be read.
fn light(results: &CameraResults) -> Result<Option<Signal>, Error> {
    let light = results.light();
    if let Some(electrons) = &light.electrons {
        return Ok(Some(("electrons", electrons.map(|e| e))));
    }
    let irradiance = light.irradiance.as_ref().map(|cube| ("irradiance", over_all_wavelengths(cube)));
    let radiance = || light.radiance.as_ref().map(|of| ("radiance", over_all_wavelengths(&of.mean)));
    let signal = irradiance.or_else(radiance).map(|(name, signal)| Ok((name, signal.map_err(Error::Run)?)));
    signal.transpose()
}

fn over_all_wavelengths<Q: Quantity<Sample = f32>>(cube: &StoredCube<Q>) -> Result<Plane<WatchedSignal>, String> {
    let mut sum: Plane<WatchedSignal> = Plane::new(cube.width(), cube.height());
    let width_nm = cube.bands().width_nm() as f32;
    for band in 0..cube.bands().count() {
        let plane = cube.plane(band)?;
        sum.samples_mut().iter_mut().zip(plane.samples()).for_each(|(sum, value)| *sum += width_nm * value);
    }
    Ok(sum)
}
