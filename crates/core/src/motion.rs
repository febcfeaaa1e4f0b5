//! Motion through nested moving frames: a wheel on a vehicle, a lamp on an arm, a camera on either.
//!
//! A motion is a chain of tracks, the outermost first: each moves in the frame that the tracks before it move. A transform that is constant in a moving frame
//! becomes part of that frame's track, so the length of a chain is the number of nested motions. A single track is evaluated directly.

mod bounds;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use crate::TimeInterval;
use crate::track::{MovingTransform, RollingError, Track};

/// Transform over time from a moved frame to the world. It is constant before the first key and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion(MotionChain);

#[derive(Clone, Debug, PartialEq)]
enum MotionChain {
    One(Track),
    /// Two or more, the outermost first; all but the first move.
    Chain(Arc<[Track]>),
}

/// Tolerance for a matrix to count as a rotation, by element: descriptions have some ten digits.
const RIGID_TOLERANCE: f64 = 1e-6;

impl From<Track> for Motion {
    fn from(track: Track) -> Self {
        Self(MotionChain::One(track))
    }
}

impl Motion {
    /// Returns a constant transform: any affine one, kept bit for bit.
    #[must_use]
    pub fn constant(transform: DAffine3) -> Self {
        Track::constant(transform).into()
    }

    /// Returns the motion of an object that moves by `inner` in the frame moved by `self`.
    #[must_use]
    pub fn carrying(&self, inner: &Self) -> Self {
        Self::nested([self, inner])
    }

