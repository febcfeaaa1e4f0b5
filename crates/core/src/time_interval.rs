//! Intervals of simulated time.

/// Closed interval of simulated time: of a shutter, of an exposure, of a frame. The default is the single moment 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimeInterval {
    start_s: f64,
    end_s: f64,
}

impl TimeInterval {
    /// Returns the interval from `start_s` to `end_s`, s; `None` if one is not finite or the end lies before the start.
    #[must_use]
    pub fn new(start_s: f64, end_s: f64) -> Option<Self> {
        let is_legal = start_s.is_finite() && end_s.is_finite() && start_s <= end_s;
        is_legal.then_some(Self { start_s, end_s })
    }

    /// Returns a single moment, s; `None` if it is not finite.
    #[must_use]
    pub fn at(time_s: f64) -> Option<Self> {
        Self::new(time_s, time_s)
    }

    #[must_use]
    pub fn start_s(&self) -> f64 {
        self.start_s
    }

    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.end_s
    }

    /// Length, s; 0 for a single moment.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        self.end_s - self.start_s
    }

    /// Midpoint, s.
    #[must_use]
    pub fn middle_s(&self) -> f64 {
        self.start_s + 0.5 * self.length_s()
    }

    /// Returns the same interval later by `delay_s`, which is finite.
    #[must_use]
    pub fn later(&self, delay_s: f64) -> Self {
        Self { start_s: self.start_s + delay_s, end_s: self.end_s + delay_s }
    }

    /// Returns the smallest interval that holds both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { start_s: self.start_s.min(other.start_s), end_s: self.end_s.max(other.end_s) }
    }

    /// Returns true if it is a single moment.
    #[must_use]
    pub fn is_moment(&self) -> bool {
        self.start_s == self.end_s
    }

    /// Returns the simulated time, s, of a ray's [`crate::Ray::time_s`], which counts from the interval's start. Times outside are clamped to the interval; NaN
    /// gives the start.
    #[must_use]
    pub fn moment(&self, time_s: f32) -> f64 {
        (self.start_s + f64::from(time_s)).max(self.start_s).min(self.end_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_has_finite_ends_in_order() {
        assert!(TimeInterval::new(1.0, 0.999).is_none() && TimeInterval::new(f64::NAN, 1.0).is_none());
        assert!(TimeInterval::new(0.0, f64::INFINITY).is_none() && TimeInterval::at(f64::NAN).is_none());
        assert_eq!(TimeInterval::at(0.0), Some(TimeInterval::default()));
    }

    #[test]
    fn intervals_are_moved_and_joined() {
        let interval = TimeInterval::new(1.0, 3.0).expect("in order");
        let later = interval.later(4.0);
        assert_eq!((later.start_s(), later.end_s(), later.middle_s()), (5.0, 7.0, 6.0));
        assert_eq!(Some(later.union(&interval)), TimeInterval::new(1.0, 7.0));
    }

    #[test]
    fn the_time_of_a_ray_counts_from_the_start_and_stays_within() {
        let interval = TimeInterval::new(1e6, 1e6 + 0.03125).expect("in order");
        assert_eq!(interval.moment(0.0), 1e6);
        assert_eq!(interval.moment(0.015625), 1e6 + 0.015625);
        let outside = [(-1.0, 1e6), (1.0, 1e6 + 0.03125), (f32::NAN, 1e6), (f32::INFINITY, 1e6 + 0.03125)];
        outside.into_iter().for_each(|(time_s, expected)| assert_eq!(interval.moment(time_s), expected));
    }
}
