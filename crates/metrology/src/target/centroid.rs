//! The centroid of a dot, weighted by its contrast.
//!
//! w = 1 − I/B, with B a plane through the background around the dot, over the ellipse of the dot's second moments, enlarged by a
//! few pixels for the blurred edge: partly dark pixels count in part, and multiplicative shading does not shift the centroid.
//! (For bright dots the image is inverted first, and w = B − I.) The standard uncertainty is that of the centroid due to the
//! pixels' own scatter. Their variance is interpolated by w between that of the background and that of the dot's centre (bright
//! dots have more of it, from their own photons, dark dots less).
//!
//! The centroid, less its shift by the pixel raster (below), is the image of the disc's centre of area. Perspective and
//! distortion shift it from the image of the disc's centre; [`disc`](crate::patch_statistics) computes this shift, once the map
//! from the chart to the image is known.
//!
//! Effect of sampling by square pixels on the centroid of a disc:
//!
//! A pixel integrates over its square, but counts as if all its light came from its centre. For a disc (an ellipse of half width
//! a along a coordinate, centre c) blurred by a Gaussian of standard deviation s before the pixels, the sum over pixels is off by
//! the harmonics of the raster (Poisson's sum; due to the pixel's own sinc only those along the coordinate itself remain):
//!
//! ```text
//! centroid − c = Σₖ 2 J₁(2πka)/(2πka) · exp(−2π²k²s²) · sin(2πkc)/(πk)        k = 1, 2, …; c in raster coordinates
//! ```
//!
//! This is 0.006 px at most for a sharp disc of 3 px radius, 0.001 px for 10 px. It is small, but equal for all dots of a column;
//! if steps are nearly whole pixels it drifts slowly over the field and resembles distortion.
//!
//! s follows from the edge of the dots: with w the fraction of a pixel that the disc covers, Q = Σ w (1 − w) divided by the
//! perimeter is 1/6 px for a sharp edge and increases as Q² = 1/36 + s²/π, averaged over all dots. A blur of 0.4 px leaves 4 % of
//! the first harmonic.
//!
//! Assumption: pixels without gaps between their apertures, and a nearly Gaussian blur if it is less than half a pixel.

use core::f64::consts::{FRAC_PI_4, PI, TAU};

use etendue_core::maths::f64::{cos, exp, sin_cos};
use glam::{DMat2, DVec2};

use crate::Image;
use crate::linear::{Matrix, Orthogonal};

/// Approximate dark region.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blob {
    pub(super) at: DVec2,
    /// px².
    pub(super) area: f64,
    /// Second moments over the area, px².
    pub(super) covariance: DMat2,
    pub(super) darkest: f64,
}

/// A measured dot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Centroid {
    pub(super) at: DVec2,
    /// Equivalent area at the contrast of the dot's centre, px².
    pub(super) area: f64,
    pub(super) uncertainty_px: f64,
    pub(super) outline: EllipseOutline,
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

    /// A pixel is a square: it adds a twelfth to the variance of its centre.
    pub(super) fn blob(&self) -> Option<Blob> {
        let mean = self.first / self.sum;
        let variance = self.squares / self.sum - mean * mean + 1.0 / 12.0;
        let cross = self.cross / self.sum - mean.x * mean.y;
        let covariance = DMat2::from_cols(DVec2::new(variance.x, cross), DVec2::new(cross, variance.y));
        Some(Blob { at: self.mean()?, area: self.sum, covariance, darkest: 0.0 })
    }
}

/// Margin for a blurred edge, and for the background beyond it, px.
const EDGE_PX: f64 = 3.0;
const BACKGROUND_PX: f64 = 1.5;
/// Number of pixels of the dot's centre whose scatter gives its noise.
const CORE_PX: u64 = 9;

