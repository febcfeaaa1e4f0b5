//! Defect pixels: distribution of the deviations of pixels.
//!
//! EMVA 1288 release 3.1 (section 4.4; 8.4 how to) and 4.0, defect pixel characterisation. The standard leaves the limit of a
//! defective pixel to the application and requests two histograms of the averaged images instead:
//!
//! - the **logarithmic** one of deviations from the mean, in at most 256 bins of equal width, a whole number of steps of the
//!   averages, with the normal distribution: pixels above it are defective;
//! - the **accumulated** one: the fraction of pixels that deviate by more than x, which gives the number of defects for a limit.
//!
//! Without light: ȳ_dark − μ_dark, DN. For the response: (ȳ_50 − ȳ_dark)/(μ_50 − μ_dark) − 1, %. The normal distribution has the
//! standard deviation 1.4826 times the median magnitude, which hot pixels do not affect (the standard: the white part of the
//! spectrogram). Averages of L frames still contain temporal noise of variance σ²/L. Limitations: no high-pass filter of the
//! standard against non-uniform light; use uniform illumination.

use etendue_core::maths::f64::exp;

use super::Stack;

/// Maximum number of bins.
const BINS: usize = 256;
/// The standard deviation of a normal distribution over its median magnitude: 1/Φ⁻¹(3/4).
const MAD_TO_SIGMA: f64 = 1.482_602_2;

/// Histograms of deviations from their mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviations {
    /// Centre of each bin, and its number of pixels.
    pub bins: Vec<(f64, u64)>,
    /// Width of a bin.
    pub width: f64,
    /// Standard deviation of the normal distribution that fits the centre.
    pub sigma: f64,
    /// Total number of pixels.
    pub pixels: usize,
    /// x, and the fraction of pixels that deviate by more than x from the mean.
    pub accumulated: Vec<(f64, f64)>,
}

impl Deviations {
    /// Deviations of pixels from the mean without light, DN.
    #[must_use]
    pub fn from_dark(dark: &Stack) -> Self {
        let average = dark.average();
        let mean = average.iter().sum::<f64>() / average.len() as f64;
        Self::from_deviations(average.iter().map(|y| y - mean).collect(), step_dn(&[dark]))
    }

    /// Deviations of responses from the mean response, %.
    #[must_use]
    pub fn from_response(dark: &Stack, bright: &Stack) -> Self {
        let signal: Vec<f64> = bright.average().iter().zip(&dark.average()).map(|(b, d)| b - d).collect();
        let mean = signal.iter().sum::<f64>() / signal.len() as f64;
        let step = 100.0 * step_dn(&[dark, bright]) / mean.abs();
        Self::from_deviations(signal.iter().map(|s| 100.0 * (s / mean - 1.0)).collect(), step)
    }

    /// Bin widths are whole multiples of the step of averages of integers: otherwise bins would contain varying numbers of steps.
    fn from_deviations(deviations: Vec<f64>, step: f64) -> Self {
        let pixels = deviations.len();
        let (low, high) = deviations.iter().fold((0.0_f64, 0.0_f64), |(l, h), d| (l.min(*d), h.max(*d)));
        let width = step * ((high - low) / (step * (BINS - 1) as f64)).ceil().max(1.0);
        let low = low - 0.5 * step;
        let mut counts = vec![0; ((high - low) / width) as usize + 1];
        for d in &deviations {
            counts[((d - low) / width) as usize] += 1;
        }
        let mut sorted: Vec<f64> = deviations.iter().map(|d| d.abs()).collect();
        sorted.sort_by(f64::total_cmp);
        let middle = |i: usize| low + (i as f64 + 0.5) * width;
        let largest = sorted[pixels - 1];
        let above = |i: usize| {
            let x = largest * i as f64 / BINS as f64;
            (x, (pixels - sorted.partition_point(|d| *d <= x)) as f64 / pixels as f64)
        };
        Self {
            bins: counts.into_iter().enumerate().map(|(i, n)| (middle(i), n)).collect(),
            width,
            sigma: MAD_TO_SIGMA * median(&sorted, step),
            pixels,
            accumulated: (0..BINS).map(above).collect(),
        }
    }

