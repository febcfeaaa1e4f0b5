//! Maximum distance of a ray's start from a mesh.
//!
//! Triangles are tested in f32 by products of three coordinates relative to the ray's origin, sheared along the ray. With coordinates of mesh and
//! origin up to R, those along the ray are up to 2R. The corners of a triangle that is hit lie around the ray, and the mesh is 2R wide, so that
//! across the ray, with shears of 1 at most, they are up to 4R. Edge functions are up to 32R². They sum to twice the projected area, 16R² at most,
//! and their sum with the depths is up to 32R³. At R = 1e12 that is 3.2e37, a tenth of the largest f32. Meshes are limited to the same R when they
//! are built.
//!
//! The start of a ray is rounded to f32 in the mesh's frame. If that moves the camera by half its distance from the box that holds the mesh, rays
//! start behind surfaces in front of it: such a mesh is refused too. From inside its box nothing can be checked.
//!
//! Spheres are tested in f64, and limited to the same R in metres, where half a unit in the last place is 0.06 mm: beyond, the distance of a surface
//! near the camera would be lost.

use etendue_core::{CameraPath, CameraPose, TimeInterval};
use glam::{DMat3, DVec3};

use super::world::{World, WorldError};
use crate::geometry::{Instance, InstanceTransform, Mesh, Placement, Shape};

/// R, in units of the mesh's frame; m for spheres.
const MAX_DISTANCE: f64 = 1e12;

impl World {
    /// Checks that rays that start near `origin_m` (world, m) or on any surface can be tested against every mesh at any time of an
    /// interval. For a moving mesh, the camera's rounding in its frame is checked at seventeen equidistant times, everything else by
    /// bounds.
    ///
    /// # Errors
    /// If a mesh is so far from a ray's start, in units of its own frame, that products of three coordinates overflow f32: such a ray would
    /// miss it.
    pub fn check_reach(&self, origin_m: DVec3, interval: TimeInterval) -> Result<(), WorldError> {
        let rotation = DMat3::IDENTITY;
        check(self, &CameraPath::constant(CameraPose { position_m: origin_m, rotation }), interval)
    }

    /// As [`World::check_reach`], for rays that start near a camera anywhere on its path during the interval. For a moving camera, rounding
    /// is checked at those times too.
    ///
    /// # Errors
    /// As [`World::check_reach`].
    pub fn check_reach_along(&self, camera: &CameraPath, interval: TimeInterval) -> Result<(), WorldError> {
        check(self, camera, interval)
    }
}

/// Times of an interval at which the conditions without a bound are checked for moving objects.
const TIME_STEPS: u32 = 16;

/// Checks that every mesh can be hit from the camera, anywhere on its path, and from every surface.
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
                let reach = placed.max_local_coordinate(low, high);
                if !(0.0..=MAX_DISTANCE).contains(&reach) {
                    return Err(WorldError::Reach { instance, reach });
                }
                let still = placed.static_transform().is_some() && camera.is_stationary();
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

/// Equidistant times of an interval, including both its ends.
fn moments(interval: TimeInterval) -> Vec<f64> {
    let part = |i: u32| f64::from(i) / f64::from(TIME_STEPS);
    (0..=TIME_STEPS).map(|i| interval.start_s() + interval.length_s() * part(i)).collect()
}

/// Checks that the camera's position in the frame of a mesh stays in front of the box that holds the mesh when it is rounded to f32. The
/// camera is at `from` in the render frame, m.
fn check_rounding(instance: usize, placed: &InstanceTransform, mesh: &Mesh, from: DVec3) -> Result<(), WorldError> {
    let Some((low, high)) = mesh.bounds() else { return Ok(()) };
    let (camera, _) = placed.line_to_local(from, DVec3::X);
    let away = (low.as_dvec3() - camera).max(camera - high.as_dvec3());
    let moved = (camera.as_vec3().as_dvec3() - camera).abs();
    let outside: Vec<usize> = (0..3).filter(|&axis| away[axis] > 0.0).collect();
    // Less than a millimetre moves it to a surface that it touches.
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
    if (0.0..=MAX_DISTANCE).contains(&reach) {
        Ok(())
    } else {
        Err(WorldError::Sphere { instance: index, reach_m: reach })
    }
}
