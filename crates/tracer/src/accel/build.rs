//! Binary trees.
//!
//! The builder is the obvhs library's and this file is all that knows it: parallel locally-ordered clustering
//! (Meister & Bittner 2018), then reinsertion of subtrees (Meister & Bittner 2018), over boxes that are padded first.
//! Large triangles may stand in several boxes, each about a piece of them. The same boxes give the same tree, whatever
//! the number of threads.

use super::binary::{BinaryKind, BinaryNode};
use super::boxes::Box3;
use super::median_split::{halve, is_crowded};
use glam::Vec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::splits::split_aabbs_preset;
use obvhs::triangle::Triangle;

/// A tree over the triangles of a mesh, worth some effort: it is built once. Node 0 is the root; empty without
/// triangles.
pub(super) fn over_triangles(triangles: &[[Vec3; 3]]) -> Vec<BinaryNode> {
    let triangles: Vec<_> = triangles.iter().map(|t| triangle(*t)).collect();
    let mut boxes: Vec<_> = triangles.iter().map(Triangle::aabb).collect();
    let paddings: Vec<_> = boxes.iter().map(|b| own(b).padding_by_axis()).collect();
    let mut indices: Vec<_> = (0..triangles.len() as u32).collect();
    split(&triangles, &mut boxes, &mut indices);
    for (bounds, triangle) in boxes.iter_mut().zip(&indices) {
        *bounds = theirs(&own(bounds).grown(paddings[*triangle as usize]));
    }
    binary(&boxes, indices, (2, 1.0))
}

/// A tree over boxes, built fast: a view makes one for its instances. Node 0 is the root; empty without boxes.
pub(super) fn over_boxes(boxes: &[Box3]) -> Vec<BinaryNode> {
    let indices = (0..boxes.len() as u32).collect();
    let boxes: Vec<_> = boxes.iter().map(|b| theirs(&b.grown(b.padding()))).collect();
    binary(&boxes, indices, (1, 0.05))
}

fn split(triangles: &[Triangle], boxes: &mut Vec<Aabb>, indices: &mut Vec<u32>) {
    let areas = boxes.iter().map(Aabb::half_area);
    let largest = areas.clone().fold(0.0, f32::max);
    let mean = areas.sum::<f32>() / boxes.len().max(1) as f32;
    split_aabbs_preset(boxes, indices, triangles, mean, largest);
}

/// Reinsertion makes good what clustering among few neighbours leaves: with it, few are better than many (fewer steps a
/// ray, measured). `indices` are the primitives of the boxes; in so many rounds, a share of the nodes is tried for a better place.
fn binary(boxes: &[Aabb], indices: Vec<u32>, (rounds, share): (u32, f32)) -> Vec<BinaryNode> {
    let plain: Vec<_> = boxes.iter().map(own).collect();
    if is_crowded(&plain) {
        return halve(&plain, &indices);
    }
    let mut tree =
        PlocBuilder::with_capacity(boxes.len()).build(PlocSearchDistance::Low, boxes, indices, SortPrecision::U64, 2);
    for _ in 0..rounds {
        ReinsertionOptimizer::default().run(&mut tree, share, None);
    }
    let kind = |node: &obvhs::bvh2::node::Bvh2Node| match node.prim_count {
        0 => BinaryKind::Inner(node.first_index),
        _ => BinaryKind::Leaf(tree.primitive_indices[node.first_index as usize]),
    };
    tree.nodes.iter().map(|node| BinaryNode { bounds: own(node.aabb()), kind: kind(node) }).collect()
}

fn triangle([a, b, c]: [Vec3; 3]) -> Triangle {
    Triangle { v0: a.into(), v1: b.into(), v2: c.into() }
}

fn own(bounds: &Aabb) -> Box3 {
    Box3 { low: bounds.min.into(), high: bounds.max.into() }
}

fn theirs(bounds: &Box3) -> Aabb {
    Aabb::new(bounds.low.into(), bounds.high.into())
}
