//! A study: configurations, their order, and the evaluation.

use crate::Clock;
use crate::budget::affordable_tiles;
use crate::configuration::{Configuration, EXACT_BOUNCES};
use crate::error::{ErrorMetrics, Estimate};
use crate::front::{FrameOverhead, FrontPoint, Recommendation, front, point, recommend, targets};
use crate::measured::{Bias, ConfigurationMeasurement, Role, SampledPilot, Times, bias, in_series, variance};
use crate::pilot::{Pilot, Pilots};
use crate::pixels::SampledPixels;
use crate::plan::pixel_fraction;
use crate::trial::TrialContext;
use crate::work_timer::WorkTimer;
use clap::Args;
use etendue::{
    Accelerator, Error, ErrorCode, ExistingFiles, Integrator, Job, JobRequest, LightSignal, Observer, PathSettings,
    Progress, ProgressUnit, RenderOptions, Simd, Word as _,
};
use etendue_core::LightSampling;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Samples of a replicate of the short and of the long pilots, and replicates of each.
const FEW_SAMPLES: u32 = 2;
const MANY_SAMPLES: u32 = 8;
const SEEDS: u32 = 8;
/// Approximate number of configurations of a study, which share its time.
const TYPICAL_CONFIGURATIONS: f64 = 22.0;
/// Fraction of the time for pilots; the rest is for whole frames and tests of recommendations.
const PILOT_FRACTION: f64 = 0.7;
/// Samples assumed for a job with noise-limited sampling.
const UNIFORM_SPP: u32 = 64;
/// Maximum relative cost of an unbiased choice that is adopted.
const MAX_RELATIVE_COST: f64 = 0.9;

/// Request of a study.
#[derive(Args, Clone, Debug)]
pub struct StudyRequest {
    /// The job, with its changes.
    #[arg(skip = JobRequest::new(""))]
    pub job: JobRequest,
    /// Name of the camera; `None`: the first.
    #[arg(skip)]
    pub camera: Option<String>,
    /// Approximate duration of the study, seconds (10 or more); longer studies are more precise
    #[arg(long = "time", value_name = "S", default_value_t = 120.0, value_parser = seconds)]
    pub budget_s: f64,
    /// Instruction set of the accelerator.
    #[arg(skip)]
    pub simd: Simd,
    /// For changes of a frame: path of a new folder in which a chart of edges is captured for the contrast transfer; removed afterwards. `None`: no contrast
    /// transfer.
    #[arg(skip)]
    pub edges: Option<PathBuf>,
}

/// Parses the seconds of a study.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|s: &f64| (10.0..=1e6).contains(s));
    seconds.ok_or_else(|| format!("expected seconds from 10 to 1000000, not '{text}'"))
}

/// Result of a study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Study {
    pub camera: String,
    /// Quantity of its signal: `electrons`, `irradiance` or `radiance`.
    pub signal: &'static str,
    /// Fraction of the frame's pixels that were sampled.
    #[serde(rename = "share")]
    pub pixel_fraction: f64,
    /// Time of a frame excluding loading and light, s: sensor, processing, ground truth, files.
    pub rest_s: f64,
    /// The unchanged job.
    pub as_stated: FrontPoint,
    /// All configurations of the study, the job's own first.
    #[serde(rename = "ways")]
    pub configurations: Vec<ConfigurationMeasurement>,
    /// Pareto front, shortest first.
    pub front: Vec<FrontPoint>,
    /// Settings for a draft, a standard image and a reference.
    pub recommendations: Vec<Recommendation>,
    /// Duration of the study, s.
    pub took_s: f64,
    /// Ratio of the pilots' wall-clock time to the reported times, which are those of an idle machine: 1 on an idle machine.
    pub slowed: f64,
}

