//! Whether the edges of a polygon cross, by a line that sweeps over them (Shamos and Hoey 1976, "Geometric intersection
//! problems"): in n log n steps.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use super::plane::{Point, turn};

/// Whether two edges of the closed polygon cross in a point inside both.
pub(super) fn edges_cross(flat: &[Point]) -> bool {
    let edges: Vec<Edge> = (0..flat.len()).filter_map(|i| Edge::new(i, flat[i], flat[(i + 1) % flat.len()])).collect();
    let mut met = BTreeSet::new();
    events(&edges).into_iter().any(|(_, ends, i)| {
        if ends { meet_at_the_end(&mut met, &edges[i]) } else { meet_at_the_start(&mut met, &edges[i]) }
    })
}

/// An edge from the corner that the sweep meets first to the other.
#[derive(Clone, Copy, Debug)]
struct Edge {
    first: Point,
    last: Point,
    index: usize,
}

impl Edge {
    /// `None` for an edge without length.
    fn new(index: usize, a: Point, b: Point) -> Option<Self> {
        match along(&a, &b) {
            Ordering::Less => Some(Self { first: a, last: b, index }),
            Ordering::Greater => Some(Self { first: b, last: a, index }),
            Ordering::Equal => None,
        }
    }

    fn crosses(&self, other: &Self) -> bool {
        let parts = |s: &Self, t: &Self| turn(s.first, s.last, t.first) * turn(s.first, s.last, t.last) < 0.0;
        parts(self, other) && parts(other, self)
    }

    /// Whether an edge that begins later lies above this one.
    fn is_under(&self, later: &Self) -> Ordering {
        let side = |p: Point| turn(self.first, self.last, p).partial_cmp(&0.0).unwrap_or(Ordering::Equal);
        side(later.first).then_with(|| side(later.last))
    }
}

/// The order in which the sweep meets points: by the first coordinate, then by the second.
fn along(a: &Point, b: &Point) -> Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
}

/// The ends of all edges in the sweep's order, where an edge ends before others begin.
fn events(edges: &[Edge]) -> Vec<(Point, bool, usize)> {
    let both = |(i, e): (usize, &Edge)| [(e.first, false, i), (e.last, true, i)];
    let mut events: Vec<_> = edges.iter().enumerate().flat_map(both).collect();
    events.sort_by(|a, b| along(&a.0, &b.0).then(b.1.cmp(&a.1)).then(a.2.cmp(&b.2)));
    events
}

/// Edges are in order from below to above, as the sweep meets them at one time.
impl Ord for Edge {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_height = match along(&self.first, &other.first) {
            Ordering::Greater => other.is_under(self),
            _ => self.is_under(other).reverse(),
        };
        by_height.then(self.index.cmp(&other.index))
    }
}

impl PartialOrd for Edge {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Edge {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}

impl Eq for Edge {}

fn below<'e>(met: &BTreeSet<&'e Edge>, edge: &'e Edge) -> Option<&'e Edge> {
    met.range::<Edge, _>(..edge).next_back().copied()
}

fn above<'e>(met: &BTreeSet<&'e Edge>, edge: &'e Edge) -> Option<&'e Edge> {
    use std::ops::Bound::{Excluded, Unbounded};
    met.range::<Edge, _>((Excluded(edge), Unbounded)).next().copied()
}

/// Takes an edge in; whether it crosses a neighbour.
fn meet_at_the_start<'e>(met: &mut BTreeSet<&'e Edge>, edge: &'e Edge) -> bool {
    let crossed = [below(met, edge), above(met, edge)].into_iter().flatten().any(|n| n.crosses(edge));
    met.insert(edge);
    crossed
}

/// Lets an edge go; whether those that it kept apart cross.
fn meet_at_the_end<'e>(met: &mut BTreeSet<&'e Edge>, edge: &'e Edge) -> bool {
    met.remove(edge);
    below(met, edge).zip(above(met, edge)).is_some_and(|(b, a)| b.crosses(a))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn by_all_pairs(flat: &[Point]) -> bool {
        let edges: Vec<Edge> =
            (0..flat.len()).filter_map(|i| Edge::new(i, flat[i], flat[(i + 1) % flat.len()])).collect();
        edges.iter().any(|a| edges.iter().any(|b| a.crosses(b)))
    }

    proptest::proptest! {
        #![proptest_config(proptest::prelude::ProptestConfig::with_cases(4000))]

        /// Corners on a coarse grid coincide, stand on edges, and lie on one line.
        #[test]
        fn the_sweep_finds_what_all_pairs_find(corners in proptest::collection::vec((0_i32..7, 0_i32..7), 3..12)) {
            let flat: Vec<Point> = corners.iter().map(|(x, y)| [f64::from(*x), f64::from(*y)]).collect();
            proptest::prop_assert_eq!(edges_cross(&flat), by_all_pairs(&flat));
        }

        #[test]
        fn the_sweep_finds_crossings_anywhere(corners in proptest::collection::vec((0.0_f64..1.0, 0.0_f64..1.0), 3..9)) {
            let flat: Vec<Point> = corners.iter().map(|(x, y)| [*x, *y]).collect();
            proptest::prop_assert_eq!(edges_cross(&flat), by_all_pairs(&flat));
        }
    }
}
