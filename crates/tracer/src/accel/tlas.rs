//! The tree over the instances of a view.

use super::lanes::{LaneTask, Lanes, Plain, Visit};
use super::node::{Child, Node};
use super::packet::{BestHit, PrimitiveHit, PrimitiveNames};
use super::ray::{LocalRay, NO_PRIMITIVE, SlabRay};
#[cfg(target_arch = "x86_64")]
use super::simd::Avx2;
use super::{Simd, blas::Blas, boxes::Box3, build::over_boxes, collapse::collapse, merged::MergedMesh};
use core::cell::Cell;
use std::{collections::BTreeMap, sync::Arc};

use etendue_core::{Ray, TimeInterval};
use glam::Vec3;

use super::visits::{VisitCounter, Visits};
use super::walk::{Leaves, walk};
use super::{swept::AnimatedTree, world::World};
use crate::geometry::{Hit, Instance, MeshId, Placement, Shape, sphere};
use crate::is_optional;

/// A shape with the data of its intersection test.
#[derive(Clone, Debug)]
enum Target<'w> {
    Mesh(&'w Blas),
    Sphere(f64),
    /// A mesh whose vertices move.
    Animated(Arc<AnimatedTree<'w>>),
    /// An instance that is merged.
    Merged,
}

/// The lanes chosen when the view was built.
#[derive(Clone, Copy, Debug)]
pub(super) enum InstructionSet {
    Plain,
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
}

impl InstructionSet {
    pub(super) fn new(simd: Simd) -> Self {
        match simd {
            Simd::Scalar => Self::Plain,
            #[cfg(target_arch = "x86_64")]
            Simd::Auto => Avx2::detect().map_or(Self::Plain, Self::Avx2),
            #[cfg(not(target_arch = "x86_64"))]
            Simd::Auto => Self::Plain,
        }
    }

    #[inline(always)]
    pub(super) fn run<J: LaneTask>(self, job: J) -> J::Output {
        match self {
            Self::Plain => Plain.run(job),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(lanes) => lanes.run(job),
        }
    }
}

/// A leaf that is no single instance.
const MERGED: u32 = u32::MAX;

/// The instances of a view, with a tree over them.
#[derive(Clone, Debug)]
pub(crate) struct Tlas<'w> {
    nodes: Vec<Node>,
    root: Option<Child>,
    /// The instance of each leaf, or [`MERGED`].
    leaves: Vec<u32>,
    merged: Option<MergedMesh>,
    targets: Vec<Target<'w>>,
    placed: Vec<Placement>,
    chosen: InstructionSet,
}

impl<'w> Tlas<'w> {
    /// Builds the tree over instances placed in the render frame; small ones are merged.
    pub(crate) fn with_merging(
        world: &'w World,
        mut placed: Vec<Placement>,
        interval: TimeInterval,
        simd: Simd,
    ) -> Self {
        let merged = MergedMesh::new(world, &mut placed, interval);
        Self::new(world, placed, merged, interval, simd)
    }

    /// Builds the tree over instances placed in the render frame, of which some may be merged.
    pub(crate) fn new(
        world: &'w World,
        placed: Vec<Placement>,
        merged: Option<MergedMesh>,
        interval: TimeInterval,
        simd: Simd,
    ) -> Self {
        let bounded = placed.iter().zip(world.instances()).zip(0_u32..).filter(|((placed, _), _)| !placed.is_merged());
        let single = bounded.filter_map(|((placed, instance), index)| {
            let (low, high) = placed.bounds(instance, world.meshes())?;
            Some((Box3::from_f64(low, high), index))
        });
        let bounds = merged.as_ref().map(|merged| merged.bounds);
        let (boxes, members): (Vec<_>, Vec<_>) = single.chain(bounds.map(|bounds| (bounds, MERGED))).unzip();
        let mut leaves = Vec::with_capacity(members.len());
        let wide = collapse(&over_boxes(&boxes), 1, |leaf| {
            leaves.push(members[leaf[0] as usize]);
            leaves.len() - 1
        });
        let targets = targets(world, &placed, interval);
        Self { nodes: wide.nodes, root: wide.root, leaves, merged, targets, placed, chosen: InstructionSet::new(simd) }
    }

    /// The instances' placements, by their index.
    pub(crate) fn placed(&self) -> &[Placement] {
        &self.placed
    }

    /// The first primitive that a ray hits.
    pub(crate) fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.chosen.run(ClosestQuery { top: self, ray })
    }

    /// Visits of a ray until the first primitive that it hits, or any.
    pub(crate) fn visits(&self, ray: &Ray, any: bool) -> Visits {
        let visits = Cell::new(Visits::default());
        if any {
            VisitCounter(&visits).run(OcclusionQuery { top: self, ray });
        } else {
            VisitCounter(&visits).run(ClosestQuery { top: self, ray });
        }
        visits.get()
    }

    /// True if a ray hits anything.
    pub(crate) fn occluded(&self, ray: &Ray) -> bool {
        self.chosen.run(OcclusionQuery { top: self, ray })
    }
}

