//! Transforms over time: keys of position, rotation and scale, and the motion between them.
//!
//! A constant track holds one matrix. A moving one is cut at its keys into spans, each a smooth function of time. It gives the transform at any time, and boxes
//! that bound the motion during an interval (`bounds`).

mod bounds;
mod rates;
mod rolling;
mod span;
#[cfg(test)]
mod tests;
mod turn;

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3};

use crate::{TimeInterval, words};
use span::{Cubic, Pose, Span};
use turn::{Turn, vector_between};

pub use rolling::RollingError;

pub(crate) use rates::{CurvatureBounds, MovingTransform};

/// Pose at a moment: scale, then rotation, then translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Simulated time, s.
    pub time_s: f64,
    /// Origin of the moved frame in the frame that it moves in, m.
    pub position_m: DVec3,
    /// Rotation, a quaternion of any length except 0; it is normalised. q and −q are the same.
    pub rotation: DQuat,
    /// Scale along each axis of the moved frame; negative ones mirror.
    pub scale: DVec3,
}

/// Interpolates rotations along the shorter arc about one axis at constant rate (Shoemake 1985). `share` is the fraction of the arc, 0 … 1. Both quaternions
/// may have any length except 0.
pub fn slerp(from: DQuat, to: DQuat, fraction: f64) -> DQuat {
    Turn::even(from.normalize(), to.normalize()).at(fraction)
}

words! {
    /// Interpolation of a track between keys. The transform is constant before the first key and after the last.
    pub enum Interpolation = Linear {
        /// Position and scale along straight lines at an even speed; rotation the short way about one axis at an even rate (slerp,
        /// Shoemake 1985, "Animating rotation with quaternion curves", SIGGRAPH).
        "linear" => Linear,
        /// Without jumps of the velocities at the keys. Position and scale by cubic Hermite curves whose derivative at a key is that
        /// of the parabola through it and its two neighbours (Catmull–Rom for uneven times: Barry, Goldman 1988, "A recursive
        /// evaluation algorithm for a class of Catmull-Rom splines", SIGGRAPH), at the first and last key that of the parabola
        /// through three; rotation by the cubic Hermite curve of quaternions (Kim, Kim, Shin 1995) with angular velocities made
        /// alike from those of the slerps beside a key. Two keys are joined as by `Linear`. The curves may overshoot the keys.
        "smooth" => Smooth,
    }
}

/// Reason for which a track is refused. Keys are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TrackError {
    /// No key.
    #[error("the track has no keys; give at least one")]
    Empty,
    /// A number is infinite or NaN, or so large that a velocity is.
    #[error(
        "key {key} of the track is not finite, or the motion from it to the next is too fast for floating-point numbers"
    )]
    NotFinite { key: usize },
    /// A quaternion of length 0.
    #[error("key {key} of the track has a rotation quaternion of length 0; give a unit quaternion")]
    NoRotation { key: usize },
    /// A key before its predecessor.
    #[error("key {key} of the track is at {time_s} s, before key {} at {before_s} s; give the keys in order of time", .key - 1)]
    Unordered {
        /// The later key of the two.
        key: usize,
        time_s: f64,
        /// The time of the key before it, s.
        before_s: f64,
    },
    /// Two keys at the same time.
    #[error("keys {} and {key} of the track are both at {time_s} s; remove one", .key - 1)]
    Repeated {
        /// The later key of the two.
        key: usize,
        /// Their time, s.
        time_s: f64,
    },
}

/// Transform over time. It is constant before its first key and after its last.
#[derive(Clone, Debug, PartialEq)]
pub struct Track(TrackState);

#[derive(Clone, Debug, PartialEq)]
enum TrackState {
    Static(DAffine3),
    Moving(Arc<KeyedTrack>),
}

/// Two keys or more, not all equal.
#[derive(Clone, Debug, PartialEq)]
struct KeyedTrack {
    /// Times of the keys, in increasing order.
    times_s: Vec<f64>,
    /// One span from each key except the last to the next.
    spans: Vec<Span>,
    /// The last key.
    last: Pose,
    /// Transform applied before the track's own.
    first: DAffine3,
}

impl Track {
    /// Returns a constant transform: any affine one, kept bit for bit.
    #[must_use]
    pub fn constant(transform: DAffine3) -> Self {
        Self(TrackState::Static(transform))
    }

