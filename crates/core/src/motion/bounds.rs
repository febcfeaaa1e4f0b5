//! Bounds of a moving object in nested frames during an interval.
//!
//! One track has its own bounds. The interval of a chain is cut at the keys of all its tracks, and each piece into sixteen parts, or more for fast rotation, so
//! that no track turns by more than 0.1 rad in a part. At each moment the whole transform is affine: the box of a part is that of the moved corners at its two
//! ends, enlarged by the maximum deviation of their paths from the chords between, h²/8 · max|p̈|. The acceleration of a point that is carried by a chain is
//! bounded from within outwards by the product rule ([`crate::track`]'s `Bend`), so that a box is as tight as that of one track, however long the chain.

use core::f64::consts::PI;

use glam::{BVec3, DVec3};

use super::{Motion, MotionChain, is_similarity};
use crate::TimeInterval;
use crate::track::{CurvatureBounds, Track};

/// Tolerance for rounding of each track, relative to the sum: at most some sixty operations of 1.1e-16 each.
const ROUNDING: f64 = 2e-14;
/// Rounding of a time, and of the elapsed fraction of a span, relative to the time.
const TIME_ROUNDING: f64 = 1e-15;
/// Maximum rotation within a part, rad.
const MAX_PART_TURN_RAD: f64 = 0.1;
/// Minimum and maximum number of parts of a piece.
const PARTS: (f64, f64) = (16.0, 1024.0);

impl Motion {
    /// Returns the minimum and maximum coordinates of a box that holds the box from `low` to `high` (of the moved frame) at every moment of an interval,
    /// including the rounding of [`Motion::at`].
    #[must_use]
    pub fn bounds_over(&self, interval: TimeInterval, (low, high): (DVec3, DVec3)) -> (DVec3, DVec3) {
        if let MotionChain::One(track) = &self.0 {
            return track.bounds_over(interval, (low, high));
        }
        let corner = |i: u32| DVec3::select(BVec3::new(i & 1 == 0, i & 2 == 0, i & 4 == 0), low, high);
        self.bounds_of_points(interval, &[0, 1, 2, 3, 4, 5, 6, 7].map(corner))
    }

    /// Returns the same for a ball.
    #[must_use]
    pub fn bounds_of_ball(&self, interval: TimeInterval, centre: DVec3, radius: f64) -> (DVec3, DVec3) {
        if let MotionChain::One(track) = &self.0 {
            return track.bounds_of_ball(interval, centre, radius);
        }
        let (low, high) = self.bounds_of_points(interval, &[centre]);
        let reach = DVec3::splat(radius * self.stretch_over(interval).1 * (1.0 + ROUNDING));
        (low - reach, high + reach)
    }

    /// Returns a box that holds a ball of the given radius about the moved frame's origin during an interval: looser than [`Motion::bounds_of_ball`], and fast
    /// for intervals of many keys.
    #[must_use]
    pub fn rough_bounds(&self, interval: TimeInterval, radius: f64) -> (DVec3, DVec3) {
        let carried = self.links()[1..].iter().rev().fold(radius, |radius, link| {
            let (low, high) = link.rough_bounds(interval, radius);
            low.abs().max(high.abs()).length()
        });
        self.links()[0].rough_bounds(interval, carried)
    }

    /// Returns bounds, during an interval, of the smallest and the largest factor by which lengths change.
    #[must_use]
    pub fn stretch_over(&self, interval: TimeInterval) -> (f64, f64) {
        let factors = self.links().iter().map(|link| link.stretch_over(interval));
        factors.fold((1.0, 1.0), |all, link| (all.0 * link.0, all.1 * link.1))
    }

