//! Motion over time: from keys and trajectories to motions.

use super::context::{Context, ErrorCode};
use etendue_core::track::{Key, RollingError};
use etendue_core::{ExactTime, Motion, Track};
use etendue_scene::Place;
use etendue_scene::record::motion::{MotionKeys, Trajectory, TrajectoryAxes, Wheel};
use glam::DVec3;

/// Motion through `keys`, stated at `place`.
pub(super) fn through_keys(
    keys: &[Key],
    motion_keys: Option<&MotionKeys>,
    place: &Place,
    context: &mut Context<'_>,
) -> Option<Motion> {
    let interpolation =
        motion_keys.and_then(|motion_keys| motion_keys.interpolation.as_ref()).map(|key| key.value).unwrap_or_default();
    context.accept(place, Track::new(keys, interpolation)).map(Motion::from)
}

/// Trajectory of a course.
pub(super) fn trajectory(motion_keys: Option<&MotionKeys>) -> Option<&Trajectory> {
    motion_keys?.trajectory.as_ref()
}

/// Motion through the rows of a trajectory's file.
pub(super) fn along_trajectory(
    trajectory: &Trajectory,
    motion_keys: Option<&MotionKeys>,
    context: &mut Context<'_>,
) -> Option<Motion> {
    let file = &trajectory.file;
    let Some(asset) = context.assets.trajectories.get(&file.value) else {
        context.error(ErrorCode::UnreadableFile, &file.place, "the trajectory was not loaded", "give a readable file");
        return None;
    };
    if !asset.unread.is_empty() {
        context.note_on(file.value.display(), format!("not read: {}", asset.unread.join(", ")));
    }
    let offset = trajectory.time_offset_s.as_ref().map_or(ExactTime::default(), |offset| offset.value);
    let epoch = context.epoch;
    let axes = trajectory.axes.as_ref().map_or(TrajectoryAxes::Flu, |axes| axes.value);
    let key = |row: &_| {
        let row = axes.to_standard_axes(row);
        let (position_m, rotation) = (row.position_m, row.rotation);
        Key { time_s: epoch.to(row.time + offset), position_m, rotation, scale: DVec3::ONE }
    };
    let keys: Vec<Key> = asset.rows.iter().map(key).collect();
    through_keys(&keys, motion_keys, &file.place, context)
}

/// Rotation of a wheel in the frame of its hub.
pub(super) fn wheel_rotation(hub: &Motion, rolls: &Wheel, context: &mut Context<'_>) -> Option<Motion> {
    match hub.rolling(rolls.radius_m.value) {
        Ok(turns) => Some(turns),
        Err(RollingError::Still) => {
            context.error(
                ErrorCode::NoEffect,
                &rolls.place,
                "\"rolls\" has no effect: the wheel does not move",
                "give the wheel keys, a trajectory or a moving frame, or remove \"rolls\"",
            );
            None
        }
        Err(error @ RollingError::TooFar { .. }) => {
            context.error(ErrorCode::OutOfRange, &rolls.radius_m.place, error.to_string(), "");
            None
        }
    }
}

/// A hub with the wheel that rolls on it; without a wheel the hub itself.
pub(super) fn with_wheel(hub: Motion, rolls: Option<&Wheel>, context: &mut Context<'_>) -> Option<Motion> {
    let Some(rolls) = rolls else { return Some(hub) };
    wheel_rotation(&hub, rolls, context).map(|turns| hub.carrying(&turns))
}
