//! Piecewise-linear levels over time, with jumps: once, or repeated.

use crate::TimeInterval;

/// Segment of `length_s` from one level to another along a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub(super) length_s: f64,
    pub(super) from: f64,
    pub(super) to: f64,
}

impl Piece {
    /// Returns the level at a time since the segment's beginning, within it.
    fn at(&self, time_s: f64) -> f64 {
        // Constant levels are exact.
        if self.from == self.to { self.from } else { self.from + (self.to - self.from) * (time_s / self.length_s) }
    }

    /// Returns the integral from one time since the beginning to another.
    fn integral(&self, from_s: f64, to_s: f64) -> f64 {
        0.5 * (self.at(from_s) + self.at(to_s)) * (to_s - from_s)
    }

    fn max_over(&self, from_s: f64, to_s: f64) -> f64 {
        self.at(from_s).max(self.at(to_s))
    }
}

/// Consecutive segments.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Levels {
    /// Start of the first segment, s; with a period it repeats.
    start_s: f64,
    /// Segments without those of zero length. Without a period the last one holds for ever. Never empty.
    pieces: Vec<Piece>,
    /// Start of each segment, s, counted from `start_s`.
    starts_s: Vec<f64>,
    /// Level × time of all segments before each, s.
    sums_s: Vec<f64>,
    /// `None` if the levels are not repeated.
    period_s: Option<f64>,
}

impl Levels {
    /// Returns the segments of a period, from `start_s` on, repeated.
    pub(super) fn periodic(start_s: f64, pieces: &[Piece], period_s: f64) -> Self {
        Self::new(start_s, pieces, Some(period_s))
    }

    /// Returns segments from `start_s` on, once: the first one's level holds before them, the level `last` after them.
    pub(super) fn one_shot(start_s: f64, pieces: &[Piece], last: f64) -> Self {
        let held = Piece { length_s: f64::INFINITY, from: last, to: last };
        Self::new(start_s, &[pieces, &[held]].concat(), None)
    }

    fn new(start_s: f64, pieces: &[Piece], period_s: Option<f64>) -> Self {
        let pieces: Vec<Piece> = pieces.iter().copied().filter(|piece| piece.length_s > 0.0).collect();
        let (mut starts_s, mut sums_s) = (Vec::new(), Vec::new());
        let (mut time_s, mut sum_s) = (0.0, 0.0);
        for piece in &pieces {
            starts_s.push(time_s);
            sums_s.push(sum_s);
            time_s += piece.length_s;
            sum_s += piece.integral(0.0, piece.length_s);
        }
        Self { start_s, pieces, starts_s, sums_s, period_s }
    }

    /// Returns the segment at a time since the start, and the time since the segment's beginning; before the start the first one's beginning.
    fn find(&self, time_s: f64) -> (usize, f64) {
        let index = self.starts_s.partition_point(|start_s| *start_s <= time_s).saturating_sub(1);
        (index, (time_s - self.starts_s[index]).clamp(0.0, self.pieces[index].length_s))
    }

    /// Time since the start, reduced to a period if there is one.
    fn local(&self, time_s: f64) -> f64 {
        let local_s = time_s - self.start_s;
        // `rem_euclid` may round up to the period.
        self.period_s
            .map_or(local_s, |period_s| Some(local_s.rem_euclid(period_s)).filter(|s| *s < period_s).unwrap_or(0.0))
    }

    pub(super) fn at(&self, time_s: f64) -> f64 {
        let (index, within_s) = self.find(self.local(time_s));
        self.pieces[index].at(within_s)
    }

    pub(super) fn mean(&self, over: TimeInterval) -> f64 {
        let from_s = self.local(over.start_s());
        let to_s = from_s + over.length_s();
        let length_s = to_s - from_s;
        if length_s <= 0.0 {
            return self.at(over.start_s());
        }
        let Some(period_s) = self.period_s.filter(|period_s| to_s > *period_s) else {
            return self.integral(from_s, to_s) / length_s;
        };
        let periods = (to_s / period_s).floor();
        let rest_s = (to_s - periods * period_s).max(0.0);
        let between = (periods - 1.0) * self.integral(0.0, period_s);
        (self.integral(from_s, period_s) + between + self.integral(0.0, rest_s)) / length_s
    }

    /// Level × time between two times since the start, s; must not cross the end of a period.
    fn integral(&self, from_s: f64, to_s: f64) -> f64 {
        // Times before the start occur only without a period.
        let early_s = (to_s.min(0.0) - from_s.min(0.0)).max(0.0);
        early_s * self.pieces[0].from + self.integral_inside(from_s.max(0.0), to_s.max(0.0))
    }

    fn integral_inside(&self, from_s: f64, to_s: f64) -> f64 {
        let ((first, from_s), (last, to_s)) = (self.find(from_s), self.find(to_s));
        if first == last {
            return self.pieces[first].integral(from_s, to_s);
        }
        let rest = self.pieces[first].integral(from_s, self.pieces[first].length_s);
        rest + (self.sums_s[last] - self.sums_s[first + 1]) + self.pieces[last].integral(0.0, to_s)
    }

    pub(super) fn mean_level(&self) -> Option<f64> {
        self.period_s.map(|period_s| self.integral(0.0, period_s) / period_s)
    }

    pub(super) fn period_s(&self) -> Option<f64> {
        self.period_s
    }

    pub(super) fn max_level(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.from.max(piece.to)).fold(0.0, f64::max)
    }

    pub(super) fn max_over(&self, over: TimeInterval) -> f64 {
        let from_s = self.local(over.start_s());
        let to_s = from_s + over.length_s();
        match self.period_s {
            Some(period_s) if over.length_s() >= period_s => self.max_level(),
            Some(period_s) if to_s >= period_s => {
                self.max_inside(from_s, period_s).max(self.max_inside(0.0, to_s - period_s))
            }
            _ => self.max_inside(from_s, to_s),
        }
    }

    fn max_inside(&self, from_s: f64, to_s: f64) -> f64 {
        let ((first, from_s), (last, to_s)) = (self.find(from_s), self.find(to_s));
        if first == last {
            return self.pieces[first].max_over(from_s, to_s);
        }
        let between = self.pieces[first + 1..last].iter().map(|piece| piece.from.max(piece.to)).fold(0.0, f64::max);
        let first = self.pieces[first].max_over(from_s, self.pieces[first].length_s);
        first.max(between).max(self.pieces[last].max_over(0.0, to_s))
    }
}
