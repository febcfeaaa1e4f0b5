//! The edge's profile: a spline through all pixels' distances, and the response that follows.

use super::spline::{SUPPORT, bell, step};
use super::{Edge, SfrError, SfrPoint, SfrSettings};
use crate::linear::Matrix;
use crate::solve::Normal;
use crate::{Estimate, Image};
use core::f64::consts::{PI, TAU};
use etendue_core::maths::f64::{sin, sin_cos};

/// The finest step of the splines, px.
const FINEST_STEP_PX: f64 = 0.25;
/// The widest gap between distances. Steps are wider than gaps, as least squares on evenly clustered distances needs: 0.58 pixels then,
/// where a fit of degree 5 at 0.5 cycles a pixel still keeps aliases below (0.29/0.71)⁶ = 0.5 % of the response.
const WIDEST_GAP_PX: f64 = 0.46;
const STEP_OVER_GAP: f64 = 1.25;
/// How far the fine splines reach unless told, px.
pub(super) const USUAL_REACH_PX: f64 = 10.0;
/// The step of the splines beyond, px, and how far they go.
const COARSE_STEP_PX: f64 = 2.0;
const FARTHEST_PX: f64 = 100.0;
/// How much of the picture's nearer side the profile may change in; the rest is plateau, whose mean the response at 0 rests on.
const CHANGING: f64 = 0.65;
/// Rounds of the refinement at most, the move that ends it, px, and the largest move of a round, px.
const ROUNDS: usize = 30;
const LEAST_MOVE_PX: f64 = 1e-4;
const LARGEST_MOVE_PX: f64 = 2.0;
/// Pixels that differ from the fit by more than so many robust standard deviations (1.4826 times the median of the residuals' magnitudes)
/// and more than so much of the edge's height are defects, and left out; the share of them at most, and how often they are sought.
const OUTLIER_SIGMAS: f64 = 6.0;
const OUTLIER_SHARE: f64 = 0.05;
const MOST_OUTLIERS: f64 = 0.02;
const REJECTIONS: usize = 8;

/// A pixel: its distance from the edge, its row, and its reading.
#[derive(Clone, Copy)]
struct Sample {
    distance: f64,
    row: f64,
    reading: f64,
}

/// A profile fitted to the pixels.
pub(super) struct Profile {
    step_px: f64,
    reach_px: f64,
    /// Coefficients: levels of the fine B-splines of degree 5, whose steps are their differences; then heights of coarse steps.
    values: Vec<f64>,
    /// Their covariance.
    covariance: Matrix,
    /// Where the coarse steps lie, px.
    coarse: Vec<f64>,
    noise: f64,
}

impl Profile {
    /// Fits edge and profile at once, and again without the pixels that are defects.
    pub(super) fn fitted(image: &Image, start: Edge, settings: &SfrSettings) -> Result<(Edge, Self), SfrError> {
        let mut kept = vec![true; image.samples().len()];
        let mut edge = settled(image, start, &kept, settings)?;
        for _ in 0..REJECTIONS {
            let found = regular(image, &edge, &kept, settings)?;
            if found == kept {
                break;
            }
            kept = found;
            edge = settled(image, edge, &kept, settings)?;
        }
        edge.check()?;
        let samples = samples(image, &edge, &kept);
        let knots = Knots::new(image, &edge, &samples, settings)?;
        let profile = knots.profile(&samples).ok_or(SfrError::NoEdge("its profile has gaps"))?;
        profile.check()?;
        Ok((edge, profile))
    }

    /// Whether what was fitted is an edge: residuals below a tenth of its height.
    fn check(&self) -> Result<(), SfrError> {
        let [dark, bright] = self.levels();
        if self.noise.is_nan() || self.noise > 0.1 * (bright - dark) {
            return Err(SfrError::NoEdge(
                "the picture differs from a straight edge by more than a tenth of its height",
            ));
        }
        Ok(())
    }

