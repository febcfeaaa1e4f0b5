//! Animated nodes.
//!
//! Source: glTF 2.0 Specification, 3.11 and appendix C (interpolation).

use std::path::Path;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use gltf::json::animation::{Channel, Interpolation, Property, Sampler};
use gltf::{json::Root, json::scene::Node, json::validation::Checked};

use super::accessor::{finite, numbers};
use super::tracks::{self, GltfTrack};
use super::{buffers::Buffers, document, nodes, parts::GltfParts};
use crate::{Error, Problem, Sandbox, source::read_bytes};

/// Animated nodes of a glTF file, over all its animations.
#[derive(Clone, Debug)]
pub struct GltfMotion {
    /// Animated nodes, parents before children; `parent` is an index into this list.
    pub animated_nodes: Vec<GltfMover>,
    /// Unused content, in sentences.
    pub notes: Vec<String>,
    /// The file without moving nodes, and each of these separately.
    pub parts: GltfParts,
}

/// Animated node.
#[derive(Clone, Debug)]
pub struct GltfMover {
    /// Name; empty if it has none.
    pub name: String,
    /// Number in the file.
    pub node: usize,
    /// Nearest animated ancestor.
    pub parent: Option<usize>,
    /// Transform from its parent node's axes to those of that ancestor, or to the file's: rotation, one scale, translation.
    pub to_parent: (DQuat, f64, DVec3),
    /// Transform from its own axes to the file's, without animation.
    pub to_file: DAffine3,
    /// Rest transform in its parent, without animation: translation, rotation, scale.
    pub rest: (DVec3, DQuat, DVec3),
    /// Translation over time, m.
    pub translation: Option<GltfTrack<3>>,
    /// Rotation over time, quaternions x, y, z, w.
    pub rotation: Option<GltfTrack<4>>,
    /// Scale over time.
    pub scale: Option<GltfTrack<3>>,
    /// True if it, or a static node below it, shows a mesh.
    pub has_mesh: bool,
}

/// Reads the animated nodes, with the buffers of their animations.
///
/// # Errors
/// Damaged files.
pub fn read_gltf_motion(file: &Path) -> Result<GltfMotion, Error> {
    let bytes = read_bytes(file, "scene")?;
    read(file, &bytes).map_err(|problem| Error::new(file, problem))
}

fn read(file: &Path, bytes: &[u8]) -> Result<GltfMotion, Problem> {
    let (root, blob) = document::parse(bytes)?;
    let (shown, to_file) = nodes::visible_nodes(&root)?;
    let mut notes = Vec::new();
    let mut tracks = vec![NodeTracks::default(); root.nodes.len()];
    if !root.animations.is_empty() {
        let buffers = Buffers::read(file, &root, blob.clone(), &Sandbox::NONE)?;
        tracks = all_tracks(&root, &buffers, &mut notes)?;
    }
    let above = parents(&root);
    for node in skin_nodes(&root, &above) {
        if std::mem::take(&mut tracks[node]).is_some() {
            notes.push(format!("the motion of {} is not used: skins keep their rest pose", called(&root, node)));
        }
    }
    let mut movers: Vec<GltfMover> = Vec::new();
    let mut mover_of: Vec<Option<usize>> = vec![None; root.nodes.len()];
    for node in &shown {
        let node = *node;
        mover_of[node] = above[node].and_then(|parent| mover_of[parent]);
        let own = std::mem::take(&mut tracks[node]);
        if own.is_some() {
            match mover(&root, node, mover_of[node], &movers, above[node], &to_file, own) {
                Ok(mover) => {
                    mover_of[node] = Some(movers.len());
                    movers.push(mover);
                }
                Err(why) => notes.push(format!("the motion of {} is not used: {why}", called(&root, node))),
            }
        }
        if let (Some(mover), true) = (mover_of[node], root.nodes[node].mesh.is_some()) {
            movers[mover].has_mesh = true;
        }
    }
    let parts = GltfParts::new(bytes, blob, movers.iter().map(|mover| mover.node).collect(), mover_of)?;
    Ok(GltfMotion { animated_nodes: movers, notes, parts })
}

