//! Simulated time far from zero: whole seconds with a fraction, and the epoch that times within a job are counted from.
//!
//! An f64 of 1.7·10⁹ s (a Unix time) has steps of 0.24 µs, and one of 10¹⁰ s of 1.9 µs. Times of a job are therefore stored as whole seconds and a fraction,
//! and a job that begins far from zero counts its times from a whole second near its beginning.

use std::{fmt, str::FromStr};

/// A point of simulated time or a difference of two: whole seconds and a fraction of a second of the same sign.
///
/// It is ordered by time. Resolution: 10⁻¹⁶ s, whatever the whole seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct ExactTime {
    whole_s: i64,
    /// Above −1 and below 1; 0 or of the sign of `whole_s`.
    fraction_s: f64,
}

impl ExactTime {
    /// The largest distance from zero, s: whole seconds up to it are exact in an f64.
    pub const MAX_S: f64 = 1e15;

    /// Returns the exact time of a number of seconds; `None` if it is not finite or beyond [`ExactTime::MAX_S`].
    #[must_use]
    pub fn from_seconds(seconds: f64) -> Option<Self> {
        let is_legal = seconds.abs() <= Self::MAX_S;
        is_legal.then(|| Self { whole_s: seconds.trunc() as i64, fraction_s: seconds.fract() })
    }

    /// Returns the nearest f64, s; for a time from [`ExactTime::from_seconds`] it is the same number.
    #[must_use]
    pub fn seconds(self) -> f64 {
        self.whole_s as f64 + self.fraction_s
    }

    /// Returns the whole seconds, rounded towards zero.
    #[must_use]
    pub fn whole_s(self) -> i64 {
        self.whole_s
    }

    /// Returns the fraction of a second: 0, or with the sign of the time.
    #[must_use]
    pub fn fraction_s(self) -> f64 {
        self.fraction_s
    }

    /// Returns the time rounded to whole nanoseconds.
    #[must_use]
    pub fn nanoseconds(self) -> i128 {
        i128::from(self.whole_s) * 1_000_000_000 + (self.fraction_s * 1e9).round() as i128
    }

    /// Returns the spacing of f64 values at this time, s: the resolution of [`ExactTime::seconds`].
    #[must_use]
    pub fn step_s(self) -> f64 {
        let seconds = self.seconds().abs();
        seconds.next_up() - seconds
    }

    /// Returns true if a number in a file represents the time exactly.
    #[must_use]
    pub fn is_number(self) -> bool {
        Self::from_seconds(self.seconds()) == Some(self)
    }

    fn new(whole_s: i64, fraction_s: f64) -> Self {
        let carried = fraction_s.trunc();
        let (mut whole_s, mut fraction_s) = (whole_s + carried as i64, fraction_s - carried);
        if whole_s > 0 && fraction_s < 0.0 {
            (whole_s, fraction_s) = (whole_s - 1, fraction_s + 1.0);
        } else if whole_s < 0 && fraction_s > 0.0 {
            (whole_s, fraction_s) = (whole_s + 1, fraction_s - 1.0);
        }
        // The sum with 1 may have been rounded up to 1.
        match fraction_s.abs() < 1.0 {
            true => Self { whole_s, fraction_s },
            false => Self { whole_s: whole_s + fraction_s as i64, fraction_s: 0.0 },
        }
    }
}

impl std::ops::Add for ExactTime {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.whole_s + other.whole_s, self.fraction_s + other.fraction_s)
    }
}

impl std::ops::Sub for ExactTime {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::new(self.whole_s - other.whole_s, self.fraction_s - other.fraction_s)
    }
}

impl From<f64> for ExactTime {
    /// As [`ExactTime::from_seconds`], clamped; 0 for NaN.
    fn from(seconds: f64) -> Self {
        Self::from_seconds(seconds.clamp(-Self::MAX_S, Self::MAX_S)).unwrap_or_default()
    }
}

impl fmt::Display for ExactTime {
    /// Decimal seconds that [`FromStr`] reads back as the same time: `1700000000.0000001`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let fraction = self.fraction_s.abs().to_string();
        let sign = if self.whole_s < 0 || self.fraction_s < 0.0 { "-" } else { "" };
        write!(f, "{sign}{}{}", self.whole_s.unsigned_abs(), fraction.trim_start_matches('0'))
    }
}

/// Error: the text is not a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected a decimal number of seconds from -1e15 to 1e15")]
pub struct ParseTimeError;

