//! Ground truth: the hit of each pixel's principal ray. Point-sampled, never filtered: a surface with opacity is present where it is at least one half.

use crate::plan::camera_body::has_planar_depth;
use crate::plan::{CameraPlan, Plan, TimeDependence};
use crate::render::exposure::{FilmExposure, FrameCapture};
use etendue_core::quantity::{Identity, Length, Quantity, Vector};
use etendue_core::{CameraPose, Plane};
use etendue_optics::front::{FrontRay, Optic};
use etendue_tracer::accel::Simd;
use etendue_tracer::geometry::SurfacePoint;
use etendue_tracer::materials::MaterialTable;
use etendue_tracer::render_space::{RenderSpace, Truth};
use etendue_tracer::textures::Lookup;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::ops::Range;

/// Planes of ground truth, in the image raster.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundTruth {
    /// Distance along the camera's axis from the entrance pupil, m; +∞ for the sky, NaN where no principal ray passes and where it looks sideways, backwards
    /// or at a mirror, so that depth along the axis is undefined.
    pub depth: Plane<Length>,
    /// Distance along the pixel's ray from its origin (in the ray table: the centre of the entrance pupil, except for real pupils, which move with the
    /// field), m; with a mirror the whole path from the pupil. +∞ for the sky, NaN where no ray passes.
    pub distance: Plane<Length>,
    /// Unit shading normal in the world; zero for the sky.
    pub normal: Plane<Vector>,
    /// Position in the world, m, rounded to 32 bits; zero for the sky.
    pub position: Plane<Vector>,
    /// Rounding residual of `position`, m: the sum of both is the position to 10⁻⁶ of its distance from the camera. Only for cameras that are more than
    /// [`FAR_M`] from the world's origin along an axis, at any time; otherwise `None`.
    pub position_low: Option<Plane<Vector>>,
    /// Position in the camera's frame, m; z is negative behind the camera; zero for the sky. `None` if not requested.
    pub camera_space_position: Option<Plane<Vector>>,
    /// Instance ids; 0 is the background.
    pub instance: Plane<Identity>,
    /// Class ids; 0 is the background, and objects without a class.
    pub semantic: Plane<Identity>,
    /// Positions in the plan's list of materials, from 1; 0 is the background.
    pub material: Plane<Identity>,
    /// Kind of the pixel's ray: 0 none passes the lens, 1 the principal ray, 2 the ray through the centroid of the open pupil, because the principal ray is
    /// clipped.
    pub ray: Plane<Identity>,
    /// For a camera with a mirror: intersection of the ray with it, in the camera frame, m; NaN if there is none.
    pub mirror: Option<Plane<Vector>>,
}

/// Distance from the world's origin above which a camera's positions are stored in two parts, m: nearer ones are rounded by at most 0.03 mm, or by less than
/// the uncertainty from their distance to the camera.
pub const FAR_M: f64 = 1000.0;

/// Hit of one pixel.
pub(crate) enum GroundTruthHit {
    /// No principal ray: the lens blocks it.
    Nothing,
    Sky {
        ahead: bool,
    },
    Surface {
        depth_m: f64,
        distance_m: f64,
        truth: Truth,
    },
}

/// Origin and time of a pixel's ground-truth ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Viewpoint {
    pub(crate) pose: CameraPose,
    /// Offset from the origin of the render frame to the camera, m.
    offset_m: DVec3,
    /// As [`etendue_core::Ray::time_s`].
    time_s: f32,
}

impl Viewpoint {
    /// A camera at a time, s, in a view of the world.
    pub(crate) fn new(view: &RenderSpace<'_>, camera: &CameraPlan, moment_s: f64) -> Self {
        let pose = camera.path.at(moment_s);
        let time_s = (moment_s - view.interval().start_s()) as f32;
        Self { pose, offset_m: pose.position_m - view.origin_m(), time_s }
    }
}

/// Time of the ground truth of an image row, s: the middle of the row's first exposure.
#[must_use]
pub fn truth_time_s(camera: &CameraPlan, frame: u32, row: usize) -> f64 {
    match camera.time {
        TimeDependence::None => 0.0,
        TimeDependence::Lights | TimeDependence::Motion => camera.timing.row(frame, 0, row).middle_s(),
    }
}

/// A pixel's ray and its hit.
struct PixelHit {
    /// As [`GroundTruth::ray`].
    ray: u32,
    hit: GroundTruthHit,
    mirror_m: Option<DVec3>,
}

/// Ground truth of a camera, along the principal rays (587.56 nm) of its pixel centres. If the lens clips that ray but transmits light, the ray through the
/// centroid of the open pupil is used. Runs on the caller's pool.
#[must_use]
pub fn ground_truth(plan: &Plan, camera: &CameraPlan, frame: u32, simd: Simd) -> GroundTruth {
    TruthRows::new(plan, camera, frame, simd).rows(0..camera.body.raster.height())
}

/// Number of rows whose hits are in memory at the same time: that of a block of an EXR file.
const STRIP_ROWS: usize = 16;

