//! ASAM OSI 3.8.0: `osi/SPLIT/TIME_gt_380_6302_FRAMES_NNNNNN.osi`, one trace per sample: for each frame a `GroundTruth` after its length (four bytes,
//! little-endian).
//!
//! - Names follow OSI's convention: the time of the first frame, counted from 1970 like those of the messages, so that no clock time is in them; the version of
//!   the messages; 6.30.2, the version of protobuf that osi-python 3.8.0 is built with and requires; the number of frames; and the sample's number as the name
//!   of the trace.
//! - Objects are all of the world with a class, visible or not, by identity: those that move by class or by motion as `moving_object`, others as
//!   `stationary_object`, by the lists below; `source_reference` holds their names. Surfaces (road, terrain …) and the sky have no box.
//! - The frame of the ground truth is the scene's (x forward, y left, z up, m); position is the centre of the object's box, whose length, width and height are
//!   along the object's own x, y and z; orientation is a rotation about z (yaw), then y (pitch), then x (roll), rad.
//! - The time is the middle of the exposure of the first camera that the job lists.
//! - Not written: the host vehicle, accelerations and angular rates, lanes and markings, the meaning of signs and lights (they are stationary objects of type
//!   other), occupants, environment.
//!
//! Names of traces: `<time>_<type>_<OSI version>_<protobuf version>_<number of frames>_<name>.osi`.
//!
//! Source: ASAM OSI 3.8.0, "OSI trace file naming conventions".
//!
//! Protocol buffers on the wire (Google, encoding of proto2): fields of a message one after the other, each with its number and length.

#[cfg(test)]
mod tests;

use std::{cell::RefCell, collections::BTreeMap};

use etendue::{Error, OutputFolder, WorldObject};
use etendue_core::{ExactTime, maths::f64::atan2};
use glam::{DMat3, DVec3};

use crate::records::{FormatWriter, Records, write};
use crate::{picture::SampleImage, record::SampleRecord, set::Set};

/// Version of the messages.
const VERSION: [u64; 3] = [3, 8, 0];

/// Messages of the frames of the current sample.
#[derive(Default)]
pub(super) struct Osi(RefCell<BTreeMap<u32, (ExactTime, ProtobufMessage)>>);

impl FormatWriter for Osi {
    fn write_image(&self, set: &Set, image: &SampleImage<'_>, _folder: &mut OutputFolder) -> Result<(), Error> {
        let record = &image.record;
        if set.cameras.first() == Some(&record.camera) {
            let message = ground_truth(record.exact_time(), &image.world_objects());
            self.0.borrow_mut().insert(record.frame, (record.exact_time(), message));
        }
        Ok(())
    }

