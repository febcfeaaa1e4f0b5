//! References to triangles: one each, but several to a triangle that is large beside the others, each about a piece of it.
//!
//! Large triangles make large boxes which many rays enter in vain. Cutting them before the tree is built (Ernst, Greiner 2007,
//! "Early split clipping for bounding volume hierarchies") costs little; a piece's box is enlarged by what the whole
//! triangle's box needs.

use super::reference::Reference;
use crate::accel::boxes::Box3;
use glam::{Vec3, Vec3A};
use obvhs::splits::split_triangle;
use rayon::prelude::*;

/// Boxes that are this many times as large as the mean are worth cutting.
const LARGE: f32 = 3.0;
/// A cut must make the areas' sum smaller by this factor.
const GAIN: f32 = 1.8;
/// The same where the box is not much larger than the mean.
const GAIN_OF_SMALL: f32 = 1.6;
/// Places tried along the longest axis, and one more.
const PLACES: u32 = 12;
/// A quarter more than the padding, 1.5e-7 of the coordinates, for a rounding of what moves.
const ROUNDED: f32 = 1.25;
/// Cuts one below the other: at most 2¹² pieces.
const DEEPEST: u32 = 12;

/// A reference to each of `count` triangles with the given corners.
pub(super) fn whole(count: usize, corners: &(impl Fn(u32) -> [Vec3; 3] + Sync)) -> Vec<Reference> {
    let reference = |triangle| {
        let bounds = Box3::about(&corners(triangle));
        Reference::new(&bounds.grown(bounds.padding_by_axis()), triangle)
    };
    (0..count as u32).into_par_iter().map(reference).collect()
}

/// A reference to each of `count` triangles that move, by the box about all places of each.
pub(super) fn swept(count: usize, bounds: &(impl Fn(u32) -> Box3 + Sync)) -> Vec<Reference> {
    let reference = |triangle| {
        let bounds = bounds(triangle);
        Reference::new(&bounds.grown(bounds.padding_by_axis() * ROUNDED), triangle)
    };
    (0..count as u32).into_par_iter().map(reference).collect()
}

/// As [`whole`], with several references to a triangle that is large beside the others.
pub(super) fn cut_large(count: usize, corners: &(impl Fn(u32) -> [Vec3; 3] + Sync)) -> Vec<Reference> {
    let mut references = whole(count, corners);
    let limits = Limits::new(&references);
    for triangle in 0..count {
        // The padded box is no smaller.
        if references[triangle].bounds().half_area() <= limits.large {
            continue;
        }
        let corners = corners(triangle as u32);
        let (mut pieces, bounds) = (Vec::new(), Box3::about(&corners));
        cut(&corners, bounds, &limits, DEEPEST, &mut pieces);
        let padding = bounds.padding_by_axis();
        let mut pieces = pieces.into_iter().map(|piece| Reference::new(&piece.grown(padding), triangle as u32));
        references[triangle] = pieces.next().expect("a piece at least");
        references.extend(pieces);
    }
    references
}

/// Areas (half of the surface) from which boxes are cut.
struct Limits {
    large: f32,
    /// Below this a smaller gain is enough.
    small: f32,
}

impl Limits {
    fn new(references: &[Reference]) -> Self {
        let (mut sum, mut largest) = (0.0_f64, 0.0_f32);
        for reference in references {
            let area = reference.bounds().half_area();
            sum += f64::from(area);
            largest = largest.max(area);
        }
        let mean = (sum / references.len().max(1) as f64) as f32;
        Self { large: LARGE * mean, small: (4.0 * mean).max(0.9 * mean + 0.1 * largest) }
    }
}

/// Adds the pieces of a box about a triangle, or the box itself.
fn cut(corners: &[Vec3; 3], bounds: Box3, limits: &Limits, depth: u32, pieces: &mut Vec<Box3>) {
    let area = bounds.half_area();
    let parted = if depth > 0 && area > limits.large { best_cut(corners, &bounds) } else { None };
    let pays = |sum: f32| sum * GAIN < area || limits.small > area && sum * GAIN_OF_SMALL < area;
    match parted {
        Some((sum, [low, high])) if pays(sum) => {
            cut(corners, low, limits, depth - 1, pieces);
            cut(corners, high, limits, depth - 1, pieces);
        }
        _ => pieces.push(bounds),
    }
}

/// The two boxes about what a plane across the longest axis parts, and the sum of their areas, where that is least.
fn best_cut(corners: &[Vec3; 3], bounds: &Box3) -> Option<(f32, [Box3; 2])> {
    let size = bounds.high - bounds.low;
    let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    let [a, b, c] = corners.map(Vec3A::from);
    let at = |place: u32| {
        let share = place as f32 / PLACES as f32;
        let plane = bounds.low[axis] * share + bounds.high[axis] * (1.0 - share);
        let (low, high) = split_triangle(axis as u32, plane, [a, b, c, a]);
        let (mut below, mut above) = (*bounds, *bounds);
        (below.high[axis], above.low[axis]) = (plane, plane);
        let parts = [(low, below), (high, above)].map(|(part, limit)| Box3 {
            low: Vec3::from(part.min).max(limit.low),
            high: Vec3::from(part.max).min(limit.high),
        });
        (parts[0].half_area() + parts[1].half_area(), parts)
    };
    (1..PLACES)
        .map(at)
        .filter(|(_, parts)| parts.iter().all(Box3::is_valid))
        .reduce(|a, b| if b.0 < a.0 { b } else { a })
}
