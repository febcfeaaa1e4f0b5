//! Modulation of a light over time: a factor on its strength, with exact means over any interval.
//!
//! Times of a periodic waveform are first reduced to the period, so after 10⁶ s the phase is still accurate to 10⁻¹⁰ s, the resolution of f64.

mod levels;
#[cfg(test)]
mod tests;

use core::f64::consts::{PI, TAU};

use crate::maths::f64::{cos, sin};
use crate::{Cycle, ExactTime, TimeInterval};
use levels::{Levels, Piece};

/// Maximum level of a waveform.
pub const MAX_LEVEL: f64 = 1e6;

/// Factor on a light's strength over time, 0 … [`MAX_LEVEL`].
#[derive(Clone, Debug, PartialEq)]
pub struct Waveform {
    shape: WaveformShape,
    /// Frequency or period; `None` if the waveform is not periodic.
    cycle: Option<Cycle>,
    /// Delay of the whole waveform, s.
    delay_s: f64,
}

#[derive(Clone, Debug, PartialEq)]
enum WaveformShape {
    Mains(Mains),
    Levels(Levels),
}

/// Periodic pulses: pulse-width modulation, or a blinker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulses {
    /// Pulse frequency, Hz, above 0.
    pub frequency_hz: f64,
    /// Duty cycle: fraction of the period between the half heights of a pulse (the pulse duration of IEEE Std 181), above 0 and below 1. It is the mean over
    /// the peak, whatever the edges.
    pub duty: f64,
    /// Rise and fall time of a pulse, s, 0 or more. The edges are straight lines; half of each lies within the pulse. Half of both together must fit into the
    /// pulse and into the pause.
    pub edges_s: [f64; 2],
    /// Level of a pulse, above 0.
    pub peak: f64,
}

/// Interpolation of a table between its rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TableInterpolation {
    /// Along straight lines.
    #[default]
    Linear,
    /// Each level holds until the next row.
    Steps,
}

/// Reason for which a waveform is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WaveformError {
    /// The frequency is not above 0, or not finite.
    #[error("found a frequency of {frequency_hz} Hz; give one above 0")]
    Frequency { frequency_hz: f64 },
    /// The duty is outside (0, 1).
    #[error("found a duty of {duty}; give one above 0 and below 1")]
    Duty { duty: f64 },
    /// The edges do not fit.
    #[error(
        "half of the rise time plus half of the fall time is {edges_s} s, more than the shorter of pulse and pause, \
         {room_s} s; make the edges faster"
    )]
    Edges {
        /// Half of both, s.
        edges_s: f64,
        /// The shorter one of pulse and pause, s.
        room_s: f64,
    },
    /// The modulation depth is outside [0, 1].
    #[error("found a modulation depth of {depth}; give one from 0 to 1")]
    Depth { depth: f64 },
    /// A level is negative, too large or not finite.
    #[error("found the level {level}; give one from 0 to 1e6")]
    Level { level: f64 },
    /// All levels are 0.
    #[error("the light is dark at all times; give at least one level above 0")]
    Dark,
    /// There are no levels.
    #[error("there are no levels; give at least one")]
    Empty,
    /// Times are out of order, or not finite.
    #[error("the time {time_s} s follows {before_s} s; give the times in increasing order")]
    Unordered {
        /// Time of the later row, s.
        time_s: f64,
        /// Time before it, s.
        before_s: f64,
    },
    /// A duration is not above 0, or not finite.
    #[error("found a duration of {duration_s} s; give one above 0")]
    Duration { duration_s: f64 },
    /// The table does not fit into the period.
    #[error(
        "the table lasts {length_s} s, but its period is {period_s} s; the period must be longer with steps, else at least as long"
    )]
    Period {
        /// Length from the table's first time to its last, s.
        length_s: f64,
        period_s: f64,
    },
}

impl Waveform {
    /// Returns pulses; the first one is at half height at the time 0.
    ///
    /// # Errors
    /// If a number is out of its range.
    pub fn pulses(pulses: &Pulses) -> Result<Self, WaveformError> {
        let Pulses { frequency_hz, duty, edges_s: [rise_s, fall_s], peak } = *pulses;
        let period_s = period_of(frequency_hz)?;
        if !(duty > 0.0 && duty < 1.0) {
            return Err(WaveformError::Duty { duty });
        }
        if !(peak > 0.0 && peak <= MAX_LEVEL) {
            return Err(WaveformError::Level { level: peak });
        }
        let (pulse_s, pause_s) = (duty * period_s, (1.0 - duty) * period_s);
        let (edges_s, room_s) = (0.5 * (rise_s + fall_s), pulse_s.min(pause_s));
        // Written so that NaN is refused.
        if !(rise_s >= 0.0 && fall_s >= 0.0 && edges_s <= room_s * (1.0 + 1e-12)) {
            return Err(WaveformError::Edges { edges_s, room_s });
        }
        // From half a rise before 0: rise, plateau, fall, pause.
        let (plateau_s, dark_s) = ((pulse_s - edges_s).max(0.0), (pause_s - edges_s).max(0.0));
        let pieces = [
            Piece { length_s: rise_s, from: 0.0, to: peak },
            Piece { length_s: plateau_s, from: peak, to: peak },
            Piece { length_s: fall_s, from: peak, to: 0.0 },
            Piece { length_s: dark_s, from: 0.0, to: 0.0 },
        ];
        let levels = Levels::periodic(-0.5 * rise_s, &pieces, period_s);
        Ok(Self { cycle: Some(Cycle::from_frequency(frequency_hz)), ..Self::from_levels(levels) })
    }

