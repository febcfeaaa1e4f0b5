//! Plots as SVG: one pair of axes with ranges and ticks, lines, points, error bars, a legend.
//!
//! Ranges follow from the data unless stated. The text of a plot depends only on its data.

mod draw;

use etendue_core::maths::f64::{log10, pow};

pub use draw::svg;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 460.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 44.0;
const BOTTOM: f64 = 60.0;

/// An axis with its range.
struct AxisRange {
    scale: Scale,
    /// In the axis's own measure: numbers, or their logarithms.
    low: f64,
    high: f64,
    step: f64,
}

impl AxisRange {
    /// A range that covers the values, rounded to full tick steps.
    fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
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
        let rounded = |v: f64, round: fn(f64) -> f64| round(v / step) * step;
        let (low, high) = (rounded(low + 1e-9 * step, f64::floor), rounded(high - 1e-9 * step, f64::ceil));
        Self { scale: axis.scale, low, high, step }
    }

    /// Position of a number, 0 to 1; `None` if the axis cannot show it.
    fn place(&self, value: f64) -> Option<f64> {
        let measured = match self.scale {
            Scale::Linear => value,
            Scale::Log if value > 0.0 => log10(value),
            Scale::Log => return None,
        };
        Some((measured - self.low) / (self.high - self.low)).filter(|p| p.is_finite())
    }

    /// Ticks: position and text.
    fn ticks(&self) -> Vec<(f64, String)> {
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

/// Rounds to three digits, so that powers of ten print cleanly.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// As many decimals as a step needs; powers of ten for very large or small numbers.
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

/// Height of a row of the legend, and its distance from the axes and everything drawn.
const ROW: f64 = 18.0;
const MARGIN: f64 = 8.0;

/// Position of the legend.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Legend {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
    is_below: bool,
}

impl Legend {
    /// Below the axis, clear of everything.
    fn below(plot: &Plot) -> Self {
        let named = || plot.series.iter().filter(|s| !s.name.is_empty());
        let longest = named().map(|s| s.name.chars().count()).max().unwrap_or(0);
        let (width, height) = (28.0 + 7.2 * longest as f64, ROW * named().count() as f64 + MARGIN);
        Self { left: LEFT, top: HEIGHT - MARGIN, width, height, is_below: true }
    }

    /// In the first empty corner within the axes; `None` if there is none.
    fn in_a_corner(self, drawn: &[(f64, f64)]) -> Option<Self> {
        let (left, right) = (LEFT + MARGIN, WIDTH - RIGHT - MARGIN - self.width);
        let (top, bottom) = (TOP + MARGIN, HEIGHT - BOTTOM - MARGIN - self.height);
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        let corners = corners.map(|(left, top)| Self { left, top, is_below: false, ..self });
        corners
            .into_iter()
            .find(|corner| right >= left && bottom >= top && !drawn.iter().any(|(x, y)| corner.covers_point(*x, *y)))
    }

    fn covers_point(&self, x: f64, y: f64) -> bool {
        let within = |at: f64, from: f64, size: f64| at > from - MARGIN && at < from + size + MARGIN;
        within(x, self.left, self.width) && within(y, self.top, self.height)
    }
}

/// Mapping of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    Linear,
    /// Logarithmic; numbers that are not positive are left out.
    Log,
}

#[derive(Clone, Debug)]
pub struct Axis {
    /// Label, with its unit.
    pub label: String,
    /// Scale of its numbers.
    pub scale: Scale,
    /// Minimum range.
    pub shows: Vec<f64>,
}

impl Axis {
    /// A linear axis.
    #[must_use]
    pub fn linear(label: &str) -> Self {
        Self { label: label.to_owned(), scale: Scale::Linear, shows: Vec::new() }
    }

    /// A logarithmic axis.
    #[must_use]
    pub fn log(label: &str) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label) }
    }

    /// Extends the range to include these values.
    #[must_use]
    pub fn showing(self, values: &[f64]) -> Self {
        Self { shows: values.to_vec(), ..self }
    }
}

/// Style of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Points joined by a line.
    Line,
    /// A thin dashed line: limits and models.
    Broken,
    /// Dots.
    Points,
}

/// Colours of the palette for series that concern a colour of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// For blue light.
    Blue,
    /// For red light.
    Red,
}

/// A series of points with the half heights of their error bars.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Style.
    pub mark: Mark,
    /// (x, y, half an error bar).
    pub points: Vec<[f64; 3]>,
    /// `None`: the next of the palette.
    pub colour: Option<Colour>,
}

impl Series {
    /// Points (x, y) without error bars.
    pub fn new(name: &str, mark: Mark, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self::with_errors(name, mark, points.into_iter().map(|(x, y)| (x, y, 0.0)))
    }

    /// Points (x, y, half an error bar).
    pub fn with_errors(name: &str, mark: Mark, points: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        Self { name: name.to_owned(), mark, points: points.into_iter().map(<[f64; 3]>::from).collect(), colour: None }
    }

    /// Sets the colour.
    pub fn coloured(self, colour: Colour) -> Self {
        Self { colour: Some(colour), ..self }
    }
}

/// A pair of axes with series.
#[derive(Clone, Debug)]
pub struct Plot {
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Series, drawn in order.
    pub series: Vec<Series>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis, values: [f64; 2]) -> Vec<String> {
        AxisRange::new(axis, values.into_iter()).ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_and_enclose_the_data() {
        assert_eq!(texts(&Axis::linear(""), [0.03, 0.97]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"].map(zero));
        let expected = ["-150", "-100", "-50", "0", "50", "100", "150", "200", "250", "300"];
        assert_eq!(texts(&Axis::linear(""), [-130.0, 260.0]), expected);
        assert_eq!(texts(&Axis::log(""), [0.5, 900.0]), ["0.1", "1", "10", "100", "1000"]);
        // A single value: a range around it.
        let fitted = AxisRange::new(&Axis::linear(""), [5.0].into_iter());
        assert!(fitted.place(5.0).is_some_and(|p| p > 0.0 && p < 1.0));
        assert_eq!(AxisRange::new(&Axis::log(""), [1.0, 10.0].into_iter()).place(0.0), None);
    }

    fn zero(text: &str) -> &str {
        if text == "0.0" { "0" } else { text }
    }
}
