//! Where a camera stands and looks, or moves.

use etendue_core::{CameraPose, ExactTime};
use glam::{DMat3, DVec3};

use super::motion::{Course, check_course, check_ways, trajectory_way};
use super::transform::yaw_pitch_roll;
use crate::fault::{ErrorCode, Faults, Named};
use crate::place::{Place, Placed};
use crate::reader::{keyed, list, name_of, number, record, time, vector};

record! {
    /// Where a camera stands and looks, or moves.
    pub struct Pose check(check) {
        /// Where the centre of the entrance pupil stands in the world, m.
        optional position_m: Placed<[f64; 3]> = vector::<3>(number("m"));
        /// Where it looks.
        group aim: Aim;
        /// With "look_at_m": the direction that shall appear upwards. Default: +z.
        optional up: Placed<[f64; 3]> = vector::<3>(number(""));
        /// Where it stands and looks over time, in place of one position; one key stands still.
        many keys: PoseKey = list(record(), 1);
        /// How it moves.
        group course: Course;
        /// The frame of the scene that it is placed in, and moves with; positions, points and directions are in it. Default: the
        /// world.
        optional frame: Placed<String> = name_of(Named::Frame);
    }
}

record! {
    /// Where a camera stands and looks at a time.
    pub struct PoseKey check(check_key) {
        /// Simulated time, s.
        required time_s: Placed<ExactTime> = time();
        /// Where the centre of the entrance pupil stands in the world, m.
        required position_m: Placed<[f64; 3]> = vector::<3>(number("m"));
        /// Where it looks.
        inside aim: Aim;
        /// With "look_at_m": the direction that shall appear upwards. Default: +z.
        optional up: Placed<[f64; 3]> = vector::<3>(number(""));
    }
}

keyed! {
    /// Where a camera looks.
    pub enum Aim {
        /// The point in the middle of the view, in the world, m.
        look_at_m => LookAt(Placed<[f64; 3]>) = vector::<3>(number("m"));
        /// Yaw, pitch and roll, degrees, as for objects; at 0, 0, 0 the camera looks along +x with +z upwards. Positive
        /// yaw turns to the left, positive pitch lowers the view, positive roll lowers the right side of the camera.
        rotation_deg => Rotation(Placed<[f64; 3]>) = vector::<3>(number("°"));
    }
}

impl Pose {
    /// A camera that stands still in the world and looks at a point.
    #[must_use]
    pub fn looking_at(position_m: [f64; 3], target_m: [f64; 3], up: [f64; 3]) -> Self {
        let aim = Some(Aim::LookAt(target_m.into()));
        Self { position_m: Some(position_m.into()), aim, up: Some(up.into()), ..Self::default() }
    }

    /// Its own pose in its frame, where it states one; a record that was checked has that, keys or a trajectory.
    #[must_use]
    pub fn to_camera_pose(&self) -> Option<CameraPose> {
        of_aim(self.position_m.as_ref()?, self.aim.as_ref()?, self.up.as_ref())
    }

    /// Where it says where it is.
    #[must_use]
    pub fn stated_at(&self) -> &Place {
        let keys = self.keys.first().map(|key| &key.place);
        let own = self.position_m.as_ref().map(|position| &position.place);
        let course = self.course.as_ref().and_then(|course| course.trajectory.as_ref());
        own.or(keys).or(course.map(|trajectory| &trajectory.place)).unwrap_or(&self.place)
    }
}

impl PoseKey {
    /// The pose in the camera's frame; a record that was checked has one.
    #[must_use]
    pub fn to_camera_pose(&self) -> Option<CameraPose> {
        of_aim(&self.position_m, &self.aim, self.up.as_ref())
    }
}

/// The camera's axes (x right, y down, z forward) in a frame that it looks along the x axis of, with z upwards.
#[must_use]
pub fn camera_axes() -> DMat3 {
    DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X)
}

/// `None` where it cannot be told: the camera looks at itself or along "up".
fn of_aim(position_m: &Placed<[f64; 3]>, aim: &Aim, up: Option<&Placed<[f64; 3]>>) -> Option<CameraPose> {
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

fn check(pose: &Pose, faults: &mut Faults) {
    let own = pose.position_m.as_ref().map(|p| ("\"position_m\"", p.place.clone()));
    let own = own.or(pose.aim.as_ref().map(|aim| ("the camera's own aim", aim.place().clone())));
    let keys = pose.keys.first().map(|key| ("\"keys\"", key.place.clone()));
    check_ways([own, keys, trajectory_way(pose.course.as_ref())], "the camera", faults);
    check_course(pose.course.as_ref(), pose.keys.iter().map(|key| &key.time_s), faults);
    let moves = !pose.keys.is_empty() || trajectory_way(pose.course.as_ref()).is_some();
    match (&pose.position_m, &pose.aim) {
        (Some(position), Some(aim)) => check_aim(position, aim, pose.up.as_ref(), faults),
        _ if moves => {}
        (None, _) => faults.add(
            ErrorCode::MissingKey,
            &pose.place,
            "the key \"position_m\" is missing",
            "add it: a list of 3, each a number in m; or \"keys\" or a \"trajectory\" for a camera that moves",
        ),
        (_, None) => faults.add(
            ErrorCode::MissingKey,
            &pose.place,
            "a key is missing",
            "give one of \"look_at_m\", \"rotation_deg\"",
        ),
    }
    if let (Some(up), None) = (&pose.up, &pose.aim) {
        note_idle(up, faults);
    }
}

fn check_key(key: &PoseKey, faults: &mut Faults) {
    check_aim(&key.position_m, &key.aim, key.up.as_ref(), faults);
}

fn check_aim(position: &Placed<[f64; 3]>, aim: &Aim, up: Option<&Placed<[f64; 3]>>, faults: &mut Faults) {
    match (aim, up) {
        (Aim::Rotation(_), Some(up)) => note_idle(up, faults),
        (Aim::LookAt(target), _) if of_aim(position, aim, up).is_none() => faults.add(
            ErrorCode::Degenerate,
            &target.place,
            "the camera looks at its own position or along \"up\"",
            "move \"look_at_m\", or give \"up\" at an angle to the view",
        ),
        _ => {}
    }
}

fn note_idle(up: &Placed<[f64; 3]>, faults: &mut Faults) {
    faults.add(ErrorCode::NoEffect, &up.place, "\"up\" has no effect here, it belongs to \"look_at_m\"", "remove it");
}

impl Aim {
    fn place(&self) -> &Place {
        match self {
            Self::LookAt(v) | Self::Rotation(v) => &v.place,
        }
    }
}
