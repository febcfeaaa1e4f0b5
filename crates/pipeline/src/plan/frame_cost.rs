//! The processor time and memory that a frame of a camera is foretold to take.
//!
//! Paths are those of the street scene (docs/performance.md): other scenes' take from a tenth of it to three times as long.

use super::film_cost::{self, Share};
use crate::plan::{CameraPlan, Plan};
use crate::render::film::Film;
use crate::render::layout;
use etendue_tracer::integrator::Level;

/// A path of the street scene (docs/performance.md).
pub(crate) const PATH_CPU_S: f64 = 3e-6;
/// The same of at most two bounces, with direct light alone, and without its shadows: shares of a whole path, by street.toml with max_bounces 6 and 2
/// and the integrators direct and flat (docs/plan.md).
pub(crate) const TWO_BOUNCES_CPU_S: f64 = 0.74 * PATH_CPU_S;
pub(crate) const DIRECT_PATH_CPU_S: f64 = 0.50 * PATH_CPU_S;
pub(crate) const FLAT_PATH_CPU_S: f64 = 0.34 * PATH_CPU_S;

/// What a frame of a camera is foretold to take.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameCost {
    /// Paths that are traced; where noise decides, the fewest. 0 where another camera's light serves.
    pub paths: f64,
    /// Processor time of these paths at the street's rate, s.
    pub paths_cpu_s: f64,
    /// What is done on the finished film; parts that the camera does not have take no time.
    pub parts: Vec<Share>,
    /// Memory of the film, bytes.
    pub film_bytes: f64,
    /// Whether more samples than the fewest may be needed.
    pub is_lower_bound: bool,
}

impl FrameCost {
    /// Of a frame of a camera of the plan.
    #[must_use]
    pub fn of(plan: &Plan, camera: &CameraPlan) -> Self {
        let (width, height) = camera.film_size();
        let settings = &camera.settings;
        let is_served = plan.cameras.iter().any(|other| other.light == camera.light && other.index < camera.index);
        let samples = settings.adaptive.map_or(settings.spp, |limit| limit.min_spp);
        let paths = if is_served { 0.0 } else { f64::from(width) * f64::from(height) * f64::from(samples) };
        Self {
            paths,
            paths_cpu_s: paths * path_cpu_s(camera),
            parts: film_cost::shares(plan, camera),
            film_bytes: Film::bytes(width as usize, height as usize, &layout(camera)),
            is_lower_bound: settings.adaptive.is_some(),
        }
    }

    /// Processor time of the whole frame, s.
    #[must_use]
    pub fn cpu_s(&self) -> f64 {
        self.paths_cpu_s + self.film_cpu_s()
    }

    /// Processor time of what is done on the film, s.
    #[must_use]
    pub fn film_cpu_s(&self) -> f64 {
        self.parts.iter().map(|part| part.cpu_s).sum()
    }
}

/// Processor time of a path by the integrator and bounces of a camera, s.
pub(crate) fn path_cpu_s(camera: &CameraPlan) -> f64 {
    match (camera.settings.level, camera.settings.max_bounces) {
        (Level::Flat, _) => FLAT_PATH_CPU_S,
        (Level::Direct, _) | (Level::Path, 1) => DIRECT_PATH_CPU_S,
        (Level::Path, 2) => TWO_BOUNCES_CPU_S,
        (Level::Path, _) => PATH_CPU_S,
    }
}
