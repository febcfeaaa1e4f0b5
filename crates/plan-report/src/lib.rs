//! The report of a plan (`etendue plan --json`, field by field in docs/plan.md), and what results and camera files state of a camera: the facts of a
//! side-car, the keys of a calibration, tone curves. A camera file is opened here.

pub mod calibration;
mod camera;
pub mod camera_facts;
mod camera_file;
mod effect;
mod memory;
mod remark;
mod scene;
pub mod tone_curve;

use etendue_pipeline::Plan;
use std::path::{Path, PathBuf};

pub use camera::{CameraReport, CostReport, FilmPart, LensSummary, LightsReport};
pub use camera_file::open_camera;
pub use effect::{EffectReport, IfDroppedReport, Need};
pub use memory::{CameraMemoryReport, MemoryReport, StageReport};
pub use remark::{RemarkReport, RemarkWeight};
pub use scene::{SceneReport, SkyReport};

/// What a job's plan says. What is not known is `None`, null in JSON.
#[derive(Clone, Debug, serde::Serialize)]
pub struct PlanReport {
    /// The program's version.
    pub version: &'static str,
    /// The job file.
    pub job: PathBuf,
    /// The plan's hash, hexadecimal: equal plans give equal bytes.
    pub hash: String,
    /// What there is to see.
    pub scene: SceneReport,
    /// The cameras of the job, or the one that was asked for.
    pub cameras: Vec<CameraReport>,
    /// The memory of the whole run.
    pub memory: MemoryReport,
    /// What compiling found that is no fault, equal ones once.
    pub remarks: Vec<RemarkReport>,
    /// What a rendering repeats of them, and of the lights, in sentences.
    pub warnings: Vec<String>,
    /// What the command line supersedes of the job file, in sentences.
    pub notices: Vec<String>,
}

impl PlanReport {
    /// Of the plan of a job file.
    pub fn of(job: &Path, plan: &Plan) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION"),
            job: job.to_owned(),
            hash: plan.hash_text(),
            scene: SceneReport::of(plan),
            cameras: plan.cameras.iter().map(|camera| CameraReport::of(plan, camera)).collect(),
            memory: MemoryReport::of(plan),
            remarks: RemarkReport::all(plan),
            warnings: plan.warnings(),
            notices: plan.notices.clone(),
        }
    }
}
