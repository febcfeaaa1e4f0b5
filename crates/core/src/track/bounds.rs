//! Bounds of a moving object during an interval.
//!
//! Every span that overlaps the interval is cut into sixteen parts (one for straight motion without rotation). The box of a part is that of the corners at its
//! two ends, enlarged by the maximum deviation of their paths from the chords between ([`Span::each_box`]): at each moment the transform is affine, so that the
//! moved box is the convex hull of its moved corners.

use core::f64::consts::PI;

use glam::{BVec3, DAffine3, DMat3, DVec3};

use super::{KeyedTrack, Track, TrackState, span::Span};
use crate::TimeInterval;

/// Tolerance for rounding, relative to the sum: at most some thirty operations of 1.1e-16 each.
const ROUNDING: f64 = 1e-14;
/// Smallest scale of a moving object, relative to its largest along the same axis. Smaller scales count as flattened.
const MIN_SCALE_RATIO: f64 = 1e-12;

impl Track {
    /// Returns the minimum and maximum coordinates of a box that holds the box from `low` to `high` (of the moved frame) at every moment of an interval,
    /// including the rounding of [`Track::at`].
    #[must_use]
    pub fn bounds_over(&self, interval: TimeInterval, (low, high): (DVec3, DVec3)) -> (DVec3, DVec3) {
        let corner = |i: u32| DVec3::select(BVec3::new(i & 1 == 0, i & 2 == 0, i & 4 == 0), low, high);
        let corners: Vec<DVec3> = (0..8).map(corner).collect();
        self.bounds_of_points(interval, &corners)
    }

    /// Returns the same for a ball.
    #[must_use]
    pub fn bounds_of_ball(&self, interval: TimeInterval, centre: DVec3, radius: f64) -> (DVec3, DVec3) {
        let (low, high) = self.bounds_of_points(interval, &[centre]);
        let reach = DVec3::splat(radius * self.stretch_over(interval).1 * (1.0 + ROUNDING));
        (low - reach, high + reach)
    }

    /// Returns a box that holds a ball of the given radius about the moved frame's origin during an interval: looser than [`Track::bounds_of_ball`] if a
    /// transform is applied before the track's own or scales change, and fast for long intervals.
    #[must_use]
    pub fn rough_bounds(&self, interval: TimeInterval, radius: f64) -> (DVec3, DVec3) {
        let (first, (low, high)) = match &self.0 {
            TrackState::Static(transform) => (None, (transform.translation, transform.translation)),
            TrackState::Moving(keyed) => (Some(&keyed.first), keyed.origin_over(interval)),
        };
        let inner = first.map_or(radius, |first| max_stretch(&first.matrix3) * radius + first.translation.length());
        let stretch = match &self.0 {
            TrackState::Static(transform) => max_stretch(&transform.matrix3),
            TrackState::Moving(keyed) => keyed.scales_over(interval).1.max_element(),
        };
        let reach = DVec3::splat(inner * stretch);
        let room = (low.abs().max(high.abs()) + reach) * ROUNDING;
        (low - reach - room, high + reach + room)
    }

    /// Returns bounds, during an interval, of the smallest and the largest factor by which lengths change; exact if each scale is the same along all axes and
    /// no transform is applied before.
    #[must_use]
    pub fn stretch_over(&self, interval: TimeInterval) -> (f64, f64) {
        let of_matrix = |m: &DMat3| (1.0 / max_stretch(&m.inverse()), max_stretch(m));
        match &self.0 {
            TrackState::Static(transform) => of_matrix(&transform.matrix3),
            TrackState::Moving(keyed) => {
                let (minimum, maximum) = keyed.scales_over(interval);
                let first = of_matrix(&keyed.first.matrix3);
                (minimum.min_element() * first.0, maximum.max_element() * first.1)
            }
        }
    }

    /// Returns a bound, during an interval, of the largest coordinate in the moved frame of points in the box from `low` to `high` of the parent frame.
    #[must_use]
    pub fn local_reach(&self, interval: TimeInterval, (low, high): (DVec3, DVec3)) -> f64 {
        let ((origin_low, origin_high), minimum) = match &self.0 {
            TrackState::Static(transform) => {
                ((transform.translation, transform.translation), 1.0 / max_stretch(&transform.matrix3.inverse()))
            }
            TrackState::Moving(keyed) => (keyed.origin_over(interval), keyed.scales_over(interval).0.min_element()),
        };
        let away = (high - origin_low).abs().max((origin_high - low).abs()).length();
        let reach = away * (1.0 + ROUNDING) / minimum;
        match &self.0 {
            TrackState::Static(_) => reach,
            TrackState::Moving(keyed) => {
                let back = keyed.first.inverse();
                (back.translation.abs() + row_lengths(&back.matrix3) * reach).max_element()
            }
        }
    }

    /// Returns a bound of the angle, rad, by which normals turn during an interval from their directions at its start; π if scales change.
    #[must_use]
    pub fn turning_over(&self, interval: TimeInterval) -> f64 {
        let of_span = |(span, (u0, u1)): (&Span, (f64, f64))| {
            if span.scale.is_constant() { span.turn.max_rates(u0, u1).0 * (u1 - u0) } else { PI }
        };
        match &self.0 {
            TrackState::Static(_) => 0.0,
            TrackState::Moving(keyed) => keyed.during(interval).map(of_span).sum::<f64>().min(PI),
        }
    }