/// Measures the dot of a region; its ellipse may be enlarged `room` times at most. `None` if there is no background or no dot.
pub(super) fn measure_dot(image: &Image, blob: &Blob, room: f64, bright: bool) -> Option<Centroid> {
    let half_variance = 0.5 * (blob.covariance.x_axis.x + blob.covariance.y_axis.y);
    let determinant = blob.covariance.determinant();
    let spread = (half_variance * half_variance - determinant).max(0.0).sqrt();
    let (major, minor) = (2.0 * (half_variance + spread).sqrt(), 2.0 * (half_variance - spread).max(0.0).sqrt());
    let outer = (1.0 + (EDGE_PX + BACKGROUND_PX) / minor).min(room);
    let inner = (outer - BACKGROUND_PX / minor).max(1.0 + 0.5 * (outer - 1.0));
    let inverse = blob.covariance.inverse();
    // In units of the dot's own ellipse.
    let distance = |p: DVec2| 0.5 * (inverse * (p - blob.at)).dot(p - blob.at).max(0.0).sqrt();
    let pixels = pixels_around(image, blob.at, outer * major, |p| distance(p) <= outer)?;
    let ring: Vec<(DVec2, f64)> = pixels.iter().filter(|(p, _)| distance(*p) > inner).copied().collect();
    let (plane, noise) = background(&ring, blob)?;
    let weighted = |(p, value): &(DVec2, f64)| {
        let level = plane[0] + plane[1] * (p.x - blob.at.x) + plane[2] * (p.y - blob.at.y);
        if bright { level - value } else { 1.0 - value / level }
    };
    let mut moments = Moments::default();
    pixels.iter().for_each(|p| moments.add(p.0, weighted(p)));
    let at = moments.mean()?;
    let relative = if bright { noise } else { noise / plane[0] };
    let middle = etendue_stats::Moments::from_values(pixels.iter().filter(|(p, _)| distance(*p) < 0.5).map(weighted));
    let core = middle.mean();
    let around = relative * relative;
    let within = middle.variance().filter(|_| middle.count() >= CORE_PX).unwrap_or(around);
    let variance = |p: &(DVec2, f64)| around + (within - around) * (weighted(p) / core).clamp(0.0, 1.0);
    let moment_sum: f64 = pixels.iter().map(|p| (p.0 - at).length_squared() * variance(p)).sum();
    let area = moments.sum / core;
    let uncertainty_px = (0.5 * moment_sum).sqrt() / moments.sum;
    let noise: f64 = pixels.iter().map(variance).sum();
    // Noise adds its variance to the expectation of w².
    let partial = pixels.iter().map(|p| weighted(p) / core).map(|w| w * (1.0 - w)).sum::<f64>() + noise / (core * core);
    // The shape from the contrast of every pixel, less the pixel's own variance; moments of a thresholded region are off by a tenth
    // of a pixel.
    let moved = moments.blob()?.covariance - DMat2::from_diagonal(DVec2::splat(2.0 / 12.0));
    let shape = if moved.determinant() > 0.0 { moved } else { blob.covariance };
    let scale = area / (TAU * 2.0 * shape.determinant().sqrt());
    let half = 2.0 * (scale * DVec2::new(shape.x_axis.x, shape.y_axis.y)).map(|v| v.max(0.0).sqrt());
    let softness_px = partial / length(half.x, half.y);
    (area > 0.0 && core > 0.0 && uncertainty_px.is_finite()).then_some(Centroid {
        at,
        area,
        uncertainty_px,
        outline: EllipseOutline { half, softness_px },
    })
}

/// Centres and values of the pixels that `wanted` selects; `None` if the image does not contain them all.
fn pixels_around(image: &Image, at: DVec2, reach: f64, includes: impl Fn(DVec2) -> bool) -> Option<Vec<(DVec2, f64)>> {
    let inside = |size: usize, c: f64| c - reach >= 0.0 && c + reach <= size as f64;
    if !(inside(image.width(), at.x) && inside(image.height(), at.y)) {
        return None;
    }
    let range = |c: f64, size: usize| ((c - reach) as usize)..((c + reach).ceil() as usize).min(size);
    let all = range(at.y, image.height()).flat_map(|y| range(at.x, image.width()).map(move |x| (x, y)));
    let placed = all.map(|(x, y)| (DVec2::new(x as f64 + 0.5, y as f64 + 0.5), f64::from(image.at(x, y))));
    Some(placed.filter(|(p, _)| includes(*p)).collect())
}