    /// The steps of the line spread: place, px, width, px, and the coefficients whose difference (or which alone) is the height.
    fn steps(&self) -> impl Iterator<Item = Step> + '_ {
        let fine = self.values.len() - self.coarse.len();
        let place = |j: usize| -self.reach_px + (j as f64 + 0.5 * SUPPORT as f64) * self.step_px;
        let near = (1..fine).map(move |k| Step { at: place(k - 1), width: self.step_px, up: k, down: Some(k - 1) });
        let far = self.coarse.iter().enumerate();
        near.chain(far.map(move |(i, at)| Step { at: *at, width: COARSE_STEP_PX, up: fine + i, down: None }))
    }

    fn height(&self, step: &Step) -> f64 {
        self.values[step.up] - step.down.map_or(0.0, |k| self.values[k])
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
        let value = |s: Step| {
            let climbed = step((distance - s.at) / s.width);
            self.height(&s) * if s.down.is_none() && s.at < 0.0 { climbed - 1.0 } else { climbed }
        };
        self.values[0] + self.steps().map(value).sum::<f64>()
    }

    /// |M(f)|/M(0) and its uncertainty: M(f) = Σ (height of a step) sinc(f h)⁵ exp(−2πi f t) is linear in the coefficients.
    pub(super) fn response(&self, frequency: f64) -> SfrPoint {
        let waves: Vec<(Step, [f64; 2])> = self.steps().map(|s| (s, s.wave(frequency))).collect();
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
            slopes[s.up] += slope;
            s.down.into_iter().for_each(|k| slopes[k] -= slope);
        }
        let variance = self.covariance.form(&slopes).max(0.0);
        SfrPoint { frequency, response: Estimate::new(value, variance.sqrt()) }
    }
}

/// A step of the profile.
#[derive(Clone, Copy)]
struct Step {
    at: f64,
    width: f64,
    up: usize,
    down: Option<usize>,
}

impl Step {
    /// The Fourier transform of its slope.
    fn wave(&self, frequency: f64) -> [f64; 2] {
        let bell = sinc(frequency * self.width);
        let bell = bell * bell * bell * bell * bell;
        let (sine, cosine) = sin_cos(-TAU * frequency * self.at);
        [bell * cosine, bell * sine]
    }
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { sin(PI * x) / (PI * x) }
}

fn samples(image: &Image, edge: &Edge, kept: &[bool]) -> Vec<Sample> {
    let sample = |i: usize| {
        let (x, y) = (i % image.width(), i / image.width());
        let (column, row) = (x as f64 + 0.5, y as f64 + 0.5);
        Sample { distance: edge.distance(column, row), row, reading: f64::from(image.at(x, y)) }
    };
    (0..kept.len()).filter(|i| kept[*i]).map(sample).collect()
}

/// The edge that the pixels fit best: Gauss–Newton on edge and profile together, so that neither holds the other back.
fn settled(image: &Image, start: Edge, kept: &[bool], settings: &SfrSettings) -> Result<Edge, SfrError> {
    let mut edge = start;
    let mut best: Option<(f64, Edge, Vec<f64>)> = None;
    for _ in 0..ROUNDS {
        let samples = samples(image, &edge, kept);
        let knots = Knots::new(image, &edge, &samples, settings)?;
        let (squares, mut by) = knots.correction(&samples, &edge, settings.edge_degree)?;
        // A move that made the fit worse went too far: half of it.
        match best.as_mut().filter(|(least, ..)| squares > *least) {
            Some((_, from, last)) => {
                last.iter_mut().for_each(|v| *v *= 0.5);
                (edge, by) = (from.clone(), last.clone());
            }
            None => best = Some((squares, edge.clone(), by.clone())),
        }
        edge = edge.moved(&by);
        if by.iter().all(|move_px| move_px.abs() < LEAST_MOVE_PX) {
            break;
        }
    }
    Ok(edge)
}

/// Which pixels are no defects, judged by their residuals from the profile of those that were none so far.
fn regular(image: &Image, edge: &Edge, kept: &[bool], settings: &SfrSettings) -> Result<Vec<bool>, SfrError> {
    let believed = samples(image, edge, kept);
    let knots = Knots::new(image, edge, &believed, settings)?;
    let levels = knots.normal(&believed).solve().ok_or(SfrError::NoEdge("its profile has gaps"))?;
    let samples = samples(image, edge, &vec![true; kept.len()]);
    let residuals: Vec<f64> = samples.iter().map(|s| knots.residual(s, &levels).abs()).collect();
    let mut sorted = residuals.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let sigma = 1.4826 * sorted[sorted.len() / 2];
    let [left, right] = knots.plateaus(&levels);
    let limit = (OUTLIER_SIGMAS * sigma).max(OUTLIER_SHARE * (right - left).abs());
    let kept: Vec<bool> = residuals.iter().map(|r| *r <= limit).collect();
    let outliers = kept.iter().filter(|kept| !**kept).count();
    if outliers as f64 > MOST_OUTLIERS * kept.len() as f64 {
        return Err(SfrError::NoEdge("more than a fiftieth of the pixels are far from one straight edge"));
    }
    Ok(kept)
}