    /// Returns the modulation of a lamp on mains of `frequency_hz`: 1 + m cos(2π · 2f t), with the modulation `depth` m, 0 … 1. It is brightest at the time 0
    /// and twice per period of the mains. Its mean is 1. Harmonics are not included: use a table.
    ///
    /// # Errors
    /// If a number is out of its range.
    pub fn mains(frequency_hz: f64, depth: f64) -> Result<Self, WaveformError> {
        period_of(frequency_hz)?;
        if !(0.0..=1.0).contains(&depth) {
            return Err(WaveformError::Depth { depth });
        }
        let cycle = Some(Cycle::from_frequency(2.0 * frequency_hz));
        Ok(Self { shape: WaveformShape::Mains(Mains { frequency_hz, depth }), cycle, delay_s: 0.0 })
    }

    /// Returns a table of levels at increasing times (s). Without `period_s` the first level holds before and the last after them. With it the table repeats:
    /// the last row is followed by the first one a period later.
    ///
    /// # Errors
    /// If rows are out of order, a level is out of its range or all are 0, or the period is too short.
    pub fn table(
        rows: &[(f64, f64)],
        between: TableInterpolation,
        period_s: Option<f64>,
    ) -> Result<Self, WaveformError> {
        check_levels(rows.iter().map(|(_, level)| *level))?;
        let (first, last) = (rows[0], rows[rows.len() - 1]);
        if let Some([before, after]) = rows.array_windows().find(|[a, b]| !(a.0 < b.0 && b.0.is_finite())) {
            return Err(WaveformError::Unordered { time_s: after.0, before_s: before.0 });
        }
        if !first.0.is_finite() {
            return Err(WaveformError::Unordered { time_s: first.0, before_s: first.0 });
        }
        let piece = |[a, b]: &[(f64, f64); 2]| {
            let to = if between == TableInterpolation::Linear { b.1 } else { a.1 };
            Piece { length_s: b.0 - a.0, from: a.1, to }
        };
        let mut pieces: Vec<Piece> = rows.array_windows().map(piece).collect();
        let Some(period_s) = period_s else { return Ok(Self::from_levels(Levels::one_shot(first.0, &pieces, last.1))) };
        let length_s = last.0 - first.0;
        let fits = if between == TableInterpolation::Linear { period_s >= length_s } else { period_s > length_s };
        if !(fits && period_s > 0.0 && period_s.is_finite()) {
            return Err(WaveformError::Period { length_s, period_s });
        }
        let to = if between == TableInterpolation::Linear { first.1 } else { last.1 };
        pieces.push(Piece { length_s: period_s - length_s, from: last.1, to });
        Ok(Self::from_levels(Levels::periodic(first.0, &pieces, period_s)))
    }

    /// Returns levels that hold for their durations (s), one after the other from the time 0 on: repeated, or once, with the first held before it and the last
    /// after it.
    ///
    /// # Errors
    /// If a duration or a level is out of its range, or all levels are 0.
    pub fn programme(steps: &[(f64, f64)], repeats: bool) -> Result<Self, WaveformError> {
        check_levels(steps.iter().map(|(_, level)| *level))?;
        if let Some((duration_s, _)) = steps.iter().find(|(s, _)| !(*s > 0.0 && s.is_finite())) {
            return Err(WaveformError::Duration { duration_s: *duration_s });
        }
        let piece = |(length_s, level): &(f64, f64)| Piece { length_s: *length_s, from: *level, to: *level };
        let pieces: Vec<Piece> = steps.iter().map(piece).collect();
        let period_s = pieces.iter().map(|piece| piece.length_s).sum();
        let last = steps[steps.len() - 1].1;
        Ok(Self::from_levels(match repeats {
            true => Levels::periodic(0.0, &pieces, period_s),
            false => Levels::one_shot(0.0, &pieces, last),
        }))
    }

    fn from_levels(levels: Levels) -> Self {
        let cycle = levels.period_s().map(Cycle::Period);
        Self { shape: WaveformShape::Levels(levels), cycle, delay_s: 0.0 }
    }