    /// Returns a bound, during an interval, of the largest coordinate in the moved frame of points in the box from `low` to `high` of the world.
    #[must_use]
    pub fn local_reach(&self, interval: TimeInterval, world_box: (DVec3, DVec3)) -> f64 {
        let (inmost, outer) = (&self.links()[self.outer().len()], self.outer());
        let inward = |outside: (DVec3, DVec3), link: &Track| {
            let reach = DVec3::splat(link.local_reach(interval, outside));
            (-reach, reach)
        };
        inmost.local_reach(interval, outer.iter().fold(world_box, inward))
    }

    /// Returns a bound of the angle, rad, by which normals turn during an interval from their directions at its start; π if scales change, or if the rotated
    /// frame is stretched.
    #[must_use]
    pub fn turning_over(&self, interval: TimeInterval) -> f64 {
        let stretches = |link: &Track| !is_similarity(&link.at(interval.start_s()).matrix3);
        if self.outer().iter().any(stretches) {
            return PI;
        }
        self.links().iter().map(|link| link.turning_over(interval)).sum::<f64>().min(PI)
    }

    /// Returns true if the transform has an inverse at every time.
    #[must_use]
    pub fn is_invertible(&self) -> bool {
        self.links().iter().all(Track::is_invertible)
    }

    fn bounds_of_points(&self, interval: TimeInterval, points: &[DVec3]) -> (DVec3, DVec3) {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (start_s, end_s) in self.pieces(interval) {
            let parts = self.parts(start_s, end_s);
            let part_start_s = |i: u32| {
                if i == parts { end_s } else { start_s + (end_s - start_s) * f64::from(i) / f64::from(parts) }
            };
            let mut before = self.at(start_s);
            for part in 0..parts {
                let (from_s, to_s) = (part_start_s(part), part_start_s(part + 1));
                let after = self.at(to_s);
                for point in points {
                    let (a, b) = (before.transform_point3(*point), after.transform_point3(*point));
                    let stray = DVec3::splat(self.chord_deviation(from_s, to_s, *point));
                    low = low.min(a.min(b) - stray);
                    high = high.max(a.max(b) + stray);
                }
                before = after;
            }
        }
        (low, high)
    }

    /// Cuts the interval at the keys within it.
    fn pieces(&self, interval: TimeInterval) -> Vec<(f64, f64)> {
        let (start_s, end_s) = (interval.start_s(), interval.end_s());
        let mut ends_s = vec![start_s, end_s];
        for times_s in self.links().iter().map(Track::times_s) {
            let within =
                |passes: fn(&f64, &f64) -> bool, end_s: f64| times_s.partition_point(|key_s| passes(key_s, &end_s));
            let first = within(f64::le, start_s);
            ends_s.extend(&times_s[first..within(f64::lt, end_s).max(first)]);
        }
        ends_s.sort_by(f64::total_cmp);
        ends_s.dedup();
        if ends_s.len() == 1 {
            return vec![(start_s, end_s)];
        }
        ends_s.windows(2).map(|pair| (pair[0], pair[1])).collect()
    }

    fn parts(&self, start_s: f64, end_s: f64) -> u32 {
        let rate: f64 = self.links().iter().map(|link| link.turning_rate(start_s, end_s)).sum();
        if start_s == end_s {
            1
        } else {
            (rate * (end_s - start_s) / MAX_PART_TURN_RAD).ceil().max(PARTS.0).min(PARTS.1) as u32
        }
    }

    /// Maximum deviation of a point's path from the chord between its places at two times without a key between them, including the rounding of places and of
    /// times.
    fn chord_deviation(&self, start_s: f64, end_s: f64, point: DVec3) -> f64 {
        let own = CurvatureBounds { distance: point.length(), ..CurvatureBounds::default() };
        let links = self.links();
        let bend = links.iter().rev().fold(own, |inner, link| link.curvature_bounds(start_s, end_s, &inner));
        let step_s = end_s - start_s;
        let timing = bend.speed * TIME_ROUNDING * (start_s.abs().max(end_s.abs()) + step_s);
        bend.acceleration * (step_s * step_s / 8.0) + bend.distance * ROUNDING * links.len() as f64 + timing
    }
}
