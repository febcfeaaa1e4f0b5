//! Test whether two estimated images differ.
//!
//! Each image provides per pixel a mean and the variance of that mean from R independent replicates. As replicates are few,
//! single variances are inaccurate. Runs of k neighbouring pixels are therefore pooled to at least [`POOLED_DEGREES_OF_FREEDOM`]
//! nominal degrees of freedom, k = ⌈30/(min R − 1)⌉:
//!
//! t = (Σ aᵢ − Σ bᵢ) / √(Σ uᵢ + Σ vᵢ),   ν = (Σ uᵢ + Σ vᵢ)² / (Σ uᵢ²/(R_a − 1) + Σ vᵢ²/(R_b − 1))
//!
//! (Welch 1947, Satterthwaite 1946). Each t is compared with Student's distribution of its own ν, the family by Šidák.
//!
//! **Rounding.** Means are stored as `f32`: a difference up to `ROUNDING` times the larger mean counts as zero, and is subtracted
//! before the test. **Zero variance.** If both variances of a pixel are zero, the means must agree within that rounding,
//! otherwise the images differ; such a pixel is not a random test. An exactly known image (a closed form) has variances of zero
//! and any number of replicates. **Not finite.** Every value that is not finite, and every negative variance, is counted and
//! makes the verdict *different*.
//!
//! **Correlated errors.** If paths of m pixels were shared (path reuse), the errors of these pixels may be equal. The variance of
//! a sum over k pixels is then multiplied by min(k, m), and its degrees of freedom are divided by the same number: the bound for
//! equal errors, too wide for errors that differ.
//!
//! Limitations: replicate means that are not normally distributed. With very few samples per replicate the distribution is skewed
//! and the test is too strict. The symptom is failures at both extremes; the remedy is more samples.

use crate::{chi_square, student};

/// Nominal degrees of freedom to which runs of pixels are pooled.
pub const POOLED_DEGREES_OF_FREEDOM: u32 = 30;

/// Relative difference of two `f32` means due to rounding alone: each is rounded by 2⁻²⁴ when stored, and may carry as much again
/// from its last operation.
pub const ROUNDING: f64 = 1.0 / (1 << 22) as f64;

/// An image of one quantity: per pixel a mean and the variance of that mean, and the number of replicates.
#[derive(Clone, Copy, Debug)]
pub struct EstimatedPlane<'a> {
    /// Means, row by row.
    pub mean: &'a [f32],
    /// Variances of the means.
    pub variance_of_mean: &'a [f32],
    /// Replicates for each variance; at least 2 if any variance is positive.
    pub replicates: u32,
    /// Number of pixels that may have equal errors; 1 if all are independent.
    pub correlated_pixels: u32,
}

/// Verdict of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// No difference at the requested significance.
    Agree,
    /// The images differ.
    Differ,
}

/// Result of a comparison of two images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneTest {
    /// The largest difference in units of its standard error; infinite if a pixel without variance differs.
    pub max_abs_z: f64,
    /// The first pixel of the run with the largest difference.
    pub worst_pixel: usize,
    /// Number of runs that exceed the corrected level, plus pixels without variance that differ.
    pub exceeding: usize,
    /// Number of random tests.
    pub tests: usize,
    /// Pixels in a run.
    pub pooled_pixels: usize,
    /// Pixels with a value that is not finite, or a negative variance.
    pub not_finite: usize,
    /// Probability that a family of tests of equal images has one as extreme as the worst here.
    pub p: f64,
    pub verdict: Verdict,
}

/// Reason why two images cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlaneTestError {
    /// The slices (means and variances of one image, then of the other) do not have the same length.
    #[error("two images of equal size are needed, but means and variances of one are {} and {}, of the other {} and {} samples long",
        .0[0], .0[1], .0[2], .0[3])]
    Lengths([usize; 4]),
    /// An image has variances but fewer than two replicates.
    #[error("a variance needs at least 2 replicates, but the image states {0}: render it with more replicates")]
    Replicates(u32),
}

