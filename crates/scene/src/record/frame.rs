//! `[[frames]]`: coordinate frames that move and carry objects, lamps and cameras.

use etendue_core::ExactTime;

use std::collections::BTreeMap;

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::motion::{MotionKeys, Wheel, check_motion, check_placements, trajectory_placement};
use super::transform::{yaw_pitch_roll, yaw_pitch_roll_quaternion};
use crate::fault::{DescriptionErrors, ErrorCode, NameKind};
use crate::place::{Place, Placed};
use crate::reader::{list, name_of, number, record, text, time, vector};

record! {
    /// A coordinate frame in which objects, lamps, cameras and other frames are placed, and with which they move.
    pub struct Frame check(check) {
        /// Name of the frame.
        required name: Placed<String> = text("the name of the frame");
        /// Parent frame. Default: the world.
        optional parent: Placed<String> = name_of(NameKind::Frame);
        /// Placement of a frame that is fixed in its parent.
        inside placement: FramePlacement;
        /// Placement over time.
        many keys: FrameKey = list(record(), 1);
        /// Motion.
        group course: MotionKeys;
        /// Wheel that rolls along its path.
        optional rolls: Wheel = record();
    }
}

record! {
    /// Placement of a frame at a time.
    pub struct FrameKey {
        /// Simulated time.
        required time_s: Placed<ExactTime> = time();
        /// Placement.
        inside placement: FramePlacement;
    }
}

record! {
    /// Placement of a frame in its parent: rotation, then translation, without scale.
    pub struct FramePlacement {
        /// Origin in its parent. Default: the parent's origin.
        optional position_m: Placed<[f64; 3]> = vector::<3>(number("m"));
        /// Yaw, pitch and roll. Default: 0.
        optional rotation_deg: Placed<[f64; 3]> = vector::<3>(number("°"));
    }
}

impl FramePlacement {
    /// Transform from the frame to its parent.
    #[must_use]
    pub fn to_parent(&self) -> DAffine3 {
        let rotation = self.rotation_deg.as_ref().map_or(DMat3::IDENTITY, |r| yaw_pitch_roll(r.value));
        DAffine3::from_mat3_translation(rotation, self.position())
    }

    /// Its origin in its parent, m.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.position_m.as_ref().map_or(DVec3::ZERO, |p| DVec3::from_array(p.value))
    }

    /// Its rotation in its parent.
    #[must_use]
    pub fn quaternion(&self) -> DQuat {
        self.rotation_deg.as_ref().map_or(DQuat::IDENTITY, |r| yaw_pitch_roll_quaternion(r.value))
    }

    fn place(&self) -> Option<&Place> {
        self.position_m.as_ref().map(|p| &p.place).or(self.rotation_deg.as_ref().map(|r| &r.place))
    }
}

fn check(frame: &Frame, errors: &mut DescriptionErrors) {
    let own = frame.placement.place().map(|place| ("\"position_m\", \"rotation_deg\"", place.clone()));
    let keys = frame.keys.first().map(|key| ("\"keys\"", key.place.clone()));
    check_placements([own, keys, trajectory_placement(frame.course.as_ref())], "the frame", errors);
    check_motion(frame.course.as_ref(), frame.keys.iter().map(|key| &key.time_s), errors);
}

/// Largest number of names of a circle in a message.
const MAX_NAMES: usize = 8;

/// Reports every frame that is carried by itself, in time linear in their number.
pub(super) fn check_circles(frames: &[Frame], errors: &mut DescriptionErrors) {
    let mut places = BTreeMap::new();
    for (place, frame) in frames.iter().enumerate() {
        places.entry(frame.name.value.as_str()).or_insert(place);
    }
    let parent = |place: usize| places.get(frames[place].parent.as_ref()?.value.as_str()).copied();
    // For each frame the start of the first walk along the parents that reached it.
    let mut reached_from = vec![usize::MAX; frames.len()];
    for start in 0..frames.len() {
        let mut next = Some(start);
        while let Some(place) = next.filter(|place| reached_from[*place] == usize::MAX) {
            reached_from[place] = start;
            next = parent(place);
        }
        // A walk that reaches its own path has found a circle, which no other walk enters again.
        let Some(first) = next.filter(|place| reached_from[*place] == start) else { continue };
        let circle: Vec<usize> =
            std::iter::successors(Some(first), |place| parent(*place).filter(|place| *place != first)).collect();
        note_cycle(&circle, frames, errors);
    }
}

/// Reports each frame of a circle, in which each is carried by the next and the last by the first.
fn note_cycle(circle: &[usize], frames: &[Frame], errors: &mut DescriptionErrors) {
    let name = |place: usize| frames[circle[place % circle.len()]].name.value.as_str();
    for (place, frame) in circle.iter().enumerate() {
        let Some(own) = &frames[*frame].parent else { continue };
        let mut chain: Vec<&str> = (place..=place + circle.len().min(MAX_NAMES)).map(name).collect();
        if circle.len() > MAX_NAMES {
            chain.extend(["…", name(place)]);
        }
        let problem = format!("frames form a cycle: {}", chain.join(" -> "));
        errors.add(ErrorCode::CircularReference, &own.place, problem, "give another parent, or none");
    }
}