impl FromStr for ExactTime {
    type Err = ParseTimeError;

    /// Decimal seconds such as `-12.5`, or with an exponent, which is read as an f64.
    fn from_str(text: &str) -> Result<Self, ParseTimeError> {
        let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
        let (whole_digits, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        let is_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
        if !is_digits(whole_digits)
            || !is_digits(fraction)
            || whole_digits.len() > 15
            || digits.len() == fraction.len() + 1
        {
            let seconds: f64 = text.parse().map_err(|_| ParseTimeError)?;
            return Self::from_seconds(seconds).ok_or(ParseTimeError);
        }
        let whole_s: i64 = whole_digits.parse().map_err(|_| ParseTimeError)?;
        let fraction_s = format!("0.{fraction}0").parse().map_err(|_| ParseTimeError)?;
        let sum = Self::new(whole_s, fraction_s);
        Ok(if text.starts_with('-') { Self::default() - sum } else { sum })
    }
}

/// The whole second of simulated time that all times of a job are counted from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Epoch {
    whole_s: i64,
}

impl Epoch {
    /// Minimum distance from zero of the epoch of a job, s. Below it the spacing of f64 values is at most 1.2·10⁻¹⁰ s.
    const MIN_EPOCH_S: f64 = 1e6;

    /// Returns the epoch of a job that begins at `start`: zero unless `start` is far from zero.
    #[must_use]
    pub fn near(start: ExactTime) -> Self {
        Self { whole_s: if start.seconds().abs() < Self::MIN_EPOCH_S { 0 } else { start.whole_s } }
    }

    /// Returns true if times are counted from zero.
    #[must_use]
    pub fn is_zero(self) -> bool {
        self.whole_s == 0
    }

    /// Returns the seconds from the epoch to `time`.
    #[must_use]
    pub fn to(self, time: ExactTime) -> f64 {
        ExactTime { whole_s: time.whole_s - self.whole_s, ..time }.seconds()
    }

    /// Returns the time that is `since_s` after the epoch.
    #[must_use]
    pub fn time(self, since_s: f64) -> ExactTime {
        ExactTime { whole_s: self.whole_s, fraction_s: 0.0 } + since_s.into()
    }

    /// Returns the epoch as a time.
    #[must_use]
    pub fn start(self) -> ExactTime {
        self.time(0.0)
    }
}

/// Rate or period of a periodic process, whichever is stated exactly: 1/f would be rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cycle {
    /// A period of `count` events, which follow each other at `rate_hz`.
    Events {
        /// Events per second, Hz.
        rate_hz: f64,
        /// Events in a period.
        count: u32,
    },
    /// Period, s.
    Period(f64),
}

impl Cycle {
    /// Returns the cycle of a frequency, Hz.
    #[must_use]
    pub fn from_frequency(frequency_hz: f64) -> Self {
        Self::Events { rate_hz: frequency_hz, count: 1 }
    }

    /// Returns a delay of the same phase, s: the same number if it is near zero, else one less than a period from zero plus its fraction of
    /// a second. The error is below 10⁻⁶ of an event or a period for the stated rate or period.
    #[must_use]
    pub fn reduced_s(self, delay: ExactTime) -> f64 {
        if delay.seconds().abs() < Epoch::MIN_EPOCH_S {
            return delay.seconds();
        }
        let whole_s = match self {
            Self::Events { rate_hz, count } => remaining_events(rate_hz, delay.whole_s, count) / rate_hz,
            // The remainder of f64 is exact.
            Self::Period(period_s) => delay.whole_s as f64 % period_s,
        };
        whole_s + delay.fraction_s
    }
}

