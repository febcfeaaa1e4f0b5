//! The memory of a run in a plan.

use etendue_pipeline::Plan;
use etendue_pipeline::plan::RunMemory;

/// The memory of the whole run on four threads, bytes.
#[derive(Clone, Debug, serde::Serialize)]
pub struct MemoryReport {
    /// At most: the program, the scene and the camera that takes most.
    pub bytes: f64,
    /// Of the program before a job is read.
    pub program_bytes: f64,
    /// Of meshes, their trees and textures.
    pub scene_bytes: f64,
    /// Of each camera.
    pub cameras: Vec<CameraMemoryReport>,
}

/// The memory of a camera, bytes.
#[derive(Clone, Debug, serde::Serialize)]
pub struct CameraMemoryReport {
    /// Its name.
    pub name: String,
    /// At most.
    pub bytes: f64,
    /// Of its stages, each with all that is held at that time; those that take nothing are left out.
    pub stages: Vec<StageReport>,
}

/// The memory of a stage of a camera's work.
#[derive(Clone, Debug, serde::Serialize)]
pub struct StageReport {
    /// What is done, after "while".
    pub stage: &'static str,
    /// Bytes.
    pub bytes: f64,
}

impl MemoryReport {
    pub(super) fn of(plan: &Plan) -> Self {
        let memory = RunMemory::planned(plan);
        let cameras = memory.cameras.iter().map(|(name, camera)| {
            let stages = camera.stages.iter().filter(|stage| stage.bytes > 0.0);
            CameraMemoryReport {
                name: name.clone(),
                bytes: camera.most().bytes,
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
    use etendue_pipeline::plan::ROWS_WAITING_BYTES;

    /// The pipeline cannot see the crate that writes files.
    #[test]
    fn as_many_rows_wait_to_be_written_as_plans_count() {
        assert_eq!(etendue_io::exr::WAITING_BYTES, ROWS_WAITING_BYTES);
    }
}
