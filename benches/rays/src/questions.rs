//! Rays as a renderer asks them: what a camera sees, where light goes on, whether a light is free.

use etendue_core::random::{Draw, FrameAddress, PathStream, Pixel, PixelAddress};
use etendue_core::{Basis, Ray, warp};
use etendue_tracer::geometry::SurfacePoint;
use etendue_tracer::render_space::RenderSpace;
use glam::Vec3;

/// Rays of one kind.
#[derive(Clone, Debug)]
pub struct RayQueries {
    /// What they are.
    pub name: &'static str,
    /// The rays.
    pub rays: Vec<Ray>,
    /// Whether any hit answers, or only the first.
    pub any_hit: bool,
}

impl RayQueries {
    /// Asks all of them; the number of rays that met something.
    pub fn count_hits(&self, view: &RenderSpace<'_>) -> usize {
        match self.any_hit {
            true => self.rays.iter().filter(|ray| view.occluded(ray)).count(),
            false => self.rays.iter().filter(|ray| view.closest(ray).is_some()).count(),
        }
    }
}

/// A point that the camera sees, with the normal on its side.
struct VisiblePoint {
    point: SurfacePoint,
    normal: Vec3,
    stream: PathStream,
}

/// Questions of all kinds that begin with `primary` rays, under a sun in direction `sun`.
pub fn about(primary: Vec<Ray>, sun: Vec3, view: &RenderSpace<'_>) -> Vec<RayQueries> {
    let visible_points: Vec<VisiblePoint> =
        primary.iter().enumerate().filter_map(|(i, ray)| visible_point(view, ray, i as u32)).collect();
    vec![
        RayQueries { name: "primary", rays: primary, any_hit: false },
        RayQueries { name: "bounce", rays: visible_points.iter().map(VisiblePoint::bounce).collect(), any_hit: false },
        RayQueries {
            name: "shadow, sun",
            rays: visible_points.iter().filter_map(|s| s.towards(sun)).collect(),
            any_hit: true,
        },
        RayQueries {
            name: "shadow, sky",
            rays: visible_points.iter().filter_map(|s| s.towards(s.sky())).collect(),
            any_hit: true,
        },
    ]
}

fn visible_point(view: &RenderSpace<'_>, ray: &Ray, number: u32) -> Option<VisiblePoint> {
    let point = view.surface(ray, &view.closest(ray)?);
    let outward = point.geometric_normal;
    let normal = if outward.dot(ray.direction) > 0.0 { -outward } else { outward };
    let pixel = Pixel { x: number, y: 0 };
    let address = PixelAddress { frame: FrameAddress { seed: 1, ..FrameAddress::default() }, pixel, replicate: 0 };
    Some(VisiblePoint { point, normal, stream: PathStream::new(&address, 0) })
}

impl VisiblePoint {
    /// Where a diffuse surface sends light on.
    fn bounce(&self) -> Ray {
        let local = warp::cosine_hemisphere(self.stream.two(Draw::BsdfDirection, 0));
        self.leaving(Basis::about(self.normal).outward(local))
    }

    /// A ray towards a light, unless the surface faces away.
    fn towards(&self, light: Vec3) -> Option<Ray> {
        (light.dot(self.normal) > 0.0).then(|| self.leaving(light))
    }

    /// Any direction above the horizon.
    fn sky(&self) -> Vec3 {
        let direction = warp::uniform_sphere(self.stream.two(Draw::LightPoint, 0));
        Vec3 { z: direction.z.abs(), ..direction }
    }

    fn leaving(&self, direction: Vec3) -> Ray {
        self.point.leave(direction)
    }
}
