//! An instance relative to the camera, during an interval of time.
//!
//! A static instance has one transform. A moving one has that of a ray's own time, computed for each ray: there is no interpolation or rounding to
//! steps. Rays are intersected in its own frame, which holds the tree of its mesh. Only its box in the render frame, by which rays reach it, is that
//! of the whole interval.

use std::borrow::Cow;

use etendue_core::{Motion, Ray, TimeInterval};
use glam::{DVec3, Vec3};

use super::{Instance, InstanceTransform, Mesh, Shape, instance::about};

/// An instance relative to the camera.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "rays come to what stands still without another step in memory")]
pub(crate) enum Placement {
    /// At rest during the interval.
    Static(InstanceTransform),
    /// In motion.
    Moving(Box<MovingPlacement>),
}

/// An instance that moves during an interval.
#[derive(Clone, Debug)]
pub(crate) struct MovingPlacement {
    to_world: Motion,
    origin_m: DVec3,
    interval: TimeInterval,
}

impl Placement {
    /// Places an instance relative to a camera at `origin_m` during an interval.
    pub(crate) fn new(instance: &Instance, origin_m: DVec3, interval: TimeInterval) -> Self {
        match instance.to_world.constant_over(interval) {
            Some(to_world) => Self::Static(InstanceTransform::new(to_world, origin_m)),
            None => Self::Moving(Box::new(MovingPlacement { to_world: instance.to_world.clone(), origin_m, interval })),
        }
    }

    /// The transforms at a ray's [`Ray::time_s`].
    #[inline]
    pub(crate) fn at(&self, time_s: f32) -> Cow<'_, InstanceTransform> {
        match self {
            Self::Static(transform) => Cow::Borrowed(transform),
            Self::Moving(moving) => Cow::Owned(moving.at(moving.interval.moment(time_s))),
        }
    }

    /// The transforms of a static instance.
    #[inline(always)]
    pub(crate) fn static_transform(&self) -> Option<&InstanceTransform> {
        match self {
            Self::Static(transform) => Some(transform),
            Self::Moving(_) => None,
        }
    }

    /// As [`Placement::static_transform`], mutable.
    pub(crate) fn still_mut(&mut self) -> Option<&mut InstanceTransform> {
        match self {
            Self::Static(transform) => Some(transform),
            Self::Moving(_) => None,
        }
    }

    /// True if the corners of its triangles are rounded in the render frame.
    pub(crate) fn is_merged(&self) -> bool {
        self.static_transform().is_some_and(InstanceTransform::is_merged)
    }

    /// A ray's origin and direction in the instance's frame at the ray's time. The direction keeps its stretch, so t keeps its
    /// meaning.
    #[inline]
    pub(crate) fn ray_to_local(&self, ray: &Ray) -> (DVec3, DVec3) {
        match self {
            Self::Static(transform) => transform.ray_to_local(ray),
            Self::Moving(moving) => moving.ray_to_local(ray),
        }
    }

    /// As [`Placement::ray_to_local`], rounded to f32.
    pub(crate) fn rounded_ray_to_local(&self, ray: &Ray) -> (Vec3, Vec3) {
        let (origin, direction) = self.ray_to_local(ray);
        (origin.as_vec3(), direction.as_vec3())
    }

    /// Minimum and maximum coordinates in the render frame, m, of the instance's shape among the world's `meshes` at any time of the
    /// interval; `None` for a mesh without triangles.
    pub(crate) fn bounds(&self, instance: &Instance, meshes: &[Mesh]) -> Option<(DVec3, DVec3)> {
        match self {
            Self::Static(transform) => transform.bounds(instance, meshes),
            Self::Moving(moving) => moving.bounds(instance, meshes),
        }
    }

    /// As [`Placement::bounds`]; for moving instances looser, and fast for intervals of many keys.
    pub(crate) fn rough_bounds(&self, instance: &Instance, meshes: &[Mesh]) -> Option<(DVec3, DVec3)> {
        match self {
            Self::Static(transform) => transform.bounds(instance, meshes),
            Self::Moving(moving) => moving.rough_bounds(instance, meshes),
        }
    }

    /// The maximum coordinate, in the instance's frame, of a box of the render frame, or an upper bound of it.
    pub(crate) fn max_local_coordinate(&self, low: DVec3, high: DVec3) -> f64 {
        match self {
            Self::Static(transform) => transform.max_local_coordinate(low, high),
            Self::Moving(moving) => {
                moving.to_world.local_reach(moving.interval, (low + moving.origin_m, high + moving.origin_m))
            }
        }
    }

    /// The transforms at a simulated time of the interval, s.
    pub(crate) fn at_moment(&self, time_s: f64) -> Cow<'_, InstanceTransform> {
        match self {
            Self::Static(transform) => Cow::Borrowed(transform),
            Self::Moving(moving) => Cow::Owned(moving.at(time_s)),
        }
    }
}

impl MovingPlacement {
    fn at(&self, time_s: f64) -> InstanceTransform {
        InstanceTransform::new(self.to_world.at(time_s), self.origin_m)
    }

    fn ray_to_local(&self, ray: &Ray) -> (DVec3, DVec3) {
        let (_, to_local) = about(self.to_world.at(self.interval.moment(ray.time_s)), self.origin_m);
        (to_local.transform_point3(ray.origin.as_dvec3()), to_local.transform_vector3(ray.direction.as_dvec3()))
    }

    fn bounds(&self, instance: &Instance, meshes: &[Mesh]) -> Option<(DVec3, DVec3)> {
        let (low, high) = match instance.shape {
            Shape::Mesh(id) => {
                let (low, high) = meshes[id.0 as usize].bounds()?;
                self.to_world.bounds_over(self.interval, (low.as_dvec3(), high.as_dvec3()))
            }
            Shape::Sphere { radius_m } => self.to_world.bounds_of_ball(self.interval, DVec3::ZERO, radius_m),
        };
        Some((low - self.origin_m, high - self.origin_m))
    }

    fn rough_bounds(&self, instance: &Instance, meshes: &[Mesh]) -> Option<(DVec3, DVec3)> {
        let radius = match instance.shape {
            Shape::Mesh(id) => {
                let (low, high) = meshes[id.0 as usize].bounds()?;
                low.abs().max(high.abs()).as_dvec3().length()
            }
            Shape::Sphere { radius_m } => radius_m,
        };
        let (low, high) = self.to_world.rough_bounds(self.interval, radius);
        Some((low - self.origin_m, high - self.origin_m))
    }
}
