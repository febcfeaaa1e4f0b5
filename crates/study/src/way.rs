//! A way to render: what of a job's rendering a study changes.

use etendue::{Integrator, Job, JobRequest};
use serde::Serialize;

/// How much work goes into the bounding-volume hierarchies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Accelerator {
    /// Built quickly.
    Fast,
    /// As usual.
    Default,
    /// Built for many rays.
    Best,
}

impl Accelerator {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Default, Self::Best];

    /// Its word in the key `render.accelerator`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Default => "default",
            Self::Best => "best",
        }
    }
}

/// What of a camera's rendering a study changes; samples come on top.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct WayToRender {
    /// How much of the light's ways is followed.
    pub integrator: Integrator,
    /// Greatest number of scattering events; of paths only.
    pub max_bounces: u32,
    /// Whether caustics of lamps are followed; of paths only.
    pub caustics: bool,
    /// Whether lobes are widened that come after wider ones; of paths only.
    pub regularize: bool,
    /// How many paths go on, and lights are drawn, at the first surface of a sample; of paths only.
    pub branches: u32,
    /// Side of the squares of pixels that share the tails of their paths; of paths only.
    pub path_reuse_px: u32,
    /// What lights are drawn by: "gloss" or "irradiance".
    pub light_sampling: &'static str,
    /// Wavelengths a path.
    pub wavelengths: u32,
    /// How the hierarchies are built.
    pub accelerator: Accelerator,
}

impl WayToRender {
    /// That of a camera of a job.
    ///
    /// # Errors
    /// Where the job cannot be read or has no such camera.
    pub(crate) fn of(job: &Job, camera: &str) -> Result<Self, etendue::Error> {
        let settings = job.render_settings(camera)?;
        let word = job.request().stated_render(camera)?.accelerator;
        Ok(Self {
            integrator: settings.integrator,
            max_bounces: settings.max_bounces,
            caustics: settings.caustics,
            regularize: settings.regularize,
            branches: settings.branches,
            path_reuse_px: settings.path_reuse_px,
            light_sampling: settings.light_sampling,
            wavelengths: settings.wavelengths,
            accelerator: Accelerator::ALL.into_iter().find(|a| a.name() == word).unwrap_or(Accelerator::Default),
        })
    }

    /// The keys of `[render]` that say it, with their values as TOML writes them: none that has no effect.
    #[must_use]
    pub fn keys(&self) -> Vec<(&'static str, String)> {
        let mut keys = vec![("integrator", format!("\"{}\"", self.integrator.name()))];
        if self.integrator == Integrator::Path {
            keys.push(("max_bounces", self.max_bounces.to_string()));
            keys.push(("caustics", self.caustics.to_string()));
            keys.push(("regularize", self.regularize.to_string()));
            // What it learns belongs to whole pictures, of which a study renders parts.
            keys.push(("guiding", "false".to_owned()));
            keys.push(("branches", self.branches.to_string()));
            keys.push(("path_reuse_px", self.path_reuse_px.to_string()));
        }
        keys.push(("light_sampling", format!("\"{}\"", self.light_sampling)));
        keys.push(("wavelengths_per_path", self.wavelengths.to_string()));
        keys.push(("accelerator", format!("\"{}\"", self.accelerator.name())));
        keys
    }

    /// The job rendered so, with samples that the caller says.
    pub(crate) fn request(&self, job: &JobRequest, camera: &str) -> JobRequest {
        let mut request = without_keys(job, camera, &[&SAMPLE_KEYS[..], &WAY_KEYS[..]].concat());
        request.integrator = Some(self.integrator);
        let keys = self.keys().into_iter().filter(|(key, _)| *key != "integrator");
        request.set.extend(keys.map(|(key, value)| format!("cameras.{camera}.render.{key}={value}")));
        request.camera = Some(camera.to_owned());
        request
    }

    /// In a few words.
    #[must_use]
    pub fn label(&self) -> String {
        let accelerator = match self.accelerator {
            Accelerator::Default => String::new(),
            other => format!(", {} accelerator", other.name()),
        };
        let lights = if self.light_sampling == BLIND { ", lights by irradiance" } else { "" };
        let wavelengths = format!("{} λ{lights}", self.wavelengths);
        if self.integrator != Integrator::Path {
            return format!("{}, {wavelengths}{accelerator}", self.integrator.name());
        }
        let caustics = if self.caustics { "caustics" } else { "no caustics" };
        let lobes = if self.regularize { ", widened lobes" } else { "" };
        let branches = if self.branches == 1 { String::new() } else { format!(", {} branches", self.branches) };
        let reuse = if self.path_reuse_px == 1 { String::new() } else { format!(", reuse {} px", self.path_reuse_px) };
        format!("path, {} bounces, {caustics}{lobes}{branches}{reuse}, {wavelengths}{accelerator}", self.max_bounces)
    }

    /// Whether it follows all the light that the exact form follows: it has no bias.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.integrator == Integrator::Path && self.caustics && !self.regularize && self.max_bounces >= EXACT_BOUNCES
    }

    /// What it leaves out of the exact form, in words.
    #[must_use]
    pub fn left_out(&self) -> String {
        match self.integrator {
            Integrator::Flat => "shadows and all light from other surfaces".to_owned(),
            Integrator::Direct => "all light from other surfaces".to_owned(),
            Integrator::Path => {
                let bounces = (self.max_bounces < EXACT_BOUNCES)
                    .then(|| format!("light after more than {} bounces", self.max_bounces));
                let caustics = (!self.caustics).then(|| "caustics of lamps".to_owned());
                let lobes = self.regularize.then(|| "how narrow lobes behind wider ones are".to_owned());
                bounces.into_iter().chain(caustics).chain(lobes).collect::<Vec<_>>().join(" and ")
            }
        }
    }
}

/// The choice of lights that does not know gloss.
const BLIND: &str = "irradiance";
/// What lights can be drawn by.
pub(crate) const LIGHT_SAMPLINGS: [&str; 2] = ["gloss", BLIND];

/// Keys of `[render]` that say a way.
pub(crate) const WAY_KEYS: [&str; 10] = [
    "integrator",
    "max_bounces",
    "caustics",
    "regularize",
    "guiding",
    "branches",
    "path_reuse_px",
    "light_sampling",
    "wavelengths_per_path",
    "accelerator",
];
/// Keys of `[render]` that say how many samples there are.
pub(crate) const SAMPLE_KEYS: [&str; 6] = ["spp", "noise_threshold", "min_spp", "max_spp", "passes", "replicates"];

/// Whether a change, `key=value`, is of one of these keys of `[render]`, of all cameras or of this one.
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

/// Bounces of the exact form: Russian roulette has ended nearly every path before, and a job that asks for more keeps its own.
pub(crate) const EXACT_BOUNCES: u32 = 64;
