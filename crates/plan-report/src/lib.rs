//! The report of a plan (`etendue plan --json`, field by field in docs/plan.md), and facts of a camera in results and camera files: the facts of a side-car,
//! the keys of a calibration, tone curves. Also opens camera files.

pub mod calibration;
mod camera;
pub mod camera_facts;
mod camera_file;
mod effect;
mod memory;
mod note;
mod scene;
pub mod tone_curve;

use etendue_pipeline::Plan;
use std::path::{Path, PathBuf};

pub use camera::{CameraReport, CostReport, FilmPart, LensSummary, LightsReport};
pub use camera_file::open_camera;
pub use effect::{EffectReport, EffectStatusReport, OmissionReport};
pub use memory::{CameraMemoryReport, MemoryReport, StageReport};
pub use note::{NoteReport, NoteSeverity};
pub use scene::{SceneReport, SkyReport};

/// Report of a job's plan. Unknown values are `None`, null in JSON.
#[derive(Clone, Debug, serde::Serialize)]
pub struct PlanReport {
    /// The program's version.
    pub version: &'static str,
    /// The job file.
    pub job: PathBuf,
    /// The plan's hash, hexadecimal: equal plans give equal bytes.
    pub hash: String,
    /// Content of the scene.
    pub scene: SceneReport,
    /// The cameras of the job, or the requested one.
    pub cameras: Vec<CameraReport>,
    /// Memory of the whole run.
    pub memory: MemoryReport,
    /// Notes and warnings of compilation, without duplicates.
    #[serde(rename = "remarks")]
    pub notes: Vec<NoteReport>,
    /// Warnings that a render repeats from them, and warnings of the lights, as sentences.
    pub warnings: Vec<String>,
    /// Settings of the job file overridden by the command line, as sentences.
    pub notices: Vec<String>,
}

impl PlanReport {
    /// Report of the plan of a job file.
    pub fn new(job: &Path, plan: &Plan) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION"),
            job: job.to_owned(),
            hash: plan.hash_text(),
            scene: SceneReport::new(plan),
            cameras: plan.cameras.iter().map(|camera| CameraReport::new(plan, camera)).collect(),
            memory: MemoryReport::new(plan),
            notes: NoteReport::notes_of_plan(plan),
            warnings: plan.warnings(),
            notices: plan.overridden_keys.clone(),
        }
    }
}