/// Tests whether `a` and `b` are estimates of the same image; the verdict is wrong with probability `significance` if they are.
///
/// # Errors
/// If the sizes differ, or an image has variances without two replicates.
pub fn compare(a: &EstimatedPlane<'_>, b: &EstimatedPlane<'_>, significance: f64) -> Result<PlaneTest, PlaneTestError> {
    let lengths = [a.mean.len(), a.variance_of_mean.len(), b.mean.len(), b.variance_of_mean.len()];
    if lengths.iter().any(|l| *l != lengths[0]) {
        return Err(PlaneTestError::Lengths(lengths));
    }
    let freedom = [degrees_of_freedom(a)?, degrees_of_freedom(b)?];
    let fewest = freedom.into_iter().flatten().min().unwrap_or(POOLED_DEGREES_OF_FREEDOM);
    let pooled_pixels = POOLED_DEGREES_OF_FREEDOM.div_ceil(fewest) as usize;
    let runs = runs(a, b, freedom, pooled_pixels);
    Ok(evaluate(&runs, [a.correlated_pixels, b.correlated_pixels], pooled_pixels, significance))
}

/// R − 1 if the image has variances, `None` if it is exact.
fn degrees_of_freedom(plane: &EstimatedPlane<'_>) -> Result<Option<u32>, PlaneTestError> {
    let exact = plane.variance_of_mean.iter().all(|v| *v == 0.0);
    match plane.replicates {
        _ if exact => Ok(None),
        r if r < 2 => Err(PlaneTestError::Replicates(r)),
        r => Ok(Some(r - 1)),
    }
}

/// Sums over a run of pixels.
#[derive(Clone, Copy, Default)]
struct PixelRun {
    first_pixel: usize,
    difference: f64,
    rounding: f64,
    /// Σ u of each image.
    variance: [f64; 2],
    /// Σ u²/ν of each image, the denominator of Satterthwaite's degrees of freedom.
    spread: [f64; 2],
    certain_differences: usize,
    not_finite: usize,
}

impl PixelRun {
    fn add(&mut self, means: [f64; 2], variances: [f64; 2], freedom: [Option<u32>; 2]) {
        let legal = means.iter().all(|m| m.is_finite()) && variances.iter().all(|v| v.is_finite() && *v >= 0.0);
        if !legal {
            self.not_finite += 1;
            return;
        }
        let difference = means[0] - means[1];
        let rounding = ROUNDING * means[0].abs().max(means[1].abs());
        if variances == [0.0; 2] {
            self.certain_differences += usize::from(difference.abs() > rounding);
            return;
        }
        self.difference += difference;
        self.rounding += rounding;
        for (i, (v, nu)) in variances.into_iter().zip(freedom).enumerate() {
            self.variance[i] += v;
            self.spread[i] += nu.map_or(0.0, |nu| v * v / f64::from(nu));
        }
    }

    /// The sum of all runs, which reveals an image that is slightly off everywhere.
    fn total(runs: &[Self]) -> Self {
        let sum = |of: &dyn Fn(&Self) -> f64| runs.iter().map(of).sum();
        Self {
            difference: sum(&|r| r.difference),
            rounding: sum(&|r| r.rounding),
            variance: [0, 1].map(|i| sum(&|r| r.variance[i])),
            spread: [0, 1].map(|i| sum(&|r| r.spread[i])),
            ..Self::default()
        }
    }

    /// |t| and its two-sided p, where this many pixels of each image have equal errors; `None` if the run contains no random test.
    fn test(&self, correlated_pixels: [f64; 2]) -> Option<(f64, f64)> {
        let variance = self.variance[0] * correlated_pixels[0] + self.variance[1] * correlated_pixels[1];
        if variance == 0.0 {
            return None;
        }
        // m equal errors: m² times the variance of one, with the degrees of freedom of one.
        let cubed = correlated_pixels.map(|m| m * m * m);
        let spread = self.spread[0] * cubed[0] + self.spread[1] * cubed[1];
        let z = (self.difference.abs() - self.rounding).max(0.0) / variance.sqrt();
        Some((z, student::two_sided_p(z, variance * variance / spread)))
    }
}

fn runs(a: &EstimatedPlane<'_>, b: &EstimatedPlane<'_>, freedom: [Option<u32>; 2], length: usize) -> Vec<PixelRun> {
    let mut runs = Vec::with_capacity(a.mean.len().div_ceil(length));
    for first_pixel in (0..a.mean.len()).step_by(length) {
        let mut run = PixelRun { first_pixel, ..PixelRun::default() };
        for i in first_pixel..(first_pixel + length).min(a.mean.len()) {
            let means = [f64::from(a.mean[i]), f64::from(b.mean[i])];
            run.add(means, [f64::from(a.variance_of_mean[i]), f64::from(b.variance_of_mean[i])], freedom);
        }
        runs.push(run);
    }
    runs
}

