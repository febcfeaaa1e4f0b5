//! The edge's profile and the response that follows.

use super::covariance::Covariance;
use super::knots::{FARTHEST_PX, FINEST_STEP_PX, Knots, STEP_OVER_GAP, Sample, Step};
use super::spline::step;
use super::{Edge, SfrError, SfrPoint};
use crate::{Estimate, Image};
use core::f64::consts::{PI, TAU};
use etendue_core::maths::f64::{sin, sin_cos};

/// The largest response at half the frequency of the profile's sampling: what is beyond is folded back into the response.
const MOST_BEYOND: f64 = 0.03;

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
    /// The profile that the samples fit best between the knots.
    pub(super) fn of(knots: Knots, samples: &[Sample], image: &Image) -> Option<Self> {
        let rows = knots.rows(samples);
        let normal = knots.normal(samples, &rows);
        let values = normal.solve()?;
        let residuals: Vec<f64> = samples.iter().zip(&rows).map(|(s, row)| s.reading - row.dot(&values)).collect();
        // Parameters use up freedom: the residuals are that much too small.
        let free = samples.len() as f64 - values.len() as f64;
        let noise = (residuals.iter().map(|r| r * r).sum::<f64>() / free).sqrt();
        let covariance = Covariance::new(&rows, samples, &residuals, image, &normal.inverse()?);
        let (steps, leftmost) = (knots.steps(), knots.leftmost());
        let Knots { step_px, reach_px, .. } = knots;
        Some(Self { step_px, reach_px, steps, leftmost, values, covariance, noise })
    }

    /// Whether what was fitted is an edge, with residuals below a tenth of its height, and its samples tell it.
    pub(super) fn check(&self, edge: &Edge) -> Result<(), SfrError> {
        let [dark, bright] = self.levels();
        if self.noise.is_nan() || self.noise > 0.1 * (bright - dark) {
            return Err(SfrError::NoEdge(
                "the picture differs from a straight edge by more than a tenth of its height",
            ));
        }
        let gap_px = self.step_px / STEP_OVER_GAP;
        let finest = self.step_px <= FINEST_STEP_PX;
        if !finest && self.response(0.5 / gap_px).response.value > MOST_BEYOND {
            return Err(SfrError::Steep { gap_px, angle_deg: edge.angle_deg() });
        }
        Ok(())
    }

    fn height(&self, step: &Step) -> f64 {
        self.values[step.right] - self.values[step.left]
    }

    pub(super) fn levels(&self) -> [f64; 2] {
        let left = self.reading(-2.0 * FARTHEST_PX);
        let right = self.reading(2.0 * FARTHEST_PX);
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
        let climbed = |s: &Step| self.height(s) * step((distance - s.at) / s.width);
        self.values[self.leftmost] + self.steps.iter().map(climbed).sum::<f64>()
    }

    /// |M(f)|/M(0) and its uncertainty: M(f) = Σ (height of a step) sinc(f h)⁵ exp(−2πi f t) is linear in the coefficients.
    pub(super) fn response(&self, frequency: f64) -> SfrPoint {
        let waves: Vec<(Step, [f64; 2])> = self.steps.iter().map(|s| (*s, wave(s, frequency))).collect();
        let total: f64 = waves.iter().map(|(s, _)| self.height(s)).sum();
        let [re, im] = waves.iter().fold([0.0; 2], |[re, im], (s, wave)| {
            let height = self.height(s);
            [re + height * wave[0], im + height * wave[1]]
        });
        let magnitude = (re * re + im * im).sqrt();
        let value = magnitude / total.abs();
        let mut slopes = vec![0.0; self.values.len()];
        for (s, wave) in &waves {
            // Along its own phase the magnitude is linear in the heights.
            let along = if magnitude > 0.0 { (re * wave[0] + im * wave[1]) / magnitude } else { 0.0 };
            let slope = (along - total.signum() * value) / total.abs();
            slopes[s.right] += slope;
            slopes[s.left] -= slope;
        }
        SfrPoint { frequency, response: Estimate::new(value, self.covariance.variance(&slopes).sqrt()) }
    }
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
