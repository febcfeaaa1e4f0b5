//! Detail: noise reduction before colour, sharpening after tone; both off by default.
//!
//! Bilateral filter (Tomasi & Manduchi 1998): a mean over near pixels of similar colour.
//!
//! ```text
//! p′ = Σ w p_i / Σ w,   w = exp(−r²/2σ_s² − d²/2σ_r²)
//! ```
//!
//! r the distance (px, to 2 σ_s), d² the mean over the channels of the squared difference of the two colours. σ_r is a fraction of white and should
//! be two or three times the noise to be removed; edges much higher than it are preserved. One σ_r applies at all brightnesses: shot noise, which
//! grows with the light, is smoothed less in highlights.
//!
//! Unsharp mask: adds the detail that a blur removes.
//!
//! On luma Y = 0.2126 R + 0.7152 G + 0.0722 B of the encoded image (weights of ITU-R BT.709), so that colours do not
//! change: d = Y − blur_σ(Y); where |d| is above the threshold, each channel becomes its value + amount · d, clipped to
//! 0 … 1.
//!
//! Gaussian blur: rows, then columns.
//!
//! The kernel exp(−x²/2σ²) is cut at 5 σ, where it is 4e-6 of its centre (at 3 σ, 1 %, the halo of a lamp would end in a visible square at night),
//! and normalised to 1; near the image's edge it is normalised over the existing pixels, so a flat image stays flat.

use etendue_core::{Plane, maths::f32::exp, maths::f64::exp as exp_f64, quantity::Display};
use etendue_spectra::colour::luma;
use rayon::prelude::*;

/// Noise reduction on linear camera colours after demosaic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseReduction {
    /// Means over near pixels of similar colour.
    Bilateral(Bilateral),
    /// The median of each channel over squares of 2 r + 1 pixels, r from 1 to 3.
    Median {
        /// r, px.
        radius_px: usize,
    },
}

impl NoiseReduction {
    /// Checks the ranges of the parameters.
    ///
    /// # Errors
    /// If one is out of range.
    pub fn check(&self) -> Result<(), DetailError> {
        match self {
            Self::Bilateral(bilateral) => bilateral.check(),
            Self::Median { radius_px } if (1..=3).contains(radius_px) => Ok(()),
            Self::Median { radius_px } => {
                Err(DetailError::Range { name: "radius_px", value: *radius_px as f64, range: "from 1 to 3" })
            }
        }
    }

    /// The smoothed image. Runs in the rayon pool of the caller; the result does not depend on it.
    pub(crate) fn apply<const N: usize>(&self, image: &[[f32; N]], width: usize) -> Vec<[f32; N]> {
        match self {
            Self::Bilateral(bilateral) => bilateral.apply(image, width),
            Self::Median { radius_px } => apply(image, width, *radius_px),
        }
    }
}

/// Error of noise reduction or sharpening.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DetailError {
    /// A length or fraction out of range.
    #[error("{name} is {value}, but a number {range} is needed")]
    Range {
        /// Name of the number.
        name: &'static str,
        value: f64,
        /// The legal range.
        range: &'static str,
    },
}

/// Refuses a number outside `low` (excluded) to `high`.
fn within(name: &'static str, value: f64, low: f64, high: f64, range: &'static str) -> Result<(), DetailError> {
    if value > low && value <= high { Ok(()) } else { Err(DetailError::Range { name, value, range }) }
}

/// Widths of the two Gaussians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bilateral {
    /// σ_s, px, above 0 and at most 10.
    pub radius_px: f64,
    /// σ_r, fraction of white, above 0 and at most 1.
    pub range: f64,
}

impl Bilateral {
    fn check(&self) -> Result<(), DetailError> {
        within("radius_px", self.radius_px, 0.0, 10.0, "above 0 and at most 10")?;
        within("range", self.range, 0.0, 1.0, "above 0 and at most 1")
    }

    fn apply<const N: usize>(&self, image: &[[f32; N]], width: usize) -> Vec<[f32; N]> {
        let reach = (2.0 * self.radius_px).ceil() as usize;
        let near = (-0.5 / (self.radius_px * self.radius_px)) as f32;
        let like = (-0.5 / (self.range * self.range * N as f64)) as f32;
        let height = image.len() / width.max(1);
        let smoothed = |i: usize| {
            let (x, y, centre) = (i % width, i / width, image[i]);
            let (mut sum, mut total) = ([0.0; N], 0.0);
            for row in y.saturating_sub(reach)..(y + reach + 1).min(height) {
                for column in x.saturating_sub(reach)..(x + reach + 1).min(width) {
                    let v = image[row * width + column];
                    let (dx, dy) = (column.abs_diff(x) as f32, row.abs_diff(y) as f32);
                    let difference: f32 = (0..N).map(|c| (v[c] - centre[c]) * (v[c] - centre[c])).sum();
                    let weight = exp(near * (dx * dx + dy * dy) + like * difference);
                    (0..N).for_each(|c| sum[c] += weight * v[c]);
                    total += weight;
                }
            }
            sum.map(|s| s / total)
        };
        (0..image.len()).into_par_iter().map(smoothed).collect()
    }
}

