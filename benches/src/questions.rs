//! Rays as a renderer asks them: what a camera sees, where light goes on, whether a light is free.

use etendue_core::random::{Draw, FrameAddress, PathStream, Pixel, PixelAddress};
use etendue_core::{Basis, Ray, warp};
use etendue_pipeline::Plan;
use etendue_pipeline::plan::CameraPlan;
use etendue_tracer::geometry::SurfacePoint;
use etendue_tracer::render_space::RenderSpace;
use glam::{DVec2, Vec3};

/// Rays of one kind.
#[derive(Clone, Debug)]
pub struct Questions {
    /// What they are.
    pub name: &'static str,
    /// The rays.
    pub rays: Vec<Ray>,
    /// Whether any hit answers, or only the first.
    pub any_hit: bool,
}

impl Questions {
    /// Asks all of them; the number of rays that met something.
    pub fn ask(&self, view: &RenderSpace<'_>) -> usize {
        match self.any_hit {
            true => self.rays.iter().filter(|ray| view.occluded(ray)).count(),
            false => self.rays.iter().filter(|ray| view.closest(ray).is_some()).count(),
        }
    }
}

/// A point that the camera sees, with the normal on its side.
struct Seen {
    point: SurfacePoint,
    normal: Vec3,
    stream: PathStream,
}

/// Questions of all kinds about a plan's first camera, in the order of its pixels.
pub fn questions(plan: &Plan, camera: &CameraPlan, view: &RenderSpace<'_>) -> Vec<Questions> {
    about(primary(camera), plan.sources.suns.first().expect("the street has a sun").direction(), view)
}

/// Questions of all kinds that begin with `primary` rays, under a sun in direction `sun`.
pub fn about(primary: Vec<Ray>, sun: Vec3, view: &RenderSpace<'_>) -> Vec<Questions> {
    let seen: Vec<Seen> = primary.iter().enumerate().filter_map(|(i, ray)| seen(view, ray, i as u32)).collect();
    vec![
        Questions { name: "primary", rays: primary, any_hit: false },
        Questions { name: "bounce", rays: seen.iter().map(Seen::bounce).collect(), any_hit: false },
        Questions { name: "shadow, sun", rays: seen.iter().filter_map(|s| s.towards(sun)).collect(), any_hit: true },
        Questions {
            name: "shadow, sky",
            rays: seen.iter().filter_map(|s| s.towards(s.sky())).collect(),
            any_hit: true,
        },
    ]
}

/// The principal ray of every pixel, row by row.
fn primary(camera: &CameraPlan) -> Vec<Ray> {
    let raster = &camera.body.raster;
    let pixels = (0..raster.height()).flat_map(|y| (0..raster.width()).map(move |x| DVec2::new(x as f64, y as f64)));
    pixels.filter_map(|pixel| principal(camera, raster.sensor_mm(pixel + 0.5))).collect()
}

fn principal(camera: &CameraPlan, sensor_mm: DVec2) -> Option<Ray> {
    let ray = camera.body.lens.principal_ray(sensor_mm)?;
    let direction = camera.path.at(0.0).direction_to_world(ray.direction).as_vec3().normalize();
    Some(Ray::new(camera.path.at(0.0).point_to_render(ray.origin_m).as_vec3(), direction, 0.0))
}

fn seen(view: &RenderSpace<'_>, ray: &Ray, number: u32) -> Option<Seen> {
    let point = view.surface(ray, &view.closest(ray)?);
    let outward = point.geometric_normal;
    let normal = if outward.dot(ray.direction) > 0.0 { -outward } else { outward };
    let pixel = Pixel { x: number, y: 0 };
    let address = PixelAddress { frame: FrameAddress { seed: 1, ..FrameAddress::default() }, pixel, replicate: 0 };
    Some(Seen { point, normal, stream: PathStream::new(&address, 0) })
}

impl Seen {
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
