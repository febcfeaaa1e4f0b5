//! The tree of a mesh whose vertices move during a view's interval.
//!
//! Between the interval's ends and the times of frames inside it every vertex moves straight, so that a triangle stays within the box of its corners
//! at all of these times: the boxes of the tree. A leaf names its triangles, whose corners are computed at the ray's own time and tested like static
//! ones. Two triangles that share a vertex compute the same bits for it.

use etendue_core::{Accelerator, TimeInterval};

use super::collapse::{WideTree, collapse};
use super::lanes::{LaneTask, Lanes, Visit};
use super::node::{Child, Node};
use super::packet::{BestHit, HalfPacket, Packet, PrimitiveNames, RayLanes};
use super::ray::{LocalRay, SlabRay};
use super::walk::{Leaves, walk};
use super::{blas::Blas, boxes::Box3, build::over_moving};
use crate::geometry::{Mesh, MeshPose};

/// Triangles per leaf: as many as are tested at once.
const LEAF_SIZE: usize = 8;

/// The tree of a mesh in motion.
#[derive(Clone, Debug)]
pub(super) struct SweptTree<'w> {
    mesh: &'w Mesh,
    interval: TimeInterval,
    nodes: Vec<Node>,
    /// Start and end of the triangles of each leaf in `primitives`.
    leaves: Vec<[u32; 2]>,
    primitives: Vec<u32>,
    root: Option<Child>,
}

impl<'w> SweptTree<'w> {
    /// Builds the tree of a mesh for an interval.
    pub(super) fn new(mesh: &'w Mesh, interval: TimeInterval, quality: Accelerator) -> Self {
        let poses = mesh.poses_of(interval);
        let swept = |primitive: u32| {
            let boxes = poses.iter().map(|pose| Box3::about(&pose.corners(primitive)));
            boxes.reduce(|a, b| a.union(&b)).expect("a pose at least")
        };
        let binary = over_moving(mesh.triangles().len(), swept, quality);
        let (mut leaves, mut primitives) = (Vec::new(), Vec::new());
        let WideTree { nodes, root } = collapse(&binary, LEAF_SIZE, |leaf| {
            let begin = primitives.len() as u32;
            primitives.extend_from_slice(leaf);
            leaves.push([begin, primitives.len() as u32]);
            leaves.len() - 1
        });
        Self { mesh, interval, nodes, leaves, primitives, root }
    }

    /// Offers the triangles that a ray of this time ([`etendue_core::Ray::time_s`]) hits with 0 < t ≤ `limit` to `best`, which lowers it.
    pub(super) fn closest<L: Lanes>(
        &self,
        l: L,
        ray: &LocalRay,
        time_s: f32,
        names: PrimitiveNames<'_>,
        best: &mut BestHit,
        limit: &mut f32,
    ) {
        let pose = self.mesh.at(self.interval.moment(time_s));
        l.run(ClosestQuery { tree: self, pose, ray, names, best, limit });
    }

    /// True if a ray of this time hits a triangle with 0 < t < `t_max`.
    pub(super) fn occluded<L: Lanes>(&self, l: L, ray: &LocalRay, time_s: f32, t_max: f32) -> bool {
        let pose = self.mesh.at(self.interval.moment(time_s));
        l.run(OcclusionQuery { tree: self, pose, ray, t_max })
    }

    /// The triangles of a leaf in a pose; the second half is the first if there are four at most.
    #[inline(always)]
    fn halves(&self, pose: &MeshPose<'_>, leaf: usize) -> ([HalfPacket; 2], usize) {
        let [begin, end] = self.leaves[leaf];
        let primitives = &self.primitives[begin as usize..end as usize];
        let (first, second) = primitives.split_at(primitives.len().min(HalfPacket::SIZE));
        let first = HalfPacket::new(first, |primitive| pose.corners(primitive));
        if second.is_empty() {
            return ([first.clone(), first], 0);
        }
        ([first, HalfPacket::new(second, |primitive| pose.corners(primitive))], 1)
    }
}

struct ClosestQuery<'a> {
    tree: &'a SweptTree<'a>,
    pose: MeshPose<'a>,
    ray: &'a LocalRay,
    names: PrimitiveNames<'a>,
    best: &'a mut BestHit,
    limit: &'a mut f32,
}

