//! Motion over time: from keys and trajectories to motions.

use super::context::{Context, ErrorCode};
use etendue_core::track::{Key, RollingError};
use etendue_core::{ExactTime, Motion, Track};
use etendue_scene::Place;
use etendue_scene::record::motion::{Course, Rolls, Trajectory, TrajectoryAxes};
use glam::DVec3;

/// Motion through `keys`, stated at `place`.
pub(super) fn through(
    keys: &[Key],
    course: Option<&Course>,
    place: &Place,
    context: &mut Context<'_>,
) -> Option<Motion> {
    let interpolation =
        course.and_then(|course| course.interpolation.as_ref()).map(|key| key.value).unwrap_or_default();
    context.accept(place, Track::new(keys, interpolation)).map(Motion::from)
}

/// Trajectory of a course.
pub(super) fn trajectory(course: Option<&Course>) -> Option<&Trajectory> {
    course?.trajectory.as_ref()
}

/// Motion through the rows of a trajectory's file.
pub(super) fn along(trajectory: &Trajectory, course: Option<&Course>, context: &mut Context<'_>) -> Option<Motion> {
    let file = &trajectory.file;
    let Some(asset) = context.assets.trajectories.get(&file.value) else {
        context.fault(ErrorCode::UnreadableFile, &file.place, "the trajectory was not loaded", "give a readable file");
        return None;
    };
    if !asset.unread.is_empty() {
        context.remark_on(file.value.display(), format!("not read: {}", asset.unread.join(", ")));
    }
    let offset = trajectory.time_offset_s.as_ref().map_or(ExactTime::default(), |offset| offset.value);
    let epoch = context.epoch;
    let axes = trajectory.axes.as_ref().map_or(TrajectoryAxes::Flu, |axes| axes.value);
    let key = |row: &_| {
        let row = axes.turned(row);
        let (position_m, rotation) = (row.position_m, row.rotation);
        Key { time_s: epoch.to(row.time + offset), position_m, rotation, scale: DVec3::ONE }
    };
    let keys: Vec<Key> = asset.rows.iter().map(key).collect();
    through(&keys, course, &file.place, context)
}

/// Rotation of a wheel in the frame of its hub.
pub(super) fn turning(hub: &Motion, rolls: &Rolls, context: &mut Context<'_>) -> Option<Motion> {
    match hub.rolling(rolls.radius_m.value) {
        Ok(turns) => Some(turns),
        Err(RollingError::Still) => {
            context.fault(
                ErrorCode::NoEffect,
                &rolls.place,
                "\"rolls\" has no effect: the wheel does not move",
                "give the wheel keys, a trajectory or a moving frame, or remove \"rolls\"",
            );
            None
        }
        Err(error @ RollingError::TooFar { .. }) => {
            context.fault(ErrorCode::OutOfRange, &rolls.radius_m.place, error.to_string(), "");
            None
        }
    }
}

/// A hub with the wheel that rolls on it; without a wheel the hub itself.
pub(super) fn rolling(hub: Motion, rolls: Option<&Rolls>, context: &mut Context<'_>) -> Option<Motion> {
    let Some(rolls) = rolls else { return Some(hub) };
    turning(&hub, rolls, context).map(|turns| hub.carrying(&turns))
}
