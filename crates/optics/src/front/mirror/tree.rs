//! A tree of boxes over the triangles of a mirror: halves by the middle of the longest side.

use super::super::Line;
use glam::DVec3;

/// Triangles of a leaf at most.
const LEAF: usize = 4;
/// Deeper than any tree that halves: 2³² triangles.
const DEPTH: usize = 64;
/// By how much of its numbers a box is larger than what it holds, for rounding.
const MARGIN: f64 = 1e-12;

/// Stands for 1/0.
const HUGE: f64 = 1e300;

#[derive(Clone, Debug, PartialEq)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// Of a leaf the range of `order`; else the right child, the left one being next.
    first: u32,
    count: u32,
}

/// The tree.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Tree {
    pub(super) fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let boxes: Vec<(DVec3, DVec3)> = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| positions[i as usize]);
                (a.min(b).min(c), a.max(b).max(c))
            })
            .collect();
        let order: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut tree = Self { nodes: Vec::new(), order };
        tree.split(&boxes, 0, triangles.len());
        tree
    }

    fn split(&mut self, boxes: &[(DVec3, DVec3)], from: usize, to: usize) {
        let held = self.order[from..to].iter().map(|i| boxes[*i as usize]);
        let (low, high) = held.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default();
        let margin = DVec3::splat(MARGIN * low.abs().max(high.abs()).max_element());
        let at = self.nodes.len();
        let (first, count) = (from as u32, (to - from) as u32);
        self.nodes.push(Node { low: low - margin, high: high + margin, first, count });
        if to - from <= LEAF {
            return;
        }
        let size = high - low;
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let middle = |i: &u32| boxes[*i as usize].0[axis] + boxes[*i as usize].1[axis];
        let half = (to - from) / 2;
        self.order[from..to].select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
        self.split(boxes, from, from + half);
        let right = self.nodes.len() as u32;
        self.split(boxes, from + half, to);
        (self.nodes[at].first, self.nodes[at].count) = (right, 0);
    }

    /// Hands over the triangles that a ray may meet nearer than `nearest`, which the visitor lowers.
    pub(super) fn visit(&self, line: &Line, nearest: &mut f64, mut each: impl FnMut(u32, &mut f64)) {
        // Not infinite, so that no 0 · ∞ arises on a box's face.
        let inverse = DVec3::from_array(line.direction.to_array().map(|d| if d == 0.0 { HUGE } else { 1.0 / d }));
        let (mut stack, mut depth) = ([0_u32; DEPTH], 1);
        while depth > 0 {
            depth -= 1;
            let at = stack[depth] as usize;
            let node = &self.nodes[at];
            if !node.meets(line.point_mm, inverse, *nearest) {
                continue;
            }
            if node.count > 0 {
                let range = node.first as usize..(node.first + node.count) as usize;
                self.order[range].iter().for_each(|i| each(*i, nearest));
            } else {
                (stack[depth], stack[depth + 1]) = (node.first, at as u32 + 1);
                depth += 2;
            }
        }
    }
}

impl Node {
    fn meets(&self, origin: DVec3, inverse: DVec3, nearest: f64) -> bool {
        let (a, b) = ((self.low - origin) * inverse, (self.high - origin) * inverse);
        let enter = a.x.min(b.x).max(a.y.min(b.y)).max(a.z.min(b.z)).max(0.0);
        let leave = a.x.max(b.x).min(a.y.max(b.y)).min(a.z.max(b.z)).min(nearest);
        enter <= leave
    }
}
