//! The edge profile and its response.

use core::f64::consts::{PI, TAU};

use etendue_core::maths::f64::{sin, sin_cos};

use super::knots::{Knots, MAX_PX, MIN_STEP_PX, STEP_OVER_GAP, Sample, Step, step};
use super::{Edge, SfrError, SfrPoint, covariance::Covariance};
use crate::{Estimate, Image};

/// Maximum response at half the sampling frequency of the profile: higher frequencies alias into the response.
const MAX_ALIASED_RESPONSE: f64 = 0.03;

/// A profile fitted to the pixels.
pub(super) struct Profile {
    step_px: f64,
    reach_px: f64,
    steps: Vec<Step>,
    /// The level on the far left.
    leftmost: usize,
    /// Levels between the steps.
    values: Vec<f64>,
    /// Their covariance.
    covariance: Covariance,
    noise: f64,
}

impl Profile {
    /// The best-fitting profile of the samples for the knots.
    pub(super) fn fit(knots: Knots, samples: &[Sample], image: &Image) -> Option<Self> {
        let rows = knots.rows(samples);
        let normal = knots.normal(samples, &rows);
        let values = normal.solve()?;
        let residuals: Vec<f64> = samples.iter().zip(&rows).map(|(s, row)| s.reading - row.dot(&values)).collect();
        // Parameters use degrees of freedom: the residuals are too small by this factor.
        let free = samples.len() as f64 - values.len() as f64;
        let noise = (residuals.iter().map(|r| r * r).sum::<f64>() / free).sqrt();
        let covariance = Covariance::new(&rows, samples, &residuals, image, &normal.inverse()?);
        let (steps, leftmost) = (knots.steps(), knots.leftmost());
        let Knots { step_px, reach_px, .. } = knots;
        Some(Self { step_px, reach_px, steps, leftmost, values, covariance, noise })
    }

    /// Checks that the fit is an edge, with residuals below a tenth of its height, and determined by its samples.
    pub(super) fn check(&self, edge: &Edge) -> Result<(), SfrError> {
        let [dark, bright] = self.levels();
        if self.noise.is_nan() || self.noise > 0.1 * (bright - dark) {
            return Err(SfrError::NoEdge("the image differs from a straight edge by more than a tenth of its height"));
        }
        let gap_px = self.step_px / STEP_OVER_GAP;
        let finest = self.step_px <= MIN_STEP_PX;
        if !finest && self.response(0.5 / gap_px).response.value > MAX_ALIASED_RESPONSE {
            return Err(SfrError::Steep { gap_px, angle_deg: edge.angle_deg() });
        }
        Ok(())
    }

    fn height(&self, step: &Step) -> f64 {
        self.values[step.right] - self.values[step.left]
    }

    pub(super) fn levels(&self) -> [f64; 2] {
        let left = self.reading(-2.0 * MAX_PX);
        let right = self.reading(2.0 * MAX_PX);
        [left.min(right), left.max(right)]
    }

    pub(super) fn noise(&self) -> f64 {
        self.noise
    }

    pub(super) fn step_px(&self) -> f64 {
        self.step_px
    }

    /// The profile at every quarter step.
    pub(super) fn samples(&self) -> Vec<(f64, f64)> {
        let count = (8.0 * self.reach_px / self.step_px).floor() as usize;
        let at = |i: usize| -self.reach_px + 2.0 * self.reach_px * i as f64 / count as f64;
        (0..=count).map(at).map(|d| (d, self.reading(d))).collect()
    }

    fn reading(&self, distance: f64) -> f64 {
        let rise = |s: &Step| self.height(s) * step((distance - s.at) / s.width);
        self.values[self.leftmost] + self.steps.iter().map(rise).sum::<f64>()
    }

