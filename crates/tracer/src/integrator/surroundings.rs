//! The solid that a camera stands in.
//!
//! From the centre of the entrance pupil, rays of fixed directions are followed straight through everything. A solid that a
//! ray comes out of once more than it goes in holds the camera; of several the one it first comes out of, which is the
//! innermost. Most of the rays decide: of a solid whose surface is closed all agree. What moves is taken where it is half-way through
//! the view's interval; left out is a camera that enters or leaves a solid while it exposes.

use core::f32::consts::TAU;
use etendue_core::Ray;
use etendue_core::maths::f32::sin_cos;
use glam::Vec3;

use crate::MaterialId;
use crate::materials::MaterialTable;
use crate::render_space::RenderSpace;

/// Rays that are followed.
const RAYS: u32 = 15;

/// Surfaces that a ray is followed through at most.
const MAX_PASSED: u32 = 4096;

/// What surrounds a camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Surroundings {
    /// The material of the solid that most rays come out of; `None` for air.
    pub solid: Option<MaterialId>,
    /// A solid that some rays come out of where others do not: its surface is not closed.
    pub open: Option<MaterialId>,
}

impl Surroundings {
    /// What surrounds the camera of a view.
    #[must_use]
    pub fn of(view: &RenderSpace<'_>, material_table: &MaterialTable) -> Self {
        if !material_table.has_solids() {
            return Self::default();
        }
        let around: Vec<_> = (0..RAYS).map(|i| left_first(view, material_table, direction(i))).collect();
        let votes = |id: Option<MaterialId>| around.iter().filter(|seen| **seen == id).count();
        let solid = around.iter().flatten().copied().find(|id| 2 * votes(Some(*id)) > around.len());
        let open = around.iter().flatten().copied().find(|id| votes(Some(*id)) < around.len());
        Self { solid, open }
    }
}

/// Unit directions spread over the sphere (a Fibonacci lattice), none of them along an axis.
fn direction(i: u32) -> Vec3 {
    let z = 1.0 - (2.0 * i as f32 + 1.0) / RAYS as f32 + 0.013;
    let (sin, cos) = sin_cos((0.618_034 * i as f32 + 0.137).fract() * TAU);
    let r = (1.0 - z * z).sqrt();
    Vec3::new(r * cos, r * sin, z).normalize()
}

/// Of the solids that hold the camera as seen along one direction, the one that is left first.
fn left_first(view: &RenderSpace<'_>, material_table: &MaterialTable, direction: Vec3) -> Option<MaterialId> {
    // Instance, material, how often it was left more than entered; in the order in which they were first left.
    let mut met: Vec<(u32, MaterialId, i32)> = vec![];
    let mut ray = Ray::new(Vec3::ZERO, direction, (0.5 * view.interval().length_s()) as f32);
    for _ in 0..MAX_PASSED {
        let Some(hit) = view.closest(&ray) else { break };
        let point = view.surface(&ray, &hit);
        if let Some(material) = material_table.solid(point.material) {
            let step = if point.geometric_normal.dot(direction) > 0.0 { 1 } else { -1 };
            match met.iter_mut().find(|(instance, ..)| *instance == hit.instance) {
                Some((.., left)) => *left += step,
                None => met.push((hit.instance, material, step)),
            }
        }
        ray.origin = point.spawn(direction);
    }
    met.into_iter().find(|(.., left)| *left > 0).map(|(_, material, _)| material)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_unit_and_spread() {
        let all: Vec<_> = (0..RAYS).map(direction).collect();
        assert!(all.iter().all(|d| (d.length() - 1.0).abs() < 1e-6 && d.abs().min_element() > 1e-3));
        let sum: Vec3 = all.iter().sum();
        assert!(sum.length() < 1.0, "{sum}");
    }
}
