//! The memory of the scene: of textures, and of the acceleration structure in which a view of the scene flattens instances
//! (`etendue_tracer::render_space`).

use etendue_tracer::accel::World;
use etendue_tracer::geometry::Shape;
use etendue_tracer::materials::MaterialTable;
use glam::Vec3;

/// Maximum number of triangles of flattened instances.
const MAX_TRIANGLES: usize = 1 << 19;
/// Size of a node of the binary tree that is built first: a box and two indices.
const NODE_BYTES: usize = 2 * size_of::<[f32; 4]>();
/// Memory per triangle while the tree is built: its corners, its box, the reference that is sorted, and two nodes before and after optimisation.
const BUILDING_BYTES: usize = size_of::<[Vec3; 3]>() + size_of::<[Vec3; 2]>() + NODE_BYTES + 2 * 2 * NODE_BYTES;
/// Memory per triangle in the tree: a quarter of a group of four with their indices, as much for groups that are not full and for nodes, and its identifier.
const TREE_BYTES: usize = 2 * size_of::<[f32; 10]>() + size_of::<[u32; 2]>();

/// The memory of a view, bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ViewMemory {
    /// Memory while its tree is built.
    pub(super) building: f64,
    /// Memory while it is in use.
    pub(super) stored: f64,
}

impl ViewMemory {
    pub(super) fn new(world: &World) -> Self {
        let triangles = |shape: &Shape| match shape {
            Shape::Mesh(id) => world.mesh(*id).triangles().len(),
            Shape::Sphere { .. } => 0,
        };
        let instanced: usize = world.instances().iter().map(|instance| triangles(&instance.shape)).sum();
        let flattened = instanced.min(MAX_TRIANGLES);
        Self { building: (flattened * BUILDING_BYTES) as f64, stored: (flattened * TREE_BYTES) as f64 }
    }

    /// Returns the memory of a stage that builds a view and then takes `bytes` while it uses the view; 0 if `bytes` is 0.
    pub(super) fn stage_bytes(&self, bytes: f64) -> f64 {
        if bytes == 0.0 { 0.0 } else { self.building.max(bytes + self.stored) }
    }
}

/// Bytes of texels, and their storage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::report) struct TextureUse {
    /// Bytes of the textures in memory.
    bytes_in_memory: u64,
    /// Number of textures in tiles on disk.
    tiled: usize,
    /// Bytes of these on disk.
    tiled_bytes: u64,
    /// Maximum bytes of these in memory.
    limit_bytes: u64,
}

impl TextureUse {
    pub(in crate::report) fn from_materials(materials: &MaterialTable) -> Self {
        let mut all = Self::default();
        for texture in materials.textures() {
            all.bytes_in_memory += texture.texel_bytes() as u64;
            if let Some((bytes, memory)) = texture.tiles() {
                all.tiled += 1;
                all.tiled_bytes += bytes;
                // All textures share one memory limit.
                all.limit_bytes = memory.limit_bytes();
            }
        }
        all
    }

    /// Maximum memory, bytes.
    pub(in crate::report) fn memory_bytes(&self) -> u64 {
        self.bytes_in_memory + self.limit_bytes.min(self.tiled_bytes)
    }

    /// Textures on disk, as text; `None` without any.
    pub(in crate::report) fn tiles(&self) -> Option<String> {
        let [tiled, limit] = [self.tiled_bytes, self.limit_bytes].map(|bytes| bytes.div_ceil(1_000_000));
        let count = self.tiled;
        (count > 0).then(|| format!("{count} in tiles on disk, {tiled} MB; at most {limit} MB of them in memory"))
    }
}
