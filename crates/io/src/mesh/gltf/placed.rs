//! Meshes in their places.

use glam::DAffine3;

/// A mesh as a node of the scene shows it.
pub(super) struct PlacedMesh {
    /// Its number in the file.
    pub(super) mesh: usize,
    /// From its own axes to those of the file; of a skinned mesh the skin says it.
    pub(super) to_file: DAffine3,
    /// From its own axes at the bind pose to those of the file, joint by joint; `None` where it has no skin.
    pub(super) joints: Option<Vec<DAffine3>>,
}
