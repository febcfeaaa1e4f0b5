//! Where a camera stands and looks.

use etendue_core::CameraPose;
use glam::{DMat3, DVec3};

use super::transform::yaw_pitch_roll;
use crate::fault::Faults;
use crate::place::Placed;
use crate::reader::{keyed, number, record, vector};

record! {
    /// Where a camera stands and looks.
    pub struct Pose check(check) {
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
    /// The pose in the world; `None` where it cannot be told: the camera looks at itself or along "up". A record that
    /// was checked has a pose.
    #[must_use]
    pub fn to_camera_pose(&self) -> Option<CameraPose> {
        let position_m = DVec3::from_array(self.position_m.value);
        match &self.aim {
            Aim::LookAt(target) => {
                let up = self.up.as_ref().map_or(DVec3::Z, |u| DVec3::from_array(u.value));
                CameraPose::looking_at(position_m, DVec3::from_array(target.value), up)
            }
            Aim::Rotation(degrees) => {
                let axes = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X);
                Some(CameraPose { position_m, rotation: yaw_pitch_roll(degrees.value) * axes })
            }
        }
    }
}

fn check(pose: &Pose, faults: &mut Faults) {
    match (&pose.aim, &pose.up) {
        (Aim::Rotation(_), Some(up)) => {
            faults.add(&up.place, "\"up\" has no effect here, it belongs to \"look_at_m\"", "remove it");
        }
        (Aim::LookAt(target), _) if pose.to_camera_pose().is_none() => faults.add(
            &target.place,
            "the camera looks at its own position or along \"up\"",
            "move \"look_at_m\", or give \"up\" at an angle to the view",
        ),
        _ => {}
    }
}
