//! Trees over triangles and over boxes.
//!
//! - `reference`, `pieces`: what they are built over: padded boxes, of large triangles several.
//! - `partition`: where a range is cut, by the surface area heuristic.
//! - `top_down`: ranges cut in two, again and again.
//! - `reinsertion`: better places for subtrees, by the obvhs library.
//!
//! The same boxes give the same tree, whatever the number of threads.

mod partition;
mod pieces;
mod reference;
mod reinsertion;
mod top_down;

use super::binary::BinaryNode;
use super::boxes::Box3;
use glam::Vec3;
use reference::Reference;
use reinsertion::Effort;

/// What is spent on the trees of meshes. Every choice gives the same answers to rays; docs/performance.md has the price of
/// each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum TreeQuality {
    /// The least time to build: one pass from the top down.
    Fast,
    /// The same with large triangles cut, and better places for the largest subtrees.
    #[default]
    Default,
    /// The same for half of all subtrees: the least time a ray.
    Best,
}

/// Of the largest subtrees of a mesh. Twice as many gave 3 % fewer nodes a ray in the street, for 15 % more time to build.
const LARGEST: Effort = Effort { apart: 0.06, tried: 1.0 };
/// Of half of a mesh's subtrees. All of them, or more of them tried, gave no better trees.
const HALF: Effort = Effort { apart: 0.5, tried: 0.3 };
/// Of a tree over instances, which are few.
const ALL: Effort = Effort { apart: 1.0, tried: 0.2 };

/// A binary tree over triangles with the given corners; empty without triangles. Of a large triangle there may be several
/// leaves.
pub(super) fn over_triangles(
    count: usize,
    corners: impl Fn(u32) -> [Vec3; 3] + Sync,
    quality: TreeQuality,
) -> Vec<BinaryNode> {
    let mut references = match quality {
        TreeQuality::Fast => pieces::whole(count, &corners),
        TreeQuality::Default | TreeQuality::Best => pieces::cut_large(count, &corners),
    };
    let binary = top_down::build(&mut references);
    drop(references);
    match quality {
        TreeQuality::Fast => binary,
        TreeQuality::Default => reinsertion::improved(binary, LARGEST),
        TreeQuality::Best => reinsertion::improved(binary, HALF),
    }
}

/// A binary tree over triangles that move, each in its box for all of an interval; empty without triangles. Places found at times in between
/// may be rounded out of those boxes by a unit in the last place of f32, 1.2e-7 of their coordinates, for which there is room too.
pub(super) fn over_moving(count: usize, swept: impl Fn(u32) -> Box3 + Sync, quality: TreeQuality) -> Vec<BinaryNode> {
    let mut references = pieces::swept(count, &swept);
    let binary = top_down::build(&mut references);
    match quality {
        TreeQuality::Fast => binary,
        TreeQuality::Default | TreeQuality::Best => reinsertion::improved(binary, LARGEST),
    }
}

/// A binary tree over boxes; empty without boxes.
pub(super) fn over_boxes(boxes: &[Box3]) -> Vec<BinaryNode> {
    let reference = |(b, number): (&Box3, u32)| Reference::new(&b.grown(b.padding()), number);
    let mut references: Vec<_> = boxes.iter().zip(0..).map(reference).collect();
    reinsertion::improved(top_down::build(&mut references), ALL)
}
