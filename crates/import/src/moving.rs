//! Moving nodes of glTF files, as frames with keys and objects in them.

use std::path::Path;

use etendue_core::{ExactTime, maths::f64 as maths, track::slerp};
use etendue_io::mesh::{GLTF_CUBIC_KEYS as CUBIC_KEYS, GLTF_MIN_TURN, GltfMotion, GltfMover, GltfTrack};
use etendue_scene::record::frame::{FrameKey, FramePlacement};
use etendue_scene::record::{Body, Frame, Mesh, Object, Scene, Transform};
use etendue_scene::{record::object::Keyframe, record::transform::angles_deg};
use glam::{DMat3, DQuat, DVec3};

use super::naming::{UniqueNames, path_between, rounded};

/// Binary chunk of a GLB file, by its name in `meshes/`.
const BLOB: &str = "chunk.bin";
/// Duration of a jump of a stepped track, s.
const JUMP_S: f64 = 1e-6;
/// Upper limit of the rotation between two keys, degrees.
const MAX_TURN_DEG: f64 = 170.0;

/// Rotation from the file's axes (+y up, +z forward) to the world's (+z up, +x forward).
pub(super) fn to_world(v: DVec3) -> DVec3 {
    DVec3::new(v.z, v.x, v.y)
}

/// Moving nodes in the written scene.
pub(super) struct MovingNodes {
    /// Frames and their scales of length, by the numbers of moving nodes.
    frames: Vec<(String, f64)>,
}

impl MovingNodes {
    /// Name of a moving node's frame, and the scale of lengths in the node.
    pub(super) fn frame(&self, mover: usize) -> (&str, f64) {
        let (name, scale) = &self.frames[mover];
        (name, *scale)
    }
}

/// Adds the moving nodes to a scene, under free names, and their meshes to the written files.
pub(super) fn add_moving(
    scene: &mut Scene,
    motion: &GltfMotion,
    source: &Path,
    folder: &Path,
    names: &mut UniqueNames,
    files: &mut Vec<(String, Vec<u8>)>,
    report: &mut Vec<String>,
) -> Result<MovingNodes, String> {
    let shown = motion.animated_nodes.iter().filter(|mover| mover.has_mesh).count();
    motion
        .parts
        .check_size(if motion.animated_nodes.is_empty() { 0 } else { shown + 1 })
        .map_err(|problem| problem.words)?;
    let mut moving = MovingNodes { frames: Vec::new() };
    for (number, mover) in motion.animated_nodes.iter().enumerate() {
        let name = names.take(&mover.name, "mover");
        let above = mover.parent.map_or(1.0, |parent| moving.frames[parent].1);
        let (turn, scale, _) = mover.to_parent;
        let mover_motion = MoverMotion { mover, above, turn };
        let times = mover_motion.times();
        let mut frame = Frame::new(name.as_str(), mover_motion.placement(times.first().copied().unwrap_or(0.0)));
        if times.len() > 1 {
            frame = Frame::new(name.as_str(), FramePlacement::default());
            frame.keys = times
                .iter()
                .map(|time_s| FrameKey::new(ExactTime::from(*time_s), mover_motion.placement(*time_s)))
                .collect();
        }
        frame.parent = mover.parent.map(|parent| moving.frames[parent].0.as_str().into());
        scene.frames.push(frame);
        report.push(format!(
            "node \"{name}\" moves: a frame with {} keys{}",
            times.len(),
            mover_motion.approximation_note(&times)
        ));
        let total_scale = above * scale;
        if mover.has_mesh {
            let own = if mover.scale.is_some() { DVec3::ONE } else { mover.rest.2 };
            let part = format!("meshes/{name}.gltf");
            let bytes = part_of(motion, Some((number, (total_scale * own).to_array())), source, folder);
            files.push((part.clone(), bytes));
            scene.meshes.push(Mesh::new(name.as_str(), part.as_str()));
            let body = Body::Mesh(name.as_str().into());
            let mut object = Object::new(name.as_str(), body, Transform::default());
            object.frame = Some(name.as_str().into());
            object.keys = mover.scale.as_ref().map(scale_keys).unwrap_or_default();
            scene.objects.push(object);
        }
        // Nothing that moves lies within a non-uniform scale, and lights and cameras are not scaled.
        moving.frames.push((name, total_scale * mover.rest.2.x));
    }
    if let (Some(blob), false) = (&motion.parts.blob, motion.animated_nodes.is_empty()) {
        files.push((format!("meshes/{BLOB}"), blob.clone()));
    }
    Ok(moving)
}

/// Part as a file in `meshes/`.
pub(super) fn part_of(motion: &GltfMotion, mover: Option<(usize, [f64; 3])>, source: &Path, folder: &Path) -> Vec<u8> {
    let source_folder = source.parent().unwrap_or(Path::new(""));
    let path_of =
        |name: &str| path_between(&folder.join("meshes"), &source_folder.join(name)).to_string_lossy().into_owned();
    motion.parts.part(mover, BLOB, &path_of)
}

struct MoverMotion<'a> {
    mover: &'a GltfMover,
    /// Scale of lengths in the parent.
    above: f64,
    /// Rotation from its parent's axes to those of the frame above.
    turn: DQuat,
}

