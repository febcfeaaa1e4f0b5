//! Vertices that move within their mesh: positions and normals at several times, straight lines between them.
//!
//! A vertex moves from its position at one time to that at the next along a straight line at constant speed. Positions are computed in f64 and
//! rounded to f32, so that a vertex has the same bits for all triangles that share it: closed bodies stay closed. Rounding preserves order, so that a
//! position between two others leaves their box by at most a unit in the last place.

use etendue_core::TimeInterval;
use glam::{DVec3, Vec3};

use super::MeshError;

/// The vertices of a mesh at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexFrame {
    /// Positions, m.
    pub positions: Vec<Vec3>,
    /// Normals of any length above 0: one per vertex, or none.
    pub normals: Vec<Vec3>,
}

/// Behaviour after the last frame and before the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repeat {
    /// The last holds, and the first before its time.
    Hold,
    /// The first again, and so on without end, in both directions of time.
    Loop,
}

/// Vertices over time.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexAnimation {
    frames: Vec<VertexFrame>,
    /// One per frame, rising; for a loop one more, at which the first frame recurs. Simulated time, s.
    times_s: Vec<f64>,
    repeat: Repeat,
}

/// A time between two frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FrameBlend {
    from: u32,
    to: u32,
    /// Weight of the frame `to`, 0 … 1.
    weight: f64,
}

/// Fraction of a loop's period by which times may be rounded across a frame's time.
const ROUNDING: f64 = 1e-9;

impl VertexAnimation {
    /// Frames at rising times, s; for a loop one time more, at which the first frame recurs.
    ///
    /// # Errors
    /// Fewer than two frames, frames of unequal numbers of vertices or normals, and times that are not finite, not rising or not as many as
    /// needed.
    pub fn new(frames: Vec<VertexFrame>, times_s: Vec<f64>, repeat: Repeat) -> Result<Self, MeshError> {
        let needed = frames.len() + usize::from(repeat == Repeat::Loop);
        let rises = times_s.windows(2).all(|pair| pair[0] < pair[1]) && times_s.iter().all(|time_s| time_s.is_finite());
        if frames.len() < 2 || times_s.len() != needed || !rises {
            return Err(MeshError::FrameTimes { frames: frames.len(), times: times_s.len() });
        }
        let counts = |frame: &VertexFrame| [frame.positions.len(), frame.normals.len()];
        let unequal = frames.iter().position(|frame| counts(frame) != counts(&frames[0]));
        match unequal {
            Some(frame) => Err(MeshError::UnequalFrames { frame }),
            None => Ok(Self { frames, times_s, repeat }),
        }
    }

    /// The frames, in the order of their times.
    #[must_use]
    pub fn frames(&self) -> &[VertexFrame] {
        &self.frames
    }

    /// From the first frame to the last, or to the recurrence of the first.
    #[must_use]
    pub fn motion_interval(&self) -> TimeInterval {
        TimeInterval::new(self.times_s[0], self.end_s()).expect("rising times")
    }

    /// True if the vertices are the same at all times.
    #[must_use]
    pub fn is_static(&self) -> bool {
        self.frames.windows(2).all(|pair| pair[0] == pair[1])
    }

    fn end_s(&self) -> f64 {
        self.times_s[self.times_s.len() - 1]
    }

    fn period_s(&self) -> f64 {
        self.end_s() - self.times_s[0]
    }

    /// The span of a simulated time (s).
    pub(crate) fn span(&self, time_s: f64) -> FrameBlend {
        let (start_s, count) = (self.times_s[0], self.frames.len() as u32);
        let time_s = match self.repeat {
            Repeat::Hold => time_s.max(start_s).min(self.end_s()),
            Repeat::Loop => start_s + (time_s - start_s).rem_euclid(self.period_s()),
        };
        let after = self.times_s.partition_point(|t| *t <= time_s).clamp(1, self.times_s.len() - 1);
        let (before_s, after_s) = (self.times_s[after - 1], self.times_s[after]);
        let weight = ((time_s - before_s) / (after_s - before_s)).clamp(0.0, 1.0);
        FrameBlend { from: after as u32 - 1, to: after as u32 % count, weight }
    }

    /// Times between which all vertices move straight, from the interval's start to its end: both and the frames inside, these in no order.
    pub(crate) fn corners_of(&self, interval: TimeInterval) -> Vec<FrameBlend> {
        let mut spans = vec![self.span(interval.start_s()), self.span(interval.end_s())];
        let inside = (0..self.frames.len()).filter(|frame| self.has_frame(interval, *frame));
        spans.extend(inside.map(|frame| FrameBlend { from: frame as u32, to: frame as u32, weight: 0.0 }));
        spans
    }

    /// True if the time of a frame lies in an interval, or so near that rounding may move times across it.
    fn has_frame(&self, interval: TimeInterval, frame: usize) -> bool {
        let room_s = ROUNDING * self.period_s();
        match self.repeat {
            Repeat::Hold => {
                let time_s = self.times_s[frame];
                (interval.start_s() - room_s..=interval.end_s() + room_s).contains(&time_s)
            }
            Repeat::Loop => {
                let later_s = (self.times_s[frame] - interval.start_s()).rem_euclid(self.period_s());
                later_s <= interval.length_s() + room_s || later_s >= self.period_s() - room_s
            }
        }
    }

    /// Its pose during a whole interval; `None` if some vertex moves.
    pub(crate) fn static_span(&self, interval: TimeInterval) -> Option<FrameBlend> {
        let start = self.span(interval.start_s());
        let holds =
            self.repeat == Repeat::Hold && (interval.end_s() <= self.times_s[0] || interval.start_s() >= self.end_s());
        if interval.is_moment() || holds {
            return Some(start);
        }
        let frames = self.corners_of(interval).into_iter().flat_map(|span| [span.from, span.to]);
        let first = &self.frames[start.from as usize];
        frames.into_iter().all(|frame| self.frames[frame as usize] == *first).then_some(start)
    }