    /// Returns the track through `keys`, which must be in order of time.
    ///
    /// # Errors
    /// If there are no keys, if they are out of order or two are at the same time, if numbers are not finite, or if a rotation has length 0.
    pub fn new(keys: &[Key], interpolation: Interpolation) -> Result<Self, TrackError> {
        check(keys)?;
        let poses = poses(keys);
        let times_s: Vec<f64> = keys.iter().map(|key| key.time_s).collect();
        let spans = match interpolation {
            Interpolation::Linear => poses.windows(2).map(|pair| straight(&pair[0], &pair[1])).collect(),
            Interpolation::Smooth => smooth(&times_s, &poses),
        };
        if let Some(key) = spans.iter().position(|span| !span.is_finite()) {
            return Err(TrackError::NotFinite { key });
        }
        if spans.iter().all(Span::is_constant) {
            return Ok(Self::constant(poses[0].transform()));
        }
        let last = poses[poses.len() - 1];
        Ok(Self(TrackState::Moving(Arc::new(KeyedTrack { times_s, spans, last, first: DAffine3::IDENTITY }))))
    }

    /// Returns the same track with `first` applied before it.
    #[must_use]
    pub fn after(&self, first: &DAffine3) -> Self {
        match &self.0 {
            TrackState::Static(transform) => Self::constant(*transform * *first),
            TrackState::Moving(keyed) => {
                let moved = KeyedTrack { first: keyed.first * *first, ..KeyedTrack::clone(keyed) };
                Self(TrackState::Moving(Arc::new(moved)))
            }
        }
    }

    /// Returns the transform at `time_s`.
    #[must_use]
    pub fn at(&self, time_s: f64) -> DAffine3 {
        match &self.0 {
            TrackState::Static(transform) => *transform,
            TrackState::Moving(keyed) => keyed.at(time_s),
        }
    }

    /// Returns the transform if the track is constant; `None` for a moving one.
    #[must_use]
    pub fn as_constant(&self) -> Option<DAffine3> {
        match &self.0 {
            TrackState::Static(transform) => Some(*transform),
            TrackState::Moving(_) => None,
        }
    }

    /// Returns the transform if the track is constant within an interval; else `None`. A single moment is such an interval.
    #[must_use]
    pub fn constant_over(&self, interval: TimeInterval) -> Option<DAffine3> {
        match &self.0 {
            TrackState::Static(transform) => Some(*transform),
            TrackState::Moving(keyed) => {
                let holds = interval.is_moment() || keyed.during(interval).all(|(span, _)| span.is_constant());
                holds.then(|| keyed.at(interval.start_s()))
            }
        }
    }
}

impl KeyedTrack {
    fn at(&self, time_s: f64) -> DAffine3 {
        self.pose(time_s).transform() * self.first
    }

    fn pose(&self, time_s: f64) -> Pose {
        let passed = self.times_s.partition_point(|key_s| *key_s <= time_s);
        match passed {
            0 => self.spans[0].at(0.0),
            _ if passed == self.times_s.len() => self.last,
            _ => self.spans[passed - 1].at(self.part(passed - 1, time_s)),
        }
    }

    /// Elapsed fraction of a span.
    fn part(&self, span: usize, time_s: f64) -> f64 {
        let (start_s, end_s) = (self.times_s[span], self.times_s[span + 1]);
        ((time_s - start_s) / (end_s - start_s)).clamp(0.0, 1.0)
    }

    /// Returns the spans that overlap an interval by more than a moment, with the fractions at which the overlap begins and ends.
    fn during(&self, interval: TimeInterval) -> impl Iterator<Item = (&Span, (f64, f64))> {
        let inner = &self.times_s[1..self.times_s.len() - 1];
        let first = inner.partition_point(|key_s| *key_s <= interval.start_s());
        let last = inner.partition_point(|key_s| *key_s < interval.end_s());
        let ends_s = (self.times_s[0], self.times_s[self.times_s.len() - 1]);
        let holds = interval.is_moment() || interval.end_s() <= ends_s.0 || interval.start_s() >= ends_s.1;
        let spans = if holds { 0..0 } else { first..last + 1 };
        spans.map(move |span| {
            (&self.spans[span], (self.part(span, interval.start_s()), self.part(span, interval.end_s())))
        })
    }
}