#[derive(Clone, Debug, Default)]
struct NodeTracks {
    translation: Option<GltfTrack<3>>,
    rotation: Option<GltfTrack<4>>,
    scale: Option<GltfTrack<3>>,
}

impl NodeTracks {
    fn is_some(&self) -> bool {
        self.translation.is_some() || self.rotation.is_some() || self.scale.is_some()
    }
}

fn called(root: &Root, node: usize) -> String {
    match &root.nodes[node].name {
        Some(name) => format!("node \"{name}\""),
        None => format!("node {node}"),
    }
}

fn parents(root: &Root) -> Vec<Option<usize>> {
    let mut parents = vec![None; root.nodes.len()];
    for (number, node) in root.nodes.iter().enumerate() {
        node.children.iter().flatten().for_each(|child| parents[child.value()] = Some(number));
    }
    parents
}

/// Joints, nodes with skins, and all their ancestors.
fn skin_nodes(root: &Root, above: &[Option<usize>]) -> Vec<usize> {
    let mut is_held = vec![false; root.nodes.len()];
    let joints = root.skins.iter().flat_map(|skin| &skin.joints).map(|joint| joint.value());
    let skinned = root.nodes.iter().enumerate().filter(|(_, node)| node.skin.is_some()).map(|(number, _)| number);
    for held in joints.chain(skinned) {
        let mut node = Some(held).filter(|node| *node < is_held.len());
        while let Some(number) = node.filter(|number| !std::mem::replace(&mut is_held[*number], true)) {
            node = above[number];
        }
    }
    (0..is_held.len()).filter(|node| is_held[*node]).collect()
}

fn all_tracks(root: &Root, buffers: &Buffers, notes: &mut Vec<String>) -> Result<Vec<NodeTracks>, Problem> {
    let mut tracks = vec![NodeTracks::default(); root.nodes.len()];
    let mut keys = 0;
    for (number, animation) in root.animations.iter().enumerate() {
        let located = |problem: Problem| problem.within(format_args!("animation {number}"));
        for channel in &animation.channels {
            let sampler = animation.samplers.get(channel.sampler.value());
            let sampler = sampler.ok_or_else(|| located("a channel refers to a sampler that does not exist".into()))?;
            let node = tracks.get_mut(channel.target.node.value());
            let node = node.ok_or_else(|| located("a channel refers to a node that does not exist".into()))?;
            if !add(root, buffers, channel, sampler, node, &mut keys).map_err(located)? {
                let what = called(root, channel.target.node.value());
                let note = match channel.target.path {
                    Checked::Valid(Property::MorphTargetWeights) => format!("morph targets of {what} are not used"),
                    _ => format!("a further animation of {what} is not used: only the first is"),
                };
                if !notes.contains(&note) {
                    notes.push(note);
                }
            }
        }
    }
    Ok(tracks)
}

/// Adds a channel to its node, and its number of keys to `keys`; `false` if it is not used.
fn add(
    root: &Root,
    buffers: &Buffers,
    channel: &Channel,
    sampler: &Sampler,
    node: &mut NodeTracks,
    keys: &mut u64,
) -> Result<bool, Problem> {
    let Checked::Valid(interpolation) = sampler.interpolation else {
        return Err("unknown interpolation".into());
    };
    let is_used = match channel.target.path {
        Checked::Valid(Property::Translation) => node.translation.is_none(),
        Checked::Valid(Property::Rotation) => node.rotation.is_none(),
        Checked::Valid(Property::Scale) => node.scale.is_none(),
        _ => false,
    };
    if !is_used {
        return Ok(false);
    }
    let stated = root.accessors.get(sampler.input.value()).map_or(0, |accessor| accessor.count.0);
    *keys = tracks::counted(*keys, stated, interpolation)?;
    let times = finite(numbers::<1>(root, buffers, sampler.input, "times")?, "time")?;
    let times: Vec<f64> = times.into_iter().map(|[time]| time).collect();
    let cubic = matches!(interpolation, Interpolation::CubicSpline);
    let steps = matches!(interpolation, Interpolation::Step);
    let values = |what: &'static str| TrackValues { root, buffers, accessor: sampler.output, what };
    match channel.target.path {
        Checked::Valid(Property::Rotation) => {
            let rotation = track(times, values("rotations"), cubic, steps)?;
            tracks::check_rotation(&rotation)?;
            node.rotation = Some(rotation);
        }
        Checked::Valid(Property::Scale) => node.scale = Some(track(times, values("scales"), cubic, steps)?),
        _ => node.translation = Some(track(times, values("translations"), cubic, steps)?),
    }
    Ok(true)
}

