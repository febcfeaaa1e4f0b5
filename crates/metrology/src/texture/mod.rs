//! Texture: preservation of fine structure by a camera.
//!
//! [`measure_star`]: modulation of a Siemens star over frequency. [`leaves`]: response to a texture with all frequencies, such as
//! dead leaves, relative to its reference.
//!
//! Modulation of a Siemens star.
//!
//! After ISO 12233:2017, annex on the sine-wave star: on the circle of radius r a star of n cycles has the frequency f = n/(2π r) along the
//! circle. The readings of the pixels within half a pixel of the circle, by their angle φ:
//!
//! ```text
//! y = a + b cos n φ + c sin n φ           least squares
//! modulation = √(b² + c²)/a               over that at the outer radius: the response
//! ```
//!
//! A star of hard sectors gives the same: its first harmonic is 4/π of the square wave at every radius. The centre is refined
//! from the given one to the position of maximum modulation, within two pixels. Uncertainty: the covariance of the fit, and that
//! of the outer circle. At n cycles the circle curves by 1/r: the response is that of the tangent's frequency to (n/2πr)²/n² of
//! itself.

pub mod leaves;

use core::f64::consts::TAU;

use etendue_core::maths::f64::{atan2, hypot, sin_cos};

use crate::{Estimate, Image, linear::Normal, patch_statistics::saturated_percent};

/// Reason why texture cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TextureError {
    /// A star outside the image or without cycles.
    #[error(
        "the star must be within the image: expected 4 or more cycles, an outer radius above the inner one, and {0}"
    )]
    Star(&'static str),
    #[error("no star was found at this position: the modulation at the outer radius is {percent:.1} %, below 5 %")]
    NoStar {
        /// Modulation, %.
        percent: f64,
    },
    /// Clipped.
    #[error("{percent:.1} % of the pixels are saturated, which distorts the modulation: expose less")]
    Saturated {
        /// Percentage of saturated pixels.
        percent: f64,
    },
    /// A reading is NaN or infinite.
    #[error("the image contains readings that are not finite: give finite values")]
    NotFinite,
    /// Images of different sizes, or too small ones.
    #[error(
        "image and reference must have the same size of at least {least} × {least} pixels, not {} × {} and {} × {}",
        picture.0, picture.1, reference.0, reference.1
    )]
    Size {
        /// Minimum side.
        least: usize,
        /// Width and height of the image.
        picture: (usize, usize),
        /// Width and height of the reference.
        reference: (usize, usize),
    },
    /// The image for the noise is too small.
    #[error("the image of a uniform surface must have at least {least} × {least} pixels, not {} × {}", size.0, size.1)]
    Even {
        /// Minimum side.
        least: usize,
        /// Width and height.
        size: (usize, usize),
    },
    /// Image and reference are displaced.
    #[error("the texture in the image is {:.1} px right of and {:.1} px below its position in the reference: give a reference of the same region, within \
        2 px", shift_px[0], shift_px[1])]
    Shifted {
        /// To the right and down, px.
        shift_px: [f64; 2],
    },
    /// The reference has no texture, or the image another one.
    #[error(
        "image and reference have no common texture: give a reference of the same region, pixel by pixel. A reference is a sharp render without noise: \
         `set` output.radiance=true writes radiance.exr"
    )]
    Unlike,
}

/// A star in an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Star {
    /// Centre, raster coordinates, px.
    pub centre_px: (f64, f64),
    /// Number of dark and bright cycles around the circle.
    pub cycles: u32,
    /// Radius of the smallest circle, px.
    pub inner_px: f64,
    /// Radius of the largest circle, px.
    pub outer_px: f64,
    /// Reading without light.
    pub black: f64,
    /// Reading of a saturated pixel.
    pub full_scale: Option<f64>,
}

/// Modulation of a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StarPoint {
    pub radius_px: f64,
    /// Cycles per pixel along it.
    pub frequency: f64,
    /// Modulation relative to that of the outer circle.
    pub response: Estimate,
}

