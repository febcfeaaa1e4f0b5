//! Small spheroids in uniform motion: drops and flakes about a camera, under one tree.
//!
//! Separate from the tree over the world's instances. Each spheroid is one leaf with the box of its path.

use etendue_core::Ray;
use glam::{DVec3, Vec3};

use super::lanes::{LaneTask, Lanes};
use super::node::{Child, Node};
use super::walk::{Leaves, walk};
use super::{Simd, boxes::Box3, build::over_boxes, collapse::collapse, ray::SlabRay, tlas::InstructionSet};

/// A spheroid about an upright axis, in the render frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Streak {
    /// Its centre at the start of the view's interval, m.
    pub start_m: Vec3,
    /// Its velocity, m/s.
    pub velocity_mps: Vec3,
    /// Half of its width and half of its height, m.
    pub half_m: [f32; 2],
    /// It exists while its centre is farther than this from the origin, m,
    pub from_m: f32,
    /// and nearer than this, m.
    pub to_m: f32,
}

impl Streak {
    /// Its centre at a ray's time, m.
    #[must_use]
    pub fn centre(&self, time_s: f32) -> Vec3 {
        self.start_m + self.velocity_mps * time_s
    }

    /// The box of its path.
    fn bounds(&self, length_s: f32) -> Box3 {
        let [wide, high] = self.half_m;
        let (a, b) = (self.start_m, self.centre(length_s));
        let bounds = Box3 { low: a.min(b), high: a.max(b) }.grown(Vec3::new(wide, wide, high));
        bounds.grown(bounds.padding())
    }

    /// The entry of a ray, in lengths of the direction; `None` if the ray misses, begins inside, or the spheroid does not exist there.
    #[inline(always)]
    fn enter(&self, ray: &Ray) -> Option<f32> {
        let centre = self.centre(ray.time_s);
        let away2 = centre.length_squared();
        if away2 < self.from_m * self.from_m || away2 >= self.to_m * self.to_m {
            return None;
        }
        // In a frame in which it is a ball of radius 1.
        let scale = DVec3::new(self.half_m[0].into(), self.half_m[0].into(), self.half_m[1].into()).recip();
        let origin = (ray.origin - centre).as_dvec3() * scale;
        let direction = ray.direction.as_dvec3() * scale;
        let [t, _] = crate::geometry::sphere::roots(1.0, origin, direction)?;
        (t > 0.0).then_some(t as f32)
    }
}

/// Spheroids under one tree.
#[derive(Clone, Debug)]
pub struct Streaks {
    nodes: Vec<Node>,
    root: Option<Child>,
    leaves: Vec<u32>,
    streaks: Vec<Streak>,
    chosen: InstructionSet,
}

impl Streaks {
    /// The spheroids of a view whose interval is `length_s` long.
    #[must_use]
    pub fn new(streaks: Vec<Streak>, length_s: f32, simd: Simd) -> Self {
        let boxes: Vec<_> = streaks.iter().map(|streak| streak.bounds(length_s)).collect();
        let mut leaves = Vec::with_capacity(boxes.len());
        let wide = collapse(&over_boxes(&boxes), 1, |leaf| {
            leaves.push(leaf[0]);
            leaves.len() - 1
        });
        Self { nodes: wide.nodes, root: wide.root, leaves, streaks, chosen: InstructionSet::new(simd) }
    }

    /// All of them.
    #[must_use]
    pub fn streaks(&self) -> &[Streak] {
        &self.streaks
    }

    /// The first entry of a ray before `end`, and the index of the spheroid.
    #[must_use]
    pub fn closest(&self, ray: &Ray, end: f32) -> Option<(f32, u32)> {
        self.chosen.run(ClosestQuery { all: self, ray, end })
    }
}

struct ClosestQuery<'a> {
    all: &'a Streaks,
    ray: &'a Ray,
    end: f32,
}

impl LaneTask for ClosestQuery<'_> {
    type Output = Option<(f32, u32)>;

    #[inline(always)]
    fn work<L: Lanes>(self, l: L) -> Self::Output {
        let root = self.all.root?;
        let mut leaves = StreakLeaf { all: self.all, ray: self.ray, best: None };
        if root.as_node().is_some() {
            let slab = SlabRay::new(self.ray.origin, self.ray.direction);
            walk::<L, true>(l, &self.all.nodes, root, &slab, &mut { self.end }, &mut leaves);
        } else {
            leaves.visit(root.leaf_index(), &mut { self.end });
        }
        leaves.best
    }
}

struct StreakLeaf<'a> {
    all: &'a Streaks,
    ray: &'a Ray,
    best: Option<(f32, u32)>,
}

impl Leaves for StreakLeaf<'_> {
    #[inline(always)]
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool {
        let index = self.all.leaves[leaf];
        if let Some(t) = self.all.streaks[index as usize].enter(self.ray)
            && t < *limit
        {
            *limit = t;
            self.best = Some((t, index));
        }
        false
    }
}