fn apply<const N: usize>(image: &[[f32; N]], width: usize, radius: usize) -> Vec<[f32; N]> {
    let height = image.len() / width.max(1);
    let at = |i: usize| {
        let (x, y) = (i % width, i / width);
        core::array::from_fn(|c| {
            let mut values = [0.0; 49];
            let mut count = 0;
            for row in y.saturating_sub(radius)..(y + radius + 1).min(height) {
                for column in x.saturating_sub(radius)..(x + radius + 1).min(width) {
                    values[count] = image[row * width + column][c];
                    count += 1;
                }
            }
            middle(&mut values[..count])
        })
    };
    (0..image.len()).into_par_iter().map(at).collect()
}

/// The median; the lower of the two middle values for an even number.
fn middle(values: &mut [f32]) -> f32 {
    let half = (values.len() - 1) / 2;
    *values.select_nth_unstable_by(half, f32::total_cmp).1
}

/// Amount of sharpening, and its blur.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnsharpMask {
    /// Factor on the detail, above 0 and at most 10.
    pub amount: f64,
    /// σ of the blur, px, above 0 and at most 50.
    pub radius_px: f64,
    /// Detail below this (encoded, 0 … 1) is left unchanged, as it may be noise.
    pub threshold: f64,
}

impl UnsharpMask {
    /// Checks the ranges of the parameters.
    ///
    /// # Errors
    /// If one is out of range.
    pub fn check(&self) -> Result<(), DetailError> {
        within("amount", self.amount, 0.0, 10.0, "above 0 and at most 10")?;
        within("radius_px", self.radius_px, 0.0, 50.0, "above 0 and at most 50")?;
        let threshold = self.threshold;
        let legal = (0.0..=1.0).contains(&threshold);
        let error = DetailError::Range { name: "threshold", value: threshold, range: "from 0 to 1" };
        if legal { Ok(()) } else { Err(error) }
    }

    /// Sharpens an image. Runs in the rayon pool of the caller; the result does not depend on it.
    pub(crate) fn apply(&self, image: &mut Plane<Display>) {
        let luma: Vec<[f32; 1]> = image.samples().par_iter().map(|rgb| [luma(*rgb)]).collect();
        let blurred = gaussian(&luma, image.width(), self.radius_px);
        let (amount, threshold) = (self.amount as f32, self.threshold as f32);
        image.samples_mut().par_iter_mut().enumerate().for_each(|(i, rgb)| {
            let detail = luma[i][0] - blurred[i][0];
            if detail.abs() > threshold {
                *rgb = rgb.map(|v| (v + amount * detail).clamp(0.0, 1.0));
            }
        });
    }
}

/// The image blurred by σ px, channel by channel.
pub(crate) fn gaussian<const N: usize>(image: &[[f32; N]], width: usize, sigma_px: f64) -> Vec<[f32; N]> {
    let weights = weights(sigma_px);
    let mut across = vec![[0.0; N]; image.len()];
    across.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, out)| {
        let row = &image[y * width..][..width];
        for (x, pixel) in out.iter_mut().enumerate() {
            *pixel = mean(&weights, x, width, |i| row[i]);
        }
    });
    let height = image.len() / width.max(1);
    let mut blurred = vec![[0.0; N]; image.len()];
    blurred.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, out)| {
        for (x, pixel) in out.iter_mut().enumerate() {
            *pixel = mean(&weights, y, height, |i| across[i * width + x]);
        }
    });
    blurred
}

/// One side of the kernel, from its centre.
fn weights(sigma_px: f64) -> Vec<f32> {
    let reach = (5.0 * sigma_px).ceil() as usize;
    (0..=reach).map(|i| exp_f64(-0.5 * (i as f64 / sigma_px) * (i as f64 / sigma_px)) as f32).collect()
}