fn evaluate(runs: &[PixelRun], correlated_pixels: [u32; 2], pooled_pixels: usize, significance: f64) -> PlaneTest {
    let all_pixels = (runs.len() > 1).then(|| (PixelRun::total(runs), correlated_pixels.map(f64::from)));
    let within = correlated_pixels.map(|m| f64::from(m).min(pooled_pixels as f64));
    let all = runs.iter().map(|run| (*run, within)).chain(all_pixels);
    let tests: Vec<(usize, f64, f64)> = all
        .filter_map(|(run, correlated_pixels)| run.test(correlated_pixels).map(|(z, p)| (run.first_pixel, z, p)))
        .collect();
    let level = chi_square::sidak_level(significance, tests.len());
    let certain: usize = runs.iter().map(|r| r.certain_differences).sum();
    let not_finite = runs.iter().map(|r| r.not_finite).sum();
    let random = tests.iter().filter(|t| t.2 < level).count();
    let (mut worst_pixel, mut max_abs_z) = (0, 0.0);
    for (first_pixel, z, _) in &tests {
        if *z > max_abs_z {
            (worst_pixel, max_abs_z) = (*first_pixel, *z);
        }
    }
    if let Some(run) = runs.iter().find(|r| r.certain_differences > 0) {
        (worst_pixel, max_abs_z) = (run.first_pixel, f64::INFINITY);
    }
    let smallest = tests.iter().fold(1.0_f64, |p, t| p.min(t.2));
    let p = if certain > 0 { 0.0 } else { chi_square::sidak_p(smallest, tests.len()) };
    let differ = certain + random + not_finite > 0;
    let verdict = if differ { Verdict::Differ } else { Verdict::Agree };
    let (exceeding, tests) = (certain + random, tests.len());
    PlaneTest { max_abs_z, worst_pixel, exceeding, tests, pooled_pixels, not_finite, p, verdict }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moments::Moments;
    use crate::normal;
    use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};

    /// An estimate of `truth` per pixel from `replicates` normal replicate means with the given standard deviation.
    fn estimate(seed: u64, truth: &[f64], sigma: f64, replicates: u32) -> (Vec<f32>, Vec<f32>) {
        let pixel = |(x, truth): (usize, &f64)| {
            let mut stream = NoiseStream::new(seed, 0, 0, 0, Pixel { x: x as u32, y: 0 }, NoiseDraw::Read);
            let samples = (0..replicates).map(|_| truth + sigma * normal::quantile(stream.unit_f64().max(1e-16)));
            let moments = Moments::from_values(samples);
            (moments.mean() as f32, moments.variance_of_mean().expect("two or more") as f32)
        };
        truth.iter().enumerate().map(pixel).unzip()
    }

    fn plane((mean, variance_of_mean): &(Vec<f32>, Vec<f32>), replicates: u32) -> EstimatedPlane<'_> {
        EstimatedPlane { mean, variance_of_mean, replicates, correlated_pixels: 1 }
    }

    #[test]
    fn equal_images_are_called_different_as_often_as_said() {
        // 200 families at 20 %: Binomial(200, 0.2) has mean 40 and standard deviation 5.66; four of those.
        let truth: Vec<f64> = (0..150).map(|i| f64::from(i % 7)).collect();
        for (ra, rb) in [(4, 4), (2, 9), (16, 40)] {
            let wrong = (0..200).filter(|seed| {
                let (a, b) = (estimate(*seed, &truth, 1.0, ra), estimate(seed + 1_000_000, &truth, 1.0, rb));
                compare(&plane(&a, ra), &plane(&b, rb), 0.2).expect("sizes").verdict == Verdict::Differ
            });
            let wrong = wrong.count();
            assert!((18..=62).contains(&wrong), "{ra} and {rb} replicates: {wrong} of 200");
        }
    }

    #[test]
    fn errors_that_are_alike_raise_no_alarm_where_it_is_said() {
        // Blocks of 16 equal errors: their sum has 16 times the variance that 16 single errors would have.
        let blocks = |seed| {
            let (mean, variance) = estimate(seed, &vec![10.0; 100], 1.0, 8);
            let spread = |v: Vec<f32>| v.into_iter().flat_map(|v| [v; 16]).collect::<Vec<_>>();
            (spread(mean), spread(variance))
        };
        let alarms = |correlated_pixels| {
            let differs = |seed: &u64| {
                let (a, b) = (blocks(*seed), blocks(seed + 1000));
                let stated = |image| EstimatedPlane { correlated_pixels, ..plane(image, 8) };
                compare(&stated(&a), &stated(&b), 0.05).expect("sizes").verdict == Verdict::Differ
            };
            (0..100).filter(differs).count()
        };
        // Binomial(100, 0.05) exceeds 14 in 1 of 10 000 cases.
        assert!(alarms(16) <= 14 && alarms(1) > 50, "{} and {}", alarms(16), alarms(1));
    }

    #[test]
    fn a_shift_too_small_for_any_run_is_found_in_the_whole() {
        // Half a standard error per pixel: 0.5 √1000 = 16 standard errors of the sum.
        let (truth, shifted) = (vec![10.0; 1000], vec![10.0 + 0.5 / 8.0_f64.sqrt(); 1000]);
        let (a, b) = (estimate(1, &truth, 1.0, 8), estimate(2, &shifted, 1.0, 8));
        let test = compare(&plane(&a, 8), &plane(&b, 8), 1e-3).expect("sizes");
        assert_eq!((test.verdict, test.tests), (Verdict::Differ, 201));
        assert!(test.max_abs_z > 8.0);
    }

    #[test]
    fn one_pixel_that_is_off_is_found() {
        let truth = vec![10.0; 1000];
        let mut other = truth.clone();
        other[503] = 40.0;
        let (a, b) = (estimate(1, &truth, 1.0, 8), estimate(2, &other, 1.0, 8));
        let test = compare(&plane(&a, 8), &plane(&b, 8), 1e-3).expect("sizes");
        assert_eq!((test.verdict, test.exceeding, test.pooled_pixels), (Verdict::Differ, 1, 5));
        assert!(test.worst_pixel == 500 && test.p < 1e-9 && test.max_abs_z > 10.0);
    }

    #[test]
    fn without_variance_images_must_be_equal_to_rounding() {
        let zeros = [0.0; 3];
        let exact = |mean| EstimatedPlane { mean, variance_of_mean: &zeros, replicates: 1, correlated_pixels: 1 };
        let one = [1.0, 2.0, 3.0_f32];
        let rounded = [1.0, 2.0_f32.next_up(), 3.0];
        let other = [1.0, 2.000_01, 3.0];
        let agree = compare(&exact(&one), &exact(&rounded), 0.01).expect("sizes");
        assert_eq!((agree.verdict, agree.p, agree.tests), (Verdict::Agree, 1.0, 0));
        let differ = compare(&exact(&one), &exact(&other), 0.01).expect("sizes");
        assert_eq!((differ.verdict, differ.p, differ.max_abs_z), (Verdict::Differ, 0.0, f64::INFINITY));
    }

    #[test]
    fn an_estimate_is_compared_with_a_closed_form() {
        let truth = vec![3.0; 600];
        let a = estimate(5, &truth, 0.5, 6);
        let exact = (vec![3.0_f32; 600], vec![0.0_f32; 600]);
        let biased = (vec![3.5_f32; 600], vec![0.0_f32; 600]);
        assert_eq!(compare(&plane(&a, 6), &plane(&exact, 1), 1e-3).expect("sizes").verdict, Verdict::Agree);
        assert_eq!(compare(&plane(&a, 6), &plane(&biased, 1), 1e-3).expect("sizes").verdict, Verdict::Differ);
    }

    #[test]
    fn what_is_not_finite_is_counted_and_never_agrees() {
        let (one, zero) = ([1.0_f32, f32::NAN], [0.0_f32, 0.0]);
        let a = EstimatedPlane { mean: &one, variance_of_mean: &zero, replicates: 4, correlated_pixels: 1 };
        let test = compare(&a, &a, 0.01).expect("sizes");
        assert_eq!((test.not_finite, test.verdict), (1, Verdict::Differ));
    }

    #[test]
    fn unusable_input_is_refused() {
        let (two, three, ones) = ([1.0_f32; 2], [1.0_f32; 3], [1.0_f32; 2]);
        let a = EstimatedPlane { mean: &two, variance_of_mean: &ones, replicates: 1, correlated_pixels: 1 };
        assert_eq!(compare(&a, &a, 0.01), Err(PlaneTestError::Replicates(1)));
        let b = EstimatedPlane { mean: &three, variance_of_mean: &ones, replicates: 4, correlated_pixels: 1 };
        assert_eq!(compare(&a, &b, 0.01), Err(PlaneTestError::Lengths([2, 2, 3, 2])));
    }
}
