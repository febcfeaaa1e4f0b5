//! Bilateral filter (Tomasi & Manduchi 1998): a mean over near pixels of like colour.
//!
//! ```text
//! p′ = Σ w p_i / Σ w,   w = exp(−r²/2σ_s² − d²/2σ_r²)
//! ```
//!
//! r the distance (px, to 2 σ_s), d² the mean over the channels of the squared difference of the two colours. σ_r is a
//! share of white and should be two or three times the noise to be removed; edges much higher than it stay. The noise of
//! one σ_r is the same at all brightnesses: shot noise, which grows with the light, is smoothed less in the lights.

use super::{DetailError, within};
use etendue_core::maths::f32::exp;
use rayon::prelude::*;

/// Widths of the two Gaussians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bilateral {
    /// σ_s, px, above 0 and at most 10.
    pub radius_px: f64,
    /// σ_r, share of white, above 0 and at most 1.
    pub range: f64,
}

impl Bilateral {
    pub(super) fn check(&self) -> Result<(), DetailError> {
        within("radius_px", self.radius_px, 0.0, 10.0, "above 0 and at most 10")?;
        within("range", self.range, 0.0, 1.0, "above 0 and at most 1")
    }

    pub(super) fn apply<const N: usize>(&self, picture: &[[f32; N]], width: usize) -> Vec<[f32; N]> {
        let reach = (2.0 * self.radius_px).ceil() as usize;
        let near = (-0.5 / (self.radius_px * self.radius_px)) as f32;
        let like = (-0.5 / (self.range * self.range * N as f64)) as f32;
        let height = picture.len() / width.max(1);
        let smoothed = |i: usize| {
            let (x, y, centre) = (i % width, i / width, picture[i]);
            let (mut sum, mut total) = ([0.0; N], 0.0);
            for row in y.saturating_sub(reach)..(y + reach + 1).min(height) {
                for column in x.saturating_sub(reach)..(x + reach + 1).min(width) {
                    let v = picture[row * width + column];
                    let (dx, dy) = (column.abs_diff(x) as f32, row.abs_diff(y) as f32);
                    let difference: f32 = (0..N).map(|c| (v[c] - centre[c]) * (v[c] - centre[c])).sum();
                    let weight = exp(near * (dx * dx + dy * dy) + like * difference);
                    (0..N).for_each(|c| sum[c] += weight * v[c]);
                    total += weight;
                }
            }
            sum.map(|s| s / total)
        };
        (0..picture.len()).into_par_iter().map(smoothed).collect()
    }
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

    fn spread(picture: &[[f32; 3]], columns: core::ops::Range<usize>) -> f32 {
        let values: Vec<f32> =
            picture.iter().enumerate().filter(|(i, _)| columns.contains(&(i % 32))).map(|(_, v)| v[1]).collect();
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f32>() / values.len() as f32).sqrt()
    }

    #[test]
    fn noise_falls_and_the_edge_stays() {
        let (before, after) = (noisy_edge(), FILTER.apply(&noisy_edge(), 32));
        assert!(spread(&after, 2..14) < 0.35 * spread(&before, 2..14));
        // Twelve σ_r between the sides: what leaks across is less than e^-70.
        assert!(after.iter().enumerate().all(|(i, v)| (v[0] < 0.25) == (i % 32 < 16)));
        assert!(FILTER.apply(&[[0.4; 3]; 20], 5).iter().flatten().all(|v| (v - 0.4).abs() < 1e-6));
    }

    #[test]
    fn widths_out_of_range_are_refused() {
        assert!(Bilateral { radius_px: 0.0, ..FILTER }.check().is_err());
        assert!(Bilateral { range: f64::NAN, ..FILTER }.check().is_err());
        assert!(FILTER.check().is_ok());
    }
}