/// Ground truth of a camera, some rows at a time.
#[derive(Debug)]
pub struct TruthRows<'a> {
    view: RenderSpace<'a>,
    material_table: &'a MaterialTable,
    camera: &'a CameraPlan,
    /// By row.
    viewpoints: Vec<Viewpoint>,
}

impl<'a> TruthRows<'a> {
    /// Ground truth of a frame.
    #[must_use]
    pub fn new(plan: &'a Plan, camera: &'a CameraPlan, frame: u32, simd: Simd) -> Self {
        let exposure = FilmExposure::new(camera, FrameCapture { frame, capture: 0 });
        let view = plan.world.render_space_with(exposure.origin_m(), exposure.interval(), simd);
        let rows = 0..camera.body.raster.height();
        let viewpoints = rows.map(|row| Viewpoint::new(&view, camera, truth_time_s(camera, frame, row))).collect();
        Self { view, material_table: &plan.material_table, camera, viewpoints }
    }

    /// Columns and rows of the whole image.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        let raster = &self.camera.body.raster;
        (raster.width(), raster.height())
    }

    /// Bytes of all planes of a camera in memory.
    #[must_use]
    pub fn bytes(camera: &CameraPlan) -> f64 {
        let optional_planes = [camera.products.camera_space_position, has_mirror(camera), is_far(camera)];
        let vectors = 2 + optional_planes.into_iter().filter(|is_requested| *is_requested).count();
        let numbers = 6 + 3 * vectors;
        let raster = &camera.body.raster;
        raster.width() as f64 * raster.height() as f64 * (numbers * size_of::<f32>()) as f64
    }

    /// Returns the memory of the hits of a strip of rows, bytes.
    #[must_use]
    pub fn strip_bytes(camera: &CameraPlan) -> f64 {
        (STRIP_ROWS * camera.body.raster.width() * size_of::<PixelHit>()) as f64
    }

    /// Returns true if some pixel has no depth along the axis: it has no ray, or does not look forward. Traces nothing.
    #[must_use]
    pub fn has_gaps(&self) -> bool {
        let (width, height) = self.size();
        let is_gap = |i: usize| {
            let centre = DVec2::new((i % width) as f64, (i / width) as f64) + 0.5;
            self.camera.body.truth_ray(centre).is_none_or(|(front, _)| !has_planar_depth(&front))
        };
        (0..width * height).into_par_iter().any(is_gap)
    }

    /// Planes of some rows. Runs on the caller's pool.
    #[must_use]
    pub fn rows(&self, rows: Range<usize>) -> GroundTruth {
        let mut truth = self.empty(rows.len());
        for first in rows.clone().step_by(STRIP_ROWS) {
            let strip = first..(first + STRIP_ROWS).min(rows.end);
            let hits = self.trace_rows(strip.clone());
            self.store(&mut truth, (first - rows.start) * self.size().0, strip, &hits);
        }
        truth
    }

    /// Returns empty planes of `height` rows.
    fn empty(&self, height: usize) -> GroundTruth {
        let width = self.size().0;
        let vectors = |is_requested: bool| is_requested.then(|| Plane::new(width, height));
        GroundTruth {
            depth: Plane::new(width, height),
            distance: Plane::new(width, height),
            normal: Plane::new(width, height),
            position: Plane::new(width, height),
            position_low: vectors(is_far(self.camera)),
            camera_space_position: vectors(self.camera.products.camera_space_position),
            instance: Plane::new(width, height),
            semantic: Plane::new(width, height),
            material: Plane::new(width, height),
            ray: Plane::new(width, height),
            mirror: vectors(has_mirror(self.camera)),
        }
    }

    /// Traces the pixels of some rows and returns their hits.
    fn trace_rows(&self, rows: Range<usize>) -> Vec<PixelHit> {
        let width = self.size().0;
        let hit_of = |i: usize| {
            let row = rows.start + i / width;
            let centre = DVec2::new((i % width) as f64, row as f64) + 0.5;
            trace_pixel(&self.view, self.material_table, self.camera, &self.viewpoints[row], centre)
        };
        (0..width * rows.len()).into_par_iter().map(hit_of).collect()
    }

    /// Stores the hits of the pixels of `rows` in the planes, from the sample `at` on.
    fn store(&self, truth: &mut GroundTruth, at: usize, rows: Range<usize>, hits: &[PixelHit]) {
        let rest = |truth: &Truth| truth.position_m - truth.position_m.as_vec3().as_dvec3();
        fill(&mut truth.depth, at, hits, |l| l.hit.depth());
        fill(&mut truth.distance, at, hits, |l| l.hit.distance());
        fill(&mut truth.normal, at, hits, |l| l.hit.vector(|truth| truth.normal));
        fill(&mut truth.position, at, hits, |l| l.hit.vector(|truth| truth.position_m));
        fill(&mut truth.instance, at, hits, |l| l.hit.identity(|truth| truth.instance_id));
        fill(&mut truth.semantic, at, hits, |l| l.hit.identity(|truth| truth.semantic_id));
        fill(&mut truth.material, at, hits, |l| l.hit.identity(|truth| truth.material + 1));
        fill(&mut truth.ray, at, hits, |l| l.ray);
        if let Some(plane) = &mut truth.position_low {
            fill(plane, at, hits, |l| l.hit.vector(rest));
        }
        if let Some(plane) = &mut truth.mirror {
            fill(plane, at, hits, PixelHit::mirror);
        }
        if let Some(plane) = &mut truth.camera_space_position {
            let viewpoints = self.viewpoints[rows].iter().flat_map(|v| std::iter::repeat_n(v, self.size().0));
            let samples = plane.samples_mut()[at..].iter_mut();
            for ((sample, hit), viewpoint) in samples.zip(hits).zip(viewpoints) {
                *sample = hit.hit.vector(|truth| viewpoint.pose.point_to_camera(truth.position_m));
            }
        }
    }

    /// Depth along the axis only, computed some rows at a time. Runs on the caller's pool.
    #[must_use]
    pub fn depth(&self) -> Plane<Length> {
        let (width, height) = self.size();
        let starts = (0..height).step_by(STRIP_ROWS);
        let strips = starts.flat_map(|y| self.rows(y..(y + STRIP_ROWS).min(height)).depth.into_samples());
        Plane::from_samples(width, height, strips.collect()).expect("one sample a pixel")
    }
}

