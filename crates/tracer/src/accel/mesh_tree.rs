//! A mesh's tree, in the mesh's own frame.

use super::best::Best;
use super::build::over_triangles;
use super::collapse::collapse;
use super::lanes::Lanes;
use super::local::LocalRay;
use super::node::{Child, Node};
use super::packet::{Packet, RayLanes};
use super::ray::SlabRay;
use super::walk::{Leaves, walk};
use crate::geometry::Mesh;

/// Triangles a leaf: as many as are met at once.
const LEAF_SIZE: usize = 8;

/// A tree over the triangles of a mesh.
#[derive(Clone, Debug)]
pub(crate) struct MeshTree {
    nodes: Vec<Node>,
    packets: Vec<Packet>,
    root: Option<Child>,
}

impl MeshTree {
    /// Builds the tree. The same mesh gives the same tree.
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let triangles: Vec<_> = (0..mesh.triangles().len() as u32).map(|p| mesh.corners(p)).collect();
        let wide = collapse(&over_triangles(&triangles), LEAF_SIZE);
        let packet = |leaf: &[u32]| {
            let members: Vec<_> = leaf.iter().map(|p| (*p, triangles[*p as usize])).collect();
            Packet::new(&members)
        };
        let packets = wide.leaves.iter().map(|leaf| packet(leaf)).collect();
        Self { nodes: wide.nodes, packets, root: wide.root }
    }

    /// Offers the triangles that the ray meets with 0 < t ≤ `limit` to `best`, as those of `instance`; near ones come
    /// first by and by, and `limit` is lowered to the best.
    #[inline(always)]
    pub(super) fn closest<L: Lanes>(&self, l: L, ray: &LocalRay, instance: u32, best: &mut Best, limit: &mut f32) {
        let Some(root) = self.root else { return };
        let mut leaves = ClosestLeaf { l, tree: self, ray, spread: RayLanes::new(l, ray), instance, best };
        walk::<L, true>(l, &self.nodes, root, &SlabRay::new(ray.origin, ray.direction), limit, &mut leaves);
    }

    /// Whether the ray meets a triangle with 0 < t < `t_max`.
    #[inline(always)]
    pub(super) fn occluded<L: Lanes>(&self, l: L, ray: &LocalRay, t_max: f32) -> bool {
        let Some(root) = self.root else { return false };
        let mut leaves = AnyLeaf { l, tree: self, ray, spread: RayLanes::new(l, ray) };
        walk::<L, false>(l, &self.nodes, root, &SlabRay::new(ray.origin, ray.direction), &mut { t_max }, &mut leaves)
    }
}

struct ClosestLeaf<'a, L: Lanes> {
    l: L,
    tree: &'a MeshTree,
    ray: &'a LocalRay,
    spread: RayLanes<L>,
    instance: u32,
    best: &'a mut Best,
}

impl<L: Lanes> Leaves for ClosestLeaf<'_, L> {
    #[inline(always)]
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool {
        if let Some(meeting) = self.tree.packets[leaf].meet(self.l, &self.spread, self.ray, *limit) {
            for hit in meeting {
                self.best.offer(self.instance, hit, limit);
            }
        }
        false
    }
}

struct AnyLeaf<'a, L: Lanes> {
    l: L,
    tree: &'a MeshTree,
    ray: &'a LocalRay,
    spread: RayLanes<L>,
}

impl<L: Lanes> Leaves for AnyLeaf<'_, L> {
    #[inline(always)]
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool {
        let mut met = false;
        if let Some(meeting) = self.tree.packets[leaf].meet(self.l, &self.spread, self.ray, *limit) {
            for hit in meeting {
                met |= hit.t < *limit;
            }
        }
        met
    }
}
