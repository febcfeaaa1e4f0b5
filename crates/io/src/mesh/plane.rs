//! Points of a plane.

/// A point.
pub(super) type Point = [f64; 2];

/// Twice the signed area of a triangle, positive counter-clockwise.
pub(super) fn turn(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
