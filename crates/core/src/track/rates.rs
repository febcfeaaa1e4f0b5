//! Rates of change of a track's transform: exact at a moment, and bounded over a time without keys.

use glam::{DAffine3, DMat3, DVec3};

use super::{KeyedTrack, Track, TrackState, bounds::max_stretch, span::Span};

/// Transform and its time derivative.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MovingTransform {
    pub(crate) at: DAffine3,
    /// Derivative of the matrix, 1/s.
    pub(crate) turning: DMat3,
    /// Derivative of the translation, m/s.
    pub(crate) velocity: DVec3,
}

impl MovingTransform {
    /// Returns a constant transform.
    pub(crate) fn constant(at: DAffine3) -> Self {
        Self { at, turning: DMat3::ZERO, velocity: DVec3::ZERO }
    }

    /// Returns the derivative of a motion by `inner` in a frame moved by `self`: the product rule.
    pub(crate) fn carrying(&self, inner: &Self) -> Self {
        Self {
            at: self.at * inner.at,
            turning: self.turning * inner.at.matrix3 + self.at.matrix3 * inner.turning,
            velocity: self.turning * inner.at.translation + self.at.matrix3 * inner.velocity + self.velocity,
        }
    }
}

/// Bounds of a point's motion: its distance from the frame's origin, m, and the magnitudes of its velocity, m/s, and its
/// acceleration, m/s².
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CurvatureBounds {
    pub(crate) distance: f64,
    pub(crate) speed: f64,
    pub(crate) acceleration: f64,
}

impl CurvatureBounds {
    /// Returns the bounds seen through a transform, by the product rule. `matrix` bounds the norms of its matrix and of its first and second derivative;
    /// `place` does the same for its translation.
    fn composed_with(&self, matrix: [f64; 3], place: [f64; 3]) -> Self {
        Self {
            distance: matrix[0] * self.distance + place[0],
            speed: matrix[1] * self.distance + matrix[0] * self.speed + place[1],
            acceleration: matrix[2] * self.distance
                + 2.0 * matrix[1] * self.speed
                + matrix[0] * self.acceleration
                + place[2],
        }
    }

    fn moved(&self, transform: &DAffine3) -> Self {
        self.composed_with([max_stretch(&transform.matrix3), 0.0, 0.0], [transform.translation.length(), 0.0, 0.0])
    }
}

impl Track {
    /// Times of the keys, s; none if the track is constant.
    pub(crate) fn times_s(&self) -> &[f64] {
        match &self.0 {
            TrackState::Static(_) => &[],
            TrackState::Moving(keyed) => &keyed.times_s,
        }
    }

    /// Returns the transform at `time_s` and its rate of change there, for the span that contains `within_s`: velocities may jump at a key.
    pub(crate) fn moving_at(&self, time_s: f64, within_s: f64) -> MovingTransform {
        match &self.0 {
            TrackState::Static(transform) => MovingTransform::constant(*transform),
            TrackState::Moving(keyed) => match keyed.span_at(within_s) {
                Some(span) => keyed.moving_in(span, time_s),
                None => MovingTransform::constant(keyed.at(time_s)),
            },
        }
    }

    /// Returns bounds from `start_s` to `end_s`, without a key between them, for a point whose motion in the moved frame has the bounds `inner`.
    pub(crate) fn curvature_bounds(&self, start_s: f64, end_s: f64, inner: &CurvatureBounds) -> CurvatureBounds {
        match &self.0 {
            TrackState::Static(transform) => inner.moved(transform),
            TrackState::Moving(keyed) => {
                let inner = inner.moved(&keyed.first);
                match keyed.part_of(start_s, end_s) {
                    Some((span, (u0, u1), length_s)) => span.curvature_bounds(u0, u1, length_s, &inner),
                    None => inner.moved(&keyed.pose(start_s).transform()),
                }
            }
        }
    }

    /// Returns a bound of the rotation rate, rad/s, from `start_s` to `end_s`, without a key between them.
    pub(crate) fn turning_rate(&self, start_s: f64, end_s: f64) -> f64 {
        let TrackState::Moving(keyed) = &self.0 else { return 0.0 };
        keyed.part_of(start_s, end_s).map_or(0.0, |(span, (u0, u1), length_s)| span.turn.max_rates(u0, u1).0 / length_s)
    }
}

impl KeyedTrack {
    /// Returns the span that contains a time.
    fn span_at(&self, time_s: f64) -> Option<usize> {
        let passed = self.times_s.partition_point(|key_s| *key_s <= time_s);
        (passed > 0 && passed < self.times_s.len()).then(|| passed - 1)
    }

    /// Returns the span that contains two times, the fractions of it elapsed at them, and its length, s.
    fn part_of(&self, start_s: f64, end_s: f64) -> Option<(&Span, (f64, f64), f64)> {
        let span = self.span_at(start_s + 0.5 * (end_s - start_s))?;
        let length_s = self.times_s[span + 1] - self.times_s[span];
        Some((&self.spans[span], (self.part(span, start_s), self.part(span, end_s)), length_s))
    }

    fn moving_in(&self, span: usize, time_s: f64) -> MovingTransform {
        let length_s = self.times_s[span + 1] - self.times_s[span];
        let (span, u) = (&self.spans[span], self.part(span, time_s));
        let pose = span.at(u);
        let (rotation, scale) = (DMat3::from_quat(pose.rotation), DMat3::from_diagonal(pose.scale));
        let turning = rotation * cross(span.turn.velocity(u)) * scale;
        let growing = rotation * DMat3::from_diagonal(span.scale.slope(u));
        let keyed = MovingTransform {
            at: pose.transform(),
            turning: (turning + growing) * (1.0 / length_s),
            velocity: span.position.slope(u) / length_s,
        };
        keyed.carrying(&MovingTransform::constant(self.first))
    }
}

impl Span {
    /// Bounds from u0 to u1 of a span of `length_s` seconds. With R the rotation and S the scale, |d(R S)/du| ≤ |Ṙ| |S| + |Ṡ| and
    /// |d²(R S)/du²| ≤ |R̈| |S| + 2 |Ṙ| |Ṡ| + |S̈|.
    fn curvature_bounds(&self, u0: f64, u1: f64, length_s: f64, inner: &CurvatureBounds) -> CurvatureBounds {
        let maximum = |range: (DVec3, DVec3)| range.0.abs().max(range.1.abs());
        let (rate, second) = self.turn.max_rates(u0, u1);
        let scale = [
            maximum(self.scale.range(u0, u1)).max_element(),
            self.scale.max_slope(u0, u1).max_element(),
            self.scale.max_curvature(u0, u1).max_element(),
        ];
        let matrix = [scale[0], rate * scale[0] + scale[1], second * scale[0] + 2.0 * rate * scale[1] + scale[2]];
        let place = [
            maximum(self.position.range(u0, u1)).length(),
            self.position.max_slope(u0, u1).length(),
            self.position.max_curvature(u0, u1).length(),
        ];
        let by_time = |[own, first, second]: [f64; 3]| [own, first / length_s, second / (length_s * length_s)];
        inner.composed_with(by_time(matrix), by_time(place))
    }
}

/// Matrix that maps v to ω × v.
fn cross(omega: DVec3) -> DMat3 {
    DMat3::from_cols(omega.cross(DVec3::X), omega.cross(DVec3::Y), omega.cross(DVec3::Z))
}
