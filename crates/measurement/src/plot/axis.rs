//! Ranges and ticks.

use super::figure::{Axis, Scale};
use etendue_core::maths::f64::{log10, pow};

/// An axis with its range.
pub(super) struct Fitted {
    scale: Scale,
    /// In the axis's own measure: numbers, or their logarithms.
    low: f64,
    high: f64,
    step: f64,
}

impl Fitted {
    /// A range that shows the values: to full steps of ticks.
    pub(super) fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let measure = |v: f64| if axis.scale == Scale::Log { log10(v) } else { v };
        let usable = |v: &f64| v.is_finite() && (axis.scale == Scale::Linear || *v > 0.0);
        let (low, high) = values
            .chain(axis.shows.iter().copied())
            .filter(usable)
            .map(measure)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let margin = if low == high { low.abs().max(1.0) * 0.1 } else { 0.0 };
        let (low, high) = (low - margin, high + margin);
        let step = step(axis.scale, high - low);
        let wide = |v: f64, round: fn(f64) -> f64| round(v / step) * step;
        let (low, high) = (wide(low + 1e-9 * step, f64::floor), wide(high - 1e-9 * step, f64::ceil));
        Self { scale: axis.scale, low, high, step }
    }

    /// Where a number lies, 0 to 1; `None` where the axis cannot show it.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        let measured = match self.scale {
            Scale::Linear => value,
            Scale::Log if value > 0.0 => log10(value),
            Scale::Log => return None,
        };
        Some((measured - self.low) / (self.high - self.low)).filter(|p| p.is_finite())
    }

    /// Ticks: place and text.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        let step = self.step;
        let count = ((self.high - self.low) / step + 1e-9).floor() as i64;
        let tick = |i: i64| {
            let measured = self.low + i as f64 * step;
            ((measured - self.low) / (self.high - self.low), self.text(measured, step))
        };
        (0..=count).map(tick).collect()
    }

    fn text(&self, measured: f64, step: f64) -> String {
        match self.scale {
            Scale::Linear => number(measured, step),
            Scale::Log => {
                let value = pow(10.0, measured);
                if (1e-3..1e5).contains(&value) { format!("{}", rounded(value)) } else { format!("{value:.0e}") }
            }
        }
    }
}

/// 1, 2 or 5 times a power of ten, four to ten steps; whole decades on a logarithmic axis.
fn step(scale: Scale, span: f64) -> f64 {
    if scale == Scale::Log {
        return (span / 7.0).ceil().max(1.0);
    }
    let decade = pow(10.0, log10(span / 4.0).floor());
    let fits = |step: &f64| span / step >= 4.0;
    [5.0, 2.0, 1.0].map(|k| k * decade).into_iter().find(fits).unwrap_or(decade)
}

/// Three digits, so that powers of ten look like themselves.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// As many decimals as a step needs; powers of ten for what is very large or small.
fn number(value: f64, step: f64) -> String {
    if value.abs() < 1e-9 * step {
        return "0".to_owned();
    }
    if !(1e-4..1e5).contains(&step) {
        return format!("{}", rounded(value)).parse::<f64>().map_or_else(|_| String::new(), |v| format!("{v:e}"));
    }
    let decimals = (-log10(step) - 1e-9).ceil().max(0.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis, values: [f64; 2]) -> Vec<String> {
        Fitted::new(axis, values.into_iter()).ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_and_enclose_the_data() {
        assert_eq!(texts(&Axis::linear(""), [0.03, 0.97]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"].map(zero));
        let wanted = ["-150", "-100", "-50", "0", "50", "100", "150", "200", "250", "300"];
        assert_eq!(texts(&Axis::linear(""), [-130.0, 260.0]), wanted);
        assert_eq!(texts(&Axis::log(""), [0.5, 900.0]), ["0.1", "1", "10", "100", "1000"]);
        // One value only: a range about it.
        let fitted = Fitted::new(&Axis::linear(""), [5.0].into_iter());
        assert!(fitted.place(5.0).is_some_and(|p| p > 0.0 && p < 1.0));
        assert_eq!(Fitted::new(&Axis::log(""), [1.0, 10.0].into_iter()).place(0.0), None);
    }

    fn zero(text: &str) -> &str {
        if text == "0.0" { "0" } else { text }
    }
}
