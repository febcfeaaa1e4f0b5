//! Poses of objects over time: from records to motions.

use super::context::Context;
use super::course::{along_trajectory, through_keys, trajectory, with_wheel};
use super::frames::Frames;
use etendue_core::Motion;
use etendue_core::track::Key;
use etendue_scene::Placed;
use etendue_scene::record::object::Keyframe;
use etendue_scene::record::transform::Transform;
use etendue_scene::record::{Instance, Object};
use glam::DAffine3;

/// Motion from an object's frame to the world, with the name of the instance.
type ObjectPlacement<'o> = (Motion, Option<&'o Placed<String>>);

/// Motions of all instances of an object; `None` if one is invalid.
pub(super) fn placements<'o>(
    object: &'o Object,
    frames: &Frames<'_>,
    context: &mut Context<'_>,
) -> Option<Vec<ObjectPlacement<'o>>> {
    let motion_keys = object.course.as_ref();
    let mut in_frame = |frame: Option<&Placed<String>>, own: Motion| {
        with_wheel(frames.world_motion(frame, own), object.rolls.as_ref(), context)
    };
    if !object.instances.is_empty() {
        let of = |instance: &'o Instance| {
            let frame = instance.frame.as_ref().or(object.frame.as_ref());
            Some((still(&instance.transform, object, |hub| in_frame(frame, hub))?, instance.name.as_ref()))
        };
        return object.instances.iter().map(of).collect();
    }
    let frame = object.frame.as_ref();
    let motion = match (trajectory(motion_keys), &object.keys[..]) {
        (None, []) => still(&object.transform, object, |hub| in_frame(frame, hub)),
        (None, [only]) => still(&only.transform, object, |hub| in_frame(frame, hub)),
        (Some(file), _) => {
            let own = along_trajectory(file, motion_keys, context)?;
            with_wheel(frames.world_motion(frame, own), object.rolls.as_ref(), context)
        }
        (None, keys) => {
            let mut key = |key: &Keyframe| Key {
                time_s: context.since_epoch_s(&key.time_s),
                position_m: key.transform.position(),
                rotation: key.transform.quaternion(),
                scale: key.transform.factors(),
            };
            let keys: Vec<Key> = keys.iter().map(&mut key).collect();
            let own = through_keys(&keys, motion_keys, &object.place, context)?;
            with_wheel(frames.world_motion(frame, own), object.rolls.as_ref(), context)
        }
    };
    Some(vec![(motion?, None)])
}

/// Motion of an object that is static in its frame. A wheel rotates within its scale.
fn still(transform: &Transform, object: &Object, in_frame: impl FnOnce(Motion) -> Option<Motion>) -> Option<Motion> {
    if object.rolls.is_none() {
        return in_frame(Motion::constant(transform.to_world()));
    }
    let hub = Motion::constant(transform.to_world_unscaled());
    Some(in_frame(hub)?.after(&DAffine3::from_scale(transform.factors())))
}
