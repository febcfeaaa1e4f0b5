//! Motion from one key to the next.
//!
//! Vectors that are cubic polynomials of a parameter from 0 to 1.

use glam::{DAffine3, DQuat, DVec3};

use super::turn::Turn;

/// Parts into which a span is cut for bounds: a uniform rotation by 90° in 16 parts deviates from their chords by (π/32)²/8 = 0.0012 of the radius.
const PARTS: usize = 16;

/// Position, rotation and scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) position: DVec3,
    pub(super) rotation: DQuat,
    pub(super) scale: DVec3,
}

impl Pose {
    pub(super) fn transform(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.position)
    }
}

/// Motion between two keys, by the elapsed fraction u of time: 0 at the first, 1 at the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) position: Cubic,
    pub(super) scale: Cubic,
    pub(super) turn: Turn,
}

impl Span {
    pub(super) fn at(&self, u: f64) -> Pose {
        Pose { position: self.position.at(u), rotation: self.turn.at(u), scale: self.scale.at(u) }
    }

    /// Returns true if nothing changes.
    pub(super) fn is_constant(&self) -> bool {
        self.position.is_constant() && self.scale.is_constant() && self.turn.is_constant()
    }

    pub(super) fn is_finite(&self) -> bool {
        self.position.is_finite() && self.scale.is_finite() && self.turn.is_finite()
    }

    /// Calls `hold` with boxes that together hold the images of `points` from u0 to u1.
    pub(super) fn each_box(&self, points: &[DVec3], u0: f64, u1: f64, mut hold: impl FnMut(DVec3, DVec3)) {
        let moves_straight = self.position.is_straight() && self.scale.is_straight() && self.turn.is_constant();
        let parts = if moves_straight || u0 == u1 { 1 } else { PARTS };
        let end = |part: usize| u0 + (u1 - u0) * (part as f64 / parts as f64);
        let mut before = self.at(u0).transform();
        for part in 0..parts {
            let (from, to) = (end(part), if part + 1 == parts { u1 } else { end(part + 1) });
            let after = self.at(to).transform();
            for point in points {
                let (a, b) = (before.transform_point3(*point), after.transform_point3(*point));
                let stray = self.chord_deviation(*point, from, to);
                hold(a.min(b) - stray, a.max(b) + stray);
            }
            before = after;
        }
    }

    /// Bounds, by axis, of the terms that are summed for the images of points with coordinates up to `most`.
    pub(super) fn magnitude(&self, maximum: DVec3) -> DVec3 {
        self.position.magnitude() + DVec3::splat((self.scale.magnitude() * maximum).length())
    }

    /// Maximum deviation, by axis, of a point's path from the chord between its places at u0 and u1. A component deviates from linear interpolation over a step
    /// h by at most h²/8 · max|p̈| (the error of interpolation by a polynomial of degree one).
    ///
    /// The point is p = T + R y with y = S q: |p̈| ≤ |T̈| + |R̈ y| + 2 |Ṙ ẏ| + |ÿ|. For a uniform rotation about the axis n by ω per u,
    /// |Ṙ y| = ω |n × y| and |R̈ y| = ω² |n × y|, and as y is linear in u there, |n × y| is greatest at an end.
    fn chord_deviation(&self, q: DVec3, u0: f64, u1: f64) -> DVec3 {
        let bend = match self.turn {
            Turn::Even { vector, .. } if self.scale.is_straight() => {
                let across = |y: DVec3| vector.cross(y).length();
                let maximum = across(self.scale.at(u0) * q).max(across(self.scale.at(u1) * q));
                vector.length() * maximum + 2.0 * across(self.scale.slope(u0) * q)
            }
            _ => {
                let (low, high) = self.scale.range(u0, u1);
                let (rate, second) = self.turn.max_rates(u0, u1);
                let length = |maximum: DVec3| (maximum * q).length();
                second * length(low.abs().max(high.abs()))
                    + 2.0 * rate * length(self.scale.max_slope(u0, u1))
                    + length(self.scale.max_curvature(u0, u1))
            }
        };
        let step = u1 - u0;
        (self.position.max_curvature(u0, u1) + DVec3::splat(bend)) * (step * step / 8.0)
    }
}

/// c₀ + c₁ u + c₂ u² + c₃ u³.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cubic([DVec3; 4]);

impl Cubic {
    /// Returns the straight line from `start` to `end`.
    pub(super) fn straight(start: DVec3, end: DVec3) -> Self {
        Self([start, end - start, DVec3::ZERO, DVec3::ZERO])
    }