impl MoverMotion<'_> {
    /// Position and rotation in the frame above, in the file's axes.
    fn at(&self, time_s: f64) -> (DVec3, DQuat) {
        let (translation, rotation, _) = self.mover.rest;
        let own = self.mover.translation.as_ref().map_or(translation, |t| DVec3::from_array(t.at(time_s, linear)));
        let own_turn = self.mover.rotation.as_ref().map_or(rotation, |t| turn_at(t, time_s));
        let (_, scale, moved) = self.mover.to_parent;
        (self.above * (moved + scale * (self.turn * own)), self.turn * own_turn)
    }

    fn placement(&self, time_s: f64) -> FramePlacement {
        let (position, turn) = self.at(time_s);
        let columns = [DVec3::Y, DVec3::Z, DVec3::X].map(|axis| to_world(turn * axis));
        // The file's y, z, x are our z, x, y: columns are the images of our x, y, z.
        let [z, x, y] = columns;
        // Avoids negative zeros.
        let angles = rounded(angles_deg(DMat3::from_cols(x, y, z))).map(|angle| angle + 0.0);
        let position = to_world(position);
        FramePlacement {
            position_m: (position != DVec3::ZERO).then(|| position.to_array().into()),
            rotation_deg: (angles != [0.0; 3]).then(|| angles.into()),
            ..FramePlacement::default()
        }
    }

    /// Times of keys between which straight lines and slerps describe the motion.
    fn times(&self) -> Vec<f64> {
        let mut times = Vec::new();
        self.mover.translation.iter().for_each(|track| add_times(track, &mut times));
        self.mover.rotation.iter().for_each(|track| add_times(track, &mut times));
        times.sort_by(f64::total_cmp);
        times.dedup();
        let wide: Vec<f64> = times
            .windows(2)
            .filter(|pair| angle_deg(self.at(pair[0]).1, self.at(pair[1]).1) > MAX_TURN_DEG)
            .map(|pair| 0.5 * (pair[0] + pair[1]))
            .collect();
        times.extend(wide);
        times.sort_by(f64::total_cmp);
        times
    }

    /// Note on approximations.
    fn approximation_note(&self, times: &[f64]) -> String {
        let (translation, rotation) = (&self.mover.translation, &self.mover.rotation);
        let mut note = String::new();
        if translation.as_ref().is_some_and(GltfTrack::is_step) || rotation.as_ref().is_some_and(GltfTrack::is_step) {
            note += "; each of its steps takes 1 µs";
        }
        if translation.as_ref().is_some_and(GltfTrack::is_cubic) || rotation.as_ref().is_some_and(GltfTrack::is_cubic) {
            let (mut off_m, mut off_deg) = (0.0_f64, 0.0_f64);
            for pair in times.windows(2) {
                let [from, middle, to] = [pair[0], 0.5 * (pair[0] + pair[1]), pair[1]].map(|time| self.at(time));
                off_m = off_m.max((middle.0 - 0.5 * (from.0 + to.0)).length());
                let between = slerp(from.1, to.1, 0.5);
                off_deg = off_deg.max(angle_deg(middle.1, between));
            }
            note += &format!(
                "; its cubic curves are sampled with {CUBIC_KEYS} keys per interval, with an error half-way between keys of at most {off_m:.2e} m and \
                    {off_deg:.2e}°"
            );
        }
        note
    }
}

/// Rotation at a time; that of the previous key where a cubic curve passes through zero.
fn turn_at(track: &GltfTrack<4>, time_s: f64) -> DQuat {
    let turn = |time_s: f64| DQuat::from_array(track.at(time_s, rotated));
    let own = turn(time_s);
    if own.length() >= GLTF_MIN_TURN {
        return own.normalize();
    }
    let before = track.times_s.partition_point(|time| *time <= time_s).saturating_sub(1);
    turn(track.times_s[before]).normalize()
}

fn add_times<const N: usize>(track: &GltfTrack<N>, times: &mut Vec<f64>) {
    times.extend(&track.times_s);
    for pair in track.times_s.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        if track.is_step() && to - JUMP_S > from {
            times.push(to - JUMP_S);
        }
        if track.is_cubic() {
            times.extend((1..CUBIC_KEYS).map(|i| from + (to - from) * i as f64 / CUBIC_KEYS as f64));
        }
    }
}

/// Keys of an object of changing size.
fn scale_keys(track: &GltfTrack<3>) -> Vec<Keyframe> {
    let mut times = Vec::new();
    add_times(track, &mut times);
    times.sort_by(f64::total_cmp);
    times.dedup();
    let key = |time_s: f64| {
        let scale = to_world(DVec3::from_array(track.at(time_s, linear)));
        Keyframe::new(
            ExactTime::from(time_s),
            Transform { scale: Some(scale.to_array().into()), ..Transform::default() },
        )
    };
    times.into_iter().map(key).collect()
}

fn linear(a: [f64; 3], b: [f64; 3], fraction: f64) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + fraction * (b[i] - a[i]))
}

/// Interpolates the numbers as a track of a file does.
fn rotated(a: [f64; 4], b: [f64; 4], fraction: f64) -> [f64; 4] {
    slerp(DQuat::from_array(a), DQuat::from_array(b), fraction).to_array()
}

fn angle_deg(a: DQuat, b: DQuat) -> f64 {
    2.0 * maths::acos(a.dot(b).abs().min(1.0)).to_degrees()
}
