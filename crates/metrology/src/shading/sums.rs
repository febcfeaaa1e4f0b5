//! Readings of an image, and their sums over rings and blocks.
//!
//! Row and column noise of the sensor, and its effect on the means of rings:
//!
//! A column whose pixels all respond by a fifth of a per cent more (column amplifiers) shifts a ring's mean in proportion to its
//! part of that ring, and does not average out over the column's pixels. With y/m readings over the fitted fall-off, c_x its mean
//! over a column of h pixels and σ² the variance of a pixel beyond its row's and column's (from y's second differences along
//! both, a 36th of their square), neighbouring columns differ by
//!
//! ```text
//! ⟨(c_{x−1} − 2 c_x + c_{x+1})²⟩/6 = τ² + σ²/h
//! ```
//!
//! and the covariance of the rings' means is τ² Σ_x a_kx a_lx with a_kx = m_k n_kx/n_k, m_k the ring's mean, n_kx the pixels of
//! ring k in column x; likewise for rows. Light that varies linearly from column to column does not contribute. If neighbours
//! share noise (`correlation.rs`), its effect on neighbouring columns replaces σ²/h.

use super::correlation::Correlation;
use super::report::{Basis, ShadingSettings, TERMS};
use crate::linear::{Matrix, dot};
use crate::{Image, patch_statistics::neighbour_variances};

/// Sums over the pixels of a ring or block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RegionSums {
    pub(super) count: f64,
    pub(super) reading: f64,
    /// Σ r².
    square: f64,
    /// Sums of the fall-off's terms over the pixels.
    terms: [f64; TERMS],
    pub(super) variance: f64,
    pub(super) pairs: f64,
    /// Number of the ring among those requested.
    pub(super) number: usize,
}

impl RegionSums {
    pub(super) fn add(&mut self, reading: f64, square_position: f64, basis: Basis) {
        self.count += 1.0;
        self.reading += reading;
        self.square += square_position;
        self.terms.iter_mut().zip(basis.at(square_position)).for_each(|(sum, term)| *sum += term);
    }

    pub(super) fn mean(&self) -> f64 {
        self.reading / self.count
    }

    pub(super) fn square_position(&self) -> f64 {
        self.square / self.count
    }

    /// Means of the fall-off's terms.
    pub(super) fn mean_terms(&self) -> [f64; TERMS] {
        self.terms.map(|sum| sum / self.count)
    }

    /// Of the mean reading.
    pub(super) fn standard_uncertainty(&self) -> f64 {
        if self.pairs > 0.0 { (self.variance / self.pairs / self.count).sqrt() } else { f64::INFINITY }
    }

    /// Rings that contain pixels.
    pub(super) fn rings(image: &Image, settings: &ShadingSettings, basis: Basis) -> Vec<Self> {
        let mut rings: Vec<Self> = (0..settings.rings).map(|number| Self { number, ..Self::default() }).collect();
        let square = square_position(image, settings);
        let ring = |square: f64| ring_at(square, settings);
        for (x, y, reading) in readings(image, settings) {
            let square = square(x, y);
            rings[ring(square)].add(reading, square, basis);
        }
        for (x, y, variance) in neighbour_variances(image) {
            let ring = &mut rings[ring(square(x, y))];
            ring.variance += variance;
            ring.pairs += 1.0;
        }
        rings.retain(|ring| ring.count >= 4.0 && ring.pairs >= 2.0);
        rings
    }
}

/// The ring of a squared position.
pub(super) fn ring_at(square: f64, settings: &ShadingSettings) -> usize {
    ((square.sqrt() * settings.rings as f64) as usize).min(settings.rings - 1)
}

pub(super) fn readings(image: &Image, settings: &ShadingSettings) -> impl Iterator<Item = (usize, usize, f64)> {
    let width = image.width();
    image.samples().iter().enumerate().map(move |(i, s)| (i % width, i / width, f64::from(*s) - settings.black))
}