    /// Returns the motion of an object that moves by the last of `motions`, in the frame moved by the one before it, and so on to the first, which moves in the
    /// world. The time is linear in their number. Constant if there are none.
    #[must_use]
    pub fn nested<'m>(motions: impl IntoIterator<Item = &'m Self>) -> Self {
        let mut links: Vec<Track> = Vec::new();
        for track in motions.into_iter().flat_map(Self::links) {
            match (links.last_mut(), track.as_constant()) {
                (Some(last), Some(still)) => *last = last.after(&still),
                (Some(last), None) if last.as_constant() == Some(DAffine3::IDENTITY) => *last = track.clone(),
                _ => links.push(track.clone()),
            }
        }
        match <[Track; 1]>::try_from(links) {
            Ok([only]) => only.into(),
            Err(links) if links.is_empty() => Self::constant(DAffine3::IDENTITY),
            Err(links) => Self(MotionChain::Chain(links.into())),
        }
    }

    /// Returns the same motion with `first` applied before it.
    #[must_use]
    pub fn after(&self, first: &DAffine3) -> Self {
        match &self.0 {
            MotionChain::One(track) => track.after(first).into(),
            MotionChain::Chain(_) => self.carrying(&Self::constant(*first)),
        }
    }

    /// Returns the rotation of a wheel about the y axis of its hub (moved by `self`) as it rolls without slipping on stationary ground. The angle is the
    /// distance travelled by the hub's origin in the world along the hub's x axis, divided by `radius_m` (above 0). It is 0 until the first key. The error is
    /// at most 1e-6 rad between any two keys. The result is a motion in the frame of the hub ([`Motion::carrying`]).
    ///
    /// # Errors
    /// If nothing moves, or if the wheel would turn by more than can be followed.
    pub fn rolling(&self, radius_m: f64) -> Result<Self, RollingError> {
        let times_s = self.times_s();
        if times_s.is_empty() {
            return Err(RollingError::Still);
        }
        let forward = |time_s: f64, within_s: f64| {
            let hub = self.moving_at(time_s, within_s);
            hub.velocity.dot(hub.at.matrix3.x_axis.normalize_or_zero()) / radius_m
        };
        Track::rolling(&times_s, forward).map(Self::from)
    }

    /// Returns the transform at a simulated time, s.
    #[must_use]
    #[inline]
    pub fn at(&self, time_s: f64) -> DAffine3 {
        match &self.0 {
            MotionChain::One(track) => track.at(time_s),
            MotionChain::Chain(links) => {
                links.iter().skip(1).fold(links[0].at(time_s), |outer, link| outer * link.at(time_s))
            }
        }
    }

    /// Returns the velocity in the world, m/s, of a point of the moved frame (m) at a simulated time, s. Exact; at a key it is that of the motion after the
    /// key. 0 before the first key and from the last on.
    #[must_use]
    pub fn velocity_at(&self, time_s: f64, point_m: DVec3) -> DVec3 {
        let moving = self.moving_at(time_s, time_s);
        moving.turning * point_m + moving.velocity
    }

    /// Returns the transform if nothing ever moves; else `None`.
    #[must_use]
    pub fn as_constant(&self) -> Option<DAffine3> {
        match &self.0 {
            MotionChain::One(track) => track.as_constant(),
            MotionChain::Chain(_) => None,
        }
    }

    /// Returns the transform if nothing moves within an interval; else `None`. A single moment is such an interval.
    #[must_use]
    pub fn constant_over(&self, interval: TimeInterval) -> Option<DAffine3> {
        match &self.0 {
            MotionChain::One(track) => track.constant_over(interval),
            MotionChain::Chain(links) => {
                let holds = links.iter().all(|link| link.constant_over(interval).is_some());
                holds.then(|| self.at(interval.start_s()))
            }
        }
    }

    /// Returns the interval from the first key to the last; `None` if nothing ever moves. The motion is constant outside it.
    #[must_use]
    pub fn motion_interval(&self) -> Option<TimeInterval> {
        let times_s = self.times_s();
        TimeInterval::new(*times_s.first()?, *times_s.last()?)
    }

    /// Returns true if the motion keeps all lengths and mirrors nothing, to 1e-6, at every time.
    #[must_use]
    pub fn is_rigid(&self) -> bool {
        self.links().iter().all(|link| link.keeps_scale() && is_rotation(&link.at(0.0).matrix3))
    }

    /// Returns true if all areas are constant over time.
    #[must_use]
    pub fn keeps_areas(&self) -> bool {
        let links = self.links();
        links.iter().all(Track::keeps_scale) && self.outer().iter().all(|link| is_similarity(&link.at(0.0).matrix3))
    }

    fn links(&self) -> &[Track] {
        match &self.0 {
            MotionChain::One(track) => core::slice::from_ref(track),
            MotionChain::Chain(links) => links,
        }
    }

    /// All tracks except the innermost.
    fn outer(&self) -> &[Track] {
        let links = self.links();
        &links[..links.len() - 1]
    }

    /// Returns the times of all keys, s, in increasing order, each once.
    pub(crate) fn times_s(&self) -> Vec<f64> {
        let mut times_s: Vec<f64> = self.links().iter().flat_map(|link| link.times_s()).copied().collect();
        times_s.sort_by(f64::total_cmp);
        times_s.dedup();
        times_s
    }

    fn moving_at(&self, time_s: f64, within_s: f64) -> MovingTransform {
        let still = MovingTransform::constant(DAffine3::IDENTITY);
        self.links().iter().fold(still, |outer, link| outer.carrying(&link.moving_at(time_s, within_s)))
    }
}

fn is_rotation(m: &DMat3) -> bool {
    let off = (m.transpose() * *m - DMat3::IDENTITY).to_cols_array();
    off.iter().all(|x| x.abs() <= RIGID_TOLERANCE) && m.determinant() > 0.0
}

/// Returns true if the matrix scales all lengths by the same factor.
fn is_similarity(m: &DMat3) -> bool {
    let square = m.x_axis.length_squared();
    let off = (m.transpose() * *m - DMat3::from_diagonal(DVec3::splat(square))).to_cols_array();
    off.iter().all(|x| x.abs() <= RIGID_TOLERANCE * square)
}
