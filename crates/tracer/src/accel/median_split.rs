//! Binary trees for crowds: very many boxes about one point.
//!
//! The good builder joins nearest neighbours; among boxes within boxes there is one such pair at a time, and its work
//! grows with the square of their number. Halving by the median takes little time whatever the boxes.

use super::binary::{BinaryKind, BinaryNode};
use super::boxes::Box3;
use glam::{DVec3, Vec3};

/// More boxes than this about one point are a crowd. A thousand times a thousand steps are still nothing.
const CROWD: usize = 2000;

/// Whether some point is the centre of a crowd, at a resolution of 2⁻²¹ of the whole (the builder's own).
pub(super) fn is_crowded(boxes: &[Box3]) -> bool {
    let Some(whole) = boxes.iter().copied().reduce(|a, b| a.union(&b)).filter(|_| boxes.len() > CROWD) else {
        return false;
    };
    let mut cells: Vec<_> = boxes.iter().map(|b| cell(b.centre(), &whole)).collect();
    cells.sort_unstable();
    cells.chunk_by(|a, b| a == b).any(|cell| cell.len() > CROWD)
}

/// Three times 21 bits of where a point lies in a box.
fn cell(point: Vec3, whole: &Box3) -> u64 {
    let extent = (whole.high - whole.low).as_dvec3().max(DVec3::splat(f64::MIN_POSITIVE));
    let steps = (point - whole.low).as_dvec3() / extent * f64::from((1 << 21) - 1);
    let [x, y, z] = steps.to_array().map(|s| s as u64);
    x << 42 | y << 21 | z
}

/// A tree by halving at the median centre along the axis on which centres spread most. `indices` are the primitives of
/// the boxes.
pub(super) fn halve(boxes: &[Box3], indices: &[u32]) -> Vec<BinaryNode> {
    let mut members: Vec<usize> = (0..boxes.len()).collect();
    let mut nodes = Vec::with_capacity(2 * boxes.len());
    let mut pending = Vec::new();
    if let Some(first) = boxes.first() {
        nodes.push(BinaryNode { bounds: *first, kind: BinaryKind::Inner(0) });
        pending.push((0, 0..boxes.len()));
    }
    while let Some((node, range)) = pending.pop() {
        if range.len() == 1 {
            let member = members[range.start];
            nodes[node] = BinaryNode { bounds: boxes[member], kind: BinaryKind::Leaf(indices[member]) };
            continue;
        }
        let middle = range.start + range.len() / 2;
        part(boxes, &mut members[range.clone()]);
        let first = nodes.len();
        nodes[node].kind = BinaryKind::Inner(first as u32);
        nodes.extend([nodes[node]; 2]);
        pending.extend([(first, range.start..middle), (first + 1, middle..range.end)]);
    }
    enclose(&mut nodes);
    nodes
}

/// Puts the lesser half of the centres first.
fn part(boxes: &[Box3], members: &mut [usize]) {
    let centres = || members.iter().map(|m| boxes[*m].centre());
    let spread = centres().reduce(Vec3::max).unwrap_or(Vec3::ZERO) - centres().reduce(Vec3::min).unwrap_or(Vec3::ZERO);
    let axis = (0..3).fold(0, |best, axis| if spread[axis] > spread[best] { axis } else { best });
    let along = |m: &usize| boxes[*m].centre()[axis];
    members.select_nth_unstable_by(members.len() / 2, |a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
}

/// Gives each parent the box about its children, which come after it.
fn enclose(nodes: &mut [BinaryNode]) {
    for node in (0..nodes.len()).rev() {
        if let BinaryKind::Inner(first) = nodes[node].kind {
            nodes[node].bounds = nodes[first as usize].bounds.union(&nodes[first as usize + 1].bounds);
        }
    }
}
