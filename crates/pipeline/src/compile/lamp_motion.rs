//! Positions and aims of lamps over time: from records to motions.

use super::context::Context;
use super::course::{along_trajectory, through_keys, trajectory};
use super::frames::Frames;
use etendue_core::Motion;
use etendue_core::track::Key;
use etendue_scene::Placed;
use etendue_scene::record::light::placement::MainAxis;
use etendue_scene::record::light::{LampAim, LampInstance, LampKey, LampPlacement};
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// Motions of all instances of a lamp with this main axis that is rotated by `turn` in its own frame: from the lamp's frame to the world. `None` if one is
/// invalid.
pub(super) fn lamp_motions(
    placement: &LampPlacement,
    main: MainAxis,
    turn: DMat3,
    frames: &Frames<'_>,
    context: &mut Context<'_>,
) -> Option<Vec<Motion>> {
    let motion_keys = placement.course.as_ref();
    let frame = placement.frame.as_ref();
    // Aims in a loaded description have been checked.
    let still = |position: &Placed<[f64; 3]>, aim: Option<&LampAim>| {
        let axes = axes(aim, position, main)? * turn;
        Some(Motion::constant(DAffine3::from_mat3_translation(axes, DVec3::from_array(position.value))))
    };
    if let Some(file) = trajectory(motion_keys) {
        let own = along_trajectory(file, motion_keys, context)?.after(&DAffine3::from_mat3(turn));
        return Some(vec![frames.world_motion(frame, own)]);
    }
    if let keys @ [_, _, ..] = &placement.keys[..] {
        let keys: Vec<Key> = keys.iter().map(|key_record| key(key_record, main, context)).collect::<Option<_>>()?;
        let own = through_keys(&keys, motion_keys, &placement.place, context)?.after(&DAffine3::from_mat3(turn));
        return Some(vec![frames.world_motion(frame, own)]);
    }
    let of_instance = |instance: &LampInstance| {
        let own = still(&instance.position_m, instance.aim.as_ref())?;
        Some(frames.world_motion(instance.frame.as_ref().or(frame), own))
    };
    let of_key = |key: &LampKey| Some(frames.world_motion(frame, still(&key.position_m, key.aim.as_ref())?));
    let own = placement
        .position_m
        .iter()
        .map(|position| Some(frames.world_motion(frame, still(position, placement.aim.as_ref())?)));
    own.chain(placement.keys.iter().map(of_key)).chain(placement.instances.iter().map(of_instance)).collect()
}

fn key(key: &LampKey, main: MainAxis, context: &mut Context<'_>) -> Option<Key> {
    let rotation = DQuat::from_mat3(&axes(key.aim.as_ref(), &key.position_m, main)?);
    let position_m = DVec3::from_array(key.position_m.value);
    Some(Key { time_s: context.since_epoch_s(&key.time_s), position_m, rotation, scale: DVec3::ONE })
}

fn axes(aim: Option<&LampAim>, position: &Placed<[f64; 3]>, main: MainAxis) -> Option<DMat3> {
    aim.map_or(Some(DMat3::IDENTITY), |aim| aim.axes(position.value, main))
}
