//! Instances merged into one mesh in the render frame, under one tree.
//!
//! Entering an instance costs a ray as much as several nodes, and where boxes of instances overlap a ray enters many without a hit. A view therefore
//! merges small instances: its rays then need no other frame, and traverse one tree.
//!
//! Corners are rounded to f32 in the render frame, by half a unit in the last place of their coordinates. A point of such a triangle is off the true
//! surface by no more than its corners are, and [`InstanceTransform::merged`] includes this in its error bound. Two kinds of instances are not
//! merged. One that moves, or whose vertices do, has no single place. One with a triangle less than [`MIN_HEIGHT_ROUNDINGS`] times as high as that rounding would
//! have a tilted plane.

use etendue_core::{PrimitiveId, TimeInterval};
use glam::{DVec3, Vec3};

use super::{blas::Blas, boxes::Box3, packet::PrimitiveNames, ray::NO_PRIMITIVE, world::World};
use crate::geometry::{InstanceTransform, MeshPose, Placement, Shape};

/// Maximum number of merged triangles: 32 MB of trees, and less than half a second of one thread to build them for a view.
const MAX_MERGED_TRIANGLES: usize = 1 << 19;
/// Maximum number of triangles of an instance: rays that enter a larger one stay in it for long.
const MAX_INSTANCE_TRIANGLES: usize = 1 << 16;
/// Minimum height of a triangle, in roundings of its corners: the plane then tilts by a sixteenth at most.
const MIN_HEIGHT_ROUNDINGS: f64 = 32.0;
/// Minimum height of a triangle, m: products of three lengths stay well within f32.
const MIN_HEIGHT_M: f64 = 1e-9;
/// Maximum coordinate of an instance, m: rays that leave it are pushed off it by a tenth of a millimetre at most.
const MAX_INSTANCE_COORDINATE_M: f32 = 1000.0;
/// Half a unit in the last place of f32, of a coordinate.
const HALF_ULP: f64 = 1.0 / (1 << 24) as f64;

/// Instances under one tree.
#[derive(Clone, Debug)]
pub(crate) struct MergedMesh {
    pub(super) tree: Blas,
    /// The box of all triangles.
    pub(super) bounds: Box3,
    /// Instance and primitive of each triangle, in ascending order.
    names: Vec<(u32, u32)>,
    /// Number in the tree of each instance's first triangle; [`NO_PRIMITIVE`] for those that are not in it.
    first: Vec<u32>,
}

impl MergedMesh {
    /// Merges instances of `world` as they are `placed`, and marks these as merged; `None` if there are none to merge.
    pub(super) fn new(world: &World, placed: &mut [Placement], interval: TimeInterval) -> Option<Self> {
        let (mut corners, mut names) = (Vec::new(), Vec::new());
        let mut first = vec![NO_PRIMITIVE; placed.len()];
        for instance in mergeable_instances(world, placed, interval) {
            let Some(pose) = pose(world, instance, interval) else { continue };
            let Some(transform) = placed[instance].still_mut() else { continue };
            let begin = corners.len();
            if let Some(maximum) = append_corners(&pose, transform, &mut corners) {
                names.extend((0..(corners.len() - begin) as u32).map(|primitive| (instance as u32, primitive)));
                first[instance] = begin as u32;
                transform.merge(maximum.as_dvec3());
            } else {
                corners.truncate(begin);
            }
        }
        let bounds = corners.iter().map(Box3::about).reduce(|a, b| a.union(&b))?;
        let tree = Blas::over(corners.len(), |triangle| corners[triangle as usize], world.tree_quality());
        Some(Self { tree, bounds, names, first })
    }

    /// The number in the tree of a triangle that a ray leaves; [`NO_PRIMITIVE`] if it is not in it.
    #[inline(always)]
    pub(super) fn number(&self, left: Option<PrimitiveId>) -> u32 {
        let first = |left: PrimitiveId| self.first.get(left.instance as usize).filter(|first| **first != NO_PRIMITIVE);
        left.and_then(|left| first(left)?.checked_add(left.primitive)).unwrap_or(NO_PRIMITIVE)
    }

    #[inline(always)]
    pub(super) fn names(&self) -> PrimitiveNames<'_> {
        PrimitiveNames::Merged(&self.names)
    }
}

/// Static instances of meshes with [`MAX_MERGED_TRIANGLES`] triangles together at most, those of few triangles chosen first, in ascending order; none if
/// there is only one.
fn mergeable_instances(world: &World, placed: &[Placement], interval: TimeInterval) -> Vec<usize> {
    let triangles = |instance: &usize| match world.instances()[*instance].shape {
        Shape::Mesh(id) => world.mesh(id).triangles().len(),
        Shape::Sphere { .. } => 0,
    };
    let is_still = |i: &usize| placed[*i].static_transform().is_some() && pose(world, *i, interval).is_some();
    let mut instances: Vec<usize> = (0..placed.len()).filter(|i| triangles(i) > 0 && is_still(i)).collect();
    instances.sort_by_key(triangles);
    let mut sum = 0;
    instances.retain(|instance| {
        sum += triangles(instance);
        sum <= MAX_MERGED_TRIANGLES && triangles(instance) <= MAX_INSTANCE_TRIANGLES
    });
    if instances.len() < 2 {
        return Vec::new();
    }
    instances.sort_unstable();
    instances
}

/// The mesh of an instance if it is constant during an interval; `None` if its vertices move, and for spheres.
fn pose(world: &World, instance: usize, interval: TimeInterval) -> Option<MeshPose<'_>> {
    let Shape::Mesh(id) = world.instances()[instance].shape else { return None };
    world.mesh(id).static_over(interval)
}

/// Adds the corners of an instance's triangles in the render frame. Returns their maximum coordinates by axis, m, or `None` if some are too
/// far or some triangles too low.
fn append_corners(mesh: &MeshPose<'_>, placed: &InstanceTransform, corners: &mut Vec<[Vec3; 3]>) -> Option<Vec3> {
    let mut maximum = Vec3::ZERO;
    for primitive in 0..mesh.mesh().triangles().len() as u32 {
        let exact = mesh.corners(primitive).map(|corner| placed.point_to_render(corner.as_dvec3()));
        let rounded = exact.map(DVec3::as_vec3);
        maximum = rounded.iter().fold(maximum, |largest, corner| largest.max(corner.abs()));
        if maximum.max_element() > MAX_INSTANCE_COORDINATE_M || !has_stable_plane(exact) {
            return None;
        }
        corners.push(rounded);
    }
    Some(maximum)
}

/// True if the minimum height of a triangle is large compared with the rounding of its corners.
fn has_stable_plane([a, b, c]: [DVec3; 3]) -> bool {
    let edges = [b - a, c - b, a - c];
    let longest = edges.iter().map(|edge| edge.length_squared()).fold(0.0, f64::max).sqrt();
    let height = edges[0].cross(edges[1]).length() / longest;
    let rounding = a.abs().max(b.abs()).max(c.abs()).length() * HALF_ULP;
    height > (MIN_HEIGHT_ROUNDINGS * rounding).max(MIN_HEIGHT_M)
}
