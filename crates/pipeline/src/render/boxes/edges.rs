//! Edges of an object; their images bound its image.

use crate::plan::Plan;
use crate::render::frame_view::FrameView;
use crate::render::motion::OwnPoint;
use etendue_tracer::geometry::{Instance, Mesh, Shape};
use glam::{DVec2, DVec3};

/// Number of points on the outline of a sphere: the polygon of 256 points deviates from the circle by 7.5e-5 of its radius.
const OUTLINE: u32 = 256;
/// Number of points on the edges of a mesh of few triangles, whose images distortion bends.
const ON_EDGES: usize = 512;

/// A straight edge in the instance's own frame.
pub(super) enum ObjectEdge<'w> {
    /// From one vertex of a mesh to another.
    OfMesh { mesh: &'w Mesh, ends: [u32; 2] },
    /// From one point to another.
    Between([DVec3; 2]),
}

impl<'w> ObjectEdge<'w> {
    /// Point at a fraction of its length from its first end, 0 to 1.
    pub(super) fn at(&self, fraction: f64) -> OwnPoint<'w> {
        let between = |[from, to]: [DVec3; 2]| {
            OwnPoint::Fixed(if fraction <= 0.0 {
                from
            } else if fraction >= 1.0 {
                to
            } else {
                from.lerp(to, fraction)
            })
        };
        match *self {
            Self::OfMesh { mesh, ends: [a, b] } if mesh.animation().is_some() => {
                OwnPoint::Between { mesh, vertices: [a, b, b], weights: [1.0 - fraction, fraction, 0.0] }
            }
            Self::OfMesh { mesh, ends } => between(ends.map(|vertex| mesh.positions()[vertex as usize].as_dvec3())),
            Self::Between(ends) => between(ends),
        }
    }
}

/// The edges of an object.
pub(super) struct ObjectEdges<'w> {
    pub(super) edges: Vec<ObjectEdge<'w>>,
    /// Number of parts of each edge, because distortion bends its image.
    pub(super) parts: usize,
    /// Vertices of the mesh that edges use, each once; empty if the edges are a closed line.
    vertices: Vec<ObjectEdge<'w>>,
}

impl<'w> ObjectEdges<'w> {
    /// Edges of a mesh, or chords of a sphere's outline as the frame's camera sees it at `time_s`; none for a sphere that contains the camera. (Images of
    /// edges bound an image, because a lens maps directions one to one.)
    pub(super) fn new(plan: &'w Plan, frame: &FrameView<'_>, instance: &Instance, time_s: f64) -> Self {
        match instance.shape {
            Shape::Mesh(id) => Self::from_mesh(plan.world.mesh(id)),
            Shape::Sphere { radius_m } => {
                let to_local = instance.to_world.at(time_s).inverse();
                let points = outline(radius_m, to_local.transform_point3(frame.pose_at(time_s).position_m));
                let chord = |i: usize| ObjectEdge::Between([points[i], points[(i + 1) % points.len()]]);
                Self { edges: (0..points.len()).map(chord).collect(), parts: 1, vertices: Vec::new() }
            }
        }
    }

    fn from_mesh(mesh: &'w Mesh) -> Self {
        let mut ends: Vec<[u32; 2]> = mesh
            .triangles()
            .iter()
            .flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]].map(|[a, b]| [*a.min(b), *a.max(b)]))
            .collect();
        ends.sort_unstable();
        ends.dedup();
        let mut vertices: Vec<u32> = ends.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        Self {
            parts: ON_EDGES.checked_div(ends.len()).unwrap_or(0).max(1),
            vertices: vertices.into_iter().map(|vertex| ObjectEdge::OfMesh { mesh, ends: [vertex; 2] }).collect(),
            edges: ends.into_iter().map(|ends| ObjectEdge::OfMesh { mesh, ends }).collect(),
        }
    }

    /// Points on the edges, each once: their ends and division points.
    pub(super) fn points(&self) -> Vec<OwnPoint<'w>> {
        let ends = if self.vertices.is_empty() { &self.edges } else { &self.vertices };
        let mut points: Vec<OwnPoint<'w>> = ends.iter().map(|edge| edge.at(0.0)).collect();
        for edge in &self.edges {
            points.extend((1..self.parts).map(|i| edge.at(i as f64 / self.parts as f64)));
        }
        points
    }
}

/// Points of the circle in which rays from `eye` touch a sphere at the origin. Affine maps preserve tangency, so that it is the outline in a scaled instance
/// as well.
fn outline(radius_m: f64, eye: DVec3) -> Vec<DVec3> {
    let distance_m = eye.length();
    if distance_m <= radius_m {
        return Vec::new();
    }
    let (towards, ratio) = (eye / distance_m, radius_m / distance_m);
    let (x, y) = towards.any_orthonormal_pair();
    let circle_m = radius_m * (1.0 - ratio * ratio).sqrt();
    let point = |i: u32| {
        let (sin, cos) = etendue_core::maths::f64::sin_cos(f64::from(i) / f64::from(OUTLINE) * core::f64::consts::TAU);
        let around = DVec2::new(cos, sin) * circle_m;
        towards * (radius_m * ratio) + x * around.x + y * around.y
    };
    (0..OUTLINE).map(point).collect()
}