/// A plane through the brighter part of the ring (a neighbouring dot's blur may extend into it): level at the dot and slopes,
/// with the standard deviation of a pixel about it.
fn background(ring: &[(DVec2, f64)], blob: &Blob) -> Option<([f64; 3], f64)> {
    const MIN_RING_PIXELS: usize = 8;
    if ring.len() < MIN_RING_PIXELS {
        return None;
    }
    let mut levels: Vec<f64> = ring.iter().map(|(_, v)| *v).collect();
    levels.sort_by(f64::total_cmp);
    let typical = levels[levels.len() * 3 / 4];
    let free: Vec<_> = ring.iter().filter(|(_, v)| *v > typical - 0.2 * (typical - blob.darkest)).collect();
    let design = Matrix::from_rows(3, free.iter().map(|(p, _)| [1.0, p.x - blob.at.x, p.y - blob.at.y]));
    let values: Vec<f64> = free.iter().map(|(_, v)| *v).collect();
    let plane = Orthogonal::factor(&design, 1e-9)?.solve(&values);
    let variance = plane.residual_squares / (values.len() - 3).max(1) as f64;
    Some(([plane.parameters[0], plane.parameters[1], plane.parameters[2]], variance.sqrt()))
}

/// Number of corrected harmonics.
const HARMONICS: u32 = 3;
/// Minimum half width, px.
const MIN_PX: f64 = 1.6;
/// Q of a sharp edge, px.
const SHARP_PX: f64 = 1.0 / 6.0;

/// An ellipse from its edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct EllipseOutline {
    /// Half the width and half the height of the upright rectangle around it, px.
    pub(super) half: DVec2,
    /// Q of this one, px: off by a tenth depending on the sub-pixel phase.
    pub(super) softness_px: f64,
}

/// The variance of the blur before the pixels, s², from edges with random sub-pixel phases: by their mean Q.
pub(super) fn blur_px2(outlines: impl Iterator<Item = EllipseOutline>) -> f64 {
    let (sum, count) = outlines.fold((0.0, 0.0), |(sum, count), outline| (sum + outline.softness_px, count + 1.0));
    let softness: f64 = if count > 0.0 { sum / count } else { SHARP_PX };
    PI * (softness * softness - SHARP_PX * SHARP_PX).max(0.0)
}

/// The centre of an ellipse from its centroid.
pub(super) fn centre(centroid: DVec2, outline: &EllipseOutline, blur_px2: f64) -> DVec2 {
    const ROUNDS: usize = 3;
    (0..ROUNDS).fold(centroid, |at, _| centroid - shift(at, outline.half, blur_px2))
}

fn shift(centre: DVec2, half: DVec2, blur_px2: f64) -> DVec2 {
    let along = |a: f64, c: f64| -> f64 {
        let harmonic = |k: f64| {
            let blur = exp(-0.5 * TAU * TAU * k * k * blur_px2);
            disc(TAU * k * a) * blur * sin_cos(TAU * k * c).0 / (PI * k)
        };
        // A shape that is corrupted by noise, or too small for the expansion, is not corrected.
        let is_valid = a.is_finite() && a >= MIN_PX;
        if is_valid { (1..=HARMONICS).map(|k| harmonic(f64::from(k))).sum() } else { 0.0 }
    };
    DVec2::new(along(half.x, centre.x), along(half.y, centre.y))
}

/// 2 J₁(z)/z by Hankel's expansion (Abramowitz & Stegun 9.2.5): to 1e-4 of its size for z ≥ 10, discs of 1.6 px.
fn disc(z: f64) -> f64 {
    let (angle, inverse) = (z - 3.0 * FRAC_PI_4, 1.0 / z);
    let (even, odd) = (1.0 + 15.0 / 128.0 * inverse * inverse, 0.375 * inverse);
    let (sin, _) = sin_cos(angle);
    2.0 * inverse * (2.0 * inverse / PI).sqrt() * (even * cos(angle) - odd * sin)
}

/// The perimeter of an ellipse of these semi-axes (Ramanujan 1914).
pub(super) fn length(a: f64, b: f64) -> f64 {
    PI * (3.0 * (a + b) - ((3.0 * a + b) * (a + 3.0 * b)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_of_a_disc_is_bessel_s() {
        // J₁(12) = −0.2234471045, J₁(40) = 0.1260383181 (Abramowitz & Stegun, table 9.1 and its recurrence).
        assert!((disc(12.0) + 0.223_447_104_5 / 6.0).abs() < 1e-5, "{}", disc(12.0));
        assert!((disc(40.0) - 0.126_038_318_1 / 20.0).abs() < 1e-6, "{}", disc(40.0));
        assert!((length(2.0, 2.0) - 2.0 * TAU).abs() < 1e-12);
    }
}