/// Squared distance of a pixel from the centre relative to that of the farthest corner.
pub(super) fn square_position(image: &Image, settings: &ShadingSettings) -> impl Fn(usize, usize) -> f64 + use<> {
    let (width, height) = (image.width() as f64, image.height() as f64);
    let (cx, cy) = settings.centre_px.unwrap_or((0.5 * width, 0.5 * height));
    let farthest = |c: f64, size: f64| c.max(size - c) * c.max(size - c);
    let corner_square = farthest(cx, width) + farthest(cy, height);
    move |x, y| {
        let (x, y) = (x as f64 + 0.5 - cx, y as f64 + 0.5 - cy);
        (x * x + y * y) / corner_square
    }
}

/// Readings relative to a fall-off over squared positions.
pub(super) fn relative(image: &Image, settings: &ShadingSettings, falloff: impl Fn(f64) -> f64) -> Vec<f64> {
    let square = square_position(image, settings);
    readings(image, settings).map(|(x, y, reading)| reading / falloff(square(x, y))).collect()
}

/// The covariance of the rings' means, from readings relative to their fall-off, and from the noise shared by neighbours.
pub(super) fn shared(
    image: &Image,
    settings: &ShadingSettings,
    rings: &[RegionSums],
    relative: &[f64],
    correlation: Option<&Correlation>,
) -> Matrix {
    let (width, height) = (image.width(), image.height());
    let white = white_variance(relative, width);
    let mut covariance = Matrix::zeros(rings.len(), rings.len());
    for (columns, lines, length) in [(true, width, height), (false, height, width)] {
        let line = |i: usize| if columns { i % width } else { i / width };
        let own = correlation.map_or(white, |c| c.line_differences(columns));
        let variance = line_variance(&means(relative, lines, line)) - own / length as f64;
        if variance > 0.0 {
            add(&mut covariance, variance, &line_weights(image, settings, rings, lines, line));
        }
    }
    covariance
}

/// The variance of a pixel without the parts of its row and column.
fn white_variance(relative: &[f64], width: usize) -> f64 {
    let rows: Vec<&[f64]> = relative.chunks_exact(width).collect();
    let along = |row: &[f64], x: usize| row[x - 1] - 2.0 * row[x] + row[x + 1];
    let at = |three: &[&[f64]], x: usize| along(three[0], x) - 2.0 * along(three[1], x) + along(three[2], x);
    let squares = rows.windows(3).flat_map(|three| (1..width - 1).map(move |x| at(three, x) * at(three, x)));
    let (sum, count) = squares.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
    sum / (36.0 * f64::max(count, 1.0))
}

fn means(relative: &[f64], lines: usize, line: impl Fn(usize) -> usize) -> Vec<f64> {
    let mut sums = vec![0.0; lines];
    relative.iter().enumerate().for_each(|(i, value)| sums[line(i)] += value);
    let length = (relative.len() / lines) as f64;
    sums.iter().map(|sum| sum / length).collect()
}

fn line_variance(means: &[f64]) -> f64 {
    let squares = means.windows(3).map(|m| (m[0] - 2.0 * m[1] + m[2]) * (m[0] - 2.0 * m[1] + m[2]));
    squares.sum::<f64>() / (6.0 * (means.len() - 2) as f64)
}

/// Contribution of each line to the mean of each ring.
fn line_weights(
    image: &Image,
    settings: &ShadingSettings,
    rings: &[RegionSums],
    lines: usize,
    line: impl Fn(usize) -> usize,
) -> Vec<Vec<f64>> {
    let mut weights = vec![vec![0.0; lines]; settings.rings];
    let square = square_position(image, settings);
    let width = image.width();
    for i in 0..image.samples().len() {
        weights[ring_at(square(i % width, i / width), settings)][line(i)] += 1.0;
    }
    let scaled = |ring: &RegionSums| weights[ring.number].iter().map(|n| n * ring.mean() / ring.count).collect();
    rings.iter().map(scaled).collect()
}

fn add(covariance: &mut Matrix, variance: f64, weights: &[Vec<f64>]) {
    for (i, a) in weights.iter().enumerate() {
        for (j, b) in weights.iter().enumerate() {
            *covariance.at_mut(i, j) += variance * dot(a, b);
        }
    }
}