/// The data of the intersection test of each instance.
fn targets<'w>(world: &'w World, placed: &[Placement], interval: TimeInterval) -> Vec<Target<'w>> {
    let mut animated: BTreeMap<MeshId, Arc<AnimatedTree<'w>>> = BTreeMap::new();
    let target = |(instance, placed): (&Instance, &Placement)| match instance.shape {
        Shape::Sphere { radius_m } => Target::Sphere(radius_m),
        Shape::Mesh(id) if world.mesh(id).animation().is_none() => Target::Mesh(world.tree(id)),
        Shape::Mesh(_) if placed.is_merged() => Target::Merged,
        Shape::Mesh(id) => {
            let tree = || Arc::new(AnimatedTree::new(world.mesh(id), interval, world.tree_quality()));
            Target::Animated(Arc::clone(animated.entry(id).or_insert_with(tree)))
        }
    };
    world.instances().iter().zip(placed).map(target).collect()
}

/// True for a ray with a direction and finite coordinates; others hit nothing.
#[inline(always)]
fn is_traceable(ray: &Ray) -> bool {
    let length = |v: Vec3| v.x.abs() + v.y.abs() + v.z.abs();
    let along = length(ray.direction);
    along > 0.0 && along + length(ray.origin) < f32::INFINITY
}

struct ClosestQuery<'a, 'w> {
    top: &'a Tlas<'w>,
    ray: &'a Ray,
}

impl LaneTask for ClosestQuery<'_, '_> {
    type Output = Option<Hit>;

    #[inline(always)]
    fn work<L: Lanes>(self, l: L) -> Option<Hit> {
        let Self { top, ray } = self;
        let root = top.root.filter(|_| is_traceable(ray))?;
        let mut leaves = ClosestLeaf { l, top, ray, best: BestHit::default() };
        if root.as_node().is_some() {
            let slab = SlabRay::new(ray.origin, ray.direction);
            walk::<L, true>(l, &top.nodes, root, &slab, &mut { ray.t_max }, &mut leaves);
        } else {
            leaves.visit(root.leaf_index(), &mut { ray.t_max });
        }
        leaves.best.hit
    }
}

struct ClosestLeaf<'a, 'w, L> {
    l: L,
    top: &'a Tlas<'w>,
    ray: &'a Ray,
    best: BestHit,
}

impl<L: Lanes> Leaves for ClosestLeaf<'_, '_, L> {
    #[inline(always)]
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool {
        self.l.record_visit(Visit::Instance);
        let instance = self.top.leaves[leaf];
        if let (MERGED, Some(merged)) = (instance, &self.top.merged) {
            let local = LocalRay::new(self.ray.origin, self.ray.direction).excluding(merged.number(self.ray.left));
            merged.tree.closest(self.l, &local, merged.names(), &mut self.best, limit);
            return false;
        }
        is_optional();
        let placed = &self.top.placed[instance as usize];
        match &self.top.targets[instance as usize] {
            Target::Mesh(tree) => {
                let Some(still) = placed.static_transform() else {
                    let moving = MovingEntry { l: self.l, tree, placed, ray: self.ray };
                    (self.best.hit, *limit) = moving.closest(instance, self.best.hit, *limit);
                    return false;
                };
                let (origin, direction) = still.rounded_ray_to_local(self.ray);
                let local = LocalRay::new(origin, direction).excluding(left_of(self.ray, instance));
                tree.closest(self.l, &local, PrimitiveNames::Instance(instance), &mut self.best, limit);
            }
            Target::Sphere(radius) => {
                if let Some(t) = meet_sphere(*radius, placed, self.ray) {
                    let hit = PrimitiveHit { t, u: 0.0, v: 0.0, primitive: 0 };
                    self.best.accept(PrimitiveNames::Instance(instance), hit, limit);
                }
            }
            Target::Animated(tree) => {
                let animated = AnimatedEntry { l: self.l, tree, placed, ray: self.ray };
                (self.best.hit, *limit) = animated.closest(instance, self.best.hit, *limit);
            }
            Target::Merged => {}
        }
        false
    }
}

struct OcclusionQuery<'a, 'w> {
    top: &'a Tlas<'w>,
    ray: &'a Ray,
}

impl LaneTask for OcclusionQuery<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn work<L: Lanes>(self, l: L) -> bool {
        let Self { top, ray } = self;
        let Some(root) = top.root.filter(|_| is_traceable(ray)) else { return false };
        let mut leaves = AnyLeaf { l, top, ray };
        if root.as_node().is_none() {
            return leaves.visit(root.leaf_index(), &mut { ray.t_max });
        }
        let slab = SlabRay::new(ray.origin, ray.direction);
        walk::<L, false>(l, &top.nodes, root, &slab, &mut { ray.t_max }, &mut leaves)
    }
}

