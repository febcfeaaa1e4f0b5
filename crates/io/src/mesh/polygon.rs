//! Triangulation of polygons.
//!
//! Convex polygons become a fan about their first corner. Concave ones are cut by ear clipping in the projection along their Newell normal, in 64 bits. A
//! polygon that crosses itself has no triangulation and is refused.
//!
//! Crossing edges are found by a sweep line (Shamos and Hoey 1976, "Geometric intersection problems") in n log n steps.

#[cfg(test)]
mod tests;

use std::{cmp::Ordering, collections::BTreeSet};

use super::ear_clipping::{Point2, clip_ears, turn};

/// Reason for which a polygon has no triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PolygonError {
    /// Its edges cross, or it encloses no area although its corners are not collinear.
    CrossesItself,
}

impl PolygonError {
    /// Description of the error, for a polygon of the given number of corners.
    pub(super) fn message(self, corners: usize) -> String {
        match self {
            Self::CrossesItself => {
                format!(
                    "a polygon of {corners} corners intersects itself; triangulate the mesh in the modelling program"
                )
            }
        }
    }
}

/// Triangles of the polygon `corners`, as indices into it, in its winding. Collinear corners give triangles of zero area, which the tracer counts and drops.
pub(super) fn triangulate(corners: &[[f64; 3]]) -> Result<Vec<[usize; 3]>, PolygonError> {
    if corners.len() == 3 || on_one_line(corners) {
        return Ok(fan(corners.len()));
    }
    let flat = project(corners).ok_or(PolygonError::CrossesItself)?;
    if is_convex(&flat) {
        return Ok(fan(corners.len()));
    }
    if edges_cross(&flat) {
        return Err(PolygonError::CrossesItself);
    }
    clip_ears(&flat).ok_or(PolygonError::CrossesItself)
}

/// Triangles of a polygon of three corners or more, as indices into it, in its winding; `None` if it crosses itself.
#[must_use]
pub fn polygon_triangles(corners: &[[f64; 3]]) -> Option<Vec<[usize; 3]>> {
    match corners.len() {
        0..3 => Some(Vec::new()),
        _ => triangulate(corners).ok(),
    }
}

fn fan(count: usize) -> Vec<[usize; 3]> {
    (1..count - 1).map(|i| [0, i, i + 1]).collect()
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Twice the area vector (Newell), about the first corner so that large coordinates cancel.
pub(super) fn newell(corners: &[[f64; 3]]) -> [f64; 3] {
    let from_first: Vec<[f64; 3]> = corners.iter().map(|&c| sub(c, corners[0])).collect();
    from_first.windows(2).fold([0.0; 3], |sum, pair| {
        let area = cross(pair[0], pair[1]);
        std::array::from_fn(|i| sum[i] + area[i])
    })
}

/// Threshold below which a doubled area counts as rounding: 1e-12 of the squared extent.
fn negligible_area(corners: &[[f64; 3]]) -> f64 {
    1e-12 * corners.iter().map(|&c| dot(sub(c, corners[0]), sub(c, corners[0]))).fold(0.0, f64::max)
}

fn on_one_line(corners: &[[f64; 3]]) -> bool {
    let spokes = || corners.iter().map(|&c| sub(c, corners[0]));
    let longest = spokes().fold([0.0; 3], |best, s| if dot(s, s) > dot(best, best) { s } else { best });
    let limit = negligible_area(corners);
    spokes().all(|s| {
        let area = cross(longest, s);
        dot(area, area).sqrt() <= limit
    })
}

/// Projection of the polygon to the coordinate plane with the largest projected area, counter-clockwise. `None` if it encloses no area.
fn project(corners: &[[f64; 3]]) -> Option<Vec<Point2>> {
    let normal = newell(corners);
    let largest = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()))?;
    if normal[largest].abs() <= negligible_area(corners) {
        return None;
    }
    let (mut u, mut v) = ((largest + 1) % 3, (largest + 2) % 3);
    if normal[largest] < 0.0 {
        (u, v) = (v, u);
    }
    Some(corners.iter().map(|&c| sub(c, corners[0])).map(|c| [c[u], c[v]]).collect())
}