    /// Expected pixels of the normal distribution in a bin about x.
    #[must_use]
    pub fn normal(&self, x: f64) -> f64 {
        let z = x / self.sigma;
        self.pixels as f64 * self.width * exp(-0.5 * z * z) / (self.sigma * core::f64::consts::TAU.sqrt())
    }
}

/// The median of sorted magnitudes, distributed uniformly over their step.
fn median(sorted: &[f64], step: f64) -> f64 {
    let from = sorted[sorted.len() / 2] - 0.5 * step;
    let below = sorted.partition_point(|d| *d < from);
    let within = sorted.partition_point(|d| *d <= from + step) - below;
    from + step * (0.5 * sorted.len() as f64 - below as f64) / within as f64
}

/// The step of averages of integers, and of their difference.
fn step_dn(stacks: &[&Stack]) -> f64 {
    let frames: Vec<usize> = stacks.iter().map(|s| s.frames()).collect();
    let same = frames.windows(2).all(|pair| pair[0] == pair[1]);
    let parts = if same { frames[0] } else { frames.iter().product() };
    1.0 / parts.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_stats::normal::quantile;

    #[test]
    fn hot_pixels_stand_above_the_normal_distribution() {
        const COUNT: usize = 40_000;
        // The quantiles of a normal distribution of standard deviation 2, and twenty pixels at 30.
        let mut values: Vec<f64> = (0..COUNT).map(|i| 2.0 * quantile((i as f64 + 0.5) / COUNT as f64)).collect();
        values[..20].fill(30.0);
        let deviations = Deviations::from_deviations(values, 1e-6);
        // The median of a fine grid of quantiles; twenty of forty thousand shift it by 5·10⁻⁴.
        assert!((deviations.sigma - 2.0).abs() < 3e-3, "{}", deviations.sigma);
        assert_eq!(deviations.bins.iter().map(|b| b.1).sum::<u64>(), COUNT as u64);
        let (x, counted) = *deviations.bins.last().expect("bins");
        assert!(counted == 20 && deviations.normal(x) < 1e-30, "{counted}");
        let (x, counted) = deviations.bins[deviations.bins.iter().position(|b| b.0 > 0.0).expect("a middle")];
        // A bin contains hundreds of quantiles: ± one.
        assert!((counted as f64 / deviations.normal(x) - 1.0).abs() < 0.02, "{counted} {}", deviations.normal(x));
        let above = deviations.accumulated.iter().find(|(x, _)| *x > 10.0).expect("as far as 30");
        assert!((above.1 - 20.0 / COUNT as f64).abs() < 1e-9, "{above:?}");
        assert!(
            deviations.accumulated.windows(2).all(|pair| pair[1].1 <= pair[0].1) && deviations.accumulated[0].1 > 0.99
        );
    }
    #[test]
    fn averages_of_whole_numbers_fill_the_bins_evenly() {
        // Thirty frames: steps of 1/30 DN, 126 of them in a range of 4.2 DN.
        const COUNT: usize = 200_000;
        let value = |i: usize| (30.0 * 0.42 * quantile((i as f64 + 0.5) / COUNT as f64)).round() / 30.0;
        let deviations = Deviations::from_deviations((0..COUNT).map(value).collect(), 1.0 / 30.0);
        assert!((deviations.width - 1.0 / 30.0).abs() < 1e-12, "{}", deviations.width);
        for (x, counted) in deviations.bins.iter().filter(|(x, _)| x.abs() < 0.8) {
            // σ from the median to a few hundredths; the density at the centre of a bin instead of its mean over it.
            assert!((*counted as f64 / deviations.normal(*x) - 1.0).abs() < 0.05, "{x}: {counted}");
        }
    }
}
