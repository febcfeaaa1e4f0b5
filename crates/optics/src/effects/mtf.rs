//! A point-spread function from a table of modulation: a sum of non-negative Gaussians.
//!
//! ```text
//! MTF(f) ≈ Σ wᵢ exp(−2π² σᵢ² f²)      wᵢ ≥ 0, Σ wᵢ = 1      σᵢ = 0 and 32 widths from 0.02/f_max to 1.5/f_min
//! ```
//!
//! The weights are those of least squares under wᵢ ≥ 0 (Lawson and Hanson 1974, ch. 23); f_min is the smallest frequency above 0 in the table. Any
//! modulation that falls ever more slowly in f² is such a sum. One that ends, as that of an aberration-free lens at its cut-off, is off by up to
//! 0.04.
//! [`SpreadImageParameters::deviation`] states the error of the resulting samples.
//! A table has no phase and no direction: the function is round, and the same over the image.

use core::f64::consts::PI;

use etendue_core::maths::f64::{cos, exp, ln};

use super::{error::EffectsError, spread_image::SpreadImageParameters};

/// Number of widths in addition to that of a point.
const WIDTHS: u32 = 32;
/// The narrowest width, relative to the largest frequency, and the widest, relative to the smallest.
const MIN_WIDTH: f64 = 0.02;
const MAX_WIDTH: f64 = 1.5;
/// Weight of the sum of one relative to a point of the table.
const SUM_WEIGHT: f64 = 1e3;
/// Samples per pixel.
const SAMPLES_PX: f64 = 4.0;
/// Cycles per sample up to which these are compared with the table: one cycle per pixel, beyond which the pixel's own area passes less than a fifth.
const MAX_COMPARED_FREQUENCY: f64 = 0.25;
/// Cut-off radius of a Gaussian, in its widths.
const REACH: f64 = 5.0;
/// Widths beyond this, px, cannot be distinguished from a constant loss: they are cut.
const MAX_WIDTH_PX: f64 = 24.0;
/// Maximum accepted deviation.
const MAX_DEVIATION: f64 = 0.06;

/// The samples of a point-spread function, the same at all wavelengths, from (frequency, cycles/mm, increasing from 0 or above; modulation, 1 at 0), for
/// pixels of `pixel_um`.
///
/// # Errors
/// If no sum of Gaussians is within 0.06 of the table, up to one cycle per pixel.
pub fn spread_of_modulation(table: &[(f64, f64)], pixel_um: f64) -> Result<SpreadImageParameters, EffectsError> {
    const UM_PER_MM: f64 = 1e3;
    let gaussians = gaussians(table, MAX_WIDTH_PX * pixel_um / UM_PER_MM);
    let pitch_mm = pixel_um / UM_PER_MM / SAMPLES_PX;
    let profiles: Vec<(f64, Vec<f64>)> =
        gaussians.iter().map(|(weight, sigma_mm)| (*weight, profile(*sigma_mm, pitch_mm))).collect();
    let width = profiles.iter().map(|(_, profile)| profile.len()).max().unwrap_or(1);
    let deviation = table
        .iter()
        .filter(|(f, _)| f * pitch_mm <= MAX_COMPARED_FREQUENCY)
        .map(|(f, modulation)| {
            let modelled: f64 = profiles.iter().map(|(weight, p)| weight * transform(p, f * pitch_mm)).sum();
            (modelled - modulation).abs()
        })
        .fold(0.0, f64::max);
    if deviation > MAX_DEVIATION {
        return Err(EffectsError::Modulation { deviation, most: MAX_DEVIATION });
    }
    let mut light = vec![0.0_f32; width * width];
    for (weight, profile) in &profiles {
        let from = (width - profile.len()) / 2;
        for (j, across) in profile.iter().enumerate() {
            for (i, along) in profile.iter().enumerate() {
                light[(from + j) * width + from + i] += (weight * across * along) as f32;
            }
        }
    }
    let pitch_um = pitch_mm * UM_PER_MM;
    let deviation = Some(deviation);
    Ok(SpreadImageParameters { width, light, pitch_um, wavelength_nm: None, deviation })
}

