//! The tolerance of printed digits.

use etendue_core::maths::f64::pow;

/// Range of numbers with the same printed value, and that value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PrintedRange {
    pub(super) low: f64,
    pub(super) printed: f64,
    pub(super) high: f64,
}

impl PrintedRange {
    /// Range of the numbers that print as `value`: half a unit of its last digit to both sides.
    pub(super) fn printed(value: f64) -> Self {
        let text = format!("{value}");
        let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let half = 0.5 * pow(10.0, -(decimals as f64));
        Self { low: (value - half).max(0.0), printed: value, high: value + half }
    }

    /// Maps the range by an increasing function.
    pub(super) fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        Self { low: f(self.low), printed: f(self.printed), high: f(self.high) }
    }

    /// Maps the range by a decreasing function.
    pub(super) fn falling(self, f: impl Fn(f64) -> f64) -> Self {
        Self { low: f(self.high), printed: f(self.printed), high: f(self.low) }
    }

    /// Combines two ranges by a function that increases in both.
    pub(super) fn with(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self { low: f(self.low, other.low), printed: f(self.printed, other.printed), high: f(self.high, other.high) }
    }

    pub(super) fn times(self, other: Self) -> Self {
        self.with(other, |a, b| a * b)
    }

    pub(super) fn over(self, other: Self) -> Self {
        self.times(other.falling(|x| 1.0 / x))
    }

    /// Returns true if both ranges have a number in common. Rounding of the bounds is no contradiction.
    pub(super) fn meets(self, other: Self) -> bool {
        let tolerance = 1e-9 * self.high.abs().max(other.high.abs());
        self.low <= other.high + tolerance && other.low <= self.high + tolerance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_say_how_far_a_number_may_be_off() {
        let near = |span: PrintedRange, low: f64, high: f64| {
            assert!((span.low - low).abs() < 1e-12 && (span.high - high).abs() < 1e-12, "{span:?}");
        };
        near(PrintedRange::printed(40.1), 40.05, 40.15);
        near(PrintedRange::printed(10_000.0), 9999.5, 10_000.5);
        near(PrintedRange::printed(0.25).falling(|x| 1.0 / x), 1.0 / 0.255, 1.0 / 0.245);
        near(PrintedRange::printed(8.0).over(PrintedRange::printed(2.0)), 7.5 / 2.5, 8.5 / 1.5);
        assert!(
            PrintedRange::printed(1.0).meets(PrintedRange::printed(2.0))
                && !PrintedRange::printed(1.0).meets(PrintedRange::printed(2.1))
        );
    }
}