/// Measures the response of a star, lowest frequency first, and its refined centre.
///
/// # Errors
/// If the star is outside the image or has no modulation.
pub fn measure_star(image: &Image, star: &Star) -> Result<(Vec<StarPoint>, (f64, f64)), TextureError> {
    check(image, star)?;
    let star = Star { centre_px: refined(image, star), ..*star };
    let steps = (star.outer_px - star.inner_px).floor() as usize;
    let radius = |i: usize| star.outer_px - i as f64;
    let circles: Vec<(f64, Estimate)> =
        (0..=steps).filter_map(|i| modulation(image, &star, radius(i)).map(|m| (radius(i), m))).collect();
    let outer = circles.first().ok_or(TextureError::Star("pixels on its circles"))?.1;
    if outer.value < 0.05 {
        return Err(TextureError::NoStar { percent: 100.0 * outer.value });
    }
    // For n pixels, a wave of amplitude A in noise σ has u² = 2 σ²/(n a²) and contains A²/2 of A²/2 + σ².
    let (squared, u) = (outer.value * outer.value, outer.standard_uncertainty);
    if squared < MIN_EXPLAINED * (squared + u * u * TAU * star.outer_px) {
        return Err(TextureError::Star(
            "a wave of that number of cycles around a centre within two pixels of the given one",
        ));
    }
    let point = |(i, (radius_px, modulation)): (usize, &(f64, Estimate))| {
        let value = modulation.value / outer.value;
        let (own, shared) = (modulation.standard_uncertainty, value * outer.standard_uncertainty);
        let u = if i == 0 { 0.0 } else { hypot(own, shared) / outer.value };
        let frequency = f64::from(star.cycles) / (TAU * radius_px);
        StarPoint { radius_px: *radius_px, frequency, response: Estimate::new(value, u) }
    };
    Ok((circles.iter().enumerate().map(point).collect(), star.centre_px))
}

fn check(image: &Image, star: &Star) -> Result<(), TextureError> {
    if image.samples().iter().any(|s| !s.is_finite()) {
        return Err(TextureError::NotFinite);
    }
    let (x, y) = star.centre_px;
    let (width, height) = (image.width() as f64, image.height() as f64);
    let room = x.min(y).min(width - x).min(height - y);
    let is_valid = star.cycles >= 4 && star.inner_px >= 1.0 && star.outer_px >= star.inner_px + 2.0;
    if !is_valid {
        return Err(TextureError::Star("an inner radius of one pixel or more"));
    }
    // The refined centre may be two pixels off.
    if room.is_nan() || room < star.outer_px + 2.5 {
        return Err(TextureError::Star("2.5 pixels between its outer circle and the border"));
    }
    let side = (2.0 * star.outer_px).ceil() as usize;
    let region = image.part((x - star.outer_px) as usize, (y - star.outer_px) as usize, side, side);
    match saturated_percent([&region], star.full_scale) {
        Some(percent) => Err(TextureError::Saturated { percent }),
        None => Ok(()),
    }
}

/// Minimum fraction of the outer circle's variance in the wave: hard sectors leave 8/π² of it, a wrong centre next to none.
const MIN_EXPLAINED: f64 = 0.5;
/// Maximum distance of the refined centre from the given one, px.
const MAX_PX: f64 = 2.0;

/// Modulation of the pixels within half a pixel of a circle.
fn modulation(image: &Image, star: &Star, radius: f64) -> Option<Estimate> {
    let (cx, cy) = star.centre_px;
    let mut normal = Normal::new(3);
    let mut pixels = Vec::new();
    let range = |c: f64| (c - radius - 1.0).max(0.0) as usize..=(c + radius + 1.0) as usize;
    for y in range(cy) {
        for x in range(cx) {
            let (dx, dy) = (x as f64 + 0.5 - cx, y as f64 + 0.5 - cy);
            if (hypot(dx, dy) - radius).abs() <= 0.5 && x < image.width() && y < image.height() {
                let (sine, cosine) = sin_cos(f64::from(star.cycles) * atan2(dy, dx));
                let (row, reading) = ([1.0, cosine, sine], f64::from(image.at(x, y)) - star.black);
                normal.add(&row, reading, 1.0);
                pixels.push((row, reading));
            }
        }
    }
    // Fewer than two pixels per cycle cannot sample the wave.
    if pixels.len() < 6 {
        return None;
    }
    let (fit, inverse) = (normal.solve()?, normal.inverse()?);
    let residual = |(row, reading): &([f64; 3], f64)| reading - (0..3).map(|k| row[k] * fit[k]).sum::<f64>();
    let variance = pixels.iter().map(|p| residual(p) * residual(p)).sum::<f64>() / (pixels.len() as f64 - 3.0);
    let [a, b, c] = [fit[0], fit[1], fit[2]];
    let amplitude = hypot(b, c);
    if a <= 0.0 || amplitude <= 0.0 {
        return None;
    }
    let slopes = [-amplitude / (a * a), b / (amplitude * a), c / (amplitude * a)];
    let spread = inverse.form(&slopes);
    Some(Estimate::new(amplitude / a, (variance * spread).max(0.0).sqrt()))
}