    /// Returns the waveform later by `delay_s`, which is finite.
    #[must_use]
    pub fn later(self, delay_s: f64) -> Self {
        Self { delay_s: self.delay_s + delay_s, ..self }
    }

    /// Returns the waveform delayed by a time that may be far from zero; a periodic one keeps its phase as in [`Cycle::reduced_s`].
    #[must_use]
    pub fn delay_by(self, delay: ExactTime) -> Self {
        let delay_s = self.cycle.map_or_else(|| delay.seconds(), |cycle| cycle.reduced_s(delay));
        self.later(delay_s)
    }

    /// Returns the level at a simulated time, s; at a jump the level after it.
    #[must_use]
    pub fn at(&self, time_s: f64) -> f64 {
        let time_s = time_s - self.delay_s;
        match &self.shape {
            WaveformShape::Mains(mains) => mains.at(time_s),
            WaveformShape::Levels(levels) => levels.at(time_s),
        }
    }

    /// Returns the mean level over an interval; at a single moment that of [`Waveform::at`].
    #[must_use]
    pub fn mean(&self, over: TimeInterval) -> f64 {
        let over = over.later(-self.delay_s);
        match &self.shape {
            WaveformShape::Mains(mains) => mains.mean(over),
            WaveformShape::Levels(levels) => levels.mean(over),
        }
    }

    /// Returns the mean over all times; `None` if the waveform is not periodic.
    #[must_use]
    pub fn mean_level(&self) -> Option<f64> {
        match &self.shape {
            WaveformShape::Mains(_) => Some(1.0),
            WaveformShape::Levels(levels) => levels.mean_level(),
        }
    }

    /// Returns the maximum level within an interval, its ends included; 0 only if the light is dark throughout.
    #[must_use]
    pub fn max_over(&self, over: TimeInterval) -> f64 {
        let over = over.later(-self.delay_s);
        match &self.shape {
            WaveformShape::Mains(mains) => mains.max_over(over),
            WaveformShape::Levels(levels) => levels.max_over(over),
        }
    }

    /// Returns the maximum level at any time.
    #[must_use]
    pub fn max_level(&self) -> f64 {
        match &self.shape {
            WaveformShape::Mains(mains) => 1.0 + mains.depth,
            WaveformShape::Levels(levels) => levels.max_level(),
        }
    }

    /// Returns the period, s; `None` if the waveform is not periodic.
    #[must_use]
    pub fn period_s(&self) -> Option<f64> {
        match &self.shape {
            WaveformShape::Mains(mains) => Some(0.5 / mains.frequency_hz),
            WaveformShape::Levels(levels) => levels.period_s(),
        }
    }
}

fn period_of(frequency_hz: f64) -> Result<f64, WaveformError> {
    let period_s = 1.0 / frequency_hz;
    let legal = frequency_hz > 0.0 && frequency_hz.is_finite() && period_s.is_finite();
    if legal { Ok(period_s) } else { Err(WaveformError::Frequency { frequency_hz }) }
}

fn check_levels(levels: impl Iterator<Item = f64> + Clone) -> Result<(), WaveformError> {
    if let Some(level) = levels.clone().find(|level| !(0.0..=MAX_LEVEL).contains(level)) {
        return Err(WaveformError::Level { level });
    }
    match levels.reduce(f64::max) {
        None => Err(WaveformError::Empty),
        Some(0.0) => Err(WaveformError::Dark),
        Some(_) => Ok(()),
    }
}

/// 1 + m cos(2π · 2f t).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mains {
    /// Frequency of the mains, Hz.
    frequency_hz: f64,
    /// Depth of modulation m, 0 … 1.
    depth: f64,
}

impl Mains {
    /// Periods of the modulation (2f) since the time 0.
    fn periods(&self, time_s: f64) -> f64 {
        2.0 * self.frequency_hz * time_s
    }

    fn at(&self, time_s: f64) -> f64 {
        let periods = self.periods(time_s);
        1.0 + self.depth * cos(TAU * (periods - periods.round()))
    }

    /// Cosine at the middle of the interval, attenuated by its length n in periods: sin(πn)/(πn).
    fn mean(&self, over: TimeInterval) -> f64 {
        let length = self.periods(over.length_s());
        let rest = length - length.round();
        // sin(πn) = (−1)^round(n) sin(π(n − round(n))).
        let sign = if length.round() % 2.0 == 0.0 { 1.0 } else { -1.0 };
        let left = if length > 0.0 { sign * sin(PI * rest) / (PI * length) } else { 1.0 };
        1.0 + left * (self.at(over.middle_s()) - 1.0)
    }

    fn max_over(&self, over: TimeInterval) -> f64 {
        let [start, end] = [over.start_s(), over.end_s()].map(|time_s| self.periods(time_s));
        if start.ceil() <= end { 1.0 + self.depth } else { self.at(over.start_s()).max(self.at(over.end_s())) }
    }
}
