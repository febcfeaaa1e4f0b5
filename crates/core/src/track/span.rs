//! Motion from one key to the next.

use super::cubic::Cubic;
use super::turn::Turn;
use glam::{DAffine3, DQuat, DVec3};

/// Parts into which a span is cut for bounds: an even turn by 90° in 16 parts strays from their chords by
/// (π/32)²/8 = 0.0012 of the radius.
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

/// Motion between two keys, by the part u of the time that has passed: 0 at the first, 1 at the second.
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

    /// Whether nothing changes.
    pub(super) fn is_constant(&self) -> bool {
        self.position.is_constant() && self.scale.is_constant() && self.turn.is_constant()
    }

    pub(super) fn is_finite(&self) -> bool {
        self.position.is_finite() && self.scale.is_finite() && self.turn.is_finite()
    }

    /// Calls `hold` with boxes that hold where `points` come to, together with all between them, from u0 to u1.
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
                let stray = self.stray(*point, from, to);
                hold(a.min(b) - stray, a.max(b) + stray);
            }
            before = after;
        }
    }

    /// Bounds of what is added up for the places of points with coordinates up to `most`, by axis.
    pub(super) fn magnitude(&self, most: DVec3) -> DVec3 {
        self.position.magnitude() + DVec3::splat((self.scale.magnitude() * most).length())
    }

    /// How far a point's path strays at most from the chord between its places at u0 and u1, by axis: a component strays from
    /// linear interpolation over a step h by h²/8 · max|p̈| at most (the error of interpolation by a polynomial of degree one).
    ///
    /// The point is p = T + R y with y = S q: |p̈| ≤ |T̈| + |R̈ y| + 2 |Ṙ ẏ| + |ÿ|. Of an even turn about the axis n by ω per u,
    /// |Ṙ y| = ω |n × y| and |R̈ y| = ω² |n × y|, and as y is linear in u there, |n × y| is greatest at an end.
    fn stray(&self, q: DVec3, u0: f64, u1: f64) -> DVec3 {
        let bend = match self.turn {
            Turn::Even { vector, .. } if self.scale.is_straight() => {
                let across = |y: DVec3| vector.cross(y).length();
                let most = across(self.scale.at(u0) * q).max(across(self.scale.at(u1) * q));
                vector.length() * most + 2.0 * across(self.scale.slope(u0) * q)
            }
            _ => {
                let (low, high) = self.scale.range(u0, u1);
                let (rate, second) = self.turn.most_rates(u0, u1);
                let length = |most: DVec3| (most * q).length();
                second * length(low.abs().max(high.abs()))
                    + 2.0 * rate * length(self.scale.most_slope(u0, u1))
                    + length(self.scale.most_curvature(u0, u1))
            }
        };
        let step = u1 - u0;
        (self.position.most_curvature(u0, u1) + DVec3::splat(bend)) * (step * step / 8.0)
    }
}
