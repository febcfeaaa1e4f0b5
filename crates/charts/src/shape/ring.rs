//! The ring between two outlines about a common centre.

use super::outline::area;
use glam::DVec2;

/// Triangles that partition what lies between a convex outline and another around it, by both outlines' own corners
/// alone. Both turn the same way about `centre`, which is inside of both.
///
/// The corners of both are taken in the order of their angle about the centre: each step joins an edge of one outline
/// with a corner of the other.
#[must_use]
pub fn ring(centre: DVec2, inner: &[DVec2], outer: &[DVec2]) -> Vec<[DVec2; 3]> {
    let start = nearest(centre, inner[0], outer);
    let (n, m) = (inner.len(), outer.len());
    let at = |i: usize, j: usize| (inner[i % n], outer[(start + j) % m]);
    let (mut i, mut j) = (0, 0);
    let mut triangles = Vec::with_capacity(n + m);
    while i < n || j < m {
        let (a, b) = at(i, j);
        let (next_a, next_b) = at(i + 1, j + 1);
        let of_inner = [next_a, a, b];
        let of_outer = [a, b, next_b];
        // The next corner in the order of angles; where that would fold the ring, the other.
        let turn = (next_a - centre).perp_dot(next_b - centre);
        let inner_first = j == m || (i < n && turn > 0.0);
        if (inner_first && area(&of_inner) > 0.0) || j == m {
            triangles.push(of_inner);
            i += 1;
        } else {
            triangles.push(of_outer);
            j += 1;
        }
    }
    triangles
}

/// The outer corner whose direction from the centre is nearest to that of `corner`.
fn nearest(centre: DVec2, corner: DVec2, outer: &[DVec2]) -> usize {
    let towards = (corner - centre).normalize_or_zero();
    let along = |i: &usize| (outer[*i] - centre).normalize_or_zero().dot(towards);
    (0..outer.len()).max_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::super::{disc, rectangle, turned};
    use super::*;

    fn check(centre: DVec2, inner: &[DVec2], outer: &[DVec2]) {
        let triangles = ring(centre, inner, outer);
        assert_eq!(triangles.len(), inner.len() + outer.len());
        assert!(triangles.iter().all(|t| area(t) > 0.0), "{inner:?} {outer:?}");
        let sum: f64 = triangles.iter().map(|t| area(t)).sum();
        // Triangles that all turn the right way and add up cannot overlap.
        assert!((sum / (area(outer) - area(inner)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn rings_are_partitioned() {
        let centre = DVec2::new(3.0, -2.0);
        let cell = rectangle(centre - DVec2::new(10.0, 8.0), centre + DVec2::new(10.0, 8.0));
        for corners in [3, 4, 5, 64, 128] {
            for start in [0.0, 0.1, 0.8, 2.0] {
                check(centre, &disc(centre, 4.0, corners, start), &cell);
                check(centre, &disc(centre, 2.0, corners, start), &disc(centre, 5.0, 37, 0.2));
            }
        }
        let square = rectangle(centre - 4.0, centre + 4.0);
        for degrees in [-43.0_f64, -5.0, 0.0, 2.0, 5.0, 20.0, 45.0] {
            check(centre, &turned(&square, centre, degrees.to_radians()), &cell);
        }
    }
}
