//! The names of all files of a run.

use crate::result_files::Files;
use crate::rig::asked_files;
use etendue_pipeline::plan::{CameraPlan, Plan};
use std::ops::Range;

/// The names, relative to the output folder, of all files of a plan.
pub(crate) fn file_names(plan: &Plan, frames: &Range<u32>) -> Vec<String> {
    let of_camera = |camera: &CameraPlan| {
        let names = Files::of_camera(camera, frames).into_keys().chain([Files::SIDECAR.to_owned()]);
        names.map(|name| format!("{}/{name}", camera.name)).collect::<Vec<_>>()
    };
    let rig = asked_files(plan, frames).files.into_iter().map(|(name, _)| name);
    plan.cameras.iter().flat_map(of_camera).chain(rig).collect()
}
