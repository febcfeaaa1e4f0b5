//! A tone curve by points, straight lines between.

use super::ToneError;

/// Points from input 0 to input 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    points: Vec<(f64, f64)>,
}

impl Table {
    /// Inputs (linear) and outputs (encoded); inputs rise from 0 to 1, outputs never fall and lie within 0 … 1.
    ///
    /// # Errors
    /// Where they do not.
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, ToneError> {
        check_order(&points)?;
        let (first, last) = (points[0], points[points.len() - 1]);
        if first.0 != 0.0 || last.0 != 1.0 {
            return Err(ToneError::Range("inputs that begin or end elsewhere"));
        }
        if first.1 < 0.0 || last.1 > 1.0 {
            return Err(ToneError::Range("outputs outside"));
        }
        Ok(Self { points })
    }

    /// Inputs and outputs.
    #[must_use]
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// The output of an input 0 … 1; of a NaN a NaN.
    pub(super) fn at(&self, x: f32) -> f32 {
        along(&self.points, f64::from(x)) as f32
    }

    /// The smallest input of an output; beyond the table's outputs its end.
    pub(super) fn inverse(&self, y: f32) -> f32 {
        let y = f64::from(y);
        match by_output(&self.points, y) {
            (_, None) => 1.0,
            (None, Some(_)) => 0.0,
            (Some((x0, y0)), Some((x1, y1))) => (x0 + (y - y0) * (x1 - x0) / (y1 - y0)) as f32,
        }
    }
}

/// An input and its output.
type Point = (f64, f64);

/// On the straight line between the two points about `x`, or on that of the first or the last two; of a NaN a NaN.
pub(super) fn along(points: &[Point], x: f64) -> f64 {
    let after = points.partition_point(|p| p.0 < x).clamp(1, points.len() - 1);
    let ((x0, y0), (x1, y1)) = (points[after - 1], points[after]);
    y0 + (x - x0) * (y1 - y0) / (x1 - x0)
}

/// The last point whose output is below `y`, and the first whose output is not.
pub(super) fn by_output(points: &[Point], y: f64) -> (Option<Point>, Option<Point>) {
    let after = points.partition_point(|p| p.1 < y);
    (after.checked_sub(1).map(|before| points[before]), points.get(after).copied())
}

/// At least two finite points, inputs rising, outputs not falling.
pub(super) fn check_order(points: &[(f64, f64)]) -> Result<(), ToneError> {
    if points.len() < 2 {
        return Err(ToneError::Short(points.len()));
    }
    if let Some(i) = points.iter().position(|p| !(p.0.is_finite() && p.1.is_finite())) {
        return Err(ToneError::Order(i + 1));
    }
    let fault = points.windows(2).position(|p| p[1].0 <= p[0].0 || p[1].1 < p[0].1);
    fault.map_or(Ok(()), |i| Err(ToneError::Order(i + 2)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_join_the_points() {
        let table = Table::new(vec![(0.0, 0.1), (0.5, 0.5), (0.75, 0.5), (1.0, 0.9)]).expect("legal");
        assert_eq!([0.0, 0.25, 0.6, 1.0].map(|x| table.at(x)), [0.1, 0.3, 0.5, 0.9]);
        // Of a flat piece the darkest; beyond the outputs the ends.
        assert_eq!([0.0, 0.3, 0.5, 1.0].map(|y| table.inverse(y)), [0.0, 0.25, 0.5, 1.0]);
    }

    #[test]
    fn tables_that_are_none_are_refused() {
        assert_eq!(Table::new(vec![(0.0, 0.0)]), Err(ToneError::Short(1)));
        assert_eq!(Table::new(vec![(0.0, 0.0), (0.5, 0.6), (1.0, 0.5)]), Err(ToneError::Order(3)));
        assert_eq!(Table::new(vec![(0.0, 0.0), (0.0, 0.6), (1.0, 1.0)]), Err(ToneError::Order(2)));
        assert_eq!(Table::new(vec![(0.0, 0.0), (f64::NAN, 0.6), (1.0, 1.0)]), Err(ToneError::Order(2)));
        assert!(matches!(Table::new(vec![(0.0, 0.0), (0.9, 1.0)]), Err(ToneError::Range(_))));
        assert!(matches!(Table::new(vec![(0.0, 0.0), (1.0, 1.1)]), Err(ToneError::Range(_))));
    }
}
