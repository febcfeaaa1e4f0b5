//! Pose and motion of a camera.

use etendue_core::{CameraPose, ExactTime};
use glam::{DMat3, DVec3};

use super::motion::{MotionKeys, check_motion, check_placements, trajectory_placement};
use super::transform::yaw_pitch_roll;
use crate::fault::{DescriptionErrors, ErrorCode, NameKind};
use crate::place::{Place, Placed};
use crate::reader::{keyed, list, name_of, number, record, time, vector};

record! {
    /// Pose and motion of a camera.
    pub struct Pose check(check) {
        /// Position of the entrance pupil in the world.
        optional position_m: Placed<[f64; 3]> = vector::<3>(number("m"));
        /// Viewing direction.
        group aim: Aim;
        /// With "look_at_m": direction that is up in the image. Default: +z.
        optional up: Placed<[f64; 3]> = vector::<3>(number(""));
        /// Poses over time.
        many keys: PoseKey = list(record(), 1);
        /// Motion.
        group course: MotionKeys;
        /// Frame of its positions, points and directions. Default: the world.
        optional frame: Placed<String> = name_of(NameKind::Frame);
    }
}

record! {
    /// Pose of a camera at a time.
    pub struct PoseKey check(check_key) {
        /// Simulated time.
        required time_s: Placed<ExactTime> = time();
        /// Position of the entrance pupil in the world.
        required position_m: Placed<[f64; 3]> = vector::<3>(number("m"));
        /// Viewing direction.
        inside aim: Aim;
        /// With "look_at_m": direction that is up in the image. Default: +z.
        optional up: Placed<[f64; 3]> = vector::<3>(number(""));
    }
}

keyed! {
    /// Viewing direction of a camera.
    pub enum Aim {
        /// World point in the middle of the view.
        look_at_m => LookAt(Placed<[f64; 3]>) = vector::<3>(number("m"));
        /// Yaw, pitch and roll; at 0 the camera looks along +x with +z up. Positive: left, view down, right side down.
        rotation_deg => Rotation(Placed<[f64; 3]>) = vector::<3>(number("°"));
    }
}

impl Pose {
    /// A stationary camera in the world that looks at a point.
    #[must_use]
    pub fn looking_at(position_m: [f64; 3], target_m: [f64; 3], up: [f64; 3]) -> Self {
        let aim = Some(Aim::LookAt(target_m.into()));
        Self { position_m: Some(position_m.into()), aim, up: Some(up.into()), ..Self::default() }
    }

    /// The pose in its frame, if stated; a checked record has that, keys or a trajectory.
    #[must_use]
    pub fn to_camera_pose(&self) -> Option<CameraPose> {
        pose_from_aim(self.position_m.as_ref()?, self.aim.as_ref()?, self.up.as_ref())
    }

    /// Place of the statement of its pose.
    #[must_use]
    pub fn stated_at(&self) -> &Place {
        let keys = self.keys.first().map(|key| &key.place);
        let own = self.position_m.as_ref().map(|position| &position.place);
        let motion_keys = self.course.as_ref().and_then(|motion_keys| motion_keys.trajectory.as_ref());
        own.or(keys).or(motion_keys.map(|trajectory| &trajectory.place)).unwrap_or(&self.place)
    }
}

impl PoseKey {
    /// The pose in the camera's frame; a checked record has one.
    #[must_use]
    pub fn to_camera_pose(&self) -> Option<CameraPose> {
        pose_from_aim(&self.position_m, &self.aim, self.up.as_ref())
    }
}

/// The camera's axes (x right, y down, z forward) in a frame along whose x axis it looks, with z upwards.
#[must_use]
pub fn camera_axes() -> DMat3 {
    DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X)
}

/// Returns `None` for an undefined direction: the camera looks at itself or along "up".
fn pose_from_aim(position_m: &Placed<[f64; 3]>, aim: &Aim, up: Option<&Placed<[f64; 3]>>) -> Option<CameraPose> {
    let position_m = DVec3::from_array(position_m.value);
    match aim {
        Aim::LookAt(target) => {
            let up = up.map_or(DVec3::Z, |u| DVec3::from_array(u.value));
            CameraPose::looking_at(position_m, DVec3::from_array(target.value), up)
        }
        Aim::Rotation(degrees) => {
            Some(CameraPose { position_m, rotation: yaw_pitch_roll(degrees.value) * camera_axes() })
        }
    }
}

fn check(pose: &Pose, errors: &mut DescriptionErrors) {
    let own = pose.position_m.as_ref().map(|p| ("\"position_m\"", p.place.clone()));
    let own = own.or(pose.aim.as_ref().map(|aim| ("the camera's own aim", aim.place().clone())));
    let keys = pose.keys.first().map(|key| ("\"keys\"", key.place.clone()));
    check_placements([own, keys, trajectory_placement(pose.course.as_ref())], "the camera", errors);
    check_motion(pose.course.as_ref(), pose.keys.iter().map(|key| &key.time_s), errors);
    let moves = !pose.keys.is_empty() || trajectory_placement(pose.course.as_ref()).is_some();
    match (&pose.position_m, &pose.aim) {
        (Some(position), Some(aim)) => check_aim(position, aim, pose.up.as_ref(), errors),
        _ if moves => {}
        (None, _) => errors.add(
            ErrorCode::MissingKey,
            &pose.place,
            "the key \"position_m\" is missing",
            "add it: a list of 3, each a number in m; or \"keys\" or a \"trajectory\" for a camera that moves",
        ),
        (_, None) => errors.add(
            ErrorCode::MissingKey,
            &pose.place,
            "a key is missing",
            "give one of \"look_at_m\", \"rotation_deg\"",
        ),
    }
    if let (Some(up), None) = (&pose.up, &pose.aim) {
        note_idle(up, errors);
    }
}

fn check_key(key: &PoseKey, errors: &mut DescriptionErrors) {
    check_aim(&key.position_m, &key.aim, key.up.as_ref(), errors);
}

fn check_aim(position: &Placed<[f64; 3]>, aim: &Aim, up: Option<&Placed<[f64; 3]>>, errors: &mut DescriptionErrors) {
    match (aim, up) {
        (Aim::Rotation(_), Some(up)) => note_idle(up, errors),
        (Aim::LookAt(target), _) if pose_from_aim(position, aim, up).is_none() => errors.add(
            ErrorCode::Degenerate,
            &target.place,
            "the camera looks at its own position or along \"up\"",
            "move \"look_at_m\", or give \"up\" at an angle to the view",
        ),
        _ => {}
    }
}

fn note_idle(up: &Placed<[f64; 3]>, errors: &mut DescriptionErrors) {
    errors.add(ErrorCode::NoEffect, &up.place, "\"up\" has no effect here, it belongs to \"look_at_m\"", "remove it");
}

impl Aim {
    fn place(&self) -> &Place {
        match self {
            Self::LookAt(v) | Self::Rotation(v) => &v.place,
        }
    }
}