fn check(keys: &[Key]) -> Result<(), TrackError> {
    if keys.is_empty() {
        return Err(TrackError::Empty);
    }
    for (key, entry) in keys.iter().enumerate() {
        if !(entry.time_s.is_finite()
            && entry.position_m.is_finite()
            && entry.rotation.is_finite()
            && entry.scale.is_finite())
        {
            return Err(TrackError::NotFinite { key });
        }
        if entry.rotation.length_squared() == 0.0 {
            return Err(TrackError::NoRotation { key });
        }
    }
    for (key, pair) in (1..).zip(keys.windows(2)) {
        let (before_s, time_s) = (pair[0].time_s, pair[1].time_s);
        if time_s == before_s {
            return Err(TrackError::Repeated { key, time_s });
        }
        if time_s < before_s {
            return Err(TrackError::Unordered { key, time_s, before_s });
        }
    }
    Ok(())
}

/// Returns the keys with unit rotations; of the two quaternions of a rotation, the one nearer to that of the previous key.
fn poses(keys: &[Key]) -> Vec<Pose> {
    let mut before = DQuat::IDENTITY;
    let pose = |key: &Key| {
        let unit = unit(key.rotation);
        let rotation = if unit.dot(before) < 0.0 { -unit } else { unit };
        before = rotation;
        Pose { position: key.position_m, rotation, scale: key.scale }
    };
    keys.iter().map(pose).collect()
}

/// Normalises a quaternion. One whose length is 1 to eight roundings is left as it is.
fn unit(q: DQuat) -> DQuat {
    if (q.length_squared() - 1.0).abs() <= 8.0 * f64::EPSILON { q } else { q.normalize() }
}

fn straight(from: &Pose, to: &Pose) -> Span {
    Span {
        position: Cubic::straight(from.position, to.position),
        scale: Cubic::straight(from.scale, to.scale),
        turn: Turn::even(from.rotation, to.rotation),
    }
}

/// Rates of change of position, scale and rotation at a key, per second.
type KeyRates = [DVec3; 3];

fn smooth(times_s: &[f64], poses: &[Pose]) -> Vec<Span> {
    let rates = rates(times_s, poses);
    let span = |i: usize| {
        let (from, to) = (&poses[i], &poses[i + 1]);
        let length_s = times_s[i + 1] - times_s[i];
        let [leaves, arrives] = [rates[i], rates[i + 1]].map(|rates| rates.map(|rate| rate * length_s));
        Span {
            position: Cubic::hermite(from.position, to.position, leaves[0], arrives[0]),
            scale: Cubic::hermite(from.scale, to.scale, leaves[1], arrives[1]),
            turn: Turn::smooth(from.rotation, to.rotation, leaves[2], arrives[2]),
        }
    };
    (0..poses.len() - 1).map(span).collect()
}

/// Returns the rates at all keys; none for a single key.
fn rates(times_s: &[f64], poses: &[Pose]) -> Vec<KeyRates> {
    let lengths_s: Vec<f64> = times_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let means: Vec<KeyRates> =
        poses.windows(2).zip(&lengths_s).map(|(pair, length_s)| mean_rates(pair, *length_s)).collect();
    let Some(last) = means.len().checked_sub(1) else { return Vec::new() };
    if last == 0 {
        return vec![means[0]; 2];
    }
    // Derivative at a key of the parabola through three keys, from the mean rates before and after it.
    let inner = |i: usize| {
        let (before_s, after_s) = (lengths_s[i - 1], lengths_s[i]);
        let weight = before_s / (before_s + after_s);
        join(&means[i - 1], &means[i], |before, after| before * (1.0 - weight) + after * weight)
    };
    // Derivative of the same parabola at its end: the mean rate of a span is that at its middle.
    let end = |mean: &KeyRates, inner: &KeyRates| join(mean, inner, |mean, inner| mean * 2.0 - inner);
    let mut rates: Vec<KeyRates> = (1..=last).map(inner).collect();
    let (first, end) = (end(&means[0], &rates[0]), end(&means[last], &rates[last - 1]));
    rates.insert(0, first);
    rates.push(end);
    rates
}

fn mean_rates(pair: &[Pose], length_s: f64) -> KeyRates {
    let [from, to] = [&pair[0], &pair[1]];
    let differences = [to.position - from.position, to.scale - from.scale, vector_between(from.rotation, to.rotation)];
    differences.map(|difference| difference / length_s)
}

fn join(a: &KeyRates, b: &KeyRates, f: impl Fn(DVec3, DVec3) -> DVec3) -> KeyRates {
    [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])]
}
