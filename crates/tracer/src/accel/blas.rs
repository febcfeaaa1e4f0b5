//! A mesh's tree, in the mesh's own frame.

use etendue_core::Accelerator;
use glam::Vec3;

use super::build::over_triangles;
use super::collapse::{WideTree, collapse};
use super::lanes::{LaneTask, Lanes, Visit};
use super::node::{Child, Node};
use super::packet::{BestHit, HalfPacket, Packet, PrimitiveNames, RayLanes};
use super::ray::{LocalRay, SlabRay};
use super::walk::{Leaves, walk};
use crate::geometry::Mesh;

/// Triangles per leaf: as many as are tested at once.
const LEAF_SIZE: usize = 8;

/// A tree over the triangles of a mesh.
#[derive(Clone, Debug)]
pub(crate) struct Blas {
    nodes: Vec<Node>,
    /// The leaves' triangles; a leaf's index is twice that of its first half, plus one if it has two halves.
    halves: Vec<HalfPacket>,
    root: Option<Child>,
}

impl Blas {
    /// Builds the tree. The same mesh and quality give the same tree; every quality gives the same hits.
    pub(crate) fn new(mesh: &Mesh, quality: Accelerator) -> Self {
        Self::over(mesh.triangles().len(), |p| mesh.corners(p), quality)
    }

    /// A tree over `count` triangles with the given corners.
    pub(super) fn over(count: usize, corners: impl Fn(u32) -> [Vec3; 3] + Sync, quality: Accelerator) -> Self {
        let binary = over_triangles(count, &corners, quality);
        // Enough for uniform meshes; for others the vector grows, since memory is short at this point.
        let mut halves = Vec::with_capacity(count * 9 / 32 + 2);
        let WideTree { nodes, root } = collapse(&binary, LEAF_SIZE, |leaf| {
            let first = halves.len();
            if halves.capacity() < first + 2 {
                halves.reserve_exact(count / 16 + 2);
            }
            halves.extend(HalfPacket::from_primitives(leaf, &corners));
            2 * first + halves.len() - first - 1
        });
        halves.shrink_to_fit();
        Self { nodes, halves, root }
    }

    /// Returns the size of its nodes and triangles, bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.halves.as_slice())
    }

    #[inline(always)]
    fn packet(&self, leaf: usize) -> Packet<'_> {
        Packet::new(&self.halves, leaf / 2, leaf / 2 + leaf % 2)
    }

    /// Offers the triangles that the ray hits with 0 < t ≤ `limit` to `best`, by their `names`; near ones tend to come first, and `limit`
    /// is lowered to the best.
    #[inline(always)]
    pub(super) fn closest<L: Lanes>(
        &self,
        l: L,
        ray: &LocalRay,
        names: PrimitiveNames<'_>,
        best: &mut BestHit,
        limit: &mut f32,
    ) {
        l.run(ClosestQuery { tree: self, ray, names, best, limit });
    }

    /// True if the ray hits a triangle with 0 < t < `t_max`.
    #[inline(always)]
    pub(super) fn occluded<L: Lanes>(&self, l: L, ray: &LocalRay, t_max: f32) -> bool {
        l.run(OcclusionQuery { tree: self, ray, t_max })
    }
}

/// A separate job, so that the compiler keeps the data of a traversal in registers.
struct ClosestQuery<'a> {
    tree: &'a Blas,
    ray: &'a LocalRay,
    names: PrimitiveNames<'a>,
    best: &'a mut BestHit,
    limit: &'a mut f32,
}

impl LaneTask for ClosestQuery<'_> {
    type Output = ();

    #[inline(always)]
    fn work<L: Lanes>(self, l: L) {
        let Self { tree, ray, names, best, limit } = self;
        let Some(root) = tree.root else { return };
        let mut leaves = ClosestLeaf { l, tree, ray, names, best };
        walk::<L, true>(l, &tree.nodes, root, &SlabRay::with_inverse(ray.origin, ray.inverse), limit, &mut leaves);
    }
}

struct OcclusionQuery<'a> {
    tree: &'a Blas,
    ray: &'a LocalRay,
    t_max: f32,
}

impl LaneTask for OcclusionQuery<'_> {
    type Output = bool;

    #[inline(always)]
    fn work<L: Lanes>(self, l: L) -> bool {
        let Self { tree, ray, t_max } = self;
        let Some(root) = tree.root else { return false };
        let mut leaves = AnyLeaf { l, tree, ray };
        walk::<L, false>(
            l,
            &tree.nodes,
            root,
            &SlabRay::with_inverse(ray.origin, ray.inverse),
            &mut { t_max },
            &mut leaves,
        )
    }
}

struct ClosestLeaf<'a, L: Lanes> {
    l: L,
    tree: &'a Blas,
    ray: &'a LocalRay,
    names: PrimitiveNames<'a>,
    best: &'a mut BestHit,
}

impl<L: Lanes> Leaves for ClosestLeaf<'_, L> {
    #[inline(always)]
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool {
        self.l.record_visit(Visit::Leaf);
        let spread = RayLanes::new(self.l, self.ray);
        if let Some(meeting) = self.tree.packet(leaf).intersect(self.l, &spread, self.ray, *limit) {
            for hit in meeting {
                self.best.accept(self.names, hit, limit);
            }
        }
        false
    }
}

struct AnyLeaf<'a, L: Lanes> {
    l: L,
    tree: &'a Blas,
    ray: &'a LocalRay,
}

impl<L: Lanes> Leaves for AnyLeaf<'_, L> {
    #[inline(always)]
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool {
        self.l.record_visit(Visit::Leaf);
        let spread = RayLanes::new(self.l, self.ray);
        self.tree.packet(leaf).occludes(self.l, &spread, self.ray, *limit)
    }
}