fn mean<const N: usize>(weights: &[f32], at: usize, length: usize, value: impl Fn(usize) -> [f32; N]) -> [f32; N] {
    let (mut sum, mut total) = ([0.0; N], 0.0);
    let reach = weights.len() - 1;
    for i in at.saturating_sub(reach)..(at + reach + 1).min(length) {
        let (weight, v) = (weights[i.abs_diff(at)], value(i));
        (0..N).for_each(|c| sum[c] += weight * v[c]);
        total += weight;
    }
    sum.map(|s| s / total)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILTER: Bilateral = Bilateral { radius_px: 2.0, range: 0.05 };

    /// An edge of 0.2 to 0.8 with noise of ± 0.02 (a fixed scramble).
    fn noisy_edge() -> Vec<[f32; 3]> {
        let noise = |i: usize| (i.wrapping_mul(2_654_435_761) >> 7 & 1023) as f32 / 1023.0 - 0.5;
        (0..32 * 32).map(|i| [0, 1, 2].map(|c| if i % 32 < 16 { 0.2 } else { 0.8 } + 0.04 * noise(3 * i + c))).collect()
    }

    fn spread(image: &[[f32; 3]], columns: core::ops::Range<usize>) -> f32 {
        let values: Vec<f32> =
            image.iter().enumerate().filter(|(i, _)| columns.contains(&(i % 32))).map(|(_, v)| v[1]).collect();
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f32>() / values.len() as f32).sqrt()
    }

    #[test]
    fn noise_falls_and_the_edge_stays() {
        let (before, after) = (noisy_edge(), FILTER.apply(&noisy_edge(), 32));
        assert!(spread(&after, 2..14) < 0.35 * spread(&before, 2..14));
        // Twelve σ_r between the sides: leakage is below e^-70.
        assert!(after.iter().enumerate().all(|(i, v)| (v[0] < 0.25) == (i % 32 < 16)));
        assert!(FILTER.apply(&[[0.4; 3]; 20], 5).iter().flatten().all(|v| (v - 0.4).abs() < 1e-6));
    }

    #[test]
    fn widths_out_of_range_are_refused() {
        assert!(Bilateral { radius_px: 0.0, ..FILTER }.check().is_err());
        assert!(Bilateral { range: f64::NAN, ..FILTER }.check().is_err());
        assert!(FILTER.check().is_ok());
    }

    #[test]
    fn single_pixels_go_and_edges_stay() {
        let mut image: Vec<[f32; 2]> = (0..80).map(|i| if i % 10 < 5 { [0.1, 0.9] } else { [0.6, 0.2] }).collect();
        let clean = image.clone();
        image[22] = [1.0, 0.0];
        image[57] = [0.0, 1.0];
        assert_eq!(apply(&image, 10, 1), clean);
    }

    fn edge() -> Plane<Display> {
        let samples = (0..200).map(|i| if i % 20 < 10 { [0.3, 0.4, 0.5] } else { [0.6, 0.7, 0.8] }).collect();
        Plane::from_samples(20, 10, samples).expect("filled")
    }

    #[test]
    fn edges_overshoot_alike_in_all_channels_and_flats_stay() {
        let mut sharp = edge();
        UnsharpMask { amount: 1.0, radius_px: 1.0, threshold: 0.0 }.apply(&mut sharp);
        let (before, after) = (edge(), sharp);
        let change = |x: usize| [0, 1, 2].map(|c| after.at(x, 5)[c] - before.at(x, 5)[c]);
        assert!(change(9)[1] < -0.05 && change(10)[1] > 0.05);
        assert!((0..20).all(|x| change(x).iter().all(|c| (c - change(x)[0]).abs() < 1e-6)));
        assert!((0..5).all(|x| change(x)[0].abs() < 1e-6));
    }

    #[test]
    fn small_detail_is_left_alone() {
        let mut image = edge();
        UnsharpMask { amount: 1.0, radius_px: 1.0, threshold: 0.5 }.apply(&mut image);
        assert_eq!(image, edge());
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        let legal = UnsharpMask { amount: 1.0, radius_px: 1.0, threshold: 0.0 };
        assert!(legal.check().is_ok());
        assert!(UnsharpMask { amount: 0.0, ..legal }.check().is_err());
        assert!(UnsharpMask { radius_px: 51.0, ..legal }.check().is_err());
        assert!(UnsharpMask { threshold: -0.1, ..legal }.check().is_err());
    }

    #[test]
    fn a_point_becomes_a_gaussian_and_flat_stays_flat() {
        let n = 31;
        let mut point = vec![[0.0]; n * n];
        point[15 * n + 15] = [1.0];
        let blurred = gaussian(&point, n, 2.0);
        let sum: f32 = blurred.iter().map(|v| v[0]).sum();
        let ratio = blurred[15 * n + 17][0] / blurred[15 * n + 15][0];
        // exp(−1/2) one σ away; the kernel is normalised, to f32.
        assert!((sum - 1.0).abs() < 1e-5 && (ratio - 0.606_53).abs() < 1e-4, "{sum} {ratio}");
        // The kernel ends in 1/(2π σ²) exp(−12.5), 1.5e-7: the edge of a lamp of a thousand times white is invisible.
        assert!(blurred[15 * n + 5][0] > 0.0 && blurred[15 * n + 5][0] < 2e-7 && blurred[15 * n + 4][0] == 0.0);
        assert!(
            gaussian(&[[0.3, 0.7]; 35], 7, 5.0).iter().all(|v| (v[0] - 0.3).abs() < 1e-6 && (v[1] - 0.7).abs() < 1e-6)
        );
    }
}
