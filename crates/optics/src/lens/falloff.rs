//! Measured relative illumination: irradiance over that on the axis, by distance from the principal point.

use crate::error::OpticsError;

/// A table, linear between its points; the end value holds beyond.
#[derive(Clone, Debug, PartialEq)]
pub struct Falloff {
    points: Vec<(f64, f64)>,
}

impl Falloff {
    /// The table of distances (mm, rising from 0) and ratios (0 or more, from 1).
    ///
    /// # Errors
    /// Where the points are not so.
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, OpticsError> {
        let rising = points.windows(2).all(|pair| pair[1].0 > pair[0].0);
        let legal = points.iter().all(|(r, ratio)| r.is_finite() && ratio.is_finite() && *ratio >= 0.0);
        if points.first() == Some(&(0.0, 1.0)) && rising && legal {
            Ok(Self { points })
        } else {
            Err(OpticsError::Falloff)
        }
    }

    /// Refuses a picture that reaches beyond the table.
    pub(super) fn check(&self, needed_mm: f64) -> Result<(), OpticsError> {
        let end_mm = self.points.last().map_or(0.0, |(r, _)| *r);
        if end_mm >= needed_mm { Ok(()) } else { Err(OpticsError::FalloffEnds { end_mm, needed_mm }) }
    }

    /// The ratio at a distance.
    #[must_use]
    pub fn at(&self, radius_mm: f64) -> f64 {
        let after = self.points.partition_point(|(r, _)| *r <= radius_mm);
        match (self.points.get(after.wrapping_sub(1)), self.points.get(after)) {
            (Some((r0, a)), Some((r1, b))) => a + (b - a) * (radius_mm - r0) / (r1 - r0),
            (Some((_, end)), None) => *end,
            (None, _) => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_linear_between_its_points_and_refuses_what_is_no_table() {
        let table = Falloff::new(vec![(0.0, 1.0), (2.0, 0.5), (4.0, 0.4)]).expect("a table");
        for (r, ratio) in [(0.0, 1.0), (1.0, 0.75), (2.0, 0.5), (3.0, 0.45), (4.0, 0.4), (9.0, 0.4)] {
            assert!((table.at(r) - ratio).abs() < 1e-15, "{r}");
        }
        assert!(table.check(4.0).is_ok() && table.check(4.1).is_err());
        for wrong in [vec![], vec![(0.0, 0.9)], vec![(0.0, 1.0), (0.0, 0.5)], vec![(0.0, 1.0), (1.0, -0.1)]] {
            assert!(Falloff::new(wrong).is_err());
        }
    }
}