/// Studies a job's frame. Runs on the caller's thread pool. `scratch` is the path of a new folder: one frame is written to it, and it is removed.
///
/// # Errors
/// The job is invalid or has no such camera, the observer cancels, or `scratch` cannot be written.
pub fn study(
    request: &StudyRequest,
    scratch: &Path,
    clock: &dyn Clock,
    observer: &dyn Observer,
) -> Result<Study, Error> {
    if scratch.exists() {
        let problem =
            "already exists, and a study writes a frame there and removes it; move it away, or give another folder";
        return Err(Error::coded(ErrorCode::OutputExists, format!("{}: {problem}", scratch.display())));
    }
    let from_s = clock.seconds();
    let job = request.job.clone().open()?;
    let camera = match &request.camera {
        Some(name) => name.clone(),
        None => job.plan().cameras[0].name.clone(),
    };
    let samples = f64::from(SEEDS * (FEW_SAMPLES + MANY_SAMPLES)) * TYPICAL_CONFIGURATIONS;
    let budget = (PILOT_FRACTION * request.budget_s, samples);
    let plan = affordable_tiles(&job, &camera, budget.0, budget.1, request.simd, clock, observer)?;
    let pilots = Pilots { camera: &camera, plan, simd: request.simd, clock, observer };
    let mut bench = StudyRun {
        request,
        pilots,
        job: &job,
        pixels: None,
        measured: Vec::new(),
        pilots_by_configuration: Vec::new(),
        clock_s: 0.0,
        processor_s: 0.0,
    };
    let job_configuration = Configuration::new(&job, &camera)?;
    bench.measure_configurations(job_configuration)?;
    let settings = job.camera_plan(&camera)?.settings;
    let rest_s = bench.rest_s(scratch)?;
    let frame = FrameOverhead { rest_s, replicates: settings.replicates };
    let spp = if settings.adaptive.is_some() { UNIFORM_SPP.next_multiple_of(frame.replicates) } else { settings.spp };
    bench.combine(spp, frame)?;
    let measured_configurations = &bench.measured;
    let has_sensor = measured_configurations[0].bias_squares.sensor.is_some();
    let eligible = bench.eligible(spp, frame);
    let mut recommendations: Vec<_> =
        targets(has_sensor).into_iter().filter_map(|target| recommend(&eligible, target, frame)).collect();
    let trial = TrialContext { budget_s: request.budget_s, job: &job, pilots: &bench.pilots };
    for recommendation in &mut recommendations {
        let configuration = recommendation.point.configuration;
        let measured = bench.measured.iter().find(|m| m.configuration == configuration).expect("recommended of these");
        // The job's own configuration is first; the exact form serves only as the control here.
        let control = bench
            .measured
            .iter()
            .find(|m| m.configuration != configuration)
            .expect("several configurations are measured");
        trial.run(recommendation, measured, control, rest_s)?;
    }
    Ok(Study {
        signal: match job.light_signal(&camera)? {
            LightSignal::Electrons => "electrons",
            LightSignal::Irradiance => "irradiance",
            LightSignal::Radiance => "radiance",
        },
        pixel_fraction: pixel_fraction(
            &job,
            &camera,
            bench.pilots_by_configuration.first().map_or(0, |(_, pilot)| pilot.pixels.len()),
        )?,
        rest_s,
        as_stated: point(&measured_configurations[0], spp, frame),
        front: front(&eligible, frame),
        recommendations,
        took_s: clock.seconds() - from_s,
        slowed: bench.clock_s * clock.threads() as f64 / bench.processor_s.max(1e-9),
        configurations: bench.measured,
        camera,
    })
}

/// A study in progress.
struct StudyRun<'a> {
    request: &'a StudyRequest,
    pilots: Pilots<'a>,
    /// The unchanged job.
    job: &'a Job,
    /// Known once the exact form has run.
    pixels: Option<SampledPixels>,
    measured: Vec<ConfigurationMeasurement>,
    /// Long pilots with which others are compared.
    pilots_by_configuration: Vec<(Configuration, Pilot)>,
    /// Time of all pilots by wall clock and by CPU, s.
    clock_s: f64,
    processor_s: f64,
}