/// The triangle that a ray leaves, in an instance's own tree; [`NO_PRIMITIVE`] if it belongs to another.
#[inline(always)]
fn left_of(ray: &Ray, instance: u32) -> u32 {
    match ray.left {
        Some(left) if left.instance == instance => left.primitive,
        _ => NO_PRIMITIVE,
    }
}

struct AnyLeaf<'a, 'w, L> {
    l: L,
    top: &'a Tlas<'w>,
    ray: &'a Ray,
}

impl<L: Lanes> Leaves for AnyLeaf<'_, '_, L> {
    #[inline(always)]
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool {
        self.l.record_visit(Visit::Instance);
        let instance = self.top.leaves[leaf];
        if let (MERGED, Some(merged)) = (instance, &self.top.merged) {
            let local = LocalRay::new(self.ray.origin, self.ray.direction).excluding(merged.number(self.ray.left));
            return merged.tree.occluded(self.l, &local, *limit);
        }
        is_optional();
        let placed = &self.top.placed[instance as usize];
        match &self.top.targets[instance as usize] {
            Target::Mesh(tree) => {
                let Some(still) = placed.static_transform() else {
                    return MovingEntry { l: self.l, tree, placed, ray: self.ray }.occluded(*limit);
                };
                let (origin, direction) = still.rounded_ray_to_local(self.ray);
                let local = LocalRay::new(origin, direction).excluding(left_of(self.ray, instance));
                tree.occluded(self.l, &local, *limit)
            }
            Target::Sphere(radius) => meet_sphere(*radius, placed, self.ray).is_some_and(|t| t > 0.0 && t < *limit),
            Target::Animated(tree) => AnimatedEntry { l: self.l, tree, placed, ray: self.ray }.occluded(*limit),
            Target::Merged => false,
        }
    }
}

/// A moving mesh at the entry of a ray. Separate from static meshes, whose code it would slow down: all arguments and results are passed by
/// value, so that the others stay in registers.
struct MovingEntry<'a, L> {
    l: L,
    tree: &'a Blas,
    placed: &'a Placement,
    ray: &'a Ray,
}

impl<L: Lanes> MovingEntry<'_, L> {
    /// The best hit and the limit, updated.
    #[cold]
    #[inline(never)]
    fn closest(self, instance: u32, hit: Option<Hit>, mut limit: f32) -> (Option<Hit>, f32) {
        let mut best = BestHit { hit };
        let (origin, direction) = self.placed.rounded_ray_to_local(self.ray);
        let local = LocalRay::new(origin, direction);
        self.tree.closest(self.l, &local, PrimitiveNames::Instance(instance), &mut best, &mut limit);
        (best.hit, limit)
    }

    /// True if the ray hits a triangle before the limit.
    #[cold]
    #[inline(never)]
    fn occluded(self, limit: f32) -> bool {
        let (origin, direction) = self.placed.rounded_ray_to_local(self.ray);
        self.tree.occluded(self.l, &LocalRay::new(origin, direction), limit)
    }
}

/// A mesh whose vertices move, at the entry of a ray; separate for the same reason.
struct AnimatedEntry<'a, L> {
    l: L,
    tree: &'a AnimatedTree<'a>,
    placed: &'a Placement,
    ray: &'a Ray,
}

impl<L: Lanes> AnimatedEntry<'_, L> {
    /// The best hit and the limit, updated.
    #[cold]
    #[inline(never)]
    fn closest(self, instance: u32, hit: Option<Hit>, mut limit: f32) -> (Option<Hit>, f32) {
        let mut best = BestHit { hit };
        let local = self.local();
        self.tree.closest(self.l, &local, self.ray.time_s, PrimitiveNames::Instance(instance), &mut best, &mut limit);
        (best.hit, limit)
    }

    /// True if the ray hits a triangle before the limit.
    #[cold]
    #[inline(never)]
    fn occluded(self, limit: f32) -> bool {
        self.tree.occluded(self.l, &self.local(), self.ray.time_s, limit)
    }

    fn local(&self) -> LocalRay {
        let (origin, direction) = self.placed.rounded_ray_to_local(self.ray);
        LocalRay::new(origin, direction)
    }
}

/// The first intersection of a ray with a sphere.
#[inline(always)]
fn meet_sphere(radius: f64, placed: &Placement, ray: &Ray) -> Option<f32> {
    let Some(still) = placed.static_transform() else { return meet_moving_sphere(radius, placed, ray) };
    let (origin, direction) = still.ray_to_local(ray);
    Some(sphere::nearest(radius, origin, direction)? as f32)
}

#[cold]
#[inline(never)]
fn meet_moving_sphere(radius: f64, placed: &Placement, ray: &Ray) -> Option<f32> {
    let (origin, direction) = placed.ray_to_local(ray);
    Some(sphere::nearest(radius, origin, direction)? as f32)
}
