//! How far rays may start from a mesh.
//!
//! Triangles are met in f32 by products of three coordinates relative to the ray's origin, sheared along the ray. With
//! coordinates of mesh and origin up to R, those along the ray are up to 2R. The corners of a triangle that is met lie
//! around the ray, and the mesh is 2R wide, so that across the ray, with shears of 1 at most, they are up to 4R: edge
//! functions are up to 32R², sum to twice the area seen, 16R² at most, and their sum with the depths is up to 32R³. At
//! R = 1e12 that is 3.2e37, a tenth of the greatest f32. Meshes are held to the same R when they are made.
//!
//! Spheres are met in f64 and have no such bound.

use super::World;
use super::world::WorldError;
use crate::geometry::Shape;
use crate::view::Placed;
use glam::DVec3;

/// R, in units of the mesh's frame.
const FARTHEST: f64 = 1e12;

/// Whether every mesh can be met from the camera at `origin_m` and from every surface.
pub(super) fn check(world: &World, origin_m: DVec3) -> Result<(), WorldError> {
    let instances = world.instances();
    let placed: Vec<_> = instances.iter().map(|i| Placed::new(i, origin_m)).collect();
    let bounds = placed.iter().zip(instances).filter_map(|(p, i)| p.bounds(i, world));
    // Rays start at the camera, which is the origin, or on a surface.
    let (low, high) = bounds.fold((DVec3::ZERO, DVec3::ZERO), |(low, high), b| (low.min(b.0), high.max(b.1)));
    for (instance, placed) in placed.iter().enumerate() {
        let reach = placed.greatest_local(low, high);
        let is_near = (0.0..=FARTHEST).contains(&reach);
        if matches!(instances[instance].shape, Shape::Mesh(_)) && !is_near {
            return Err(WorldError::Reach { instance, reach });
        }
    }
    Ok(())
}
