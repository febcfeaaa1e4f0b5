//! What changes drops over time.

use super::sliding::Sliding;
use super::wiper::Wiper;
use crate::error::front::{FrontError, positive};

/// What changes drops over time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Course {
    /// Simulated time at which the first drops lie on the glass, s; before it they do not change.
    pub start_s: f64,
    /// How they slide; `None` for drops that stay.
    pub sliding: Option<Sliding>,
    /// How long a drop of the greatest radius that falls takes to dry, s; `None` for drops that do not.
    pub drying_s: Option<f64>,
    /// Drops that fall on the rectangle, 1/s; 0 for none.
    pub arrivals_hz: f64,
    /// What wipes them away.
    pub wiper: Option<Wiper>,
}

impl Course {
    pub(super) fn check(&self, greatest_mm: f64) -> Result<(), FrontError> {
        self.sliding.map_or(Ok(()), |sliding| sliding.check(greatest_mm))?;
        self.drying_s.map_or(Ok(1.0), |s| positive("drying_s", s))?;
        self.wiper.map_or(Ok(()), |wiper| wiper.check())?;
        let (value, name) = (self.arrivals_hz, "arrivals_per_s");
        let right = value.is_finite() && value >= 0.0;
        if right { Ok(()) } else { Err(FrontError::Number { name, value, range: "finite and 0 or more" }) }
    }
}