/// Where the splines lie.
struct Knots {
    step_px: f64,
    reach_px: f64,
    count: usize,
    coarse: Vec<f64>,
}

impl Knots {
    fn new(image: &Image, edge: &Edge, samples: &[Sample], settings: &SfrSettings) -> Result<Self, SfrError> {
        // Both plateaus must be seen beyond the reach, from somewhere.
        let widest = |sign: f64| samples.iter().map(|s| sign * s.distance).fold(0.0, f64::max) - 1.0;
        let most = widest(1.0).min(widest(-1.0)).min(0.5 * image.width() as f64);
        let reach_px = settings.reach_px.unwrap_or(USUAL_REACH_PX).min(most);
        if reach_px < 2.0 {
            return Err(SfrError::NoEdge("the edge lies too near to the picture's border"));
        }
        let gap_px = widest_gap(samples, reach_px);
        if gap_px > WIDEST_GAP_PX {
            return Err(SfrError::Gaps { gap_px, angle_deg: edge.angle_deg() });
        }
        let step_px = (STEP_OVER_GAP * gap_px).max(FINEST_STEP_PX);
        let count = (2.0 * reach_px / step_px).floor() as usize + 1 - SUPPORT;
        if count < 2 * SUPPORT {
            return Err(SfrError::NoEdge("the edge lies too near to the picture's border"));
        }
        let reach_px = 0.5 * step_px * (count + SUPPORT - 1) as f64;
        Ok(Self { step_px, reach_px, count, coarse: coarse(reach_px, (CHANGING * most).min(FARTHEST_PX)) })
    }

    /// The coefficients that a reading depends on, and how: the fine splines of degree 5 that differ from 0 there (the first and the
    /// last of all are constant outwards), and the coarse steps (those on the left from −1 to 0, those on the right from 0 to 1).
    fn basis(&self, distance: f64) -> (Vec<usize>, Vec<f64>) {
        let u = (distance + self.reach_px) / self.step_px;
        let first = self.first(u);
        let climbed = |k: usize| match k {
            0 => 1.0,
            k if k > self.count => 0.0,
            k => step(u - (k - 1) as f64 - 0.5 * SUPPORT as f64),
        };
        let fine = (first..=first + SUPPORT).map(|k| (k, climbed(k) - climbed(k + 1)));
        let far = self.coarse.iter().zip(self.count + 1..).map(|(at, k)| {
            let climbed = step((distance - at) / COARSE_STEP_PX);
            (k, if *at < 0.0 { climbed - 1.0 } else { climbed })
        });
        fine.chain(far.filter(|(_, value)| *value != 0.0)).unzip()
    }

    fn first(&self, u: f64) -> usize {
        ((u - SUPPORT as f64).ceil().max(0.0) as usize).min(self.count - SUPPORT)
    }

    fn normal(&self, samples: &[Sample]) -> Normal {
        let mut normal = Normal::new(self.count + 1 + self.coarse.len());
        for sample in samples {
            let (places, values) = self.basis(sample.distance);
            normal.add_at(&places, &values, sample.reading, 1.0);
        }
        normal
    }

    fn residual(&self, sample: &Sample, values: &[f64]) -> f64 {
        let (places, slopes) = self.basis(sample.distance);
        sample.reading - places.iter().zip(&slopes).map(|(k, slope)| values[*k] * slope).sum::<f64>()
    }

    /// The move of the edge's coefficients by one step of Gauss–Newton on edge and profile at once. The edge's place alone is the
    /// profile's own (a moved profile is a profile): it follows from the middle of the profile's climb, which keeps it among the fine
    /// splines; where it is far from them the edge is only moved there.
    fn correction(&self, samples: &[Sample], edge: &Edge, degree: usize) -> Result<(f64, Vec<f64>), SfrError> {
        let failed = || SfrError::NoEdge("the edge crosses too few rows");
        let levels = self.normal(samples).solve().ok_or_else(failed)?;
        let mut by = vec![0.0; degree + 1];
        by[0] = self.middle_px(&levels);
        if by[0].abs() > LARGEST_MOVE_PX {
            return Ok((f64::INFINITY, by));
        }
        let linear = levels.len();
        let mut normal = Normal::new(linear + degree);
        let mut squares = 0.0;
        for sample in samples {
            let (mut places, mut values) = self.basis(sample.distance);
            if sample.distance.abs() < self.reach_px {
                let slope = self.slope(sample.distance, &levels);
                places.extend(linear..linear + degree);
                values.extend(edge.sensitivities(sample.row, degree)[1..].iter().map(|s| s * slope));
            }
            let residual = self.residual(sample, &levels);
            squares += residual * residual;
            normal.add_at(&places, &values, residual, 1.0);
        }
        let moves = normal.solve().ok_or_else(failed)?;
        let bounded = |v: &f64| v.clamp(-LARGEST_MOVE_PX, LARGEST_MOVE_PX);
        by[1..].iter_mut().zip(moves[linear..].iter().map(bounded)).for_each(|(b, v)| *b = v);
        Ok((squares, by))
    }

