//! Shapes placed in the world.

use crate::MaterialId;
use etendue_core::Motion;

/// A mesh's place in the world's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MeshId(pub u32);

/// What an instance shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A triangle mesh.
    Mesh(MeshId),
    /// A sphere about the origin of its own frame.
    Sphere {
        /// Radius in its own frame, m.
        radius_m: f64,
    },
}

/// A shape placed in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// What is placed.
    pub shape: Shape,
    /// From the shape's own frame to the world.
    pub to_world: Motion,
    /// The material of each slot of the shape; a sphere has one slot.
    pub materials: Vec<MaterialId>,
    /// Identity of the object in ground truth; 0 is the background.
    pub instance_id: u32,
    /// Class of the object in ground truth; 0 is the background.
    pub semantic_id: u32,
}
