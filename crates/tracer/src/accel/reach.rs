//! How far rays may start from a mesh.
//!
//! Triangles are met in f32 by products of three coordinates relative to the ray's origin, sheared along the ray. With
//! coordinates of mesh and origin up to R, those along the ray are up to 2R. The corners of a triangle that is met lie
//! around the ray, and the mesh is 2R wide, so that across the ray, with shears of 1 at most, they are up to 4R: edge
//! functions are up to 32R², sum to twice the area seen, 16R² at most, and their sum with the depths is up to 32R³. At
//! R = 1e12 that is 3.2e37, a tenth of the greatest f32. Meshes are held to the same R when they are made.
//!
//! The start of a ray is rounded to f32 in the mesh's frame. Where that moves the camera by half its distance from the
//! box that holds the mesh, rays start behind surfaces that stand before it: such a mesh is refused too. Seen from
//! inside its box nothing can be told.
//!
//! Spheres are met in f64, and held to the same R in metres, where half a unit in the last place is 0.06 mm: beyond, the
//! distance of a surface near the camera would be lost.

use etendue_core::{CameraPath, CameraPose, TimeInterval};
use glam::{DMat3, DVec3};

use super::world::{World, WorldError};
use crate::geometry::{Instance, InstanceTransform, Mesh, Placement, Shape};

/// R, in units of the mesh's frame; m for spheres.
const FARTHEST: f64 = 1e12;

impl World {
    /// Whether rays that start near `origin_m` (world, m) or on any surface can be met with every mesh at any time of an interval.
    /// Of a mesh that moves, the camera's rounding in its frame is checked at seventeen even moments, all else by bounds.
    ///
    /// # Errors
    /// Where a mesh is so far away from a ray's start, in units of its own frame, that products of three coordinates
    /// leave f32: such a ray would pass it unseen.
    pub fn check_reach(&self, origin_m: DVec3, interval: TimeInterval) -> Result<(), WorldError> {
        let rotation = DMat3::IDENTITY;
        check(self, &CameraPath::still(CameraPose { position_m: origin_m, rotation }), interval)
    }

    /// As [`World::check_reach`], of rays that start near a camera wherever it is during the interval. Of one that moves, rounding
    /// is checked at those moments too.
    ///
    /// # Errors
    /// As [`World::check_reach`].
    pub fn check_reach_along(&self, camera: &CameraPath, interval: TimeInterval) -> Result<(), WorldError> {
        check(self, camera, interval)
    }
}

/// Moments of an interval for which is checked what no bound tells of what moves.
const MOMENTS: u32 = 16;

/// Whether every mesh can be met from the camera, wherever it is, and from every surface.
fn check(world: &World, camera: &CameraPath, interval: TimeInterval) -> Result<(), WorldError> {
    let instances = world.instances();
    let origin_m = camera.at(interval.start_s()).position_m;
    let (camera_low, camera_high) = camera.bounds_over(interval);
    let moments = moments(interval);
    let placed: Vec<_> = instances.iter().map(|i| Placement::new(i, origin_m, interval)).collect();
    let bounds = placed.iter().zip(instances).filter_map(|(p, i)| p.rough_bounds(i, world.meshes()));
    // Rays start at the camera, which is the origin at the start, or on a surface.
    let about_camera = (camera_low - origin_m, camera_high - origin_m);
    let (low, high) = bounds.fold(about_camera, |(low, high), b| (low.min(b.0), high.max(b.1)));
    for (instance, placed) in placed.iter().enumerate() {
        match instances[instance].shape {
            Shape::Mesh(id) => {
                let reach = placed.greatest_local(low, high);
                if !(0.0..=FARTHEST).contains(&reach) {
                    return Err(WorldError::Reach { instance, reach });
                }
                let still = placed.still().is_some() && camera.is_still();
                for time_s in &moments[..if still { 1 } else { moments.len() }] {
                    let from = camera.at(*time_s).position_m - origin_m;
                    check_rounding(instance, &placed.at_moment(*time_s), world.mesh(id), from)?;
                }
            }
            Shape::Sphere { .. } => check_sphere(instance, placed, &instances[instance], world)?,
        }
    }
    Ok(())
}

/// Even moments of an interval, both its ends among them.
fn moments(interval: TimeInterval) -> Vec<f64> {
    let part = |i: u32| f64::from(i) / f64::from(MOMENTS);
    (0..=MOMENTS).map(|i| interval.start_s() + interval.length_s() * part(i)).collect()
}

/// Whether the camera's place in the frame of a mesh stays before the box that holds the mesh when it is rounded to f32. The camera is
/// at `from` in the render frame, m.
fn check_rounding(instance: usize, placed: &InstanceTransform, mesh: &Mesh, from: DVec3) -> Result<(), WorldError> {
    let Some((low, high)) = mesh.bounds() else { return Ok(()) };
    let (camera, _) = placed.line_to_local(from, DVec3::X);
    let away = (low.as_dvec3() - camera).max(camera - high.as_dvec3());
    let moved = (camera.as_vec3().as_dvec3() - camera).abs();
    let outside: Vec<usize> = (0..3).filter(|&axis| away[axis] > 0.0).collect();
    // Less than a millimetre carries it to a surface that it touches.
    let moved_m = (placed.point_to_render(camera.as_vec3().as_dvec3()) - from).length();
    let carries = outside.iter().all(|&axis| moved[axis] > 0.5 * away[axis]);
    if moved_m > 1e-3 && !outside.is_empty() && carries {
        return Err(WorldError::Rounding { instance, away: away.max_element(), moved: moved.max_element() });
    }
    Ok(())
}

fn check_sphere(index: usize, placed: &Placement, instance: &Instance, world: &World) -> Result<(), WorldError> {
    let reach = placed
        .rough_bounds(instance, world.meshes())
        .map_or(0.0, |(low, high)| low.abs().max(high.abs()).max_element());
    if (0.0..=FARTHEST).contains(&reach) { Ok(()) } else { Err(WorldError::Sphere { instance: index, reach_m: reach }) }
}