/// The centre of maximum modulation on the inner half of the circles, where it is most sensitive: by halving steps.
fn refined(image: &Image, star: &Star) -> (f64, f64) {
    let radii = [0.3, 0.4, 0.5, 0.6].map(|fraction| star.inner_px + fraction * (star.outer_px - star.inner_px));
    let merit = |centre_px: (f64, f64)| {
        let star = Star { centre_px, ..*star };
        radii.iter().filter_map(|r| modulation(image, &star, *r)).map(|m| m.value).sum::<f64>()
    };
    let (mut best, mut step) = ((star.centre_px, merit(star.centre_px)), 1.0);
    while step > 0.01 {
        let (x, y) = best.0;
        let around = [(x + step, y), (x - step, y), (x, y + step), (x, y - step)];
        let better = around.into_iter().map(|c| (c, merit(c))).fold(best, |a, b| if b.1 > a.1 { b } else { a });
        let near = hypot(better.0.0 - star.centre_px.0, better.0.1 - star.centre_px.1) <= MAX_PX;
        if better.1 > best.1 && near {
            best = better;
        } else {
            step *= 0.5;
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use etendue_core::maths::f64::{exp, sin};

    use super::*;

    /// A star blurred by a Gaussian (exact from its local frequency for many cycles) and a square pixel (by 6 × 6 points).
    fn star_image(centre_x: f64, centre_y: f64, cycles: f64, sigma: f64) -> Image {
        let at = |x: f64, y: f64| {
            let (dx, dy) = (x - centre_x, y - centre_y);
            let f = cycles / (TAU * hypot(dx, dy).max(1.0));
            let blur = exp(-2.0 * PI * PI * sigma * sigma * f * f);
            1000.0 * (1.0 + 0.8 * blur * sin_cos(cycles * atan2(dy, dx)).1)
        };
        let points = || (0..36).map(|k| (f64::from(k % 6) / 6.0 + 1.0 / 12.0, f64::from(k / 6) / 6.0 + 1.0 / 12.0));
        let pixel = |i: usize| {
            let (x, y) = ((i % 160) as f64, (i / 160) as f64);
            (points().map(|(dx, dy)| at(x + dx, y + dy)).sum::<f64>() / 36.0 + 100.0) as f32
        };
        Image::from_samples(160, 160, (0..160 * 160).map(pixel).collect()).expect("a square")
    }

    #[test]
    fn a_star_gives_the_response_of_lens_and_pixel() {
        let (centre, sigma) = ((80.6, 79.2), 0.5);
        let image = star_image(centre.0, centre.1, 48.0, sigma);
        let star = Star {
            centre_px: (80.0, 80.0),
            cycles: 48,
            inner_px: 20.0,
            outer_px: 75.0,
            black: 100.0,
            full_scale: None,
        };
        let (points, fitted_star) = measure_star(&image, &star).expect("a star");
        assert!(hypot(fitted_star.0 - centre.0, fitted_star.1 - centre.1) < 0.05, "{fitted_star:?}");
        // The square pixel, averaged over the directions of the tangent.
        let sinc = |x: f64| if x == 0.0 { 1.0 } else { sin(PI * x) / (PI * x) };
        let aperture = |f: f64| {
            let angle = |k: i32| TAU * (f64::from(k) + 0.5) / 64.0;
            (0..64).map(angle).map(|a| sinc(f * sin_cos(a).0) * sinc(f * sin_cos(a).1)).sum::<f64>() / 64.0
        };
        let truth = |f: f64| exp(-2.0 * PI * PI * sigma * sigma * f * f) * aperture(f);
        let outer = truth(points[0].frequency);
        for point in &points {
            let error = point.response.value - truth(point.frequency) / outer;
            assert!(error.abs() < 0.01, "{point:?} {error}");
        }
    }

    #[test]
    fn what_is_no_star_is_refused() {
        let star =
            Star { centre_px: (80.0, 80.0), cycles: 48, inner_px: 20.0, outer_px: 75.0, black: 0.0, full_scale: None };
        let uniform = Image::filled(160, 160, 7.0);
        assert!(matches!(measure_star(&uniform, &star), Err(TextureError::NoStar { .. } | TextureError::Star(_))));
        let large = Star { outer_px: 79.0, ..star };
        assert!(matches!(measure_star(&uniform, &large), Err(TextureError::Star(_))));
        let image = star_image(82.9, 79.3, 48.0, 0.5);
        let outside = measure_star(&image, &Star { outer_px: 70.0, ..star });
        assert!(matches!(outside, Err(TextureError::NoStar { .. } | TextureError::Star(_))), "{outside:?}");
        let clipped = Star { full_scale: Some(1500.0), ..star };
        let bright = star_image(star.centre_px.0, star.centre_px.1, 48.0, 0.5);
        assert!(matches!(measure_star(&bright, &clipped), Err(TextureError::Saturated { .. })));
    }
}
