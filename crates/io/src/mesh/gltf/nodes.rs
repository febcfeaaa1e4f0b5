//! Tree of nodes, visible nodes of the scene, and skins in their rest pose.

use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::{Index, Root};
use gltf::{json::scene::Node, json::validation::Checked};

use super::accessor::{finite, numbers};
use super::buffers::Buffers;
use crate::Problem;

/// The meshes of the scene in the order of their nodes.
pub(super) fn placed_meshes(root: &Root, buffers: &Buffers) -> Result<Vec<PlacedMesh>, Problem> {
    let (shown, to_file) = visible_nodes(root)?;
    let mut placed = Vec::new();
    for number in shown {
        let node = &root.nodes[number];
        let Some(mesh) = node.mesh else { continue };
        let joints = match node.skin {
            None => None,
            Some(skin) => Some(joints(root, buffers, skin.value(), &to_file)?),
        };
        placed.push(PlacedMesh { mesh: mesh.value(), to_file: to_file[number], joints });
    }
    Ok(placed)
}

/// Nodes that the scene shows, in order: those of the default scene, else of the first, else all. Also the transform from the axes of every node of the file to
/// those of the file.
pub(super) fn visible_nodes(root: &Root) -> Result<(Vec<usize>, Vec<DAffine3>), Problem> {
    let (roots, to_file) = tree(root)?;
    let scene = root.scene.map_or(0, |scene| scene.value());
    let mut open: Vec<usize> = match root.scenes.get(scene) {
        Some(scene) => scene.nodes.iter().map(|node| node.value()).collect(),
        None => roots,
    };
    let mut visited = vec![false; root.nodes.len()];
    open.reverse();
    let mut shown = Vec::new();
    while let Some(number) = open.pop() {
        let node =
            root.nodes.get(number).ok_or_else(|| format!("the scene refers to node {number}, which does not exist"))?;
        if std::mem::replace(&mut visited[number], true) {
            return Err(format!("the scene contains node {number} twice; export the file again").into());
        }
        open.extend(node.children.iter().flatten().rev().map(|child| child.value()));
        shown.push(number);
    }
    Ok((shown, to_file))
}

/// Nodes without parents, and for every node the transform from its axes to those of the file.
fn tree(root: &Root) -> Result<(Vec<usize>, Vec<DAffine3>), Problem> {
    let mut parents: Vec<Option<usize>> = vec![None; root.nodes.len()];
    for (number, node) in root.nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let parent = parents
                .get_mut(child.value())
                .ok_or_else(|| format!("node {number} has a child that does not exist"))?;
            if let Some(other) = parent.replace(number) {
                return Err(format!(
                    "node {} is a child of both node {other} and node {number}; export the file again",
                    child.value()
                )
                .into());
            }
        }
    }
    let roots: Vec<usize> = (0..parents.len()).filter(|n| parents[*n].is_none()).collect();
    let mut to_file = vec![None; root.nodes.len()];
    let mut open: Vec<(usize, DAffine3)> = roots.iter().map(|number| (*number, DAffine3::IDENTITY)).collect();
    while let Some((number, parent)) = open.pop() {
        let own = parent * local(number, &root.nodes[number])?;
        to_file[number] = Some(own);
        open.extend(root.nodes[number].children.iter().flatten().map(|child| (child.value(), own)));
    }
    // Nodes that no root reaches lie on a cycle, or below one.
    let cyclic =
        |number: usize| format!("node {number} is its own descendant, or below a node that is; export the file again");
    let all: Result<_, _> =
        to_file.into_iter().enumerate().map(|(number, transform)| transform.ok_or_else(|| cyclic(number))).collect();
    Ok((roots, all?))
}

