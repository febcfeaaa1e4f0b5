//! Power spectra of rows and columns of a picture, to see periodic patterns in.
//!
//! EMVA 1288 release 3.1 and 4.0, section on spectrograms: the Fourier transform of each row of the average picture less its mean, over
//! √N, its squared magnitudes averaged over the rows:
//!
//! ```text
//! p[k] = ⟨|Σ_n (y[n] − ȳ) exp(−2πi k n/N)|²/N⟩      k = 0 … N/2, frequency k/N cycles a pixel
//! ```
//!
//! White noise of variance s² has p = s² at every frequency. What L frames leave of temporal noise σ² is its white level σ²/L, which the
//! standard draws as a line.

use crate::fourier::transform;

/// The spectrum along rows (horizontal) of a picture given row by row, DN².
#[must_use]
pub fn horizontal(picture: &[f64], width: usize) -> Vec<f64> {
    let mean = picture.iter().sum::<f64>() / picture.len() as f64;
    spectrum(picture.chunks_exact(width).map(|row| row.iter().map(|y| y - mean).collect()), width)
}

/// The spectrum along columns (vertical), DN².
#[must_use]
pub fn vertical(picture: &[f64], width: usize) -> Vec<f64> {
    let mean = picture.iter().sum::<f64>() / picture.len() as f64;
    let column = |x: usize| picture.iter().skip(x).step_by(width).map(|y| y - mean).collect();
    spectrum((0..width).map(column), picture.len() / width)
}

fn spectrum(lines: impl Iterator<Item = Vec<f64>>, length: usize) -> Vec<f64> {
    let mut sums = vec![0.0; length / 2 + 1];
    let mut count = 0.0;
    for line in lines {
        let transformed = transform(&line.iter().map(|y| [*y, 0.0]).collect::<Vec<_>>());
        for (sum, [re, im]) in sums.iter_mut().zip(&transformed) {
            *sum += re * re + im * im;
        }
        count += 1.0;
    }
    sums.iter().map(|sum| sum / (count * length as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;
    use etendue_core::maths::f64::cos;

    #[test]
    fn a_wave_along_rows_is_one_line() {
        let (width, height) = (30, 12);
        let wave = |x: usize| 5.0 + 2.0 * cos(TAU * 4.0 * x as f64 / 30.0);
        let picture: Vec<f64> = (0..width * height).map(|i| wave(i % width)).collect();
        let power = horizontal(&picture, width);
        // An amplitude of 2 in one of 30 lines: (2/2)² · 30.
        assert!((power[4] - 30.0).abs() < 1e-10, "{power:?}");
        assert!(power.iter().enumerate().all(|(k, p)| k == 4 || p.abs() < 1e-10));
        // Along columns nothing changes: all of it at frequency 0.
        assert!(vertical(&picture, width).iter().skip(1).all(|p| p.abs() < 1e-10));
    }
}