impl StudyRun<'_> {
    /// Runs all configurations with a role of their own.
    fn measure_configurations(&mut self, job_configuration: Configuration) -> Result<(), Error> {
        let with_paths = |paths| Configuration { paths, ..job_configuration };
        let exact = PathSettings {
            integrator: Integrator::Path,
            max_bounces: job_configuration.paths.max_bounces.max(EXACT_BOUNCES),
            caustics: true,
            regularize: false,
            ..job_configuration.paths
        };
        let path = with_paths(exact);
        let bare = with_paths(PathSettings { caustics: false, ..exact });
        let short = |max_bounces| with_paths(PathSettings { max_bounces, ..bare.paths });
        let widened = with_paths(PathSettings { regularize: true, ..exact });
        let less = |integrator| Configuration {
            paths: PathSettings { integrator, max_bounces: 1, branches: 1, ..exact },
            path_reuse_px: 1,
            ..job_configuration
        };
        self.measure_reference(path, Role::Exact, None)?;
        self.measure_reference(bare, Role::Approximation, Some(path))?;
        self.measure(widened, Role::Approximation, Some(path))?;
        for bounces in [16, 8, 4, 2] {
            self.measure(short(bounces), Role::Approximation, Some(bare))?;
        }
        self.measure(less(Integrator::Direct), Role::Approximation, Some(bare))?;
        self.measure(less(Integrator::Flat), Role::Approximation, Some(bare))?;
        // The job's own configuration is compared with one that omits as little as possible apart from the job's own omissions.
        let against = if job_configuration.is_exact() {
            None
        } else {
            Some(if job_configuration.paths.caustics || job_configuration.paths.regularize { path } else { bare })
        };
        self.measure(job_configuration, Role::Stated, against)?;
        let own =
            self.measured.iter().position(|measured| measured.configuration == job_configuration).expect("looked at");
        let own = self.measured.remove(own);
        self.measured.insert(0, own);
        for configuration in self.choices_without_bias(job_configuration)? {
            self.measure_alternative(configuration, job_configuration, against)?;
        }
        Ok(())
    }

    /// Configurations with the job's own means: other wavelengths, shared and branched paths, choices of lights, acceleration structures.
    fn choices_without_bias(&self, job_configuration: Configuration) -> Result<Vec<Configuration>, Error> {
        let disperses = self.job.camera_plan(self.pilots.camera)?.disperses();
        let wavelengths = [1, 4, 8].into_iter().filter(|n| !disperses || *n == 1);
        let wavelengths = wavelengths.map(|wavelengths| Configuration { wavelengths, ..job_configuration });
        let block_sizes_px: &[u32] =
            if job_configuration.paths.integrator == Integrator::Path { &[1, 2, 4, 8] } else { &[] };
        let of_paths = |path_reuse_px, branches| Configuration {
            paths: PathSettings { branches, ..job_configuration.paths },
            path_reuse_px,
            ..job_configuration
        };
        let branches = block_sizes_px.iter().map(|branches| of_paths(1, *branches));
        let reuse = block_sizes_px.iter().map(|px| of_paths(*px, 1));
        let trees = Accelerator::WORDS
            .iter()
            .map(|(_, accelerator)| Configuration { accelerator: *accelerator, ..job_configuration });
        let lights = LightSampling::WORDS.iter().map(|(_, light_sampling)| Configuration {
            paths: PathSettings { light_sampling: *light_sampling, ..job_configuration.paths },
            ..job_configuration
        });
        Ok(wavelengths
            .chain(reuse)
            .chain(branches)
            .chain(lights)
            .chain(trees)
            .filter(|configuration| *configuration != job_configuration)
            .collect())
    }

    /// Runs a configuration with which others are compared.
    fn measure_reference(
        &mut self,
        configuration: Configuration,
        role: Role,
        against: Option<Configuration>,
    ) -> Result<(), Error> {
        let pilot = self.measure(configuration, role, against)?;
        self.pilots_by_configuration.extend(pilot.map(|pilot| (configuration, pilot)));
        Ok(())
    }

    /// Runs an unbiased alternative to the configuration `from`, whose bias it has.
    fn measure_alternative(
        &mut self,
        configuration: Configuration,
        from: Configuration,
        against: Option<Configuration>,
    ) -> Result<(), Error> {
        if self.measure(configuration, Role::Choice, against)?.is_some() {
            let bias = self.measured.iter().find(|m| m.configuration == from).map(|m| m.bias_squares);
            let alternative = self.measured.last_mut().expect("just looked at");
            alternative.bias_squares = bias.unwrap_or(alternative.bias_squares);
        }
        Ok(())
    }

    /// Runs a configuration and compares it with a stored one; returns its long pilot. A configuration runs only once.
    fn measure(
        &mut self,
        configuration: Configuration,
        role: Role,
        against: Option<Configuration>,
    ) -> Result<Option<Pilot>, Error> {
        if self.measured.iter().any(|measured| measured.configuration == configuration) {
            return Ok(None);
        }
        let (done, total) = (self.measured.len(), (TYPICAL_CONFIGURATIONS as usize).max(self.measured.len() + 1));
        let heading = configuration.label();
        self.pilots.observer.progress(Progress {
            heading: &heading,
            frame: None,
            unit: ProgressUnit::Pilots,
            done,
            total,
        });
        let clock = self.pilots.clock;
        let timer = WorkTimer::start(clock);
        let job = configuration.request(&self.request.job, self.pilots.camera).open()?;
        let load_s = timer.idle_machine_s();
        let few = self.pilots.run(&job, FEW_SAMPLES, SEEDS)?;
        let many = self.pilots.run(&job, MANY_SAMPLES, SEEDS)?;
        self.clock_s += few.clock_s + many.clock_s;
        self.processor_s += few.processor_s.iter().chain(&many.processor_s).sum::<f64>();
        if self.pixels.is_none() {
            let noise = self.job.temporal_noise(self.pilots.camera)?;
            self.pixels = Some(SampledPixels::new(&many.pixels, &many.planes, noise.as_ref()));
        }
        if self.pilots_by_configuration.first().is_some_and(|(_, first)| first.pixels != many.pixels) {
            // Blocks of pixels with shared paths are in other tiles if the filter's tile is large.
            return Ok(None);
        }
        let pixels = self.pixels.as_ref().expect("made above");
        let tile_fraction = pixel_fraction(&job, self.pilots.camera, many.pixels.len())?;
        let few_pilot = SampledPilot { spp: FEW_SAMPLES, pilot: &few };
        let estimate_many = SampledPilot { spp: MANY_SAMPLES, pilot: &many };
        let times = Times::new(few_pilot, estimate_many, tile_fraction, clock.threads());
        let exact = against.and_then(|against| {
            self.pilots_by_configuration.iter().find(|(configuration, _)| *configuration == against)
        });
        let bias = exact.map(|(against, exact)| Bias { against: *against, squares: bias(pixels, &many, exact) });
        let variance = variance(pixels, few_pilot, estimate_many);
        let bias_squares = self.total_bias(bias.as_ref(), &variance.map(|_| Estimate::default()));
        let Times { frame_s, sample_s } = times;
        self.measured.push(ConfigurationMeasurement {
            configuration,
            role,
            load_s,
            frame_s,
            sample_s,
            variance,
            bias,
            bias_squares,
        });
        Ok(Some(many))
    }

    /// Upper bound of the total bias: a bias plus that of the configuration it is compared with.
    fn total_bias(&self, own: Option<&Bias>, none: &ErrorMetrics<Estimate>) -> ErrorMetrics<Estimate> {
        let Some(own) = own else { return *none };
        let reference = self.measured.iter().find(|measured| measured.configuration == own.against);
        let own = own.squares.map(|square| Estimate { value: square.value.max(0.0), ..*square });
        match reference {
            Some(reference) => own.with(&reference.bias_squares, in_series),
            None => own,
        }
    }

    /// Time of one frame of the job excluding loading and light, s.
    fn rest_s(&self, scratch: &Path) -> Result<f64, Error> {
        let request = self.measured[0].configuration.request(&self.request.job, self.pilots.camera);
        let job = JobRequest { spp: Some(1), noise: None, ..request }.open()?;
        let options = RenderOptions { simd: self.request.simd, ..RenderOptions::default() };
        let clock = self.pilots.clock;
        let timer = WorkTimer::start(clock);
        let save_result = job.save(&options, scratch, ExistingFiles::Refuse, &etendue::NullObserver);
        let (clock_s, processor_s) = (timer.clock_s(), timer.processor_s());
        if scratch.exists() {
            std::fs::remove_dir_all(scratch)
                .map_err(|error| Error::Run(format!("{}: cannot be removed: {error}", scratch.display())))?;
        }
        save_result?;
        // Remaining wall-clock time on an idle machine, CPU time otherwise.
        let ConfigurationMeasurement { frame_s, sample_s, .. } = &self.measured[0];
        let left = |took_s: f64, threads: usize| (took_s - frame_s - sample_s.value * threads as f64).max(0.0);
        Ok(left(clock_s, 1).min(left(processor_s, clock.threads())))
    }

    /// Combines the best unbiased choices with the configurations that targets require.
    fn combine(&mut self, spp: u32, frame: FrameOverhead) -> Result<(), Error> {
        let job_configuration = self.measured[0].configuration;
        let best = |of: fn(&Configuration, &Configuration) -> Configuration| {
            let similar = self.measured.iter().filter(|m| of(&job_configuration, &m.configuration) == m.configuration);
            let cost = |m: &ConfigurationMeasurement| cost(m, &self.measured[0], spp, frame);
            let best = similar.min_by(|a, b| cost(a).total_cmp(&cost(b)));
            best.filter(|m| cost(m) < MAX_RELATIVE_COST).map_or(job_configuration, |m| m.configuration)
        };
        let wavelengths = best(|own, other| Configuration { wavelengths: other.wavelengths, ..*own }).wavelengths;
        // Paths either share their tails or branch, not both.
        let of_paths = |own: &Configuration, other: &Configuration| Configuration {
            paths: PathSettings { branches: other.paths.branches, ..own.paths },
            path_reuse_px: other.path_reuse_px,
            ..*own
        };
        let shared = best(of_paths);
        let of_lights = |own: &Configuration, other: &Configuration| Configuration {
            paths: PathSettings { light_sampling: other.paths.light_sampling, ..own.paths },
            ..*own
        };
        let light_sampling = best(of_lights).paths.light_sampling;
        let accelerator = best(|own, other| Configuration { accelerator: other.accelerator, ..*own }).accelerator;
        let has_sensor = self.measured[0].bias_squares.sensor.is_some();
        let called: Vec<_> = targets(has_sensor)
            .into_iter()
            .filter_map(|target| recommend(&self.eligible(spp, frame), target, frame))
            .map(|recommendation| recommendation.point.configuration)
            .collect();
        for configuration in called {
            let traces = configuration.paths.integrator == Integrator::Path;
            let (path_reuse_px, branches) = if traces { (shared.path_reuse_px, shared.paths.branches) } else { (1, 1) };
            let paths = PathSettings { branches, light_sampling, ..configuration.paths };
            let combined = Configuration { paths, path_reuse_px, wavelengths, accelerator };
            let base = self
                .measured
                .iter()
                .find(|m| m.configuration == configuration)
                .and_then(|m| m.bias.as_ref())
                .map(|b| b.against);
            self.measure_alternative(combined, configuration, base)?;
        }
        Ok(())
    }

    /// Configurations that may be recommended: of the choices derived from the job's own configuration those that gain both per pixel and per patch.
    fn eligible(&self, spp: u32, frame: FrameOverhead) -> Vec<ConfigurationMeasurement> {
        let job_configuration = self.measured[0].configuration;
        let is_of_own = |m: &ConfigurationMeasurement| {
            m.role == Role::Choice && m.configuration.paths.has_mean_of(&job_configuration.paths)
        };
        let gains = |m: &&ConfigurationMeasurement| !is_of_own(m) || cost(m, &self.measured[0], spp, frame) < 1.0;
        self.measured.iter().filter(gains).cloned().collect()
    }
}

/// Time times mean square of a choice over that of the job's own configuration, in the metric with the smallest gain: noise shared by neighbours is small in
/// each pixel and large in their mean.
fn cost(choice: &ConfigurationMeasurement, own: &ConfigurationMeasurement, spp: u32, frame: FrameOverhead) -> f64 {
    let replicate = f64::from(spp) / f64::from(frame.replicates);
    let time = choice.seconds(f64::from(spp), frame.rest_s).value / own.seconds(f64::from(spp), frame.rest_s).value;
    let ratios = choice.variance.with(&own.variance, |a, b| a.at(replicate).value / b.at(replicate).value);
    let variance = ratios.main_metric().max(ratios.patch);
    time * if variance.is_finite() { variance } else { 1.0 }
}
