//! Readings of a picture, and their sums over rings and blocks.

use super::settings::ShadingSettings;
use crate::Image;
use crate::flat::neighbour_variances;

/// Sums over the pixels of a ring or block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    pub(super) count: f64,
    pub(super) reading: f64,
    /// Of the positions: Σ 1, Σ r², … Σ r⁸.
    pub(super) powers: [f64; TERMS],
    pub(super) variance: f64,
    pub(super) pairs: f64,
    /// Which ring it is of those asked for.
    pub(super) number: usize,
}

impl Sums {
    pub(super) fn add(&mut self, reading: f64, square_position: f64) {
        self.count += 1.0;
        self.reading += reading;
        self.powers.iter_mut().zip(powers(square_position)).for_each(|(sum, power)| *sum += power);
    }

    pub(super) fn mean(&self) -> f64 {
        self.reading / self.count
    }

    pub(super) fn square_position(&self) -> f64 {
        self.powers[1] / self.count
    }

    /// Means of 1, r², … r⁸.
    pub(super) fn mean_powers(&self) -> [f64; TERMS] {
        self.powers.map(|sum| sum / self.count)
    }

    /// Of the mean.
    pub(super) fn standard_uncertainty(&self) -> f64 {
        if self.pairs > 0.0 { (self.variance / self.pairs / self.count).sqrt() } else { f64::INFINITY }
    }

    /// Rings that hold pixels.
    pub(super) fn rings(image: &Image, settings: &ShadingSettings) -> Vec<Self> {
        let mut rings: Vec<Self> = (0..settings.rings).map(|number| Self { number, ..Self::default() }).collect();
        let square = square_position(image, settings);
        let ring = |square: f64| ring_at(square, settings);
        for (x, y, reading) in readings(image, settings) {
            let square = square(x, y);
            rings[ring(square)].add(reading, square);
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

/// Squared distance of a pixel from the centre over that of the farthest corner.
pub(super) fn square_position(image: &Image, settings: &ShadingSettings) -> impl Fn(usize, usize) -> f64 + use<> {
    let (width, height) = (image.width() as f64, image.height() as f64);
    let (cx, cy) = settings.centre_px.unwrap_or((0.5 * width, 0.5 * height));
    let farthest = |c: f64, size: f64| c.max(size - c) * c.max(size - c);
    let whole = farthest(cx, width) + farthest(cy, height);
    move |x, y| {
        let (x, y) = (x as f64 + 0.5 - cx, y as f64 + 0.5 - cy);
        (x * x + y * y) / whole
    }
}

/// Coefficients of the fall-off: of 1, r², … r⁸.
pub(super) const TERMS: usize = 5;

pub(super) fn powers(square: f64) -> [f64; TERMS] {
    let mut powers = [1.0; TERMS];
    (1..TERMS).for_each(|k| powers[k] = powers[k - 1] * square);
    powers
}