fn is_far(camera: &CameraPlan) -> bool {
    camera.path.max_coordinate_m() > FAR_M
}

fn has_mirror(camera: &CameraPlan) -> bool {
    matches!(camera.body.front.as_ref().and_then(|front| front.optic()), Some(Optic::Mirror(_)))
}

fn trace_pixel(
    view: &RenderSpace<'_>,
    material_table: &MaterialTable,
    camera: &CameraPlan,
    viewpoint: &Viewpoint,
    raster_px: DVec2,
) -> PixelHit {
    match camera.body.truth_ray(raster_px) {
        None => PixelHit { ray: 0, hit: GroundTruthHit::Nothing, mirror_m: None },
        Some((front, off_centre)) => PixelHit {
            ray: 1 + u32::from(off_centre),
            hit: trace(view, material_table, viewpoint, &front),
            mirror_m: front.mirror_m,
        },
    }
}

/// Hit of a ray that has left a camera.
pub(crate) fn trace(
    view: &RenderSpace<'_>,
    material_table: &MaterialTable,
    viewpoint: &Viewpoint,
    front: &FrontRay,
) -> GroundTruthHit {
    let ray = &front.ray;
    let direction = viewpoint.pose.direction_to_world(ray.direction);
    let ahead = has_planar_depth(front);
    let origin_m = viewpoint.pose.point_to_render(ray.origin_m) + viewpoint.offset_m;
    match view.truth(origin_m, direction, viewpoint.time_s, |point| is_there(view, material_table, point)) {
        None => GroundTruthHit::Sky { ahead },
        Some(truth) => {
            let depth_m = if ahead { truth.distance_m * ray.direction.z + ray.origin_m.z } else { f64::NAN };
            GroundTruthHit::Surface { depth_m, distance_m: truth.distance_m + front.path_m, truth }
        }
    }
}

/// Returns true if a surface with opacity is present for ground truth: where the opacity is at least one half. Panes of glass are present.
pub(crate) fn is_there(view: &RenderSpace<'_>, material_table: &MaterialTable, point: &SurfacePoint) -> bool {
    if !material_table.lets_pass(point.material) {
        return true;
    }
    let origin = view.local_origin(point.instance);
    let at = Lookup { local: point.local, origin, local_normal: point.local_normal, ..Lookup::point(point.uv) };
    material_table.opacity(point.material, &at) >= 0.5
}

/// Stores a sample of each hit in the plane, from the sample `at` on.
fn fill<Q: Quantity>(plane: &mut Plane<Q>, at: usize, hits: &[PixelHit], of: impl Fn(&PixelHit) -> Q::Sample) {
    plane.samples_mut()[at..].iter_mut().zip(hits).for_each(|(sample, hit)| *sample = of(hit));
}

impl PixelHit {
    fn mirror(&self) -> [f32; 3] {
        self.mirror_m.map_or([f32::NAN; 3], |m| m.as_vec3().to_array())
    }
}

impl GroundTruthHit {
    pub(crate) fn depth(&self) -> f32 {
        match self {
            Self::Nothing | Self::Sky { ahead: false } => f32::NAN,
            Self::Sky { ahead: true } => f32::INFINITY,
            Self::Surface { depth_m, .. } => *depth_m as f32,
        }
    }

    pub(crate) fn distance(&self) -> f32 {
        match self {
            Self::Nothing => f32::NAN,
            Self::Sky { .. } => f32::INFINITY,
            Self::Surface { distance_m, .. } => *distance_m as f32,
        }
    }

    fn vector(&self, of: impl Fn(&Truth) -> DVec3) -> [f32; 3] {
        match self {
            Self::Surface { truth, .. } => of(truth).as_vec3().to_array(),
            Self::Nothing | Self::Sky { .. } => [0.0; 3],
        }
    }

    fn identity(&self, of: impl Fn(&Truth) -> u32) -> u32 {
        match self {
            Self::Surface { truth, .. } => of(truth),
            Self::Nothing | Self::Sky { .. } => 0,
        }
    }
}
