//! A mesh at one time.

use etendue_core::TimeInterval;
use glam::{DVec3, Vec2, Vec3};

use super::{Mesh, VertexAnimation, mesh::TriangleFacet, vertex_animation::FrameBlend};

/// A mesh at one time: its own vertices, or those of its animation.
#[derive(Clone, Copy, Debug)]
pub struct MeshPose<'m> {
    mesh: &'m Mesh,
    moved: Option<(&'m VertexAnimation, FrameBlend)>,
}

impl Mesh {
    /// The mesh at a simulated time, s.
    #[must_use]
    pub fn at(&self, time_s: f64) -> MeshPose<'_> {
        match self.animation() {
            None => MeshPose::from_mesh(self),
            Some(animation) => MeshPose::moved(self, animation, animation.span(time_s)),
        }
    }

    /// The mesh during a whole interval; `None` if some vertex moves.
    pub(crate) fn static_over(&self, interval: TimeInterval) -> Option<MeshPose<'_>> {
        let Some(animation) = self.animation() else { return Some(MeshPose::from_mesh(self)) };
        animation.static_span(interval).map(|span| MeshPose::moved(self, animation, span))
    }

    /// Poses between which all vertices move straight during an interval, in no order.
    pub(crate) fn poses_of(&self, interval: TimeInterval) -> Vec<MeshPose<'_>> {
        let Some(animation) = self.animation() else { return vec![MeshPose::from_mesh(self)] };
        let spans = animation.corners_of(interval).into_iter();
        spans.map(|span| MeshPose::moved(self, animation, span)).collect()
    }
}

impl<'m> MeshPose<'m> {
    /// A mesh whose vertices do not move.
    #[inline(always)]
    pub(crate) fn from_mesh(mesh: &'m Mesh) -> Self {
        Self { mesh, moved: None }
    }

    fn moved(mesh: &'m Mesh, animation: &'m VertexAnimation, span: FrameBlend) -> Self {
        Self { mesh, moved: Some((animation, span)) }
    }

    pub(crate) fn mesh(&self) -> &'m Mesh {
        self.mesh
    }

    /// The corners of a triangle.
    #[inline(always)]
    #[must_use]
    pub fn corners(&self, primitive: u32) -> [Vec3; 3] {
        match self.moved {
            None => self.mesh.corners(primitive),
            Some((animation, span)) => self.vertices(primitive).map(|v| animation.position(span, v)),
        }
    }

    /// A vertex, not rounded to f32.
    #[must_use]
    pub fn exact_position(&self, vertex: u32) -> DVec3 {
        match self.moved {
            None => self.mesh.positions()[vertex as usize].as_dvec3(),
            Some((animation, span)) => animation.exact_position(span, vertex),
        }
    }

    /// Data of a triangle that every hit needs.
    #[inline(always)]
    pub(crate) fn facet(&self, primitive: u32) -> TriangleFacet {
        match self.moved {
            None => *self.mesh.facet(primitive),
            Some(_) => TriangleFacet::new(
                self.corners(primitive),
                self.normals(primitive),
                self.mesh.slots()[primitive as usize],
            ),
        }
    }

    /// The normals of a triangle's vertices, as given; `None` without normals.
    #[inline(always)]
    pub(crate) fn normals(&self, primitive: u32) -> Option<[Vec3; 3]> {
        match self.moved {
            None => {
                let normals = self.mesh.normals();
                (!normals.is_empty()).then(|| self.vertices(primitive).map(|v| normals[v as usize]))
            }
            Some((animation, span)) => {
                let [a, b, c] = self.vertices(primitive).map(|v| animation.normal(span, v));
                Some([a?, b?, c?])
            }
        }
    }

    /// The texture coordinates of a triangle's vertices; `None` without.
    #[inline(always)]
    pub(crate) fn uvs(&self, primitive: u32) -> Option<[Vec2; 3]> {
        let uvs = self.mesh.uvs();
        (!uvs.is_empty()).then(|| self.vertices(primitive).map(|v| uvs[v as usize]))
    }

    /// Minimum and maximum coordinates of the triangles; `None` without triangles.
    #[must_use]
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        if self.moved.is_none() {
            return self.mesh.bounds();
        }
        let corners = (0..self.mesh.triangles().len() as u32).flat_map(|primitive| self.corners(primitive));
        corners.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    #[inline(always)]
    fn vertices(&self, primitive: u32) -> [u32; 3] {
        self.mesh.triangles()[primitive as usize]
    }
}
