//! Tables of points: reading, checking, and resampling on the grid of 1 nm.

use etendue_core::wavelength::{MAX_NM, MIN_NM};

/// Meaning of a table beyond its first and last wavelength.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extrapolation {
    /// Zero: for emissions and sensitivities.
    Zero,
    /// The end value: for reflectances, transmittances and refractive indices.
    Hold,
}

/// Location of an error in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TablePlace {
    /// A point, counted from 0.
    Point(usize),
    /// A line of a text, counted from 1.
    Line(usize),
}

impl core::fmt::Display for TablePlace {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Point(i) => write!(f, "point {i}"),
            Self::Line(i) => write!(f, "line {i}"),
        }
    }
}

/// Error of a table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpectrumError {
    /// A line without the expected numbers.
    #[error(
        "line {line}: found `{text}`, expected {columns} numbers separated by commas, the first a wavelength in nm"
    )]
    Malformed {
        /// The line, counted from 1.
        line: usize,
        /// The line's text.
        text: String,
        /// Expected count of numbers.
        columns: usize,
    },
    /// No points.
    #[error("the table has no points: give a value at the shortest and the longest wavelength")]
    Empty,
    /// A single point in a table that is zero outside: it has no width.
    #[error(
        "the table has one point, {nm} nm, and light and sensitivities are zero outside of their tables: give a value at the shortest \
         and the longest wavelength"
    )]
    NoWidth {
        /// The point's wavelength, nm.
        nm: f64,
    },
    /// A number is infinite or not a number.
    #[error("{place}: a wavelength or value is not finite: give finite numbers")]
    NotFinite {
        /// Location.
        place: TablePlace,
    },
    /// A wavelength is not longer than the one before.
    #[error("{place}: wavelength {nm} nm follows {before} nm: sort the table by increasing wavelength, each once")]
    NotRising {
        /// Location.
        place: TablePlace,
        /// The wavelength there, nm.
        nm: f64,
        /// The wavelength before, nm.
        before: f64,
    },
    /// The table does not reach into the legal range.
    #[error(
        "the table covers {low} to {high} nm, which does not overlap 300 to 1100 nm: give wavelengths in nanometres"
    )]
    OutOfRange {
        /// First wavelength, nm.
        low: f64,
        /// Last wavelength, nm.
        high: f64,
    },
}

/// Checks that there are enough points for the outside rule: a single one is a constant, or no spectrum at all.
pub(crate) fn check_width(points: &[(f64, f64)], outside: Extrapolation) -> Result<(), SpectrumError> {
    match (points, outside) {
        ([(nm, _)], Extrapolation::Zero) => Err(SpectrumError::NoWidth { nm: *nm }),
        _ => Ok(()),
    }
}

/// Checks that points form a spectrum; `place` names a point by its index.
pub(crate) fn check(points: &[(f64, f64)], place: impl Fn(usize) -> TablePlace) -> Result<(), SpectrumError> {
    if let Some(i) = points.iter().position(|(nm, v)| !nm.is_finite() || !(*v as f32).is_finite()) {
        return Err(SpectrumError::NotFinite { place: place(i) });
    }
    if let Some(i) = points.windows(2).position(|w| w[1].0 <= w[0].0) {
        return Err(SpectrumError::NotRising { place: place(i + 1), nm: points[i + 1].0, before: points[i].0 });
    }
    let (Some((low, _)), Some((high, _))) = (points.first().copied(), points.last().copied()) else {
        return Err(SpectrumError::Empty);
    };
    if low <= MAX_NM && high >= MIN_NM { Ok(()) } else { Err(SpectrumError::OutOfRange { low, high }) }
}

/// The checked points of a text of two columns.
pub(crate) fn points(text: &str) -> Result<Vec<(f64, f64)>, SpectrumError> {
    let rows = rows::<2>(text)?;
    let points: Vec<_> = rows.iter().map(|(_, [nm, value])| (*nm, *value)).collect();
    check(&points, |i| TablePlace::Line(rows[i].0))?;
    Ok(points)
}

/// A row: its line, counted from 1, and its numbers.
pub(crate) type TableRow<const C: usize> = (usize, [f64; C]);

/// The rows of a text of `C` columns: numbers separated by commas. Empty lines and `#` comments are skipped; a first line without any number is a
/// header.
pub(crate) fn rows<const C: usize>(text: &str) -> Result<Vec<TableRow<C>>, SpectrumError> {
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate().map(|(i, line)| (i + 1, content(line)));
    let mut lines = lines.filter(|(_, line)| !line.is_empty()).peekable();
    lines.next_if(|(_, line)| is_header(line));
    lines.map(|(line, text)| Ok((line, numbers(line, text)?))).collect()
}

/// A line without its comment and outer spaces.
fn content(line: &str) -> &str {
    line.split('#').next().unwrap_or("").trim()
}

fn is_header(line: &str) -> bool {
    line.split(',').all(|field| field.trim().parse::<f64>().is_err())
}

fn numbers<const C: usize>(line: usize, text: &str) -> Result<[f64; C], SpectrumError> {
    let parsed: Option<Vec<f64>> = text.split(',').map(|field| field.trim().parse().ok()).collect();
    let array = parsed.and_then(|values| values.try_into().ok());
    array.ok_or_else(|| SpectrumError::Malformed { line, text: text.to_owned(), columns: C })
}

