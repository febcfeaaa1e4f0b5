//! Error metrics of an image against a reference.

use crate::moments::Moments;

/// Errors of an image against a reference, over all samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorSummary {
    /// Samples compared: those that are finite in both.
    pub samples: usize,
    /// Samples excluded because one of the two is not finite.
    pub not_finite: usize,
    /// Root mean square error, in the image's unit.
    pub rmse: f64,
    /// Mean of (error)² / (reference² + ε²), ε = 1 % of the reference's mean magnitude: dimensionless.
    pub relative_mse: f64,
    /// Relative MSE without the largest thousandth of its terms, to exclude fireflies.
    pub trimmed_relative_mse: f64,
    /// Mean error, in the image's unit.
    pub bias: f64,
    /// Standard error of `bias` from the scatter of the errors, for independent pixel errors except those that may be equal; 0 for
    /// fewer than two samples.
    pub bias_standard_error: f64,
    /// Largest magnitude of an error.
    pub max_abs: f64,
}

/// ε of the relative error, as a fraction of the reference's mean magnitude.
const RELATIVE_FLOOR: f64 = 0.01;
/// Fraction of the largest terms that the trimmed error excludes.
const TRIMMED_FRACTION: f64 = 0.001;

impl ErrorSummary {
    /// Returns the same with a larger `bias_standard_error`, for errors that may be equal in groups of `alike` pixels: the bound
    /// for that many times fewer independent errors.
    #[must_use]
    pub fn with_correlated_pixels(self, correlated_pixels: u32) -> Self {
        Self { bias_standard_error: self.bias_standard_error * f64::from(correlated_pixels.max(1)).sqrt(), ..self }
    }

    /// The errors of `picture` against `reference`. `None` if their lengths differ or no sample is finite in both.
    #[must_use]
    pub fn compare(image: &[f32], reference: &[f32]) -> Option<Self> {
        if image.len() != reference.len() {
            return None;
        }
        let pairs: Vec<(f64, f64)> = image
            .iter()
            .zip(reference)
            .filter(|(p, r)| p.is_finite() && r.is_finite())
            .map(|(p, r)| (f64::from(*p) - f64::from(*r), f64::from(*r)))
            .collect();
        (!pairs.is_empty()).then(|| Self::from_errors(&pairs, image.len() - pairs.len()))
    }

    /// From pairs of (error, reference).
    fn from_errors(pairs: &[(f64, f64)], not_finite: usize) -> Self {
        let errors = Moments::from_values(pairs.iter().map(|p| p.0));
        let mut relative = relative_squares(pairs);
        let relative_mse = mean(&relative);
        relative.sort_by(f64::total_cmp);
        let retained = relative.len() - (relative.len() as f64 * TRIMMED_FRACTION) as usize;
        Self {
            samples: pairs.len(),
            not_finite,
            rmse: Moments::from_values(pairs.iter().map(|p| p.0 * p.0)).mean().sqrt(),
            relative_mse,
            trimmed_relative_mse: mean(&relative[..retained]),
            bias: errors.mean(),
            bias_standard_error: errors.variance_of_mean().unwrap_or(0.0).sqrt(),
            max_abs: pairs.iter().fold(0.0, |m, p| p.0.abs().max(m)),
        }
    }
}

/// (error)² / (reference² + ε²); if reference and ε are zero, 0 for no error and infinity otherwise.
fn relative_squares(pairs: &[(f64, f64)]) -> Vec<f64> {
    let floor = RELATIVE_FLOOR * Moments::from_values(pairs.iter().map(|p| p.1.abs())).mean();
    let term = |(e, r): &(f64, f64)| if *e == 0.0 { 0.0 } else { e * e / (r * r + floor * floor) };
    pairs.iter().map(term).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_by_hand() {
        let e = ErrorSummary::compare(&[1.0, 2.0, 3.0, f32::NAN], &[1.0, 1.0, 5.0, 1.0]).expect("three samples");
        assert_eq!((e.samples, e.not_finite, e.max_abs), (3, 1, 2.0));
        assert!((e.rmse - (5.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!((e.bias + 1.0 / 3.0).abs() < 1e-15);
        // Errors 0, 1, −2: variance 7/3, of the mean 7/9.
        assert!((e.bias_standard_error - (7.0_f64 / 9.0).sqrt()).abs() < 1e-15);
        let floor = (0.01 * 7.0 / 3.0) * (0.01 * 7.0 / 3.0);
        assert!((e.relative_mse - (1.0 / (1.0 + floor) + 4.0 / (25.0 + floor)) / 3.0).abs() < 1e-15);
    }

    #[test]
    fn a_scale_changes_no_relative_error_and_a_firefly_is_trimmed() {
        let reference: Vec<f32> = (0..2000).map(|i| 1.0 + (i % 5) as f32).collect();
        let mut image: Vec<f32> = reference.iter().map(|r| r * 1.5).collect();
        image[700] = 1e6;
        let one = ErrorSummary::compare(&image, &reference).expect("samples");
        let scale = |v: &[f32]| v.iter().map(|x| x * 1024.0).collect::<Vec<_>>();
        let scaled = ErrorSummary::compare(&scale(&image), &scale(&reference)).expect("samples");
        assert!((one.relative_mse / scaled.relative_mse - 1.0).abs() < 1e-12);
        // 25 % off everywhere: a quarter, except for ε = 1 % of the mean, which is 3 times the smallest reference.
        assert!((one.trimmed_relative_mse - 0.25).abs() < 0.25 * 0.001, "{}", one.trimmed_relative_mse);
        assert!(one.relative_mse > 1e6);
    }

    #[test]
    fn nothing_to_compare_is_none() {
        assert!(ErrorSummary::compare(&[], &[]).is_none());
        assert!(ErrorSummary::compare(&[1.0], &[1.0, 2.0]).is_none());
        assert!(ErrorSummary::compare(&[f32::NAN], &[1.0]).is_none());
        assert!(ErrorSummary::compare(&[1.0], &[0.0]).expect("one").relative_mse.is_infinite());
        assert_eq!(ErrorSummary::compare(&[0.0], &[0.0]).expect("one").relative_mse, 0.0);
    }
}
