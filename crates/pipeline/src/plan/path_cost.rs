//! The processor time of a path.

use crate::plan::CameraPlan;
use etendue_tracer::integrator::Level;

/// A path of the street scene (docs/performance.md).
pub(crate) const PATH_CPU_S: f64 = 2.2e-6;
/// The same of at most two bounces, with direct light alone, and without its shadows: shares of a whole path, by street.toml with max_bounces 6 and 2
/// and the integrators direct and flat (docs/plan.md).
pub(crate) const TWO_BOUNCES_CPU_S: f64 = 0.95 * PATH_CPU_S;
pub(crate) const DIRECT_PATH_CPU_S: f64 = 0.70 * PATH_CPU_S;
pub(crate) const FLAT_PATH_CPU_S: f64 = 0.57 * PATH_CPU_S;

/// Processor time of a path by the integrator and bounces of a camera, s.
pub(crate) fn path_cpu_s(camera: &CameraPlan) -> f64 {
    match (camera.settings.level, camera.settings.max_bounces) {
        (Level::Flat, _) => FLAT_PATH_CPU_S,
        (Level::Direct, _) | (Level::Path, 1) => DIRECT_PATH_CPU_S,
        (Level::Path, 2) => TWO_BOUNCES_CPU_S,
        (Level::Path, _) => PATH_CPU_S,
    }
}

/// What one branch more takes, as a share of the path: 0.52 to 0.57 in the wet night, 0.69 in the Cornell box (docs/decisions/branching.md).
const BRANCH: f64 = 0.6;

/// What all branches of a path beside its first take, as a share of the path.
pub(crate) fn branches_share(camera: &CameraPlan) -> f64 {
    f64::from(camera.settings.branches - 1) * BRANCH
}