/// Returns true if a counter-clockwise polygon turns left everywhere, and once in all: a pentagram turns left at each corner but twice in all, which its fan's
/// triangles show by turning right somewhere.
fn is_convex(flat: &[Point2]) -> bool {
    let n = flat.len();
    let left = |a: usize, b: usize, c: usize| turn(flat[a % n], flat[b % n], flat[c % n]) >= 0.0;
    (0..n).all(|i| left(i, i + 1, i + 2)) && (1..n - 1).all(|i| left(0, i, i + 1))
}

/// Returns true if two edges of the closed polygon cross at an interior point of both.
pub(super) fn edges_cross(flat: &[Point2]) -> bool {
    let edges: Vec<PolygonEdge> =
        (0..flat.len()).filter_map(|i| PolygonEdge::new(i, flat[i], flat[(i + 1) % flat.len()])).collect();
    let mut active = BTreeSet::new();
    events(&edges).into_iter().any(|(_, ends, i)| {
        if ends { remove_edge(&mut active, &edges[i]) } else { insert_edge(&mut active, &edges[i]) }
    })
}

/// Edge from the corner that the sweep reaches first to the other.
#[derive(Clone, Copy, Debug)]
struct PolygonEdge {
    first: Point2,
    last: Point2,
    index: usize,
}

impl PolygonEdge {
    /// `None` for an edge without length.
    fn new(index: usize, a: Point2, b: Point2) -> Option<Self> {
        match sweep_order(&a, &b) {
            Ordering::Less => Some(Self { first: a, last: b, index }),
            Ordering::Greater => Some(Self { first: b, last: a, index }),
            Ordering::Equal => None,
        }
    }

    fn crosses(&self, other: &Self) -> bool {
        let parts = |s: &Self, t: &Self| turn(s.first, s.last, t.first) * turn(s.first, s.last, t.last) < 0.0;
        parts(self, other) && parts(other, self)
    }

    /// Compares with an edge that begins later: less if that edge lies above this one.
    fn is_under(&self, later: &Self) -> Ordering {
        let side = |p: Point2| turn(self.first, self.last, p).partial_cmp(&0.0).unwrap_or(Ordering::Equal);
        side(later.first).then_with(|| side(later.last))
    }
}

/// Order of points in the sweep: by the first coordinate, then by the second.
fn sweep_order(a: &Point2, b: &Point2) -> Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
}

/// Ends of all edges in sweep order; an edge ends before others begin at the same point.
fn events(edges: &[PolygonEdge]) -> Vec<(Point2, bool, usize)> {
    let both = |(i, e): (usize, &PolygonEdge)| [(e.first, false, i), (e.last, true, i)];
    let mut events: Vec<_> = edges.iter().enumerate().flat_map(both).collect();
    events.sort_by(|a, b| sweep_order(&a.0, &b.0).then(b.1.cmp(&a.1)).then(a.2.cmp(&b.2)));
    events
}

/// Edges are ordered from bottom to top, as the sweep intersects them at one time.
impl Ord for PolygonEdge {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_height = match sweep_order(&self.first, &other.first) {
            Ordering::Greater => other.is_under(self),
            _ => self.is_under(other).reverse(),
        };
        by_height.then(self.index.cmp(&other.index))
    }
}

impl PartialOrd for PolygonEdge {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for PolygonEdge {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}

impl Eq for PolygonEdge {}

fn below<'e>(active: &BTreeSet<&'e PolygonEdge>, edge: &'e PolygonEdge) -> Option<&'e PolygonEdge> {
    active.range::<PolygonEdge, _>(..edge).next_back().copied()
}

fn above<'e>(active: &BTreeSet<&'e PolygonEdge>, edge: &'e PolygonEdge) -> Option<&'e PolygonEdge> {
    use std::ops::Bound::{Excluded, Unbounded};
    active.range::<PolygonEdge, _>((Excluded(edge), Unbounded)).next().copied()
}

/// Inserts an edge; returns true if it crosses a neighbour.
fn insert_edge<'e>(active: &mut BTreeSet<&'e PolygonEdge>, edge: &'e PolygonEdge) -> bool {
    let crossed = [below(active, edge), above(active, edge)].into_iter().flatten().any(|n| n.crosses(edge));
    active.insert(edge);
    crossed
}

/// Removes an edge; returns true if the edges that it separated cross.
fn remove_edge<'e>(active: &mut BTreeSet<&'e PolygonEdge>, edge: &'e PolygonEdge) -> bool {
    active.remove(edge);
    below(active, edge).zip(above(active, edge)).is_some_and(|(b, a)| b.crosses(a))
}