/// Weights and widths, mm, of the Gaussians whose sum best fits a table.
fn gaussians(table: &[(f64, f64)], widest_mm: f64) -> Vec<(f64, f64)> {
    let above = || table.iter().map(|(f, _)| *f).filter(|f| *f > 0.0);
    let (minimum, maximum) = (above().fold(f64::INFINITY, f64::min), above().fold(0.0, f64::max));
    let from = (MIN_WIDTH / maximum).min(0.5 * widest_mm);
    let to = (MAX_WIDTH / minimum).min(widest_mm).max(2.0 * from);
    let width = |i: u32| from * exp(f64::from(i) / f64::from(WIDTHS - 1) * ln(to / from));
    let sigmas: Vec<f64> = core::iter::once(0.0).chain((0..WIDTHS).map(width)).collect();
    let column = |sigma: &f64| {
        let modulation = |(f, _): &(f64, f64)| exp(-2.0 * PI * PI * sigma * sigma * f * f);
        table.iter().map(modulation).chain([SUM_WEIGHT]).collect()
    };
    let columns: Vec<Vec<f64>> = sigmas.iter().map(column).collect();
    let target: Vec<f64> = table.iter().map(|(_, m)| *m).chain([SUM_WEIGHT]).collect();
    let weights = non_negative_least_squares(&columns, &target);
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|w| w / sum).zip(sigmas).filter(|(weight, _)| *weight > 0.0).collect()
}

/// A Gaussian on an odd number of samples about its centre; their sum is one. A Gaussian narrower than the samples resolve has its variance in three
/// of them.
fn profile(sigma_mm: f64, pitch_mm: f64) -> Vec<f64> {
    /// Width from which samples have the modulation of the sampled function to 1e-4.
    const MIN_RESOLVED_WIDTH: f64 = 0.7;
    let width = sigma_mm / pitch_mm;
    if width == 0.0 {
        return vec![1.0];
    }
    if width < MIN_RESOLVED_WIDTH {
        let neighbour = 0.5 * width * width;
        return vec![neighbour, 1.0 - 2.0 * neighbour, neighbour];
    }
    let half = (REACH * width).ceil() as i64;
    let at = |index: i64| index as f64 / width;
    let samples: Vec<f64> = (-half..=half).map(|index| exp(-0.5 * at(index) * at(index))).collect();
    let sum: f64 = samples.iter().sum();
    samples.iter().map(|sample| sample / sum).collect()
}

/// The modulation of samples symmetric about their centre, at a frequency in cycles per sample.
fn transform(samples: &[f64], frequency: f64) -> f64 {
    let middle = (samples.len() / 2) as f64;
    samples.iter().enumerate().map(|(i, sample)| sample * cos(2.0 * PI * frequency * (i as f64 - middle))).sum()
}

/// The x ≥ 0 for which Σ xⱼ columnⱼ is nearest to a target (Lawson and Hanson 1974, algorithm 23.10).
fn non_negative_least_squares(columns: &[Vec<f64>], target: &[f64]) -> Vec<f64> {
    const MIN_RESIDUAL: f64 = 1e-12;
    let mut x = vec![0.0; columns.len()];
    let mut passive: Vec<usize> = Vec::new();
    for _ in 0..3 * columns.len() {
        let residual: Vec<f64> = (0..target.len())
            .map(|row| target[row] - passive.iter().map(|j| columns[*j][row] * x[*j]).sum::<f64>())
            .collect();
        let slope = |j: usize| dot(&columns[j], &residual) / dot(&columns[j], &columns[j]).sqrt();
        let steepest = (0..columns.len()).filter(|j| !passive.contains(j)).map(|j| (j, slope(j)));
        let Some((next, slope)) = steepest.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        if slope <= MIN_RESIDUAL {
            break;
        }
        passive.push(next);
        loop {
            let Some(free) = least_squares(columns, &passive, target) else {
                // The new column is linearly dependent on the others.
                passive.pop();
                return x;
            };
            // As far towards the free solution as no value turns negative.
            let limit = passive.iter().zip(&free).filter(|(_, free)| **free <= 0.0);
            let fraction = limit.map(|(j, free)| x[*j] / (x[*j] - free)).fold(1.0, f64::min);
            passive.iter().zip(&free).for_each(|(j, free)| x[*j] += fraction * (free - x[*j]));
            if fraction >= 1.0 {
                break;
            }
            passive.retain(|j| {
                let stays = x[*j] > MIN_RESIDUAL;
                if !stays {
                    x[*j] = 0.0;
                }
                stays
            });
        }
    }
    x
}

