//! Readings of a picture, and their sums over rings and blocks.

use super::basis::{Basis, TERMS};
use super::settings::ShadingSettings;
use crate::Image;
use crate::flat::neighbour_variances;

/// Sums over the pixels of a ring or block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    pub(super) count: f64,
    pub(super) reading: f64,
    /// Σ r².
    square: f64,
    /// Of the fall-off's terms, over the pixels.
    terms: [f64; TERMS],
    pub(super) variance: f64,
    pub(super) pairs: f64,
    /// Which ring it is of those asked for.
    pub(super) number: usize,
}

impl Sums {
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

    /// Of the mean.
    pub(super) fn standard_uncertainty(&self) -> f64 {
        if self.pairs > 0.0 { (self.variance / self.pairs / self.count).sqrt() } else { f64::INFINITY }
    }

    /// Rings that hold pixels.
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
