//! The image of a whole object, whatever hides it.

use super::pixel_box::PixelBox;
use crate::plan::Plan;
use crate::render::frame_view::FrameView;
use crate::render::motion::{OwnPoint, image_of};
use etendue_tracer::geometry::{Instance, Mesh, Shape};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::ops::Range;

/// Points on the outline of a sphere: a circle through 256 of its points is short by 7.5e-5 of its radius.
const OUTLINE: u32 = 256;
/// Points on the edges of a mesh of few triangles, of which distortion bends the images.
const ON_EDGES: usize = 512;
/// How far (of its size, and px) beyond the box of those points the pixels of an object are looked for.
const BULGE: f64 = 0.1;
const MARGIN_PX: f64 = 1.0;

/// The image of an object.
#[derive(Clone, Copy, Debug)]
pub(super) struct Amodal {
    /// About the images of its points; `None` where none has one.
    pub(super) image: Option<PixelBox>,
    /// Whether some have none.
    pub(super) is_cut: bool,
}

impl Amodal {
    /// The image of an instance in a frame; a sphere's outline is that seen at `time_s`.
    pub(super) fn of(plan: &Plan, frame: &FrameView<'_>, instance: &Instance, time_s: f64) -> Self {
        let image = |own: OwnPoint<'_>| {
            image_of(frame, own, &instance.to_world).map(|at_px| PixelBox { low: at_px, high: at_px })
        };
        let points = points(plan, frame, instance, time_s);
        let all = points.len();
        let boxes = points.into_par_iter().filter_map(image).map(|b| (1, b));
        let found = boxes.reduce_with(|a, b| (a.0 + b.0, a.1.about(&b.1)));
        Self { image: found.map(|(_, image)| image), is_cut: found.map_or(0, |(n, _)| n) < all || all == 0 }
    }

    /// Columns and rows of the pixels that may show the object: of the whole picture where a part of it has no image; `None` where it lies
    /// outside.
    pub(super) fn pixels(&self, width: usize, height: usize) -> Option<[Range<usize>; 2]> {
        let Some(image) = self.image.filter(|_| !self.is_cut) else { return Some([0..width, 0..height]) };
        let margin = (image.high - image.low) * BULGE + MARGIN_PX;
        let PixelBox { low, high } =
            PixelBox { low: image.low - margin, high: image.high + margin }.within(width, height)?;
        Some([low.x as usize..high.x.ceil() as usize, low.y as usize..high.y.ceil() as usize])
    }
}

/// Points whose images bound that of the object, in the instance's own frame: a mesh's vertices and points on its edges, or of a sphere's
/// outline; none of a sphere about the camera. (An image is bounded by images of edges: a lens maps directions one to one.)
fn points<'w>(plan: &'w Plan, frame: &FrameView<'_>, instance: &Instance, time_s: f64) -> Vec<OwnPoint<'w>> {
    match instance.shape {
        Shape::Mesh(id) => on_edges(plan.world.mesh(id)),
        Shape::Sphere { radius_m } => {
            let to_local = instance.to_world.at(time_s).inverse();
            let eye = to_local.transform_point3(frame.pose_at(time_s).position_m);
            outline(radius_m, eye).into_iter().map(OwnPoint::Fixed).collect()
        }
    }
}

fn on_edges(mesh: &Mesh) -> Vec<OwnPoint<'_>> {
    let mut edges: Vec<[u32; 2]> = mesh
        .triangles()
        .iter()
        .flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]].map(|[a, b]| [*a.min(b), *a.max(b)]))
        .collect();
    edges.sort_unstable();
    edges.dedup();
    let parts = ON_EDGES.checked_div(edges.len()).unwrap_or(0).max(1);
    let mut vertices: Vec<u32> = edges.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    let mut points: Vec<OwnPoint<'_>> = vertices.into_iter().map(|vertex| between(mesh, [vertex; 2], 0.0)).collect();
    for edge in edges {
        points.extend((1..parts).map(|i| between(mesh, edge, i as f64 / parts as f64)));
    }
    points
}

/// A point of an edge, this share of its length from the first vertex.
fn between(mesh: &Mesh, [a, b]: [u32; 2], share: f64) -> OwnPoint<'_> {
    if mesh.animation().is_some() {
        return OwnPoint::Between { mesh, vertices: [a, b, b], weights: [1.0 - share, share, 0.0] };
    }
    let [from, to] = [a, b].map(|vertex| mesh.positions()[vertex as usize].as_dvec3());
    OwnPoint::Fixed(if a == b { from } else { from.lerp(to, share) })
}

/// Points of the circle in which rays from `eye` touch a sphere about the origin: affine maps keep what touches, so that it is the outline in
/// a stretched instance as well.
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
