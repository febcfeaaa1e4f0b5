//! The centroid of a dot, weighted by what it takes away.
//!
//! w = 1 − I/B, B a plane through the background around the dot, over the ellipse of the dot's second moments, enlarged by
//! some pixels for the blurred edge: pixels that are dark in part count in part, and multiplicative shading does not move
//! the centroid. (For bright dots the picture is turned over first, and w = B − I.) The standard uncertainty is what the
//! pixels' own scatter does to the centroid: a variance that goes from that of the background to that of the dot's middle as w
//! does (bright dots have more of it, from their own photons, dark dots less).
//!
//! That, less what the pixels' raster shifts it by ([`sampling`]), is where the disc's centre of area is seen. Perspective and distortion shift it from where the disc's centre is
//! seen; [`disc`](crate::disc) says by how much, once the map from the chart to the picture is known.

use super::sampling::{self, Rim};
use crate::Image;
use crate::linear::{Matrix, Orthogonal};
use core::f64::consts::TAU;
use glam::{DMat2, DVec2};

/// A dark region, roughly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blob {
    pub(super) at: DVec2,
    /// px².
    pub(super) area: f64,
    /// Second moments over the area, px².
    pub(super) covariance: DMat2,
    pub(super) darkest: f64,
}

/// A dot as measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Centroid {
    pub(super) at: DVec2,
    /// Area that takes away as much light as the dot's middle, px².
    pub(super) area: f64,
    pub(super) uncertainty_px: f64,
    pub(super) rim: Rim,
}

/// Weighted sums over pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    origin: Option<DVec2>,
    sum: f64,
    first: DVec2,
    squares: DVec2,
    cross: f64,
}

impl Moments {
    pub(super) fn add(&mut self, pixel: DVec2, weight: f64) {
        let d = pixel - *self.origin.get_or_insert(pixel);
        self.sum += weight;
        self.first += weight * d;
        self.squares += weight * d * d;
        self.cross += weight * d.x * d.y;
    }

    fn mean(&self) -> Option<DVec2> {
        Some(self.origin? + self.first / self.sum).filter(|m| m.is_finite())
    }

    /// A pixel is a square: it adds a twelfth to the variance of its middle.
    pub(super) fn blob(&self) -> Option<Blob> {
        let mean = self.first / self.sum;
        let variance = self.squares / self.sum - mean * mean + 1.0 / 12.0;
        let cross = self.cross / self.sum - mean.x * mean.y;
        let covariance = DMat2::from_cols(DVec2::new(variance.x, cross), DVec2::new(cross, variance.y));
        Some(Blob { at: self.mean()?, area: self.sum, covariance, darkest: 0.0 })
    }
}

/// Room for a blurred edge, and for the background beyond it, px.
const EDGE_PX: f64 = 3.0;
const BACKGROUND_PX: f64 = 1.5;
/// Pixels of the dot's middle whose scatter tells its noise.
const CORE_PX: u64 = 9;

