//! Estimated CPU time and memory of a frame of a camera.
//!
//! The time per path is that of the street scene (docs/evidence/performance.md): in other scenes it is from a tenth of that to three times as long.

use super::cpu_time::{self, FilmWork, branches_fraction, path_cpu_s};
use crate::plan::{CameraPlan, Plan};
use crate::render::training;
use crate::report::FilmBytes;

/// Estimated cost of a frame of a camera.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameCost {
    /// Number of traced paths, including those that train the guiding; a lower bound for noise-limited sampling. 0 if another camera provides the light.
    pub paths: f64,
    /// CPU time of these paths at the rate of the street scene, s.
    pub paths_cpu_s: f64,
    /// Work on the finished film; parts that the camera does not have take no time.
    pub parts: Vec<FilmWork>,
    /// Bytes of the film in memory and on disk.
    pub film: FilmBytes,
    /// True if more than the minimum of samples may be needed.
    pub is_lower_bound: bool,
}

impl FrameCost {
    /// Cost of a frame of a camera of the plan.
    #[must_use]
    pub fn new(plan: &Plan, camera: &CameraPlan) -> Self {
        let (width, height) = camera.film_size();
        let settings = &camera.settings;
        let is_served = plan.cameras.iter().any(|other| other.light == camera.light && other.index < camera.index);
        let samples = settings.adaptive.map_or(settings.spp, |limit| limit.min_spp);
        let guiding = if settings.guiding { training::paths_of(camera) as f64 } else { 0.0 };
        let own = f64::from(width) * f64::from(height) * f64::from(samples);
        let (own, guiding) = if is_served { (0.0, 0.0) } else { (own, guiding) };
        Self {
            paths: own + guiding,
            // Paths that train the guiding do not branch.
            paths_cpu_s: (own * (1.0 + branches_fraction(camera)) + guiding) * path_cpu_s(camera),
            parts: cpu_time::film_work(plan, camera),
            film: plan.film_bytes(camera),
            is_lower_bound: settings.adaptive.is_some(),
        }
    }

    /// CPU time of the whole frame, s.
    #[must_use]
    pub fn cpu_s(&self) -> f64 {
        self.paths_cpu_s + self.film_cpu_s()
    }

    /// CPU time of the work on the film, s.
    #[must_use]
    pub fn film_cpu_s(&self) -> f64 {
        self.parts.iter().map(|part| part.cpu_s).sum()
    }
}
