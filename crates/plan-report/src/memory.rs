//! Memory of a run in a plan.

use etendue_pipeline::Plan;
use etendue_pipeline::report::RunMemory;

/// Memory of the whole run on four threads, bytes.
#[derive(Clone, Debug, serde::Serialize)]
pub struct MemoryReport {
    /// Peak: the sum of the program, the scene and the camera with the largest peak.
    pub bytes: f64,
    /// Memory of the program before a job is read.
    pub program_bytes: f64,
    /// Memory of meshes, their acceleration structures and textures.
    pub scene_bytes: f64,
    /// Memory of each camera.
    pub cameras: Vec<CameraMemoryReport>,
}

/// The memory of a camera, bytes.
#[derive(Clone, Debug, serde::Serialize)]
pub struct CameraMemoryReport {
    pub name: String,
    /// Peak.
    pub bytes: f64,
    /// Memory of each stage, with everything stored during it; stages without memory are omitted.
    pub stages: Vec<StageReport>,
}

/// The memory of a stage of a camera's work.
#[derive(Clone, Debug, serde::Serialize)]
pub struct StageReport {
    /// Description of the stage, worded to follow "while".
    pub stage: &'static str,
    pub bytes: f64,
}

impl MemoryReport {
    pub(super) fn new(plan: &Plan) -> Self {
        let memory = RunMemory::from_plan(plan);
        let cameras = memory.cameras.iter().map(|(name, camera)| {
            let stages = camera.stages.iter().filter(|stage| stage.bytes > 0.0);
            CameraMemoryReport {
                name: name.clone(),
                bytes: camera.peak_stage().bytes,
                stages: stages.map(|stage| StageReport { stage: stage.stage, bytes: stage.bytes }).collect(),
            }
        });
        Self {
            bytes: memory.bytes(),
            program_bytes: memory.program,
            scene_bytes: memory.scene,
            cameras: cameras.collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use etendue_pipeline::report::ROWS_WAITING_BYTES;

    /// The constant is repeated in the pipeline, which cannot use that of `etendue_io`.
    #[test]
    fn plans_count_the_rows_that_wait_to_be_written() {
        assert_eq!(etendue_io::exr::WAITING_BYTES, ROWS_WAITING_BYTES);
    }
}
