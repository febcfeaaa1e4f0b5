//! The memory of the tree under which a view of the scene writes out instances (`etendue_tracer::render_space`).

use etendue_tracer::accel::World;
use etendue_tracer::geometry::Shape;
use glam::Vec3;

/// Triangles that are written out at most.
const MAX_TRIANGLES: usize = 1 << 19;
/// A node of the binary tree that is built first: a box and two indices.
const NODE_BYTES: usize = 2 * size_of::<[f32; 4]>();
/// A triangle while its tree is built: its corners, its box, the reference that is sorted, and two nodes before and after they are improved.
const BUILDING_BYTES: usize = size_of::<[Vec3; 3]>() + size_of::<[Vec3; 2]>() + NODE_BYTES + 2 * 2 * NODE_BYTES;
/// A triangle in the tree: a quarter of a group of four with their numbers, as much for groups that are not full and for nodes, and its name.
const HELD_BYTES: usize = 2 * size_of::<[f32; 10]>() + size_of::<[u32; 2]>();

/// The memory of a view, bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ViewMemory {
    /// While its tree is built.
    pub(super) building: f64,
    /// As long as it is looked at.
    pub(super) held: f64,
}

impl ViewMemory {
    pub(super) fn new(world: &World) -> Self {
        let triangles = |shape: &Shape| match shape {
            Shape::Mesh(id) => world.mesh(*id).triangles().len(),
            Shape::Sphere { .. } => 0,
        };
        let seen: usize = world.instances().iter().map(|instance| triangles(&instance.shape)).sum();
        let written_out = seen.min(MAX_TRIANGLES);
        Self { building: (written_out * BUILDING_BYTES) as f64, held: (written_out * HELD_BYTES) as f64 }
    }

    /// Of a stage that builds a view and then takes so many bytes as long as it looks at it; nothing where it takes none.
    pub(super) fn beside(&self, bytes: f64) -> f64 {
        if bytes == 0.0 { 0.0 } else { self.building.max(bytes + self.held) }
    }
}
