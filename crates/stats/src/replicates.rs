//! Mean and honest variance of randomised quasi-Monte Carlo.
//!
//! R independently scrambled replicates give R independent, unbiased means. Their mean is the estimate; their scatter,
//! divided by R, is its variance, with R − 1 degrees of freedom (Owen 1997). The samples *within* a replicate are not
//! independent: s²/n over them overstates the variance by orders of magnitude and feeds no test.

use crate::{moments::Moments, student};

/// An estimate with the variance of its mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReplicateEstimate {
    /// Mean of the replicate means.
    pub mean: f64,
    /// Estimated variance of `mean`.
    pub variance_of_mean: f64,
    /// Degrees of freedom of `variance_of_mean`.
    pub degrees_of_freedom: u32,
}

impl ReplicateEstimate {
    /// The estimate of replicates of equal size. `None` where fewer than two.
    #[must_use]
    pub fn of(replicate_means: &[f64]) -> Option<Self> {
        let moments = Moments::of(replicate_means.iter().copied());
        let variance_of_mean = moments.variance_of_mean()?;
        let degrees_of_freedom = u32::try_from(replicate_means.len() - 1).ok()?;
        Some(Self { mean: moments.mean(), variance_of_mean, degrees_of_freedom })
    }

    /// Standard error of the mean.
    #[must_use]
    pub fn standard_error(&self) -> f64 {
        self.variance_of_mean.sqrt()
    }

    /// Half the width of the confidence interval about the mean that holds the truth with probability `confidence`
    /// (Student's t).
    #[must_use]
    pub fn half_width(&self, confidence: f64) -> f64 {
        student::critical(1.0 - confidence, f64::from(self.degrees_of_freedom)) * self.standard_error()
    }

    /// Two-sided p-value of the hypothesis that the truth is `value`. With a variance of zero it is 1 or 0.
    #[must_use]
    pub fn p_of(&self, value: f64) -> f64 {
        let difference = (self.mean - value).abs();
        if difference == 0.0 {
            return 1.0;
        }
        student::two_sided_p(difference / self.standard_error(), f64::from(self.degrees_of_freedom))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_replicates_by_hand() {
        // Mean 5, variance 20/3, of the mean 5/3.
        let estimate = ReplicateEstimate::of(&[2.0, 4.0, 6.0, 8.0]).expect("four replicates");
        assert!((estimate.mean - 5.0).abs() < 1e-15 && (estimate.variance_of_mean - 5.0 / 3.0).abs() < 1e-15);
        assert_eq!(estimate.degrees_of_freedom, 3);
        // t of 3 degrees at 95 % is 3.182446.
        assert!((estimate.half_width(0.95) - 3.182_446 * estimate.standard_error()).abs() < 1e-6);
        assert!((estimate.p_of(5.0 + estimate.half_width(0.99)) - 0.01).abs() < 1e-12);
    }

    #[test]
    fn certainty_and_ignorance() {
        let certain = ReplicateEstimate::of(&[1.0; 4]).expect("four replicates");
        assert_eq!((certain.p_of(1.0), certain.p_of(1.1)), (1.0, 0.0));
        assert!(ReplicateEstimate::of(&[1.0]).is_none());
    }
}
