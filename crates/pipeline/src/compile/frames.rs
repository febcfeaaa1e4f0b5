//! Frames of a scene: from records to motions.

use super::context::Context;
use super::course::{along_trajectory, through_keys, trajectory, wheel_rotation};
use etendue_core::Motion;
use etendue_core::track::Key;
use etendue_scene::record::Scene;
use etendue_scene::record::frame::{Frame, FrameKey};
use etendue_scene::{Placed, UnusedNames};
use glam::DVec3;
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

/// Frames in use, by name.
#[derive(Debug, Default)]
pub(super) struct Frames<'a>(BTreeMap<&'a str, PlacedFrame<'a>>);

/// A frame in its parent. The transform to the world is composed on request: a frame that only carries others stores no copy of its chain.
#[derive(Debug)]
struct PlacedFrame<'a> {
    parent: Option<&'a str>,
    /// Motion in the parent, followed by the rotation of a wheel, if any.
    own: Vec<Motion>,
    to_world: OnceCell<Motion>,
}

impl<'a> Frames<'a> {
    /// Frames of a scene.
    pub(super) fn new(scene: &'a Scene, unused: &UnusedNames, context: &mut Context<'_>) -> Self {
        let by_name: BTreeMap<&str, &Frame> =
            scene.frames.iter().map(|frame| (frame.name.value.as_str(), frame)).collect();
        let (mut frames, mut tried) = (Self::default(), BTreeSet::new());
        for frame in scene.frames.iter().filter(|frame| !unused.frames.contains(&frame.name.value)) {
            // Parents first; cycles were refused when the scene was read.
            let mut chain = Vec::new();
            let mut next = Some(frame);
            while let Some(frame) = next.filter(|frame| tried.insert(frame.name.value.as_str())) {
                chain.push(frame);
                next = frame.parent.as_ref().and_then(|name| by_name.get(name.value.as_str()).copied());
            }
            chain.into_iter().rev().for_each(|frame| frames.add(frame, context));
        }
        frames
    }

    /// World motion of an object that moves by `own` in a frame; in the world if none is named.
    pub(super) fn world_motion(&self, frame: Option<&Placed<String>>, own: Motion) -> Motion {
        match frame.and_then(|name| self.to_world(name.value.as_str())) {
            Some(frame) => frame.carrying(&own),
            None => own,
        }
    }

    /// `None` for an unknown frame, which has its own errors.
    fn to_world(&self, frame: &str) -> Option<&Motion> {
        let placed = self.0.get(frame)?;
        Some(placed.to_world.get_or_init(|| Motion::nested(self.chain(frame))))
    }

    /// Motions from the world to a frame.
    fn chain(&self, frame: &str) -> Vec<&Motion> {
        let (mut chain, mut next) = (Vec::new(), self.0.get(frame));
        while let Some(placed) = next {
            chain.extend(placed.own.iter().rev());
            next = placed.parent.and_then(|parent| self.0.get(parent));
        }
        chain.reverse();
        chain
    }

    /// Adds a frame whose parents have been added.
    fn add(&mut self, frame: &'a Frame, context: &mut Context<'_>) {
        let Some(motion) = own_motion(frame, context) else { return };
        let (name, parent) = (frame.name.value.as_str(), frame.parent.as_ref().map(|parent| parent.value.as_str()));
        let mut own = vec![motion];
        if let Some(rolls) = &frame.rolls {
            let carriers = parent.map_or(Vec::new(), |parent| self.chain(parent));
            let hub = Motion::nested(carriers.into_iter().chain(&own));
            let Some(turns) = wheel_rotation(&hub, rolls, context) else { return };
            own.push(turns);
        }
        self.0.insert(name, PlacedFrame { parent, own, to_world: OnceCell::new() });
    }
}

/// Motion in the parent.
fn own_motion(frame: &Frame, context: &mut Context<'_>) -> Option<Motion> {
    let motion_keys = frame.course.as_ref();
    match (trajectory(motion_keys), &frame.keys[..]) {
        (Some(file), _) => along_trajectory(file, motion_keys, context),
        (None, []) => Some(Motion::constant(frame.placement.to_parent())),
        (None, [only]) => Some(Motion::constant(only.placement.to_parent())),
        (None, keys) => {
            let mut key = |key: &FrameKey| Key {
                time_s: context.since_epoch_s(&key.time_s),
                position_m: key.placement.position(),
                rotation: key.placement.quaternion(),
                scale: DVec3::ONE,
            };
            let keys: Vec<Key> = keys.iter().map(&mut key).collect();
            through_keys(&keys, motion_keys, &frame.place, context)
        }
    }
}