    /// Returns the Hermite curve from `start` to `end` with the derivatives `leaves` at u = 0 and `arrives` at u = 1.
    pub(super) fn hermite(start: DVec3, end: DVec3, leaves: DVec3, arrives: DVec3) -> Self {
        let displacement = end - start;
        if leaves == displacement && arrives == displacement {
            return Self::straight(start, end);
        }
        Self([start, leaves, displacement * 3.0 - leaves * 2.0 - arrives, leaves + arrives - displacement * 2.0])
    }

    pub(super) fn at(&self, u: f64) -> DVec3 {
        let [a, b, c, d] = self.0;
        a + (b + (c + d * u) * u) * u
    }

    /// The first derivative.
    pub(super) fn slope(&self, u: f64) -> DVec3 {
        let [_, b, c, d] = self.0;
        b + (c * 2.0 + d * (3.0 * u)) * u
    }

    fn second(&self, u: f64) -> DVec3 {
        let [_, _, c, d] = self.0;
        c * 2.0 + d * (6.0 * u)
    }

    /// Returns true if it is constant.
    pub(super) fn is_constant(&self) -> bool {
        self.0[1..].iter().all(|c| *c == DVec3::ZERO)
    }

    fn is_straight(&self) -> bool {
        self.0[2..].iter().all(|c| *c == DVec3::ZERO)
    }

    pub(super) fn is_finite(&self) -> bool {
        self.0.iter().all(|c| c.is_finite())
    }

    /// Maximum magnitude of the second derivative within [u0, u1], by axis: it is linear.
    pub(super) fn max_curvature(&self, u0: f64, u1: f64) -> DVec3 {
        self.second(u0).abs().max(self.second(u1).abs())
    }

    /// Bounds of the magnitude of the first derivative, by axis: no place is farther than half the length from an end.
    pub(super) fn max_slope(&self, u0: f64, u1: f64) -> DVec3 {
        self.slope(u0).abs().max(self.slope(u1).abs()) + self.max_curvature(u0, u1) * (0.5 * (u1 - u0))
    }

    /// Minimum and maximum values within [u0, u1], by axis: at an end or at a zero of the derivative.
    pub(super) fn range(&self, u0: f64, u1: f64) -> (DVec3, DVec3) {
        let (start, end) = (self.at(u0), self.at(u1));
        let (mut low, mut high) = (start.min(end), start.max(end));
        for axis in 0..3 {
            let turning = roots(3.0 * self.0[3][axis], 2.0 * self.0[2][axis], self.0[1][axis]);
            for u in turning.into_iter().filter(|u| *u > u0 && *u < u1) {
                let value = self.at(u)[axis];
                low[axis] = low[axis].min(value);
                high[axis] = high[axis].max(value);
            }
        }
        (low, high)
    }

    /// Bound of the summed terms of a value, to which its rounding is relative.
    pub(super) fn magnitude(&self) -> DVec3 {
        self.0.iter().map(|c| c.abs()).sum()
    }
}

/// Real roots of a u² + b u + c, without cancellation; a missing root is infinite or NaN.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let q = -0.5 * (b + (b * b - 4.0 * a * c).sqrt().copysign(b));
    [q / a, c / q]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hermite_cubic_has_the_ends_and_slopes_given() {
        let [start, end, leaves, arrives] =
            [DVec3::new(1.0, -2.0, 0.5), DVec3::new(4.0, 8.0, -1.0), DVec3::new(0.25, 3.0, -7.0), DVec3::splat(2.0)];
        let cubic = Cubic::hermite(start, end, leaves, arrives);
        assert_eq!([cubic.at(0.0), cubic.at(1.0)], [start, end]);
        assert_eq!([cubic.slope(0.0), cubic.slope(1.0)], [leaves, arrives]);
    }

    #[test]
    fn the_range_holds_the_turning_points() {
        // By axis: u(1 − u), with the maximum 1/4 at 1/2; u³ − u, with the minimum −2/(3√3) at 1/√3; straight.
        let cubic =
            Cubic([DVec3::ZERO, DVec3::new(1.0, -1.0, 2.0), DVec3::new(-1.0, 0.0, 0.0), DVec3::new(0.0, 1.0, 0.0)]);
        let (low, high) = cubic.range(0.0, 1.0);
        let minimum = -2.0 / (3.0 * 3.0_f64.sqrt());
        assert!((low - DVec3::new(0.0, minimum, 0.0)).length() < 1e-15, "{low}");
        assert!((high - DVec3::new(0.25, 0.0, 2.0)).length() < 1e-15, "{high}");
        let (low, high) = cubic.range(0.75, 1.0);
        assert_eq!((low.x, high.x, low.y), (0.0, 0.1875, 0.75 * 0.75 * 0.75 - 0.75));
    }
}