    fn sample(&self, _set: &Set, record: &SampleRecord, folder: &mut OutputFolder) -> Result<(), Error> {
        let frames = self.0.take();
        let first = frames.values().next().map_or(ExactTime::default(), |(time, _)| *time);
        let name = trace_name(first.seconds(), VERSION, frames.len(), record.sample);
        let mut bytes = Vec::new();
        for (_, message) in frames.values() {
            let length = u32::try_from(message.bytes().len());
            let length = length.map_err(|_| Error::run("osi: the objects of a frame need more than 4 GiB"))?;
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
fn ground_truth(time: ExactTime, objects: &[WorldObject]) -> ProtobufMessage {
    let [major, minor, patch] = VERSION;
    let version = ProtobufMessage::default().varint(1, major).varint(2, minor).varint(3, patch);
    let message = ProtobufMessage::default().message(1, &version).message(2, &timestamp(time));
    objects.iter().fold(message, |message, object| {
        let kind = object.class.as_deref().and_then(|class| OsiObjectType::from_class(class, object.moves));
        match kind {
            Some(OsiObjectType::Stationary(number)) => message.message(4, &stationary(object, number)),
            Some(kind) => message.message(5, &moving(object, kind)),
            None => message,
        }
    })
}

/// `Timestamp`: whole seconds, and the remainder in ns, not below 0.
fn timestamp(time: ExactTime) -> ProtobufMessage {
    let ns = time.nanoseconds();
    let (seconds, rest) = (ns.div_euclid(1_000_000_000), ns.rem_euclid(1_000_000_000));
    ProtobufMessage::default().varint(1, seconds as i64 as u64).varint(2, rest as u64)
}

/// `StationaryObject`.
fn stationary(object: &WorldObject, number: u64) -> ProtobufMessage {
    let classification = ProtobufMessage::default().varint(1, number);
    ProtobufMessage::default()
        .message(1, &identifier(object.id))
        .message(2, &base(object))
        .message(3, &classification)
        .message(5, &source(object))
}

/// `MovingObject`.
fn moving(object: &WorldObject, kind: OsiObjectType) -> ProtobufMessage {
    let base = base(object).message(4, &vector(object.velocity_m_s));
    let number = kind.moving_type().expect("no stationary object");
    let message = ProtobufMessage::default().message(1, &identifier(object.id)).message(2, &base).varint(3, number);
    let message = match kind {
        OsiObjectType::Vehicle(vehicle) => message.message(6, &ProtobufMessage::default().varint(1, vehicle)),
        OsiObjectType::Mover(_) | OsiObjectType::Stationary(_) => message,
    };
    message.message(10, &source(object))
}

/// Common part of `BaseMoving` and `BaseStationary`: dimension, position, orientation.
fn base(object: &WorldObject) -> ProtobufMessage {
    let [yaw, pitch, roll] = yaw_pitch_roll(&DMat3::from_quat(object.pose.rotation));
    ProtobufMessage::default()
        .message(1, &vector(object.size_m))
        .message(2, &vector(object.pose.centre_m))
        .message(3, &vector(DVec3::new(roll, pitch, yaw)))
}

/// Three numbers: `Vector3d`, `Dimension3d`, `Orientation3d`.
fn vector(v: DVec3) -> ProtobufMessage {
    ProtobufMessage::default().double(1, v.x).double(2, v.y).double(3, v.z)
}

fn identifier(id: u32) -> ProtobufMessage {
    ProtobufMessage::default().varint(1, u64::from(id))
}

/// `ExternalReference`: the object's name in the scene.
fn source(object: &WorldObject) -> ProtobufMessage {
    ProtobufMessage::default().text(1, "scene").text(2, "etendue").text(3, &object.name)
}

/// Angles, rad, of a rotation about z, then about the new y, then about the new x; roll is 0 when pointing straight up or down.
fn yaw_pitch_roll(m: &DMat3) -> [f64; 3] {
    const UPRIGHT: f64 = 1e-9;
    let level = (m.x_axis.x * m.x_axis.x + m.x_axis.y * m.x_axis.y).sqrt();
    let pitch = atan2(-m.x_axis.z, level);
    if level < UPRIGHT {
        return [atan2(-m.y_axis.x, m.y_axis.y), pitch, 0.0];
    }
    [atan2(m.x_axis.y, m.x_axis.x), pitch, atan2(m.y_axis.z, m.z_axis.z)]
}

/// Numbers of `MovingObject.Type`.
const OTHER: u64 = 1;
const VEHICLE: u64 = 2;
const PEDESTRIAN: u64 = 3;
const ANIMAL: u64 = 4;

/// Kind of an object, from its class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OsiObjectType {
    /// A vehicle, and its `VehicleClassification.Type`.
    Vehicle(u64),
    /// `MovingObject.Type` other than a vehicle.
    Mover(u64),
    /// `StationaryObject.Classification.Type`.
    Stationary(u64),
}

/// Vehicles by class name.
const VEHICLES: [(&str, u64); 19] = [
    ("car", 4),
    ("van", 6),
    ("truck", 7),
    ("lorry", 7),
    ("semitrailer", 8),
    ("trailer", 9),
    ("caravan", 9),
    ("motorbike", 10),
    ("motorcycle", 10),
    ("bicycle", 11),
    ("bike", 11),
    ("bus", 12),
    ("tram", 13),
    ("train", 14),
    ("wheelchair", 15),
    ("scooter", 17),
    ("boat", 20),
    ("aircraft", 21),
    ("vehicle", OTHER),
];

/// Other objects that move by themselves.
const MOVERS: [(&str, u64); 7] = [
    ("person", PEDESTRIAN),
    ("pedestrian", PEDESTRIAN),
    ("rider", PEDESTRIAN),
    ("animal", ANIMAL),
    ("dog", ANIMAL),
    ("deer", ANIMAL),
    ("horse", ANIMAL),
];

/// Stationary objects.
const STATIONARY: [(&str, u64); 15] = [
    ("bridge", 2),
    ("building", 3),
    ("house", 3),
    ("pole", 4),
    ("polegroup", 4),
    ("traffic cone", 5),
    ("pylon", 5),
    ("delineator", 6),
    ("tree", 7),
    ("fence", 8),
    ("guard rail", 8),
    ("barrier", 8),
    ("vegetation", 9),
    ("curb", 10),
    ("wall", 11),
];

/// Surfaces that objects stand on, and the sky: OSI describes them by lanes and markings, without boxes.
const SURFACES: [&str; 12] = [
    "road",
    "sidewalk",
    "pavement",
    "parking",
    "rail track",
    "ground",
    "terrain",
    "grass",
    "sky",
    "marking",
    "road marking",
    "lane marking",
];

impl OsiObjectType {
    /// Kind for a class name ("-" and "_" are blanks); a class in no list is another moving or another stationary object. `None` for surfaces.
    fn from_class(class: &str, moves: bool) -> Option<Self> {
        let name = class.to_lowercase().replace(['-', '_'], " ");
        let number = |list: &[(&str, u64)]| list.iter().find(|(known, _)| *known == name).map(|(_, number)| *number);
        if let Some(vehicle) = number(&VEHICLES) {
            return Some(Self::Vehicle(vehicle));
        }
        if let Some(mover) = number(&MOVERS) {
            return Some(Self::Mover(mover));
        }
        if moves {
            return Some(Self::Mover(OTHER));
        }
        let is_surface = SURFACES.contains(&name.as_str());
        (!is_surface).then(|| Self::Stationary(number(&STATIONARY).unwrap_or(OTHER)))
    }

    /// `MovingObject.Type`; `None` for stationary objects.
    fn moving_type(self) -> Option<u64> {
        match self {
            Self::Vehicle(_) => Some(VEHICLE),
            Self::Mover(kind) => Some(kind),
            Self::Stationary(_) => None,
        }
    }
}

/// The version of protobuf: that of osi-python 3.8.0, which reads the files.
const PROTOBUF: [u64; 3] = [6, 30, 2];
const SECONDS_PER_DAY: i64 = 86_400;
/// The last second of the year 9999.
const LAST_S: f64 = 253_402_300_799.0;

/// Name of a trace of `GroundTruth` that begins at a time, s from 1970.
fn trace_name(time_s: f64, version: [u64; 3], frames: usize, sample: u32) -> String {
    let digits = |version: [u64; 3]| version.map(|number| number.to_string()).concat();
    format!("{}_gt_{}_{}_{frames}_{sample:06}.osi", stamp(time_s), digits(version), digits(PROTOBUF))
}

/// A time, s from 1970, as ISO 8601 in UTC, `yyyymmddThhmmssZ`; whole seconds, of the years 1 to 9999.
fn stamp(time_s: f64) -> String {
    let seconds = time_s.floor().clamp(-62_135_596_800.0, LAST_S) as i64;
    let (days, second) = (seconds.div_euclid(SECONDS_PER_DAY), seconds.rem_euclid(SECONDS_PER_DAY));
    let [year, month, day] = date(days);
    format!("{year:04}{month:02}{day:02}T{:02}{:02}{:02}Z", second / 3600, second / 60 % 60, second % 60)
}

/// Year, month and day of a number of days from 1970-01-01 (Gregorian).
///
/// Source: Richards in Urban and Seidelmann (eds.), Explanatory Supplement to the Astronomical Almanac, 3rd edition, 2013, section 15.11.3.
fn date(days: i64) -> [i64; 3] {
    // Number of the Julian day at noon.
    let julian = days + 2_440_588;
    let f = julian + 1401 + (4 * julian + 274_277) / 146_097 * 3 / 4 - 38;
    let e = 4 * f + 3;
    let h = 5 * (e % 1461 / 4) + 2;
    let (day, month) = (h % 153 / 5 + 1, (h / 153 + 2) % 12 + 1);
    [e / 1461 - 4716 + (14 - month) / 12, month, day]
}

/// Encoding of a field's bytes.
mod wire_type {
    pub(super) const VARINT: u64 = 0;
    pub(super) const FIXED_64: u64 = 1;
    pub(super) const LENGTH: u64 = 2;
}

/// Message under construction, field by field.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct ProtobufMessage(Vec<u8>);

impl ProtobufMessage {
    fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// Adds an unsigned number, or an enumeration; also a signed one, as its two's complement.
    fn varint(mut self, field: u64, value: u64) -> Self {
        self.key(field, wire_type::VARINT);
        self.push(value);
        self
    }

    /// Adds a `double`.
    fn double(mut self, field: u64, value: f64) -> Self {
        self.key(field, wire_type::FIXED_64);
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    /// Adds a text.
    fn text(self, field: u64, text: &str) -> Self {
        self.counted(field, text.as_bytes())
    }

    /// Adds a nested message.
    fn message(self, field: u64, message: &Self) -> Self {
        self.counted(field, &message.0)
    }

    fn counted(mut self, field: u64, bytes: &[u8]) -> Self {
        self.key(field, wire_type::LENGTH);
        self.push(bytes.len() as u64);
        self.0.extend_from_slice(bytes);
        self
    }

    fn key(&mut self, field: u64, wire_type: u64) {
        self.push(field << 3 | wire_type);
    }

    /// Appends seven bits per byte, the lowest first; the eighth is set if more follow.
    fn push(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.0.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.0.push(value as u8);
    }
}
