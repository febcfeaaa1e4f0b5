//! Motion of what is carried by what moves: a wheel on a vehicle, a lamp on an arm, a camera on either.
//!
//! A motion is a chain of tracks, the outermost first: each moves in the frame that those before it move. What stands still in
//! a moving frame is part of that frame's track, so that a chain is as long as there are motions within each other; one track
//! by itself is asked as it is.

mod bounds;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use crate::TimeInterval;
use crate::track::{MovingTransform, RollingError, Track};

/// A transform over time: from a moved frame to the world. Before the first of its keys and after the last it holds still.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion(Links);

#[derive(Clone, Debug, PartialEq)]
enum Links {
    One(Track),
    /// Two or more, the outermost first; all but the first move.
    Chain(Arc<[Track]>),
}

/// How far a matrix may be from a rotation, by element: descriptions are written with some ten digits.
const RIGID: f64 = 1e-6;

impl From<Track> for Motion {
    fn from(track: Track) -> Self {
        Self(Links::One(track))
    }
}

impl Motion {
    /// What does not move: any affine transform, kept bit for bit.
    #[must_use]
    pub fn still(transform: DAffine3) -> Self {
        Track::still(transform).into()
    }

    /// The motion of what moves by `inner` in the frame that moves by this.
    #[must_use]
    pub fn carrying(&self, inner: &Self) -> Self {
        Self::nested([self, inner])
    }

    /// The motion of what moves by the last of `motions` in the frame that moves by the one before it, and so on to the first, which moves in the world: in time
    /// linear in their number. Still where there are none.
    #[must_use]
    pub fn nested<'m>(motions: impl IntoIterator<Item = &'m Self>) -> Self {
        let mut links: Vec<Track> = Vec::new();
        for track in motions.into_iter().flat_map(Self::links) {
            match (links.last_mut(), track.as_still()) {
                (Some(last), Some(still)) => *last = last.after(&still),
                (Some(last), None) if last.as_still() == Some(DAffine3::IDENTITY) => *last = track.clone(),
                _ => links.push(track.clone()),
            }
        }
        match <[Track; 1]>::try_from(links) {
            Ok([only]) => only.into(),
            Err(links) if links.is_empty() => Self::still(DAffine3::IDENTITY),
            Err(links) => Self(Links::Chain(links.into())),
        }
    }

    /// The same motion of something that `first` is applied to before it moves.
    #[must_use]
    pub fn after(&self, first: &DAffine3) -> Self {
        match &self.0 {
            Links::One(track) => track.after(first).into(),
            Links::Chain(_) => self.carrying(&Self::still(*first)),
        }
    }

    /// How a wheel turns about the y axis of what this moves, its hub, as it rolls without slipping on ground that stands still: by the way of the hub's origin in
    /// the world along the hub's x axis, divided by `radius_m` (above 0). Not turned until the first key. Good to 1e-6 rad between any two keys. The wheel moves
    /// by that in the frame of its hub ([`Motion::carrying`]).
    ///
    /// # Errors
    /// Where nothing moves, and where the wheel would turn by more than can be followed.
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

    /// The transform at a simulated time, s.
    #[must_use]
    #[inline]
    pub fn at(&self, time_s: f64) -> DAffine3 {
        match &self.0 {
            Links::One(track) => track.at(time_s),
            Links::Chain(links) => {
                links.iter().skip(1).fold(links[0].at(time_s), |outer, link| outer * link.at(time_s))
            }
        }
    }

    /// The velocity in the world, m/s, of a point of the moved frame (m) at a simulated time, s: exact; at a key that of the motion after it.
    /// 0 before the first key and from the last on.
    #[must_use]
    pub fn velocity_at(&self, time_s: f64, point_m: DVec3) -> DVec3 {
        let moving = self.moving_at(time_s, time_s);
        moving.turning * point_m + moving.velocity
    }

    /// Where nothing ever moves, its transform.
    #[must_use]
    pub fn as_still(&self) -> Option<DAffine3> {
        match &self.0 {
            Links::One(track) => track.as_still(),
            Links::Chain(_) => None,
        }
    }

    /// Where nothing moves within an interval, the transform there. A single moment is such an interval.
    #[must_use]
    pub fn still_over(&self, interval: TimeInterval) -> Option<DAffine3> {
        match &self.0 {
            Links::One(track) => track.still_over(interval),
            Links::Chain(links) => {
                let holds = links.iter().all(|link| link.still_over(interval).is_some());
                holds.then(|| self.at(interval.start_s()))
            }
        }
    }

    /// From the first key to the last; `None` where nothing ever moves. It holds still outside.
    #[must_use]
    pub fn moves_during(&self) -> Option<TimeInterval> {
        let times_s = self.times_s();
        TimeInterval::new(*times_s.first()?, *times_s.last()?)
    }

    /// Whether it keeps all lengths and mirrors nothing, to 1e-6, at every time.
    #[must_use]
    pub fn is_rigid(&self) -> bool {
        self.links().iter().all(|link| link.keeps_scale() && is_rotation(&link.at(0.0).matrix3))
    }

    /// Whether all areas stay what they are over time.
    #[must_use]
    pub fn keeps_areas(&self) -> bool {
        let links = self.links();
        links.iter().all(Track::keeps_scale) && self.outer().iter().all(|link| is_similarity(&link.at(0.0).matrix3))
    }

    fn links(&self) -> &[Track] {
        match &self.0 {
            Links::One(track) => core::slice::from_ref(track),
            Links::Chain(links) => links,
        }
    }

    /// All but the innermost.
    fn outer(&self) -> &[Track] {
        let links = self.links();
        &links[..links.len() - 1]
    }

    /// The times of all keys, s, rising, each once.
    pub(crate) fn times_s(&self) -> Vec<f64> {
        let mut times_s: Vec<f64> = self.links().iter().flat_map(|link| link.times_s()).copied().collect();
        times_s.sort_by(f64::total_cmp);
        times_s.dedup();
        times_s
    }

    fn moving_at(&self, time_s: f64, within_s: f64) -> MovingTransform {
        let still = MovingTransform::still(DAffine3::IDENTITY);
        self.links().iter().fold(still, |outer, link| outer.carrying(&link.moving_at(time_s, within_s)))
    }
}

fn is_rotation(m: &DMat3) -> bool {
    let off = (m.transpose() * *m - DMat3::IDENTITY).to_cols_array();
    off.iter().all(|x| x.abs() <= RIGID) && m.determinant() > 0.0
}

/// Whether it changes all lengths alike.
fn is_similarity(m: &DMat3) -> bool {
    let square = m.x_axis.length_squared();
    let off = (m.transpose() * *m - DMat3::from_diagonal(DVec3::splat(square))).to_cols_array();
    off.iter().all(|x| x.abs() <= RIGID * square)
}
