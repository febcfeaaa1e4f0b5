//! ASAM OSI 3.8.0: `osi/SPLIT/TIME_gt_380_6302_FRAMES_NNNNNN.osi`, a trace a sample: for each frame a `GroundTruth` behind its length (four bytes, little-endian).
//!
//! - Names follow OSI's convention ([`name`]): the time of the first frame, counted from 1970 as the messages' own, so that no clock is in them; the version of the messages; 6.30.2, the
//!   version of protobuf that osi-python 3.8.0 is made with and asks for; how many frames; and the sample's number as the name of the trace.
//! - Objects are all of the world with a class, seen or not, by their identities: those that a class or their motion makes movers as `moving_object`, others as `stationary_object`, by the lists of [`kind`];
//!   `source_reference` has their names. Surfaces (road, terrain …) and the sky have no box.
//! - The frame of the ground truth is the scene's (x forward, y left, z up, m); position is the middle of the object's box, whose length, width and height are along the object's own x, y and z; orientation turns
//!   about z (yaw), then y (pitch), then x (roll), rad.
//! - The time is half-way through the exposure of the first camera that the job lists.
//! - Left out: the host vehicle, accelerations and rates of turning, lanes and markings, what signs and lights mean (they are stationary objects of type other), occupants, environment.

mod kind;
mod name;
mod wire;

use super::writer::{Writer, write};
use crate::picture::Picture;
use crate::record::SampleRecord;
use crate::records::Records;
use crate::set::Set;
use etendue::{Error, OutputFolder, WorldObject};
use etendue_core::ExactTime;
use etendue_core::maths::f64::atan2;
use glam::{DMat3, DVec3};
use kind::Kind;
use std::cell::RefCell;
use std::collections::BTreeMap;
use wire::Message;

/// Version of the messages.
const VERSION: [u64; 3] = [3, 8, 0];

/// The messages of the frames of the sample that is being made.
#[derive(Default)]
pub(super) struct Osi(RefCell<BTreeMap<u32, (ExactTime, Message)>>);

impl Writer for Osi {
    fn picture(&self, set: &Set, picture: &Picture<'_>, _folder: &mut OutputFolder) -> Result<(), Error> {
        let record = &picture.record;
        if set.cameras.first() == Some(&record.camera) {
            let message = ground_truth(record.exact_time(), &picture.world_objects());
            self.0.borrow_mut().insert(record.frame, (record.exact_time(), message));
        }
        Ok(())
    }

    fn sample(&self, _set: &Set, record: &SampleRecord, folder: &mut OutputFolder) -> Result<(), Error> {
        let frames = self.0.take();
        let first = frames.values().next().map_or(ExactTime::default(), |(time, _)| *time);
        let name = name::of(first.seconds(), VERSION, frames.len(), record.sample);
        let mut bytes = Vec::new();
        for (_, message) in frames.values() {
            let length = u32::try_from(message.bytes().len());
            let length = length.map_err(|_| Error::run("osi: the objects of a frame take more than 4 GiB"))?;
            bytes.extend_from_slice(&length.to_le_bytes());
            bytes.extend_from_slice(message.bytes());
        }
        write(folder, &format!("osi/{}/{name}", record.split.name()), &bytes)
    }

    fn finish(&self, _set: &Set, _records: &Records, _folder: &mut OutputFolder) -> Result<(), Error> {
        Ok(())
    }
}

/// `GroundTruth`.
fn ground_truth(time: ExactTime, objects: &[WorldObject]) -> Message {
    let [major, minor, patch] = VERSION;
    let version = Message::default().varint(1, major).varint(2, minor).varint(3, patch);
    let message = Message::default().message(1, &version).message(2, &timestamp(time));
    objects.iter().fold(message, |message, object| {
        let kind = object.class.as_deref().and_then(|class| Kind::of(class, object.moves));
        match kind {
            Some(Kind::Stationary(number)) => message.message(4, &stationary(object, number)),
            Some(kind) => message.message(5, &moving(object, kind)),
            None => message,
        }
    })
}