    /// Normalised magnitude |M(f)|/M(0) and its uncertainty: M(f) = Σ (height of a step) sinc(f h)⁵ exp(−2πi f t) is linear in the
    /// coefficients. Noise perpendicular to M's phase always increases the magnitude. With the variances v along the phase and w
    /// perpendicular to it, w is subtracted from the square, and the magnitude's variance is v + w²/2|M|², v + w at most (second
    /// order of the law of propagation, GUM 5.1.2).
    pub(super) fn response(&self, frequency: f64) -> SfrPoint {
        let waves: Vec<(Step, [f64; 2])> = self.steps.iter().map(|s| (*s, wave(s, frequency))).collect();
        let total: f64 = waves.iter().map(|(s, _)| self.height(s)).sum();
        let [re, im] = waves.iter().fold([0.0; 2], |[re, im], (s, wave)| {
            let height = self.height(s);
            [re + height * wave[0], im + height * wave[1]]
        });
        let magnitude = (re * re + im * im).sqrt();
        let value = magnitude / total.abs();
        let phase = if magnitude > 0.0 { [re / magnitude, im / magnitude] } else { [1.0, 0.0] };
        // Along its own phase the magnitude is linear in the heights.
        let along = |wave: &[f64; 2]| phase[0] * wave[0] + phase[1] * wave[1] - total.signum() * value;
        let across = |wave: &[f64; 2]| phase[0] * wave[1] - phase[1] * wave[0];
        let variance = |part: &dyn Fn(&[f64; 2]) -> f64| {
            let mut slopes = vec![0.0; self.values.len()];
            for (s, wave) in &waves {
                slopes[s.right] += part(wave) / total.abs();
                slopes[s.left] -= part(wave) / total.abs();
            }
            self.covariance.variance(&slopes)
        };
        SfrPoint { frequency, response: magnitude_of(value, variance(&along), variance(&across)) }
    }
}

/// The magnitude of a vector of length `measured`, whose components parallel and perpendicular to itself have these variances.
fn magnitude_of(measured: f64, along: f64, across: f64) -> Estimate {
    let square = measured * measured;
    let second = if 2.0 * square > across { across * across / (2.0 * square) } else { across };
    Estimate::new((square - across).max(0.0).sqrt(), (along + second).sqrt())
}

/// The Fourier transform of a step's slope.
fn wave(step: &Step, frequency: f64) -> [f64; 2] {
    let bell = sinc(frequency * step.width);
    let bell = bell * bell * bell * bell * bell;
    let (sine, cosine) = sin_cos(-TAU * frequency * step.at);
    [bell * cosine, bell * sine]
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { sin(PI * x) / (PI * x) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::maths::f64::{cos, ln};

    /// Independent normal numbers (Box & Muller 1958) by a plain congruential generator (Knuth's constants).
    fn normals(count: usize) -> Vec<f64> {
        let mut state = 20_240_501_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
        };
        (0..count).map(|_| (-2.0 * ln(uniform())).sqrt() * cos(TAU * uniform())).collect()
    }

    /// The interval covers the true value even if the response is as small as its noise, and the square is unbiased.
    #[test]
    fn magnitudes_of_noisy_vectors_cover_the_truth() {
        const SEEDS: usize = 20_000;
        for sigmas in [[1.0, 1.0], [1.0, 0.3], [0.5, 1.0]] {
            for truth in [0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0] {
                let noise = normals(2 * SEEDS);
                let results = noise.chunks(2).map(|n| {
                    let (re, im) = (truth + sigmas[0] * n[0], sigmas[1] * n[1]);
                    let length = (re * re + im * im).sqrt();
                    let (c, s) = (re / length, im / length);
                    let (v, w) = (sigmas[0] * sigmas[0], sigmas[1] * sigmas[1]);
                    magnitude_of(length, v * c * c + w * s * s, v * s * s + w * c * c)
                });
                let estimates: Vec<Estimate> = results.collect();
                let inside =
                    estimates.iter().filter(|e| (e.value - truth).abs() <= 2.0 * e.standard_uncertainty).count();
                let covered = inside as f64 / SEEDS as f64;
                assert!(covered > 0.92, "{sigmas:?} {truth}: {covered}");
                if truth >= 3.0 {
                    let mean = estimates.iter().map(|e| e.value).sum::<f64>() / SEEDS as f64;
                    assert!((mean - truth).abs() < 0.03, "{sigmas:?} {truth}: {mean}");
                }
            }
        }
    }
}
