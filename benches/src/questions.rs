//! Rays about a plan's first camera, and the file of a scene that the comparison with Embree reads.

pub use etendue_bench_rays::questions::{RayQueries, about};

use crate::scenes::{STREET, camera};
use etendue_bench_rays::contest_file::ContestFile;
use etendue_bench_rays::flat;
use etendue_core::Ray;
use etendue_pipeline::Plan;
use etendue_pipeline::plan::CameraPlan;
use etendue_tracer::render_space::RenderSpace;
use glam::{DVec2, Vec3};
use std::path::Path;

/// Writes the street, with its instances written out as one mesh, and its camera's rays.
///
/// # Errors
/// The file cannot be written.
pub fn write_street(path: &Path) -> std::io::Result<()> {
    let plan = STREET.plan();
    let camera = camera(&plan);
    let view = plan.world.render_space(camera.path.at(0.0).position_m);
    let mesh = flat::mesh(&view);
    let corners: Vec<Vec3> =
        mesh.triangles().iter().flatten().map(|vertex| mesh.positions()[*vertex as usize]).collect();
    ContestFile { corners, primary: primary(camera), sun: sun(&plan) }.write(path)
}

fn sun(plan: &Plan) -> Vec3 {
    plan.sources.suns.first().expect("the street has a sun").direction()
}

/// Questions of all kinds about a plan's first camera, in the order of its pixels.
pub fn questions(plan: &Plan, camera: &CameraPlan, view: &RenderSpace<'_>) -> Vec<RayQueries> {
    about(primary(camera), sun(plan), view)
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