    /// A vertex at a time.
    #[inline]
    pub(crate) fn position(&self, span: FrameBlend, vertex: u32) -> Vec3 {
        self.exact_position(span, vertex).as_vec3()
    }

    /// As [`VertexAnimation::position`], not rounded to f32.
    #[inline]
    pub(crate) fn exact_position(&self, span: FrameBlend, vertex: u32) -> DVec3 {
        let place = |frame: u32| self.frames[frame as usize].positions[vertex as usize].as_dvec3();
        between(place(span.from), place(span.to), span.weight)
    }

    /// A vertex's normal at a time, of any length; `None` without normals.
    pub(crate) fn normal(&self, span: FrameBlend, vertex: u32) -> Option<Vec3> {
        let normal = |frame: u32| self.frames[frame as usize].normals.get(vertex as usize).map(|n| n.as_dvec3());
        Some(between(normal(span.from)?, normal(span.to)?, span.weight).as_vec3())
    }
}

#[inline]
fn between(from: DVec3, to: DVec3, weight: f64) -> DVec3 {
    from * (1.0 - weight) + to * weight
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(times_s: &[f64], repeat: Repeat) -> VertexAnimation {
        let frame = |i: usize| VertexFrame { positions: vec![Vec3::X * (i * i) as f32], normals: vec![] };
        let frames = times_s.len() - usize::from(repeat == Repeat::Loop);
        VertexAnimation::new((0..frames).map(frame).collect(), times_s.to_vec(), repeat).expect("legal")
    }

    fn x(animation: &VertexAnimation, time_s: f64) -> f64 {
        animation.exact_position(animation.span(time_s), 0).x
    }

    fn interval(start_s: f64, end_s: f64) -> TimeInterval {
        TimeInterval::new(start_s, end_s).expect("in order")
    }

    #[test]
    fn between_two_frames_vertices_go_straight_and_beyond_they_hold() {
        let held = at(&[1.0, 2.0, 4.0], Repeat::Hold);
        let actual = [-5.0, 1.0, 1.25, 2.0, 3.0, 4.0, 9.0].map(|time_s| x(&held, time_s));
        assert_eq!(actual, [0.0, 0.0, 0.25, 1.0, 2.5, 4.0, 4.0]);
    }

    #[test]
    fn a_loop_goes_back_to_its_first_frame_and_on_in_both_directions() {
        let looped = at(&[1.0, 2.0, 4.0, 5.0], Repeat::Loop);
        let cycle = [1.25, 3.0, 4.0, 4.5, 5.0].map(|time_s| x(&looped, time_s));
        assert_eq!(cycle, [0.25, 2.5, 4.0, 2.0, 0.0]);
        for time_s in [1.25, 3.0, 4.5] {
            for turns in [-3.0, 2.0] {
                assert_eq!(x(&looped, time_s + 4.0 * turns), x(&looped, time_s));
            }
        }
    }

    /// Every time of an interval lies between two of its corner times.
    #[test]
    fn the_corners_of_an_interval_bound_all_its_moments() {
        for animation in [at(&[1.0, 2.0, 4.0], Repeat::Hold), at(&[1.0, 2.0, 4.0, 5.0], Repeat::Loop)] {
            for (start_s, length_s) in
                [(0.0, 0.5), (0.5, 1.0), (1.7, 0.2), (1.7, 0.5), (3.9, 1.3), (-7.3, 2.2), (0.2, 9.0)]
            {
                let interval = interval(start_s, start_s + length_s);
                let ends = animation.corners_of(interval).into_iter().map(|span| animation.exact_position(span, 0).x);
                let (low, high) = ends.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
                for i in 0..=100 {
                    let x = x(&animation, start_s + length_s * f64::from(i) / 100.0);
                    assert!(low - 1e-12 <= x && x <= high + 1e-12, "{interval:?}: {x} in {low} … {high}");
                }
            }
        }
    }

    #[test]
    fn nothing_moves_at_a_moment_beyond_the_ends_and_between_equal_frames() {
        let held = at(&[1.0, 2.0, 4.0], Repeat::Hold);
        assert!(held.static_span(interval(-1.0, 1.0)).is_some() && held.static_span(interval(4.0, 6.0)).is_some());
        assert!(held.static_span(interval(1.5, 1.5)).is_some() && held.static_span(interval(0.5, 1.1)).is_none());
        let same = vec![held.frames[0].clone(); 2];
        let parked = VertexAnimation::new(same, vec![0.0, 1.0], Repeat::Hold).expect("legal");
        assert!(parked.static_span(interval(0.2, 0.7)).is_some() && parked.is_static());
    }

    #[test]
    fn frames_that_do_not_agree_are_refused() {
        let frame = |count| VertexFrame { positions: vec![Vec3::ZERO; count], normals: vec![] };
        let new = |counts: &[usize], times_s: &[f64]| {
            VertexAnimation::new(counts.iter().map(|n| frame(*n)).collect(), times_s.to_vec(), Repeat::Hold)
        };
        assert_eq!(new(&[3, 3, 4], &[0.0, 1.0, 2.0]), Err(MeshError::UnequalFrames { frame: 2 }));
        assert_eq!(new(&[3, 3], &[0.0, 0.0]), Err(MeshError::FrameTimes { frames: 2, times: 2 }));
        assert_eq!(new(&[3, 3], &[0.0, 1.0, 2.0]), Err(MeshError::FrameTimes { frames: 2, times: 3 }));
        assert_eq!(new(&[3], &[0.0]), Err(MeshError::FrameTimes { frames: 1, times: 1 }));
    }
}
