//! Comparison of an estimated image with a closed form.

use etendue_stats::{EstimatedPlane, PlaneTest, Verdict, planes, student};

/// Probability of a false alarm of a test before its seed was fixed: one in a thousand.
pub const SIGNIFICANCE: f64 = 1e-3;

/// Compares an estimate with exact values, pixel by pixel, pooled and corrected for the number of tests.
///
/// A deviation up to `allowance` (absolute) is attributed to the model and subtracted before the test; the test checks that the
/// remainder is consistent with chance. Estimates without a variance (of constant integrands) must agree within the allowance.
///
/// # Errors
/// A sentence with the worst deviation.
pub fn compare_with_truth(
    estimate: EstimatedPlane<'_>,
    truth: impl Fn(usize) -> f64,
    allowance: impl Fn(usize) -> f64,
) -> Result<PlaneTest, String> {
    let truth: Vec<f64> = (0..estimate.mean.len()).map(truth).collect();
    let nearest = |i: usize| {
        let allowed = allowance(i);
        f64::from(estimate.mean[i]).clamp(truth[i] - allowed, truth[i] + allowed) as f32
    };
    let exact: Vec<f32> = (0..truth.len()).map(nearest).collect();
    let none = vec![0.0; exact.len()];
    let exact = EstimatedPlane { mean: &exact, variance_of_mean: &none, replicates: 1, correlated_pixels: 1 };
    let test = planes::compare(&estimate, &exact, SIGNIFICANCE).map_err(|e| e.to_string())?;
    if test.verdict == Verdict::Agree {
        return Ok(test);
    }
    let i = test.worst_pixel;
    Err(format!("worst at sample {i}: {} for {}, {test:?}", estimate.mean[i], truth[i]))
}

/// Mean of a plane and the standard error of that mean, for independent pixels.
#[must_use]
pub fn mean_and_error(estimate: EstimatedPlane<'_>) -> (f64, f64) {
    let n = estimate.mean.len() as f64;
    let sum = |values: &[f32]| values.iter().map(|v| f64::from(*v)).sum::<f64>();
    (sum(estimate.mean) / n, sum(estimate.variance_of_mean).sqrt() / n)
}

/// True if `mean` is `truth` within an allowance and the confidence interval of [`SIGNIFICANCE`] for `freedom` degrees of
/// freedom.
#[must_use]
pub fn is_near((mean, error): (f64, f64), truth: f64, allowance: f64, freedom: f64) -> bool {
    (mean - truth).abs() <= allowance + student::critical(SIGNIFICANCE, freedom) * error
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn truth_passes_and_a_shift_beyond_the_allowance_fails() {
        let mean: Vec<f32> = (0..64).map(|i| 1.0 + if i % 2 == 0 { 0.01 } else { -0.01 }).collect();
        let variance = vec![1e-4; 64];
        let estimate =
            EstimatedPlane { mean: &mean, variance_of_mean: &variance, replicates: 16, correlated_pixels: 1 };
        assert!(compare_with_truth(estimate, |_| 1.0, |_| 0.0).is_ok());
        assert!(compare_with_truth(estimate, |_| 1.1, |_| 0.1).is_ok());
        assert!(compare_with_truth(estimate, |_| 1.1, |_| 0.0).is_err());
        let (mean, error) = mean_and_error(estimate);
        assert!((mean - 1.0).abs() < 1e-6 && (error - 1e-2 / 8.0).abs() < 1e-8);
        assert!(is_near((1.0, 0.1), 1.2, 0.0, 30.0) && !is_near((1.0, 0.1), 1.5, 0.0, 30.0));
    }

    #[test]
    fn without_a_variance_only_the_allowance_counts() {
        let (mean, variance) = (vec![1.0; 4], vec![0.0; 4]);
        let estimate =
            EstimatedPlane { mean: &mean, variance_of_mean: &variance, replicates: 16, correlated_pixels: 1 };
        assert!(compare_with_truth(estimate, |_| 1.0 + 1e-6, |_| 2e-6).is_ok());
        assert!(compare_with_truth(estimate, |_| 1.0 + 1e-5, |_| 2e-6).is_err());
    }
}
