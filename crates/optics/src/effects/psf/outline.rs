//! The outline of the aperture, in units of the radius that the f-number states.
//!
//! A circle, or as many arcs as there are blades: with the curvature c the radius of the arcs is the corners' radius over c,
//! so 0 is a polygon and 1 the circle. The area is that of the circle of the f-number: the light is the same. A round
//! obstruction in the middle (a mirror lens) is cut out of it.

use core::f64::consts::PI;
use etendue_core::maths::f64::{asin, sin_cos};
use glam::DVec2;

/// An aperture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outline {
    edges: Vec<Edge>,
    /// Radius of the corners, or of the circle.
    radius: f64,
    obstruction: f64,
}

/// The arc of a blade: points within `radius` of `centre`, or below `distance` along `normal` where it is straight.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    normal: DVec2,
    distance: f64,
    curve: Option<(DVec2, f64)>,
}

impl Outline {
    /// `blades` (0 for a circle) of a curvature, the first corner at `rotation_rad` from x towards y.
    pub(super) fn new(blades: u32, curvature: f64, rotation_rad: f64, obstruction: f64) -> Self {
        if blades == 0 {
            return Self { edges: Vec::new(), radius: 1.0, obstruction };
        }
        let half = PI / f64::from(blades);
        let (sine, cosine) = sin_cos(half);
        // For corners at radius one: triangles, and the segments between chord and arc.
        let segment = if curvature > 0.0 {
            let arc = 1.0 / curvature;
            arc * arc * asin((sine / arc).min(1.0)) - sine * (arc * arc - sine * sine).sqrt()
        } else {
            0.0
        };
        let radius = (PI / (f64::from(blades) * (sine * cosine + segment))).sqrt();
        let edge = |i: u32| {
            let (y, x) = sin_cos(rotation_rad + (2.0 * f64::from(i) + 1.0) * half);
            let (normal, distance, chord) = (DVec2::new(x, y), radius * cosine, radius * sine);
            let curve = (curvature > 0.0).then(|| {
                let arc = radius / curvature;
                (normal * (distance - (arc * arc - chord * chord).sqrt()), arc)
            });
            Edge { normal, distance, curve }
        };
        Self { edges: (0..blades).map(edge).collect(), radius, obstruction }
    }

    /// The radius that holds all of it.
    pub(super) fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether light passes at a point.
    pub(super) fn passes(&self, point: DVec2) -> bool {
        let r2 = point.length_squared();
        let within = |edge: &Edge| match edge.curve {
            Some((centre, radius)) => (point - centre).length_squared() <= radius * radius,
            None => point.dot(edge.normal) <= edge.distance,
        };
        r2 <= self.radius * self.radius && r2 >= self.obstruction * self.obstruction && self.edges.iter().all(within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_outline_has_the_area_of_the_circle() {
        let cells = 1000;
        for (blades, curvature) in [(0, 0.0), (3, 0.0), (5, 0.4), (6, 0.0), (7, 0.9), (8, 1.0)] {
            let outline = Outline::new(blades, curvature, 0.3, 0.0);
            let side = 2.0 * outline.radius() / f64::from(cells);
            let centre = |i: i32| (f64::from(i) + 0.5) * side - outline.radius();
            let inside = |i: i32| (0..cells).filter(|j| outline.passes(DVec2::new(centre(i), centre(*j)))).count();
            let area = (0..cells).map(inside).sum::<usize>() as f64 * side * side;
            // Cells at the border: some 1e-4 of the area.
            assert!((area / PI - 1.0).abs() < 3e-4, "{blades} {curvature}: {area}");
        }
    }

    #[test]
    fn corners_lie_where_they_are_turned_to() {
        let outline = Outline::new(6, 0.0, 0.2, 0.3);
        let at = |angle: f64, r: f64| {
            let (s, c) = sin_cos(angle);
            outline.passes(DVec2::new(c, s) * r)
        };
        let flat = outline.radius() * 3f64.sqrt() / 2.0;
        assert!(at(0.2, 0.999 * outline.radius()) && !at(0.2, 1.001 * outline.radius()));
        assert!(at(0.2 + PI / 6.0, 0.999 * flat) && !at(0.2 + PI / 6.0, 1.001 * flat));
        assert!(!at(1.0, 0.299) && at(1.0, 0.301));
    }
}
