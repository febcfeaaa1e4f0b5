//! The frames of a scene: from records to motions.

use super::context::Context;
use super::course::{along, rolling, through, trajectory};
use etendue_core::Motion;
use etendue_core::track::Key;
use etendue_scene::record::Scene;
use etendue_scene::record::frame::{Frame, FrameKey};
use etendue_scene::{Placed, Unused};
use glam::DVec3;
use std::collections::BTreeMap;

/// From each frame that is used to the world, by name.
#[derive(Debug, Default)]
pub(super) struct Frames<'a>(BTreeMap<&'a str, Motion>);

impl<'a> Frames<'a> {
    /// Those of a scene.
    pub(super) fn of(scene: &'a Scene, unused: &Unused, context: &mut Context<'_>) -> Self {
        let mut frames = Self::default();
        for frame in scene.frames.iter().filter(|frame| !unused.frames.contains(&frame.name.value)) {
            frames.add(frame, scene, context);
        }
        frames
    }

    /// What moves by `own` in a frame; in the world where none is named.
    pub(super) fn carrying(&self, frame: Option<&Placed<String>>, own: Motion) -> Motion {
        // A frame that is not here has faults of its own.
        match frame.and_then(|name| self.0.get(name.value.as_str())) {
            Some(frame) => frame.carrying(&own),
            None => own,
        }
    }

    /// Parents first; what carries itself was refused where it was read.
    fn add(&mut self, frame: &'a Frame, scene: &'a Scene, context: &mut Context<'_>) {
        if self.0.contains_key(frame.name.value.as_str()) {
            return;
        }
        let parent = frame.parent.as_ref().and_then(|name| scene.frames.iter().find(|frame| frame.name == *name));
        if let Some(parent) = parent {
            self.add(parent, scene, context);
        }
        let Some(own) = own_motion(frame, context) else { return };
        let carried = self.carrying(frame.parent.as_ref(), own);
        if let Some(motion) = rolling(carried, frame.rolls.as_ref(), context) {
            self.0.insert(&frame.name.value, motion);
        }
    }
}

/// In its parent.
fn own_motion(frame: &Frame, context: &mut Context<'_>) -> Option<Motion> {
    let course = frame.course.as_ref();
    match (trajectory(course), &frame.keys[..]) {
        (Some(file), _) => along(file, course, context),
        (None, []) => Some(Motion::still(frame.placement.to_parent())),
        (None, [only]) => Some(Motion::still(only.placement.to_parent())),
        (None, keys) => {
            let key = |key: &FrameKey| Key {
                time_s: key.time_s.value,
                position_m: key.placement.position(),
                rotation: key.placement.quaternion(),
                scale: DVec3::ONE,
            };
            let keys: Vec<Key> = keys.iter().map(key).collect();
            through(&keys, course, &frame.place, context)
        }
    }
}
