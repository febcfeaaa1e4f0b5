//! The light of a lamp on alternating current.

use crate::TimeInterval;
use crate::maths::f64::{cos, sin};
use core::f64::consts::{PI, TAU};

/// 1 + m cos(2π · 2f t).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mains {
    /// Of the mains, Hz.
    pub(super) frequency_hz: f64,
    /// Depth of modulation m, 0 … 1.
    pub(super) depth: f64,
}

impl Mains {
    /// Periods of the light since the time 0.
    fn periods(&self, time_s: f64) -> f64 {
        2.0 * self.frequency_hz * time_s
    }

    pub(super) fn at(&self, time_s: f64) -> f64 {
        let periods = self.periods(time_s);
        1.0 + self.depth * cos(TAU * (periods - periods.round()))
    }

    /// The cosine at the middle of the interval, as far as its length n in periods leaves it: sin(πn)/(πn).
    pub(super) fn mean(&self, over: TimeInterval) -> f64 {
        let length = self.periods(over.length_s());
        let rest = length - length.round();
        // sin(πn) = (−1)^round(n) sin(π(n − round(n))).
        let sign = if length.round() % 2.0 == 0.0 { 1.0 } else { -1.0 };
        let left = if length > 0.0 { sign * sin(PI * rest) / (PI * length) } else { 1.0 };
        1.0 + left * (self.at(over.middle_s()) - 1.0)
    }

    pub(super) fn greatest(&self, over: TimeInterval) -> f64 {
        let [start, end] = [over.start_s(), over.end_s()].map(|time_s| self.periods(time_s));
        if start.ceil() <= end { 1.0 + self.depth } else { self.at(over.start_s()).max(self.at(over.end_s())) }
    }
}
