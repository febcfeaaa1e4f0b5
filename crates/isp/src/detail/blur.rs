//! Gaussian blur: rows, then columns.
//!
//! The kernel exp(−x²/2σ²) is cut at 5 σ, where it is 4e-6 of its middle (at 3 σ, 1 %, the halo of a lamp would end in a
//! square against the night), and normalised to 1; beside the picture's edge it is normalised over the pixels
//! that exist, so a flat picture stays flat.

use etendue_core::maths::f64::exp;
use rayon::prelude::*;

/// The picture blurred by σ px, channel by channel.
pub(crate) fn gaussian<const N: usize>(picture: &[[f32; N]], width: usize, sigma_px: f64) -> Vec<[f32; N]> {
    let weights = weights(sigma_px);
    let mut across = vec![[0.0; N]; picture.len()];
    across.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, out)| {
        let row = &picture[y * width..][..width];
        for (x, pixel) in out.iter_mut().enumerate() {
            *pixel = mean(&weights, x, width, |i| row[i]);
        }
    });
    let height = picture.len() / width.max(1);
    let mut blurred = vec![[0.0; N]; picture.len()];
    blurred.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, out)| {
        for (x, pixel) in out.iter_mut().enumerate() {
            *pixel = mean(&weights, y, height, |i| across[i * width + x]);
        }
    });
    blurred
}

/// One side of the kernel, from its middle.
fn weights(sigma_px: f64) -> Vec<f32> {
    let reach = (5.0 * sigma_px).ceil() as usize;
    (0..=reach).map(|i| exp(-0.5 * (i as f64 / sigma_px) * (i as f64 / sigma_px)) as f32).collect()
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
        // The kernel ends in 1/(2π σ²) exp(−12.5), 1.5e-7: no edge of a lamp of a thousand times white is seen.
        assert!(blurred[15 * n + 5][0] > 0.0 && blurred[15 * n + 5][0] < 2e-7 && blurred[15 * n + 4][0] == 0.0);
        assert!(
            gaussian(&[[0.3, 0.7]; 35], 7, 5.0).iter().all(|v| (v[0] - 0.3).abs() < 1e-6 && (v[1] - 0.7).abs() < 1e-6)
        );
    }
}