/// Returns the remainder of `rate_hz` × `whole_s` after division by `count`, with the sign of `whole_s`. Computed in integers of 2⁻⁷², to
/// which the fraction of the rate is rounded: an error of 2⁻⁷² · 10¹⁵ = 2·10⁻⁷ events at most.
fn remaining_events(rate_hz: f64, whole_s: i64, count: u32) -> f64 {
    const ONE: i128 = 1 << 72;
    let (whole_s, count) = (i128::from(whole_s), i128::from(count));
    let of_whole_hz = rate_hz.trunc() as i128 * whole_s % count * ONE;
    let of_fraction = (rate_hz.fract() * ONE as f64) as i128 * whole_s;
    ((of_whole_hz + of_fraction) % (count * ONE)) as f64 / ONE as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(text: &str) -> ExactTime {
        text.parse().unwrap_or_else(|_| panic!("{text}"))
    }

    #[test]
    fn numbers_are_unchanged_by_conversion() {
        for seconds in [0.0, -0.0, 0.1, -0.25, 1e-300, 12.34, -7.9, 1.7e9, 1e10 + 0.5, -1e15] {
            let exact = ExactTime::from_seconds(seconds).expect("within the range");
            assert_eq!(exact.seconds(), seconds);
            assert_eq!(exact.to_string().parse(), Ok(exact), "{seconds}");
            assert!(exact.is_number());
        }
        for seconds in [f64::NAN, f64::INFINITY, -1.1e15] {
            assert_eq!(ExactTime::from_seconds(seconds), None);
        }
    }

    #[test]
    fn text_keeps_nanoseconds_at_any_distance() {
        assert_eq!(time("1700000000.000000001").nanoseconds(), 1_700_000_000_000_000_001);
        assert_eq!(time("-10000000000.000000001").nanoseconds(), -10_000_000_000_000_000_001);
        assert_eq!(time("1700000000.0000001").to_string(), "1700000000.0000001");
        assert!(!time("1700000000.0000001").is_number());
        assert_eq!(
            [time("5"), time("+.5"), time("-2."), time("1e3")].map(ExactTime::seconds),
            [5.0, 0.5, -2.0, 1000.0]
        );
        for text in ["", ".", "-", "1.2.3", "1_000", "nan", "inf", "1e16", "12:30", "0x10"] {
            assert_eq!(text.parse::<ExactTime>(), Err(ParseTimeError), "{text}");
        }
    }

    #[test]
    fn sums_carry_and_times_are_in_order() {
        assert_eq!((time("1.75") + time("0.5")).to_string(), "2.25");
        assert_eq!((time("1.25") - time("2")).to_string(), "-0.75");
        assert_eq!((time("-1.5") + time("2")).to_string(), "0.5");
        assert_eq!((time("1") + time("-0.00000000000000000001")).seconds(), 1.0);
        let rising = ["-2", "-1.5", "-1.25", "-0.5", "0", "0.25", "1", "1.125"].map(time);
        assert!(rising.array_windows().all(|[a, b]| a < b));
    }

    #[test]
    fn times_near_an_epoch_keep_all_digits() {
        let epoch = Epoch::near(time("1700000000.25"));
        assert_eq!(epoch.to(time("1700000000.0000001")), 1e-7);
        assert_eq!(epoch.time(1e-7).to_string(), "1700000000.0000001");
        assert_eq!(epoch.to(ExactTime::default()), -1.7e9);
        assert!(Epoch::near(time("-999999.5")).is_zero() && !Epoch::near(time("-1e6")).is_zero());
    }

    /// Exact products of integers: 2^k periods of a binary fraction of a hertz, and of 59.94 Hz by rational arithmetic.
    #[test]
    fn phases_hold_at_any_distance() {
        let phase = |frequency_hz: f64, text: &str| {
            (Cycle::from_frequency(frequency_hz).reduced_s(time(text)) * frequency_hz).rem_euclid(1.0)
        };
        for far in ["1700000000", "10000000000", "999999999999999"] {
            assert_eq!(Cycle::from_frequency(1e6).reduced_s(time(far)), 0.0);
            let seconds: i64 = far.parse().expect("digits");
            let eighths = (seconds % 8) as f64 / 8.0;
            // The division by the frequency and the product with it each round by half a step.
            assert!((phase(50.125, far) - eighths).abs() <= f64::EPSILON, "{far}");
            // The f64 nearest to 59.94 is m/2^47.
            let scale = (1_i64 << 47) as f64;
            let m = (59.94 * scale) as i128;
            let exact = ((m * i128::from(seconds)) % (1 << 47)) as f64 / scale;
            assert!((phase(59.94, far) - exact).abs() < 1e-6, "{far}");
        }
        // 25 files a second in a loop of 3; the product is exact in an f64.
        let three = Cycle::Events { rate_hz: 25.0, count: 3 };
        assert_eq!(three.reduced_s(time("1700000001")), (25.0 * 1_700_000_001.0) % 3.0 / 25.0);
        assert_eq!(Cycle::Period(0.25).reduced_s(time("1700000000.125")), 0.125);
        assert_eq!(Cycle::Period(7.0).reduced_s(time("-1700000003")), -2.0);
        assert_eq!(Cycle::Period(0.3).reduced_s(time("10.5")), 10.5);
    }
}