/// `Timestamp`: whole seconds, and what is left in ns, not below 0.
fn timestamp(time: ExactTime) -> Message {
    let ns = time.nanoseconds();
    let (whole, rest) = (ns.div_euclid(1_000_000_000), ns.rem_euclid(1_000_000_000));
    Message::default().varint(1, whole as i64 as u64).varint(2, rest as u64)
}

/// `StationaryObject`.
fn stationary(object: &WorldObject, number: u64) -> Message {
    let classification = Message::default().varint(1, number);
    Message::default()
        .message(1, &identifier(object.id))
        .message(2, &base(object))
        .message(3, &classification)
        .message(5, &source(object))
}

/// `MovingObject`.
fn moving(object: &WorldObject, kind: Kind) -> Message {
    let base = base(object).message(4, &vector(object.velocity_m_s));
    let number = kind.moving_type().expect("no stationary object");
    let message = Message::default().message(1, &identifier(object.id)).message(2, &base).varint(3, number);
    let message = match kind {
        Kind::Vehicle(vehicle) => message.message(6, &Message::default().varint(1, vehicle)),
        Kind::Mover(_) | Kind::Stationary(_) => message,
    };
    message.message(10, &source(object))
}

/// What `BaseMoving` and `BaseStationary` have in common: dimension, position, orientation.
fn base(object: &WorldObject) -> Message {
    let [yaw, pitch, roll] = yaw_pitch_roll(&DMat3::from_quat(object.stance.rotation));
    Message::default()
        .message(1, &vector(object.size_m))
        .message(2, &vector(object.stance.centre_m))
        .message(3, &vector(DVec3::new(roll, pitch, yaw)))
}

/// Three numbers: `Vector3d`, `Dimension3d`, `Orientation3d`.
fn vector(v: DVec3) -> Message {
    Message::default().double(1, v.x).double(2, v.y).double(3, v.z)
}

fn identifier(id: u32) -> Message {
    Message::default().varint(1, u64::from(id))
}

/// `ExternalReference`: the object's name in the scene.
fn source(object: &WorldObject) -> Message {
    Message::default().text(1, "scene").text(2, "etendue").text(3, &object.name)
}

/// Angles, rad, of a rotation that turns about z, then about the new y, then about the new x; straight up or down roll is 0.
fn yaw_pitch_roll(m: &DMat3) -> [f64; 3] {
    const UPRIGHT: f64 = 1e-9;
    let level = (m.x_axis.x * m.x_axis.x + m.x_axis.y * m.x_axis.y).sqrt();
    let pitch = atan2(-m.x_axis.z, level);
    if level < UPRIGHT {
        return [atan2(-m.y_axis.x, m.y_axis.y), pitch, 0.0];
    }
    [atan2(m.x_axis.y, m.x_axis.x), pitch, atan2(m.y_axis.z, m.z_axis.z)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_turn_back_to_the_rotation() {
        let angles = [[0.3, -0.2, 0.1], [-3.0, 1.2, -2.0], [0.7, 0.0, 0.0], [0.4, core::f64::consts::FRAC_PI_2, 0.0]];
        for [yaw, pitch, roll] in angles {
            let turned = DMat3::from_rotation_z(yaw) * DMat3::from_rotation_y(pitch) * DMat3::from_rotation_x(roll);
            let [y, p, r] = yaw_pitch_roll(&turned);
            let again = DMat3::from_rotation_z(y) * DMat3::from_rotation_y(p) * DMat3::from_rotation_x(r);
            assert!((again - turned).to_cols_array().iter().all(|d| d.abs() < 1e-9), "{yaw} {pitch} {roll}");
            assert!([(y, yaw), (p, pitch), (r, roll)].iter().all(|(a, b)| (a - b).abs() < 1e-9), "{y} {p} {r}");
        }
    }

    #[test]
    fn times_before_the_beginning_have_nanoseconds_above_0() {
        assert_eq!(timestamp((-0.25).into()), Message::default().varint(1, u64::MAX).varint(2, 750_000_000));
        assert_eq!(timestamp(2.0.into()), Message::default().varint(1, 2).varint(2, 0));
    }
}