/// A node's value: the piecewise linear function itself or, if a table point lies closer than 1 nm, the mean of the function with a triangular weight
/// that falls to zero at the neighbouring nodes.
pub(crate) fn node_value(points: &[(f64, f64)], outside: Extrapolation, nm: f64) -> f64 {
    let inner = &points[points.partition_point(|p| p.0 <= nm - 1.0)..points.partition_point(|p| p.0 < nm + 1.0)];
    if inner.iter().all(|p| p.0 == nm) {
        return line_at(points, outside, nm);
    }
    let knots = core::iter::once(nm - 1.0).chain(knots_between(inner, nm)).chain([nm + 1.0]);
    let knots: Vec<f64> = knots.collect();
    knots.windows(2).map(|w| hat_integral(points, outside, nm, w[0], w[1])).sum()
}

/// The wavelengths of `inner` with `nm` among them, in order.
fn knots_between(inner: &[(f64, f64)], nm: f64) -> impl Iterator<Item = f64> {
    let (below, above) = inner.split_at(inner.partition_point(|p| p.0 < nm));
    let above = above.iter().filter(move |p| p.0 != nm);
    below.iter().map(|p| p.0).chain([nm]).chain(above.map(|p| p.0))
}

/// Integral of the piecewise linear function times the triangular weight about `nm`, between two neighbouring knots: a parabola, so Simpson's rule is
/// exact.
fn hat_integral(points: &[(f64, f64)], outside: Extrapolation, nm: f64, low: f64, high: f64) -> f64 {
    let middle = (low + high) / 2.0;
    let value = line_at(points, outside, middle);
    let (a, b) = (side_limit(points, outside, low, middle, value), side_limit(points, outside, high, middle, value));
    let hat = |x: f64| 1.0 - (x - nm).abs();
    (high - low) / 6.0 * (a * hat(low) + 4.0 * value * hat(middle) + b * hat(high))
}

/// The one-sided limit of the piecewise linear function at a knot from the side of `inside`, where its value is `value`: the function may jump at the
/// table's ends.
fn side_limit(points: &[(f64, f64)], outside: Extrapolation, knot: f64, inside: f64, value: f64) -> f64 {
    let (first, last) = (points[0].0, points[points.len() - 1].0);
    if inside < first || inside > last { value } else { line_at(points, outside, knot) }
}

/// The piecewise linear function at a wavelength.
fn line_at(points: &[(f64, f64)], outside: Extrapolation, nm: f64) -> f64 {
    let (first, last) = (points[0], points[points.len() - 1]);
    let end = |value: f64| if outside == Extrapolation::Zero { 0.0 } else { value };
    if nm < first.0 {
        return end(first.1);
    }
    let above = points.partition_point(|p| p.0 <= nm);
    if above == points.len() {
        return if nm == last.0 { last.1 } else { end(last.1) };
    }
    let ((x0, y0), (x1, y1)) = (points[above - 1], points[above]);
    y0 + (nm - x0) / (x1 - x0) * (y1 - y0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Spectrum;

    fn error(text: &str) -> String {
        Spectrum::from_csv(text, Extrapolation::Zero).expect_err("a fault").to_string()
    }

    #[test]
    fn a_table_with_and_without_header_comments_and_line_ends() {
        let plain = Spectrum::from_csv("400,1\n500,2\n", Extrapolation::Hold).expect("a table");
        let text = "\u{feff}# measured\r\nwavelength_nm , value\r\n\r\n 400, 1 # first\r\n500 ,2.0e0";
        assert_eq!(Spectrum::from_csv(text, Extrapolation::Hold).expect("a table"), plain);
    }

    #[test]
    fn faults_are_named_with_their_line() {
        assert!(error("nm,v\n400,1\n450;2\n").starts_with("line 3: found `450;2`, expected 2 numbers"));
        assert!(error("400,1\n450,2,3\n").starts_with("line 2: found `450,2,3`"));
        assert!(error("400,1\nnm,v\n").starts_with("line 2: found `nm,v`"), "a header comes first only");
        assert!(error("400,1\n\n450,nan\n").starts_with("line 3: a wavelength or value is not finite"));
        assert!(error("400,1\n450,1e39\n").starts_with("line 2:"), "too large for storage");
        assert!(error("400,1\n400,2\n").starts_with("line 2: wavelength 400 nm follows 400 nm"));
        assert!(error("").starts_with("the table has no points"));
        assert!(error("0.4,1\n0.7,1\n").contains("does not overlap 300 to 1100 nm"));
        let points = [(400.0, 1.0), (300.0, 1.0)];
        let message = Spectrum::from_points(&points, Extrapolation::Zero).expect_err("a fault").to_string();
        assert!(message.starts_with("point 1: wavelength 300 nm follows 400 nm"));
    }

    #[test]
    fn one_point_is_a_constant_where_ends_are_held_and_has_no_width_where_they_are_zero() {
        let held = Spectrum::from_csv("550.5,0.3\n", Extrapolation::Hold).expect("a constant");
        assert_eq!([300.0, 550.0, 1100.0].map(|nm| held.at(nm)), [0.3; 3]);
        let error = Spectrum::from_csv("550.5,0.3\n", Extrapolation::Zero).expect_err("no width").to_string();
        assert!(error.starts_with("the table has one point, 550.5 nm, and light"), "{error}");
        assert_eq!(
            Spectrum::from_points(&[(550.5, 0.3)], Extrapolation::Zero),
            Err(SpectrumError::NoWidth { nm: 550.5 })
        );
    }

    #[test]
    fn tables_that_reach_beyond_the_range_are_cut_to_it() {
        let wide = Spectrum::from_csv("200,0\n1200,10\n", Extrapolation::Zero).expect("a table");
        assert!((wide.at(300.0) - 1.0).abs() < 1e-6 && (wide.at(1100.0) - 9.0).abs() < 1e-6);
        assert_eq!(wide.covered_nm(), (300.0, 1100.0));
    }
}