/// The unconstrained solution for some columns, by orthogonalisation (modified Gram and Schmidt); `None` if they depend on each other.
fn least_squares(columns: &[Vec<f64>], chosen: &[usize], target: &[f64]) -> Option<Vec<f64>> {
    const MIN_PIVOT: f64 = 1e-13;
    let count = chosen.len();
    let mut q: Vec<Vec<f64>> = Vec::with_capacity(count);
    let mut r = vec![vec![0.0; count]; count];
    let (mut rest, mut right) = (target.to_vec(), vec![0.0; count]);
    for (k, j) in chosen.iter().enumerate() {
        let mut column = columns[*j].clone();
        let length = dot(&column, &column).sqrt();
        for (i, before) in q.iter().enumerate() {
            r[i][k] = dot(before, &column);
            column.iter_mut().zip(before).for_each(|(c, b)| *c -= r[i][k] * b);
        }
        let left = dot(&column, &column).sqrt();
        if left <= MIN_PIVOT * length {
            return None;
        }
        column.iter_mut().for_each(|c| *c /= left);
        r[k][k] = left;
        right[k] = dot(&column, &rest);
        rest.iter_mut().zip(&column).for_each(|(t, c)| *t -= right[k] * c);
        q.push(column);
    }
    let mut solution = vec![0.0; count];
    for k in (0..count).rev() {
        let known: f64 = (k + 1..count).map(|i| r[k][i] * solution[i]).sum();
        solution[k] = (right[k] - known) / r[k][k];
    }
    Some(solution)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::maths::f64::atan2;

    fn table(maximum: f64, modulation: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        (0..=40).map(|i| f64::from(i) / 40.0).map(|x| (x * maximum, modulation(x))).collect()
    }

    #[test]
    fn modulations_of_lenses_are_followed() {
        let falling = |x: f64| exp(-2.0 * x);
        let gaussian = |x: f64| exp(-3.0 * x * x);
        // A lens without aberrations: to 0.6 of its cut-off, and to the cut-off itself.
        let arc = |x: f64| atan2((1.0 - x * x).sqrt(), x);
        let perfect = |x: f64| 2.0 / PI * (arc(x) - x * (1.0 - x * x).sqrt());
        // Bounds: the residuals of SciPy's nnls with the same widths (0.001164, 0.001719, 0.004616, 0.038201, 1.3e-7), rounded up.
        for (points, bound) in [
            (table(100.0, falling), 0.0012),
            (table(100.0, gaussian), 0.0018),
            (table(60.0, |x| perfect(0.6 * x)), 0.0047),
            (table(100.0, perfect), 0.0383),
            (vec![(0.0, 1.0), (10.0, 0.93), (20.0, 0.84), (30.0, 0.74), (60.0, 0.45), (80.0, 0.3)], 1e-6),
        ] {
            let actual = spread_of_modulation(&points, 4.0).expect("near enough");
            assert!(actual.deviation.is_some_and(|off| off < bound), "{:?} {:?}", actual.deviation, points.last());
            let sum: f64 = actual.light.iter().map(|v| f64::from(*v)).sum();
            assert!((sum - 1.0).abs() < 1e-5 && actual.light.iter().all(|v| *v >= 0.0), "{sum}");
        }
    }

    /// An aberration-free f/2 lens on large pixels, to its cut-off at 3.6 cycles per pixel.
    #[test]
    fn tables_that_reach_beyond_the_samples_are_taken() {
        let arc = |x: f64| atan2((1.0 - x * x).sqrt(), x);
        let perfect = |x: f64| 2.0 / PI * (arc(x) - x * (1.0 - x * x).sqrt());
        let actual = spread_of_modulation(&table(363.6, perfect), 10.0).expect("near enough");
        assert!(actual.deviation.is_some_and(|off| off < 0.03), "{:?}", actual.deviation);
    }

    #[test]
    fn low_frequencies_alone_make_no_wider_samples() {
        for points in [[(0.0, 1.0), (0.005, 0.99), (0.01, 0.97)], [(0.0, 1.0), (0.0005, 0.99), (0.001, 0.97)]] {
            let actual = spread_of_modulation(&points, 5.0).expect("within 0.06 of one");
            assert!(
                f64::from(actual.width as u32) <= 2.0 * REACH * MAX_WIDTH_PX * SAMPLES_PX + 3.0,
                "{}",
                actual.width
            );
        }
    }

    #[test]
    fn a_perfect_modulation_is_a_point_and_one_that_rises_is_refused() {
        let point = spread_of_modulation(&[(0.0, 1.0), (50.0, 1.0), (100.0, 1.0)], 4.0).expect("a point");
        assert_eq!((point.width, point.deviation), (1, Some(0.0)));
        spread_of_modulation(&[(0.0, 1.0), (50.0, 0.2), (100.0, 0.6)], 4.0).expect_err("no lens");
    }
}