fn local(number: usize, node: &Node) -> Result<DAffine3, Problem> {
    let wide = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let local = match node.matrix {
        Some(matrix) => DAffine3::from_mat4(DMat4::from_cols_array(&matrix.map(f64::from))),
        None => {
            let [x, y, z, w] = node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |r| r.0.map(f64::from));
            let length = (x * x + y * y + z * z + w * w).sqrt();
            let rotation = DQuat::from_xyzw(x / length, y / length, z / length, w / length);
            let (scale, translation) =
                (node.scale.map_or(DVec3::ONE, wide), node.translation.map_or(DVec3::ZERO, wide));
            DAffine3::from_scale_rotation_translation(scale, rotation, translation)
        }
    };
    match local.is_finite() {
        true => Ok(local),
        false => Err(format!("the transform of node {number} is not finite; correct the model").into()),
    }
}

/// Mesh placed by a node of the scene.
pub(super) struct PlacedMesh {
    /// Number in the file.
    pub(super) mesh: usize,
    /// Transform from its own axes to those of the file; for a skinned mesh the skin gives it.
    pub(super) to_file: DAffine3,
    /// Transforms from its own axes at the bind pose to those of the file, by joint; `None` without a skin.
    pub(super) joints: Option<Vec<DAffine3>>,
}

/// Transforms from a skinned mesh's bind pose to the file, by joint.
pub(super) fn joints(
    root: &Root,
    buffers: &Buffers,
    skin: usize,
    to_file: &[DAffine3],
) -> Result<Vec<DAffine3>, Problem> {
    let record = root.skins.get(skin).ok_or_else(|| format!("skin {skin} does not exist"))?;
    let bind: Vec<[f64; 16]> = match record.inverse_bind_matrices {
        None => vec![DMat4::IDENTITY.to_cols_array(); record.joints.len()],
        Some(index) => finite(numbers(root, buffers, index, "inverse bind matrices")?, "inverse bind matrix")?,
    };
    if bind.len() < record.joints.len() {
        return Err(
            format!("skin {skin} has {} joints and {} inverse bind matrices", record.joints.len(), bind.len()).into()
        );
    }
    let joint = |(joint, bind): (&Index<_>, &[f64; 16])| {
        let place =
            to_file.get(joint.value()).ok_or_else(|| format!("skin {skin} refers to a joint that does not exist"))?;
        Ok(*place * DAffine3::from_mat4(DMat4::from_cols_array(bind)))
    };
    record.joints.iter().zip(&bind).map(|(index, bind): (&Index<gltf::json::Node>, _)| joint((index, bind))).collect()
}

/// Skin weights of a primitive: four joint numbers and four weights per vertex.
pub(super) struct SkinWeights {
    joints: Vec<[f64; 4]>,
    weights: Vec<[f64; 4]>,
}

impl SkinWeights {
    pub(super) fn read(root: &Root, buffers: &Buffers, primitive: &Primitive) -> Result<Option<Self>, Problem> {
        let accessor = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let (Some(joints), Some(weights)) = (accessor(Semantic::Joints(0)), accessor(Semantic::Weights(0))) else {
            return Ok(None);
        };
        let joints = numbers(root, buffers, joints, "JOINTS_0")?;
        let weights = finite(numbers(root, buffers, weights, "WEIGHTS_0")?, "weights")?;
        Ok(Some(Self { joints, weights }))
    }

    /// Transform from the bind pose to the file at a vertex: the weighted mean of the joints' transforms.
    pub(super) fn blend(&self, vertex: usize, joints: &[DAffine3]) -> Result<DAffine3, Problem> {
        let wrong = |problem: &str| {
            Problem::from(format!("vertex {vertex} of a skinned mesh {problem}; export the file again"))
        };
        let (numbers, weights) =
            self.joints.get(vertex).zip(self.weights.get(vertex)).ok_or_else(|| wrong("has no joints"))?;
        let sum: f64 = weights.iter().sum();
        if sum.is_nan() || sum <= 0.0 {
            return Err(wrong("has no joint with a weight above 0"));
        }
        let mut blend = DAffine3::from_cols(DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for (number, weight) in numbers.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let joint =
                joints.get(*number as usize).ok_or_else(|| wrong("refers to a joint that its skin does not have"))?;
            blend.matrix3 += joint.matrix3 * (weight / sum);
            blend.translation += joint.translation * (weight / sum);
        }
        Ok(blend)
    }
}