    /// Returns true if the scale along every axis is 1 at all times.
    #[must_use]
    pub fn keeps_scale(&self) -> bool {
        match &self.0 {
            TrackState::Static(_) => true,
            TrackState::Moving(keyed) => keyed.spans.iter().all(|span| span.scale.is_constant()),
        }
    }

    /// Returns true if the transform has an inverse at every time. No scale of a moving track passes through zero or is less than 1e-12 of its largest.
    #[must_use]
    pub fn is_invertible(&self) -> bool {
        match &self.0 {
            TrackState::Static(transform) => has_inverse(transform),
            TrackState::Moving(keyed) => keyed.is_invertible(),
        }
    }

    fn bounds_of_points(&self, interval: TimeInterval, points: &[DVec3]) -> (DVec3, DVec3) {
        match &self.0 {
            TrackState::Static(transform) => {
                let moved = points.iter().map(|point| transform.transform_point3(*point));
                let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                let (low, high) = moved.fold(none, |(low, high), p| (low.min(p), high.max(p)));
                let room = max_of(transform, points) * ROUNDING;
                (low - room, high + room)
            }
            TrackState::Moving(keyed) => keyed.bounds_of_points(interval, points),
        }
    }
}

impl KeyedTrack {
    fn bounds_of_points(&self, interval: TimeInterval, points: &[DVec3]) -> (DVec3, DVec3) {
        let maximum = max_of(&self.first, points);
        let points: Vec<DVec3> = points.iter().map(|point| self.first.transform_point3(*point)).collect();
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut room = DVec3::ZERO;
        let mut hold = |a: DVec3, b: DVec3| (low, high) = (low.min(a), high.max(b));
        let mut is_held = true;
        for (span, (u0, u1)) in self.during(interval) {
            span.each_box(&points, u0, u1, &mut hold);
            room = room.max(span.magnitude(maximum));
            is_held = false;
        }
        if is_held {
            let pose = self.pose(interval.start_s());
            let transform = pose.transform();
            points.iter().map(|point| transform.transform_point3(*point)).for_each(|p| hold(p, p));
            room = pose.position.abs() + DVec3::splat((pose.scale.abs() * maximum).length());
        }
        (low - room * ROUNDING, high + room * ROUNDING)
    }

    /// Minimum and maximum coordinates of the keyed position during an interval.
    fn origin_over(&self, interval: TimeInterval) -> (DVec3, DVec3) {
        let ranges = self.during(interval).map(|(span, (u0, u1))| span.position.range(u0, u1));
        ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_else(|| {
            let position = self.pose(interval.start_s()).position;
            (position, position)
        })
    }

    /// Bounds of the magnitudes of the scales, by axis, during an interval.
    fn scales_over(&self, interval: TimeInterval) -> (DVec3, DVec3) {
        let ranges = self.during(interval).map(|(span, (u0, u1))| span.scale.range(u0, u1));
        let (low, high) = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_else(|| {
            let pose = self.pose(interval.start_s());
            (pose.scale, pose.scale)
        });
        magnitudes(low, high)
    }

    fn is_invertible(&self) -> bool {
        let ranges = self.spans.iter().map(|span| span.scale.range(0.0, 1.0));
        let range = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let Some((low, high)) = range else { return false };
        let (minimum, maximum) = magnitudes(low, high);
        let keeps_sides = (low.cmpgt(DVec3::ZERO) | high.cmplt(DVec3::ZERO)).all();
        let ends = [minimum, maximum].map(|scale| DAffine3::from_scale(scale) * self.first);
        keeps_sides && minimum.cmpgt(maximum * MIN_SCALE_RATIO).all() && ends.iter().all(has_inverse)
    }
}

/// Minimum and maximum magnitude of numbers from `low` to `high`, by axis.
fn magnitudes(low: DVec3, high: DVec3) -> (DVec3, DVec3) {
    (low.max(-high).max(DVec3::ZERO), high.max(-low))
}

fn has_inverse(transform: &DAffine3) -> bool {
    transform.is_finite() && transform.matrix3.determinant() != 0.0 && transform.inverse().is_finite()
}

/// Bound of the largest factor by which a matrix changes lengths: the smaller of two upper norms.
pub(super) fn max_stretch(m: &DMat3) -> f64 {
    let sums =
        |m: &DMat3| [m.x_axis, m.y_axis, m.z_axis].map(|c| c.abs().element_sum()).into_iter().fold(0.0, f64::max);
    let squares: f64 = m.to_cols_array().iter().map(|x| x * x).sum();
    (sums(m) * sums(&m.transpose())).sqrt().min(squares.sqrt())
}

fn row_lengths(m: &DMat3) -> DVec3 {
    let rows = m.transpose();
    DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length())
}

/// Bounds, by axis, of the terms that are summed when `points` are transformed.
fn max_of(transform: &DAffine3, points: &[DVec3]) -> DVec3 {
    let maximum = points.iter().fold(DVec3::ZERO, |maximum, point| maximum.max(point.abs()));
    let m = &transform.matrix3;
    let rows = DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
    rows * maximum + transform.translation.abs()
}
