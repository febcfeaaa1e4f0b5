//! Measured relative illumination: irradiance over that on the axis, by distance from the principal point or by field angle.

use crate::error::OpticsError;
use core::fmt::{self, Debug, Formatter};

/// What a relative illumination goes by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FalloffBy {
    /// The distance from the principal point, mm.
    Radius,
    /// The angle from the axis in front of the lens, degrees.
    Angle,
}

impl FalloffBy {
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Radius => " mm from the principal point",
            Self::Angle => "° from the axis",
        }
    }
}

/// A table, linear between its points; the end value holds beyond.
#[derive(Clone, PartialEq)]
pub struct Falloff {
    by: FalloffBy,
    points: Vec<(f64, f64)>,
}

/// A table by radius has the text (and plans have the hashes) that it had before there were others.
impl Debug for Falloff {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("Falloff");
        if self.by != FalloffBy::Radius {
            text.field("by", &self.by);
        }
        text.field("points", &self.points).finish()
    }
}

impl Falloff {
    /// The table of distances (mm, rising from 0) and ratios (0 or more, from 1).
    ///
    /// # Errors
    /// Where the points are not so.
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, OpticsError> {
        Self::over(FalloffBy::Radius, points)
    }

    /// The table of distances (mm) or angles (degrees), rising from 0, and ratios (0 or more, from 1).
    ///
    /// # Errors
    /// Where the points are not so.
    pub fn over(by: FalloffBy, points: Vec<(f64, f64)>) -> Result<Self, OpticsError> {
        let rising = points.windows(2).all(|pair| pair[1].0 > pair[0].0);
        let legal = points.iter().all(|(r, ratio)| r.is_finite() && ratio.is_finite() && *ratio >= 0.0);
        if points.first() == Some(&(0.0, 1.0)) && rising && legal {
            Ok(Self { by, points })
        } else {
            Err(OpticsError::Falloff)
        }
    }

    /// What it goes by.
    #[must_use]
    pub fn by(&self) -> FalloffBy {
        self.by
    }

    /// Refuses a picture that reaches beyond the table.
    pub(super) fn check(&self, needed: f64) -> Result<(), OpticsError> {
        let end = self.points.last().map_or(0.0, |(r, _)| *r);
        if end >= needed { Ok(()) } else { Err(OpticsError::FalloffEnds { end, needed, unit: self.by.unit() }) }
    }

    /// The ratio at a distance (mm) or an angle (degrees).
    #[must_use]
    pub fn at(&self, field: f64) -> f64 {
        let after = self.points.partition_point(|(r, _)| *r <= field);
        match (self.points.get(after.wrapping_sub(1)), self.points.get(after)) {
            (Some((r0, a)), Some((r1, b))) => a + (b - a) * (field - r0) / (r1 - r0),
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
