//! Position and visibility of a point in the other frame.

use super::correspondence::{Correspondence, PixelView, correspondence};
use super::image_point::ImageTarget;
use super::surface_path::SurfacePath;
use crate::plan::Plan;
use crate::render::frame_view::FrameView;
use crate::render::look_at::GroundTruthView;
use etendue_core::Plane;
use etendue_core::quantity::{Identity, OpticalFlow, Quantity, Vector};
use etendue_tracer::accel::Simd;
use glam::DVec2;

/// Visibility of a point in the other frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Visibility {
    /// The pixel has no ray of its own.
    #[default]
    NotKnown = 0,
    /// Visible.
    Seen = 1,
    /// Occluded.
    Hidden = 2,
    /// Outside the image.
    Outside = 3,
    /// The lens forms no image of it.
    NoImage = 4,
}

/// Positions, in another frame, of the points that the pixels of a frame see.
#[derive(Clone, Debug, PartialEq)]
pub struct NeighbourTruth {
    /// Position there minus position here, px; NaN if it has no image there. If it is occluded there or outside the image, the position is where it would be
    /// seen.
    pub flow: Plane<OpticalFlow>,
    /// Values of [`Visibility`].
    pub visibility: Plane<Identity>,
    /// Position in the camera's frame there minus that in the camera's frame here, m; NaN for the background.
    pub scene_flow: Plane<Vector>,
}

impl NeighbourTruth {
    pub(super) fn new(width: usize, results: &[NeighbourResult]) -> Self {
        Self {
            flow: plane(results, width, |result| result.flow),
            visibility: plane(results, width, |result| result.visibility as u32),
            scene_flow: plane(results, width, |result| result.scene_flow),
        }
    }
}

/// Result for one pixel's point in the other frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct NeighbourResult {
    flow: [f32; 2],
    visibility: Visibility,
    scene_flow: [f32; 3],
}

impl Default for NeighbourResult {
    fn default() -> Self {
        Self { flow: [f32::NAN; 2], visibility: Visibility::NotKnown, scene_flow: [f32::NAN; 3] }
    }
}

/// Minimum difference in distance, relative to the distance and over the cosine of incidence, by which a nearer surface occludes a point: rays are traced
/// with 32-bit floats, which may hit the neighbouring triangle.
const OCCLUSION_TOLERANCE: f64 = 1e-6;
/// Lower limit of the cosine.
const MIN_COSINE: f64 = 1e-3;

/// Another frame with its world.
pub(super) struct Neighbour<'a>(GroundTruthView<'a>);

impl<'a> Neighbour<'a> {
    pub(super) fn new(plan: &'a Plan, frame: &FrameView<'a>, simd: Simd) -> Self {
        Self(GroundTruthView::new(plan, frame, simd))
    }

    /// Position and visibility, in the frame, of the point seen from `sight` as `here`.
    pub(super) fn find(&self, surface: &SurfacePath<'_>, pixel_view: PixelView, here: ImageTarget) -> NeighbourResult {
        let Some(there) = correspondence(&self.0.frame, surface, pixel_view) else {
            return NeighbourResult { visibility: Visibility::NoImage, ..NeighbourResult::default() };
        };
        let scene_flow = match (here, there.target) {
            (ImageTarget::Point(from), ImageTarget::Point(to)) => (to - from).as_vec3().to_array(),
            _ => [f32::NAN; 3],
        };
        let flow = (there.at_px - pixel_view.at_px).as_vec2().to_array();
        NeighbourResult { flow, visibility: self.visibility(&there), scene_flow }
    }

    fn visibility(&self, there: &Correspondence) -> Visibility {
        let frame = &self.0.frame;
        let raster = &frame.body().raster;
        let size = DVec2::new(raster.width() as f64, raster.height() as f64);
        if !(there.at_px.cmpge(DVec2::ZERO).all() && there.at_px.cmplt(size).all()) {
            return Visibility::Outside;
        }
        let Some((front, _)) = frame.body().truth_ray(there.at_px) else { return Visibility::NoImage };
        let origin_m = front.ray.origin_m;
        let Some(ahead) = there.target.direction_from(origin_m) else { return Visibility::NoImage };
        let hit =
            self.0.first_hit(&there.pose, origin_m, ahead, (there.time_s - frame.interval().start_s()) as f32, None);
        let hidden = match (hit, there.target) {
            (None, _) => false,
            (Some(_), ImageTarget::Direction(_)) => true,
            (Some(hit), ImageTarget::Point(point_m)) => {
                let distance_m = (point_m - origin_m).length();
                let cosine = hit.normal.dot(there.pose.direction_to_world(ahead)).abs().max(MIN_COSINE);
                hit.distance_m < distance_m * (1.0 - OCCLUSION_TOLERANCE / cosine)
            }
        };
        if hidden { Visibility::Hidden } else { Visibility::Seen }
    }
}

/// A plane of one property of `pixels`, `width` per row.
pub(super) fn plane<T, Q: Quantity>(pixels: &[T], width: usize, of: impl Fn(&T) -> Q::Sample) -> Plane<Q> {
    Plane::from_samples(width, pixels.len() / width, pixels.iter().map(of).collect()).expect("one sample a pixel")
}
