//! A configuration: the part of a job's render settings that a study varies.

use etendue::{Accelerator, Integrator, Job, JobRequest, PathSettings, Word as _};
use etendue_core::words::SettingValue;
use etendue_core::{LightSampling, Setting};
use serde::{Serialize, Serializer};

/// The part of a camera's render settings that a study varies, without the number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configuration {
    /// Light paths that are simulated.
    pub paths: PathSettings,
    /// Side of the blocks of pixels that share the tails of their paths, px; only for paths.
    pub path_reuse_px: u32,
    /// Wavelengths per path.
    pub wavelengths: u32,
    /// Build of the acceleration structures.
    pub accelerator: Accelerator,
}

impl Configuration {
    /// Configuration of a camera of a job.
    ///
    /// # Errors
    /// The job cannot be read or has no such camera.
    pub(crate) fn new(job: &Job, camera: &str) -> Result<Self, etendue::Error> {
        let settings = job.camera_plan(camera)?.settings;
        Ok(Self {
            paths: settings.paths,
            path_reuse_px: settings.blocks.side_px(),
            wavelengths: settings.wavelengths,
            accelerator: job.request().stated_render(camera)?.accelerator,
        })
    }

    /// The settings by their keys in `[render]`.
    pub(crate) fn settings(&self) -> Vec<Setting> {
        let own = [
            Setting::path_only("path_reuse_px", self.path_reuse_px.into()),
            Setting::new("wavelengths_per_path", self.wavelengths.into()),
            Setting::new("accelerator", SettingValue::Word(self.accelerator.word())),
        ];
        self.paths.stated().into_iter().chain(own).collect()
    }

    /// Keys of `[render]` for this configuration, with their values in TOML; keys without effect are omitted.
    #[must_use]
    pub fn keys(&self) -> Vec<(&'static str, String)> {
        let traces = self.paths.integrator == Integrator::Path;
        // Guiding learns over whole images, but a study renders parts of them.
        let guiding = Setting::path_only("guiding", false.into());
        let settings = self.settings().into_iter().chain([guiding]);
        let in_force = settings.filter(|setting| traces || !setting.is_path_only);
        in_force.map(|setting| (setting.key, setting.value.to_string())).collect()
    }

    /// The job with this configuration; the caller states the samples.
    pub(crate) fn request(&self, job: &JobRequest, camera: &str) -> JobRequest {
        let mut request = without_keys(job, camera, &studied_keys());
        request.integrator = Some(self.paths.integrator);
        let keys = self.keys().into_iter().filter(|(key, _)| *key != "integrator");
        request.set.extend(keys.map(|(key, value)| format!("cameras.{camera}.render.{key}={value}")));
        request.camera = Some(camera.to_owned());
        request
    }

    /// A short label.
    #[must_use]
    pub fn label(&self) -> String {
        let accelerator = match self.accelerator {
            Accelerator::Default => String::new(),
            other => format!(", {} accelerator", other.word()),
        };
        let paths = &self.paths;
        let lights = if paths.light_sampling == LightSampling::Irradiance { ", lights by irradiance" } else { "" };
        let wavelengths = format!("{} λ{lights}", self.wavelengths);
        if paths.integrator != Integrator::Path {
            return format!("{}, {wavelengths}{accelerator}", paths.integrator.word());
        }
        let caustics = if paths.caustics { "caustics" } else { "no caustics" };
        let lobes = if paths.regularize { ", widened lobes" } else { "" };
        let branches = if paths.branches == 1 { String::new() } else { format!(", {} branches", paths.branches) };
        let reuse = if self.path_reuse_px == 1 { String::new() } else { format!(", reuse {} px", self.path_reuse_px) };
        format!("path, {} bounces, {caustics}{lobes}{branches}{reuse}, {wavelengths}{accelerator}", paths.max_bounces)
    }

    /// Returns true if all light of the exact form is simulated: the configuration is unbiased.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        let paths = &self.paths;
        paths.integrator == Integrator::Path
            && paths.caustics
            && !paths.regularize
            && paths.max_bounces >= EXACT_BOUNCES
    }

    /// Omissions relative to the exact form, as text.
    #[must_use]
    pub fn left_out(&self) -> String {
        let paths = &self.paths;
        match paths.integrator {
            Integrator::Flat => "shadows and all light from other surfaces".to_owned(),
            Integrator::Direct => "all light from other surfaces".to_owned(),
            Integrator::Path => {
                let bounces = (paths.max_bounces < EXACT_BOUNCES)
                    .then(|| format!("light after more than {} bounces", paths.max_bounces));
                let caustics = (!paths.caustics).then(|| "caustics of lights".to_owned());
                let lobes = paths.regularize.then(|| "the narrowness of lobes behind wider ones".to_owned());
                bounces.into_iter().chain(caustics).chain(lobes).collect::<Vec<_>>().join(" and ")
            }
        }
    }
}

/// Serialises the settings as an object.
impl Serialize for Configuration {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.settings().into_iter().map(|setting| (report_name(setting.key), setting.value)))
    }
}

/// Name of a setting in a study's report.
fn report_name(key: &'static str) -> &'static str {
    if key == "wavelengths_per_path" { "wavelengths" } else { key }
}

/// Keys of `[render]` that a study states itself: those of its configurations, and those of samples.
pub(crate) fn studied_keys() -> Vec<&'static str> {
    let default = Configuration {
        paths: PathSettings::default(),
        path_reuse_px: 1,
        wavelengths: 4,
        accelerator: Accelerator::Default,
    };
    default.keys().into_iter().map(|(key, _)| key).chain(SAMPLE_KEYS).collect()
}

/// Keys of `[render]` that determine the number of samples.
pub(crate) const SAMPLE_KEYS: [&str; 6] = ["spp", "noise_threshold", "min_spp", "max_spp", "passes", "replicates"];

/// Returns true if a change, `key=value`, is of one of these keys of `[render]`, of all cameras or of this one.
pub(crate) fn is_of(change: &str, camera: &str, keys: &[&str]) -> bool {
    let key = change.split('=').next().unwrap_or_default().trim();
    let own = format!("cameras.{camera}.render.");
    let key = key.strip_prefix("render.").or_else(|| key.strip_prefix(&own));
    key.is_some_and(|key| keys.contains(&key))
}

/// A job without its changes of some keys of `[render]`.
pub(crate) fn without_keys(job: &JobRequest, camera: &str, keys: &[&str]) -> JobRequest {
    let mut job = job.clone();
    job.set.retain(|change| !is_of(change, camera, keys));
    job
}

/// Bounces of the exact form: Russian roulette has ended nearly every path by then; a job with more bounces keeps its own number.
pub(crate) const EXACT_BOUNCES: u32 = 64;
