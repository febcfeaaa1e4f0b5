//! A mesh whose vertices move, as a view has it: with a tree of its own, made for the view's interval.

use super::best::{Best, Names};
use super::blas::Blas;
use super::build::TreeQuality;
use super::lanes::Lanes;
use super::local::LocalRay;
use super::swept::SweptTree;
use crate::geometry::Mesh;
use etendue_core::TimeInterval;

/// The tree of a mesh whose vertices move.
#[derive(Clone, Debug)]
pub(super) enum AnimatedTree<'w> {
    /// Nothing moves during the interval.
    Posed(Blas),
    /// Something does.
    Swept(SweptTree<'w>),
}

impl<'w> AnimatedTree<'w> {
    /// Builds the tree for an interval.
    pub(super) fn new(mesh: &'w Mesh, interval: TimeInterval, quality: TreeQuality) -> Self {
        match mesh.still_over(interval) {
            Some(pose) => Self::Posed(Blas::over(mesh.triangles().len(), |p| pose.corners(p), quality)),
            None => Self::Swept(SweptTree::new(mesh, interval, quality)),
        }
    }

    /// Offers the triangles that a ray in the mesh's frame, of this time, meets with 0 < t ≤ `limit` to `best`, which lowers it.
    pub(super) fn closest<L: Lanes>(
        &self,
        l: L,
        ray: (&LocalRay, f32),
        names: Names<'_>,
        best: &mut Best,
        limit: &mut f32,
    ) {
        match self {
            Self::Posed(tree) => tree.closest(l, ray.0, names, best, limit),
            Self::Swept(tree) => tree.closest(l, ray, names, best, limit),
        }
    }

    /// Whether a ray in the mesh's frame, of this time, meets a triangle with 0 < t < `t_max`.
    pub(super) fn occluded<L: Lanes>(&self, l: L, ray: (&LocalRay, f32), t_max: f32) -> bool {
        match self {
            Self::Posed(tree) => tree.occluded(l, ray.0, t_max),
            Self::Swept(tree) => tree.occluded(l, ray, t_max),
        }
    }
}