/// Values of a channel in a file, with their name in words.
struct TrackValues<'a> {
    root: &'a Root,
    buffers: &'a Buffers,
    accessor: gltf::json::Index<gltf::json::Accessor>,
    what: &'static str,
}

fn track<const N: usize>(
    times: Vec<f64>,
    output: TrackValues<'_>,
    cubic: bool,
    steps: bool,
) -> Result<GltfTrack<N>, Problem> {
    let values = finite(numbers::<N>(output.root, output.buffers, output.accessor, output.what)?, output.what)?;
    tracks::track(times, values, cubic, steps)
}

fn mover(
    root: &Root,
    number: usize,
    parent: Option<usize>,
    movers: &[GltfMover],
    above: Option<usize>,
    to_file: &[DAffine3],
    tracks: NodeTracks,
) -> Result<GltfMover, Problem> {
    let node = &root.nodes[number];
    let above = above.map_or(DAffine3::IDENTITY, |above| to_file[above]);
    let to_parent = match parent {
        None => above,
        Some(parent) => {
            let scales = movers[parent].rest.2;
            if movers[parent].scale.is_some()
                || (scales.max_element() - scales.min_element()).abs() > 1e-6 * scales.max_element()
            {
                return Err(
                    "its parent changes size or is scaled non-uniformly; it does not move relative to its parent"
                        .into(),
                );
            }
            to_file[movers[parent].node].inverse() * above
        }
    };
    let to_parent = similarity(to_parent).ok_or("nodes above it are mirrored or scaled non-uniformly")?;
    let rest = rest(node)?;
    if rest.2.min_element() <= 0.0 {
        return Err("it is mirrored, or its scale is 0".into());
    }
    let NodeTracks { translation, rotation, scale } = tracks;
    if scale.as_ref().is_some_and(|track| track.values().any(|v| v.iter().any(|s| *s <= 0.0))) {
        return Err("its scale becomes 0 or negative".into());
    }
    let name = node.name.clone().unwrap_or_default();
    let to_file = to_file[number];
    Ok(GltfMover {
        name,
        node: number,
        parent,
        to_parent,
        to_file,
        rest,
        translation,
        rotation,
        scale,
        has_mesh: false,
    })
}

fn rest(node: &Node) -> Result<(DVec3, DQuat, DVec3), Problem> {
    if node.matrix.is_some() {
        return Err("it has a matrix, which cannot be animated".into());
    }
    let wide = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let rotation = node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |r| r.0.map(f64::from));
    let rotation = DQuat::from_array(rotation);
    if !rotation.is_finite() || rotation.length_squared() == 0.0 {
        return Err("its rotation is not a valid quaternion".into());
    }
    Ok((node.translation.map_or(DVec3::ZERO, wide), rotation.normalize(), node.scale.map_or(DVec3::ONE, wide)))
}

/// Rotation, scale and translation of a transform with a uniform scale and without mirroring.
fn similarity(to: DAffine3) -> Option<(DQuat, f64, DVec3)> {
    let m = to.matrix3;
    let lengths = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::length);
    let scale = lengths[0];
    let is_even = lengths.iter().all(|l| (l - scale).abs() <= 1e-5 * scale) && scale > 0.0;
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::normalize_or_zero);
    let is_square = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|c| c.abs() < 1e-5) && x.cross(y).dot(z) > 0.0;
    (is_even && is_square).then(|| (DQuat::from_mat3(&DMat3::from_cols(x, y, z)).normalize(), scale, to.translation))
}