/// The dot of a region; its ellipse may be enlarged `room` times at most. `None` where there is no background or no dot.
pub(super) fn measured(image: &Image, blob: &Blob, room: f64, bright: bool) -> Option<Centroid> {
    let half_trace = 0.5 * (blob.covariance.x_axis.x + blob.covariance.y_axis.y);
    let determinant = blob.covariance.determinant();
    let spread = (half_trace * half_trace - determinant).max(0.0).sqrt();
    let (major, minor) = (2.0 * (half_trace + spread).sqrt(), 2.0 * (half_trace - spread).max(0.0).sqrt());
    let outer = (1.0 + (EDGE_PX + BACKGROUND_PX) / minor).min(room);
    let inner = (outer - BACKGROUND_PX / minor).max(1.0 + 0.5 * (outer - 1.0));
    let inverse = blob.covariance.inverse();
    // In units of the dot's own ellipse.
    let distance = |p: DVec2| 0.5 * (inverse * (p - blob.at)).dot(p - blob.at).max(0.0).sqrt();
    let pixels = around(image, blob.at, outer * major, |p| distance(p) <= outer)?;
    let ring: Vec<(DVec2, f64)> = pixels.iter().filter(|(p, _)| distance(*p) > inner).copied().collect();
    let (plane, noise) = background(&ring, blob)?;
    let taken = |(p, value): &(DVec2, f64)| {
        let level = plane[0] + plane[1] * (p.x - blob.at.x) + plane[2] * (p.y - blob.at.y);
        if bright { level - value } else { 1.0 - value / level }
    };
    let mut moments = Moments::default();
    pixels.iter().for_each(|p| moments.add(p.0, taken(p)));
    let at = moments.mean()?;
    let relative = if bright { noise } else { noise / plane[0] };
    let middle = etendue_stats::Moments::of(pixels.iter().filter(|(p, _)| distance(*p) < 0.5).map(taken));
    let core = middle.mean();
    let around = relative * relative;
    let within = middle.variance().filter(|_| middle.count() >= CORE_PX).unwrap_or(around);
    let variance = |p: &(DVec2, f64)| around + (within - around) * (taken(p) / core).clamp(0.0, 1.0);
    let levers: f64 = pixels.iter().map(|p| (p.0 - at).length_squared() * variance(p)).sum();
    let area = moments.sum / core;
    let uncertainty_px = (0.5 * levers).sqrt() / moments.sum;
    let noise: f64 = pixels.iter().map(variance).sum();
    // Noise adds its variance to w².
    let partial = pixels.iter().map(|p| taken(p) / core).map(|w| w * (1.0 - w)).sum::<f64>() + noise / (core * core);
    // The shape by what every pixel takes away, less the pixel's own variance; a threshold's moments are off by a tenth of a pixel.
    let moved = moments.blob()?.covariance - DMat2::from_diagonal(DVec2::splat(2.0 / 12.0));
    let shape = if moved.determinant() > 0.0 { moved } else { blob.covariance };
    let scale = area / (TAU * 2.0 * shape.determinant().sqrt());
    let half = 2.0 * (scale * DVec2::new(shape.x_axis.x, shape.y_axis.y)).map(|v| v.max(0.0).sqrt());
    let softness_px = partial / sampling::length(half.x, half.y);
    (area > 0.0 && core > 0.0 && uncertainty_px.is_finite()).then_some(Centroid {
        at,
        area,
        uncertainty_px,
        rim: Rim { half, softness_px },
    })
}

/// Centres and values of the pixels that are wanted; `None` where the picture does not hold them all.
fn around(image: &Image, at: DVec2, reach: f64, wanted: impl Fn(DVec2) -> bool) -> Option<Vec<(DVec2, f64)>> {
    let inside = |size: usize, c: f64| c - reach >= 0.0 && c + reach <= size as f64;
    if !(inside(image.width(), at.x) && inside(image.height(), at.y)) {
        return None;
    }
    let range = |c: f64, size: usize| ((c - reach) as usize)..((c + reach).ceil() as usize).min(size);
    let all = range(at.y, image.height()).flat_map(|y| range(at.x, image.width()).map(move |x| (x, y)));
    let placed = all.map(|(x, y)| (DVec2::new(x as f64 + 0.5, y as f64 + 0.5), f64::from(image.at(x, y))));
    Some(placed.filter(|(p, _)| wanted(*p)).collect())
}

/// A plane through the brighter part of the ring (a neighbouring dot's blur may reach into it): level at the dot and slopes,
/// with the standard deviation of a pixel about it.
fn background(ring: &[(DVec2, f64)], blob: &Blob) -> Option<([f64; 3], f64)> {
    const LEAST: usize = 8;
    if ring.len() < LEAST {
        return None;
    }
    let mut levels: Vec<f64> = ring.iter().map(|(_, v)| *v).collect();
    levels.sort_by(f64::total_cmp);
    let typical = levels[levels.len() * 3 / 4];
    let free: Vec<_> = ring.iter().filter(|(_, v)| *v > typical - 0.2 * (typical - blob.darkest)).collect();
    let design = Matrix::from_rows(3, free.iter().map(|(p, _)| [1.0, p.x - blob.at.x, p.y - blob.at.y]));
    let values: Vec<f64> = free.iter().map(|(_, v)| *v).collect();
    let plane = Orthogonal::of(&design, 1e-9)?.solve(&values);
    let variance = plane.residual_squares / (values.len() - 3).max(1) as f64;
    Some(([plane.parameters[0], plane.parameters[1], plane.parameters[2]], variance.sqrt()))
}
