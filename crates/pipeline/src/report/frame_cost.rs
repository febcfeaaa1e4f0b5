//! The processor time and memory that a frame of a camera is foretold to take.
//!
//! Paths are those of the street scene (docs/performance.md): other scenes' take from a tenth of it to three times as long.

use super::cpu_time::{self, Share, branches_share, path_cpu_s};
use crate::plan::{CameraPlan, Plan};
use crate::render::training;
use crate::report::FilmBytes;

/// What a frame of a camera is foretold to take.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameCost {
    /// Paths that are traced, with those that learn before the picture; where noise decides, the fewest. 0 where another camera's light serves.
    pub paths: f64,
    /// Processor time of these paths at the street's rate, s.
    pub paths_cpu_s: f64,
    /// What is done on the finished film; parts that the camera does not have take no time.
    pub parts: Vec<Share>,
    /// What the film takes in memory and on the disk.
    pub film: FilmBytes,
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
        let guiding = if settings.guiding { training::paths_of(camera) as f64 } else { 0.0 };
        let own = f64::from(width) * f64::from(height) * f64::from(samples);
        let (own, guiding) = if is_served { (0.0, 0.0) } else { (own, guiding) };
        Self {
            paths: own + guiding,
            // Paths that learn do not branch.
            paths_cpu_s: (own * (1.0 + branches_share(camera)) + guiding) * path_cpu_s(camera),
            parts: cpu_time::shares(plan, camera),
            film: plan.film_bytes(camera),
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