    /// How far the profile may change, px.
    fn extent_px(&self) -> f64 {
        self.coarse.last().map_or(self.reach_px, |at| at + COARSE_STEP_PX)
    }

    /// The profile's readings on both sides.
    fn plateaus(&self, levels: &[f64]) -> [f64; 2] {
        [-self.extent_px(), self.extent_px()].map(|distance| self.value(distance, levels))
    }

    fn value(&self, distance: f64, levels: &[f64]) -> f64 {
        -self.residual(&Sample { distance, row: 0.0, reading: 0.0 }, levels)
    }

    /// Where the profile has climbed half-way, by the share of it that lies nearer to the left plateau; nothing below half a pixel.
    fn middle_px(&self, levels: &[f64]) -> f64 {
        let [left, right] = self.plateaus(levels);
        let (extent, step) = (self.extent_px(), FINEST_STEP_PX);
        let count = (2.0 * extent / step).floor() as usize;
        let at = |i: usize| -extent + (i as f64 + 0.5) * step;
        let nearer = |d: &f64| (self.value(*d, levels) - left) / (right - left) < 0.5;
        let middle = (0..count).map(at).filter(nearer).count() as f64 * step - extent;
        if middle.abs() < 0.5 { 0.0 } else { middle }
    }

    fn slope(&self, distance: f64, levels: &[f64]) -> f64 {
        let u = (distance + self.reach_px) / self.step_px;
        let first = self.first(u);
        let term = |j: usize| (levels[j + 1] - levels[j]) * bell(u - j as f64 - 0.5 * SUPPORT as f64);
        (first..first + SUPPORT).map(term).sum::<f64>() / self.step_px
    }

    fn profile(self, samples: &[Sample]) -> Option<Profile> {
        let normal = self.normal(samples);
        let values = normal.solve()?;
        let inverse = normal.inverse()?;
        let mut meat = Normal::new(values.len());
        let mut squares = 0.0;
        for sample in samples {
            let (places, slopes) = self.basis(sample.distance);
            let residual = self.residual(sample, &values);
            squares += residual * residual;
            meat.add_at(&places, &slopes, 0.0, residual * residual);
        }
        // Parameters use up freedom: the residuals are that much too small.
        let free = samples.len() as f64 - values.len() as f64;
        let bread = inverse.times_symmetric(meat.matrix()).times_symmetric(&inverse);
        let covariance = bread.scaled(samples.len() as f64 / free);
        let (step_px, reach_px, coarse) = (self.step_px, self.reach_px, self.coarse);
        Some(Profile { step_px, reach_px, values, covariance, coarse, noise: (squares / free).sqrt() })
    }
}

/// Places of the coarse steps beyond the fine splines: those whose support leaves the fine splines' range, so that no coarse step is
/// a sum of fine ones (Kraft 1997), as far as there are pixels.
fn coarse(reach_px: f64, most: f64) -> Vec<f64> {
    let first = reach_px - 1.5 * COARSE_STEP_PX;
    let right: Vec<f64> =
        (0..).map(|i| first + f64::from(i) * COARSE_STEP_PX).take_while(|at| at + COARSE_STEP_PX <= most).collect();
    right.iter().map(|at| -at).chain(right.iter().copied()).collect()
}

/// The widest gap between neighbouring distances within the reach.
fn widest_gap(samples: &[Sample], reach_px: f64) -> f64 {
    let mut distances: Vec<f64> = samples.iter().map(|s| s.distance).filter(|d| d.abs() <= reach_px).collect();
    distances.sort_unstable_by(f64::total_cmp);
    distances.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
}
