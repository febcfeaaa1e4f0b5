//! Camera poses over time: from records to paths.

use super::context::Context;
use super::course::{along_trajectory, through_keys, trajectory};
use super::frames::Frames;
use crate::plan::Mount;
use etendue_core::track::Key;
use etendue_core::{CameraPath, CameraPose, Motion};
use etendue_scene::record::Pose;
use etendue_scene::record::pose::{PoseKey, camera_axes};
use glam::{DAffine3, DQuat, DVec3};

/// Path of a camera; `None` if it is invalid.
pub(super) fn camera_path(pose: &Pose, frames: &Frames<'_>, context: &mut Context<'_>) -> Option<CameraPath> {
    let motion_keys = pose.course.as_ref();
    let own = match (trajectory(motion_keys), &pose.keys[..]) {
        (Some(file), _) => along_trajectory(file, motion_keys, context)?.after(&DAffine3::from_mat3(camera_axes())),
        // Poses in a loaded description have been checked.
        (None, []) => still(&pose.to_camera_pose()?),
        (None, [only]) => still(&only.to_camera_pose()?),
        (None, keys) => {
            let keys: Vec<Key> = keys.iter().map(|k| key(k, context)).collect::<Option<_>>()?;
            through_keys(&keys, motion_keys, pose.stated_at(), context)?
        }
    };
    Some(CameraPath::moving(frames.world_motion(pose.frame.as_ref(), own)))
}

/// Frame that carries a camera, and its pose there.
pub(super) fn mount(pose: &Pose) -> Mount {
    let fixed = match (trajectory(pose.course.as_ref()), &pose.keys[..]) {
        (Some(_), _) => None,
        (None, []) => pose.to_camera_pose(),
        (None, [only]) => only.to_camera_pose(),
        (None, _) => None,
    };
    Mount { frame: pose.frame.as_ref().map(|name| name.value.clone()), pose: fixed }
}

fn still(pose: &CameraPose) -> Motion {
    Motion::constant(DAffine3::from_mat3_translation(pose.rotation, pose.position_m))
}

fn key(key: &PoseKey, context: &mut Context<'_>) -> Option<Key> {
    let CameraPose { position_m, rotation } = key.to_camera_pose()?;
    let rotation = DQuat::from_mat3(&rotation);
    Some(Key { time_s: context.since_epoch_s(&key.time_s), position_m, rotation, scale: DVec3::ONE })
}