impl LaneTask for ClosestQuery<'_> {
    type Output = ();

    #[inline(always)]
    fn work<L: Lanes>(self, l: L) {
        let Self { tree, pose, ray, names, best, limit } = self;
        let Some(root) = tree.root else { return };
        let slab = SlabRay::with_inverse(ray.origin, ray.inverse);
        walk::<L, true>(l, &tree.nodes, root, &slab, limit, &mut ClosestLeaf { l, tree, pose, ray, names, best });
    }
}

struct ClosestLeaf<'a, L: Lanes> {
    l: L,
    tree: &'a SweptTree<'a>,
    pose: MeshPose<'a>,
    ray: &'a LocalRay,
    names: PrimitiveNames<'a>,
    best: &'a mut BestHit,
}

impl<L: Lanes> Leaves for ClosestLeaf<'_, L> {
    #[inline(always)]
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool {
        self.l.record_visit(Visit::Leaf);
        let spread = RayLanes::new(self.l, self.ray);
        let (halves, second) = self.tree.halves(&self.pose, leaf);
        if let Some(meeting) = Packet::new(&halves, 0, second).intersect(self.l, &spread, self.ray, *limit) {
            for hit in meeting {
                self.best.accept(self.names, hit, limit);
            }
        }
        false
    }
}

struct OcclusionQuery<'a> {
    tree: &'a SweptTree<'a>,
    pose: MeshPose<'a>,
    ray: &'a LocalRay,
    t_max: f32,
}

impl LaneTask for OcclusionQuery<'_> {
    type Output = bool;

    #[inline(always)]
    fn work<L: Lanes>(self, l: L) -> bool {
        let Self { tree, pose, ray, t_max } = self;
        let Some(root) = tree.root else { return false };
        let slab = SlabRay::with_inverse(ray.origin, ray.inverse);
        walk::<L, false>(l, &tree.nodes, root, &slab, &mut { t_max }, &mut AnyLeaf { l, tree, pose, ray })
    }
}

struct AnyLeaf<'a, L: Lanes> {
    l: L,
    tree: &'a SweptTree<'a>,
    pose: MeshPose<'a>,
    ray: &'a LocalRay,
}

impl<L: Lanes> Leaves for AnyLeaf<'_, L> {
    #[inline(always)]
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool {
        self.l.record_visit(Visit::Leaf);
        let spread = RayLanes::new(self.l, self.ray);
        let (halves, second) = self.tree.halves(&self.pose, leaf);
        Packet::new(&halves, 0, second).occludes(self.l, &spread, self.ray, *limit)
    }
}

/// The tree of a mesh whose vertices move.
#[derive(Clone, Debug)]
pub(super) enum AnimatedTree<'w> {
    /// No vertex moves during the interval.
    Posed(Blas),
    /// Vertices move during the interval.
    Swept(SweptTree<'w>),
}

impl<'w> AnimatedTree<'w> {
    /// Builds the tree for an interval.
    pub(super) fn new(mesh: &'w Mesh, interval: TimeInterval, quality: Accelerator) -> Self {
        match mesh.static_over(interval) {
            Some(pose) => Self::Posed(Blas::over(mesh.triangles().len(), |p| pose.corners(p), quality)),
            None => Self::Swept(SweptTree::new(mesh, interval, quality)),
        }
    }

    /// Offers the triangles that a ray in the mesh's frame, of this time, hits with 0 < t ≤ `limit` to `best`, which lowers it.
    pub(super) fn closest<L: Lanes>(
        &self,
        l: L,
        ray: &LocalRay,
        time_s: f32,
        names: PrimitiveNames<'_>,
        best: &mut BestHit,
        limit: &mut f32,
    ) {
        match self {
            Self::Posed(tree) => tree.closest(l, ray, names, best, limit),
            Self::Swept(tree) => tree.closest(l, ray, time_s, names, best, limit),
        }
    }

    /// True if a ray in the mesh's frame, of this time, hits a triangle with 0 < t < `t_max`.
    pub(super) fn occluded<L: Lanes>(&self, l: L, ray: &LocalRay, time_s: f32, t_max: f32) -> bool {
        match self {
            Self::Posed(tree) => tree.occluded(l, ray, t_max),
            Self::Swept(tree) => tree.occluded(l, ray, time_s, t_max),
        }
    }
}
