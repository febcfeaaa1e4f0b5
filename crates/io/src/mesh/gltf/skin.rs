//! Skins as they stand at rest.

use crate::Problem;
use glam::{DAffine3, DMat4, DVec3};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};

use super::accessor::{finite, numbers};
use super::buffers::Buffers;

/// From a skinned mesh's bind pose to the file, joint by joint.
pub(super) fn joints(
    root: &Root,
    buffers: &Buffers,
    skin: usize,
    to_file: &[DAffine3],
) -> Result<Vec<DAffine3>, Problem> {
    let record = root.skins.get(skin).ok_or_else(|| format!("its skin {skin} is not there"))?;
    let bind: Vec<[f64; 16]> = match record.inverse_bind_matrices {
        None => vec![DMat4::IDENTITY.to_cols_array(); record.joints.len()],
        Some(index) => finite(numbers(root, buffers, index, "inverse bind matrices")?, "inverse bind matrix")?,
    };
    if bind.len() < record.joints.len() {
        return Err(format!(
            "its skin {skin} has {} joints and {} inverse bind matrices",
            record.joints.len(),
            bind.len()
        )
        .into());
    }
    let joint = |(joint, bind): (&Index<_>, &[f64; 16])| {
        let place =
            to_file.get(joint.value()).ok_or_else(|| format!("its skin {skin} names a joint that is not there"))?;
        Ok(*place * DAffine3::from_mat4(DMat4::from_cols_array(bind)))
    };
    record.joints.iter().zip(&bind).map(|(index, bind): (&Index<gltf::json::Node>, _)| joint((index, bind))).collect()
}

/// How a primitive's vertices hang on joints: four numbers of joints and four weights a vertex.
pub(super) struct Weights {
    joints: Vec<[f64; 4]>,
    weights: Vec<[f64; 4]>,
}

impl Weights {
    pub(super) fn read(root: &Root, buffers: &Buffers, primitive: &Primitive) -> Result<Option<Self>, Problem> {
        let of = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let (Some(joints), Some(weights)) = (of(Semantic::Joints(0)), of(Semantic::Weights(0))) else {
            return Ok(None);
        };
        let joints = numbers(root, buffers, joints, "JOINTS_0")?;
        let weights = finite(numbers(root, buffers, weights, "WEIGHTS_0")?, "weights")?;
        Ok(Some(Self { joints, weights }))
    }

    /// From the bind pose to the file at a vertex: the joints' mean by their weights.
    pub(super) fn blend(&self, vertex: usize, joints: &[DAffine3]) -> Result<DAffine3, Problem> {
        let told =
            |problem: &str| Problem::from(format!("vertex {vertex} of a skinned mesh {problem}; export it again"));
        let (numbers, weights) =
            self.joints.get(vertex).zip(self.weights.get(vertex)).ok_or_else(|| told("has no joints"))?;
        let sum: f64 = weights.iter().sum();
        if sum.is_nan() || sum <= 0.0 {
            return Err(told("hangs on no joint"));
        }
        let mut blend = DAffine3::from_cols(DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for (number, weight) in numbers.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let joint = joints.get(*number as usize).ok_or_else(|| told("names a joint that its skin has not"))?;
            blend.matrix3 += joint.matrix3 * (weight / sum);
            blend.translation += joint.translation * (weight / sum);
        }
        Ok(blend)
    }
}
