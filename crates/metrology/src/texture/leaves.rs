//! Response to a texture relative to its reference.
//!
//! y is a camera's image and x the image of the texture itself at the same position, pixel by pixel (for a rendered chart: a
//! sharp render without noise). Over blocks of 64 × 64 pixels that overlap by half, with a Hann window (Welch 1967), radially
//! averaged:
//!
//! ```text
//! S_xx = ⟨|X|²⟩    S_yy = ⟨|Y|²⟩    S_xy = ⟨X* Y⟩
//! response   |S_xy|/S_xx                         preserved part of the texture (Kirk et al. 2014, "dead leaves cross")
//! direct     √((S_yy − S_noise)/S_xx)            texture and artefacts together (Cao, Guichard & Hornung 2009; McElvain et al.
//! 2010)
//! coherence  γ² = |S_xy|²/(S_xx S_yy)            1 if nothing was added
//! u(response) = response √((1 − γ²)/(2 n γ²))    n independent blocks and frequencies (Bendat & Piersol)
//! ```
//!
//! A shift s between the two rotates the phase of S_xy by −2π f·s, which would reduce the response: it is estimated by least
//! squares on the phases (weights |S_xy|²) and removed. Both are relative to their value in the lowest frequency band except
//! zero, so that exposure does not matter. The two differ if noise reduction invents or smears texture.

use core::f64::consts::TAU;

use etendue_core::maths::f64::{atan2, cos, hypot, sin_cos};

use super::TextureError;
use crate::fourier::{Complex, transform};
use crate::{Estimate, Image, linear::Normal, patch_statistics::saturated_percent};

/// Maximum shift between image and reference, px: beyond it blocks overlap their neighbours in the other too much.
const MAX_SHIFT_PX: f64 = 2.0;
/// Numbers of bands for the estimate of the shift, first coarse, then fine.
const SHIFT_BANDS: [usize; 2] = [6, 20];
/// Side of a block, px.
const BLOCK: usize = 64;
/// Bands of frequency from 0 to 0.5 cycles per pixel.
const BANDS: usize = 32;
/// Overlapping blocks and neighbouring bins under a Hann window are correlated: this fraction is independent.
const INDEPENDENT_FRACTION: f64 = 0.25;

/// A band of frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexturePoint {
    /// Cycles per pixel, in any direction.
    pub frequency: f64,
    /// Preserved part of the texture.
    pub response: Estimate,
    /// Structure of any kind relative to the texture's.
    pub direct: f64,
    /// 1 if the image contains only the texture.
    pub coherence: f64,
}

/// Response to a texture, and its shift in the image.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureResponse {
    /// Lowest frequency first.
    pub points: Vec<TexturePoint>,
    /// Shift of the image's texture relative to the reference, to the right and down, px.
    pub shift_px: [f64; 2],
}

/// Measures the response to a texture, lowest frequency first. `noise` is an image of a uniform surface of the same brightness;
/// without it noise counts as structure in `direct`.
///
/// # Errors
/// If sizes differ or are too small, or image and reference have nothing in common.
pub fn measure_texture(
    measured_image: &Image,
    reference: &Image,
    noise: Option<&Image>,
    full_scale: Option<f64>,
) -> Result<TextureResponse, TextureError> {
    let size = |image: &Image| (image.width(), image.height());
    if size(measured_image) != size(reference) || measured_image.width().min(measured_image.height()) < BLOCK {
        return Err(TextureError::Size { least: BLOCK, picture: size(measured_image), reference: size(reference) });
    }
    if measured_image.samples().iter().chain(reference.samples()).any(|s| !s.is_finite()) {
        return Err(TextureError::NotFinite);
    }
    if let Some(percent) = saturated_percent([measured_image], full_scale) {
        return Err(TextureError::Saturated { percent });
    }
    if let Some(small) = noise.filter(|n| n.width().min(n.height()) < BLOCK) {
        return Err(TextureError::Even { least: BLOCK, size: size(small) });
    }
    let sums = SpectrumSums::from_images(reference, measured_image);
    let floor = noise.map(|n| SpectrumSums::from_images(n, n));
    let shift_px = sums.shift_px();
    let points: Vec<TexturePoint> = (1..BANDS).map(|k| sums.point(k, shift_px, floor.as_ref())).collect();
    let first = points[0];
    if first.coherence.is_nan() || first.coherence < 0.2 {
        return Err(TextureError::Unlike);
    }
    if hypot(shift_px[0], shift_px[1]) > MAX_SHIFT_PX {
        return Err(TextureError::Shifted { shift_px });
    }
    let scaled = |p: TexturePoint| TexturePoint {
        response: ratio_over(p.response, first.response),
        direct: p.direct / first.direct,
        ..p
    };
    Ok(TextureResponse { points: points.into_iter().map(scaled).collect(), shift_px })
}

/// A response relative to that of the lowest band, which shares no frequency with it: relative variances add.
fn ratio_over(own: Estimate, first: Estimate) -> Estimate {
    let value = own.value / first.value;
    Estimate::new(value, hypot(own.standard_uncertainty, value * first.standard_uncertainty) / first.value)
}

/// Frequencies of a bin, cycles per pixel along rows and columns.
fn frequency(i: usize) -> [f64; 2] {
    let signed = |k: usize| if k > BLOCK / 2 { k as f64 - BLOCK as f64 } else { k as f64 };
    [i % BLOCK, i / BLOCK].map(|k| signed(k) / BLOCK as f64)
}

fn band(i: usize) -> usize {
    let [u, v] = frequency(i);
    (BLOCK as f64 * hypot(u, v) + 0.5) as usize
}

/// Sums over blocks and bins: of both images by band, of their product by bin.
struct SpectrumSums {
    xx: Vec<f64>,
    yy: Vec<f64>,
    xy: Vec<Complex>,
    bins: Vec<f64>,
    blocks: f64,
}

impl SpectrumSums {
    fn from_images(x: &Image, y: &Image) -> Self {
        let none = || vec![0.0; BANDS];
        let xy = vec![[0.0; 2]; BLOCK * BLOCK];
        let mut sums = Self { xx: none(), yy: none(), xy, bins: none(), blocks: 0.0 };
        let places = |length: usize| (0..=length - BLOCK).step_by(BLOCK / 2);
        for top in places(x.height()) {
            for left in places(x.width()) {
                sums.add(&block(x, left, top), &block(y, left, top));
            }
        }
        sums
    }

    fn add(&mut self, x: &[Complex], y: &[Complex]) {
        self.blocks += 1.0;
        for (i, (a, b)) in x.iter().zip(y).enumerate() {
            let band = band(i);
            if band < BANDS {
                self.bins[band] += 1.0;
                self.xx[band] += a[0] * a[0] + a[1] * a[1];
                self.yy[band] += b[0] * b[0] + b[1] * b[1];
                self.xy[i][0] += a[0] * b[0] + a[1] * b[1];
                self.xy[i][1] += a[0] * b[1] - a[1] * b[0];
            }
        }
    }

    /// The cross spectrum of a bin, corrected for the phase of a shift.
    fn aligned(&self, i: usize, [x, y]: [f64; 2]) -> Complex {
        let [u, v] = frequency(i);
        let (sine, cosine) = sin_cos(TAU * (u * x + v * y));
        let [re, im] = self.xy[i];
        [re * cosine - im * sine, re * sine + im * cosine]
    }

    /// The shift from the phases of the cross spectrum.
    fn shift_px(&self) -> [f64; 2] {
        let mut shift = [0.0; 2];
        for last in SHIFT_BANDS {
            let mut normal = Normal::new(2);
            for i in (0..BLOCK * BLOCK).filter(|i| (1..=last).contains(&band(*i))) {
                let [re, im] = self.aligned(i, shift);
                let row = frequency(i).map(|f| -TAU * f);
                normal.add(&row, atan2(im, re), re * re + im * im);
            }
            let by = normal.solve().unwrap_or_else(|| vec![0.0; 2]);
            shift = [shift[0] + by[0], shift[1] + by[1]];
        }
        shift
    }

    fn point(&self, k: usize, shift_px: [f64; 2], floor: Option<&Self>) -> TexturePoint {
        let bins = (0..BLOCK * BLOCK).filter(|i| band(*i) == k).map(|i| self.aligned(i, shift_px));
        let [re, im] = bins.fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        let cross = hypot(re, im);
        let value = cross / self.xx[k];
        let coherence = cross * cross / (self.xx[k] * self.yy[k]);
        // Half of the bins are redundant: images are real.
        let count = 0.5 * INDEPENDENT_FRACTION * self.bins[k];
        let u = value * ((1.0 - coherence).max(0.0) / (2.0 * coherence * count)).sqrt();
        let noise = floor.map_or(0.0, |f| f.yy[k] / f.blocks * self.blocks);
        TexturePoint {
            frequency: k as f64 / BLOCK as f64,
            response: Estimate::new(value, u),
            direct: ((self.yy[k] - noise).max(0.0) / self.xx[k]).sqrt(),
            coherence,
        }
    }
}

/// The transform of a block less its mean under a Hann window, row by row.
fn block(image: &Image, left: usize, top: usize) -> Vec<Complex> {
    let part = image.part(left, top, BLOCK, BLOCK);
    let mean = part.samples().iter().map(|s| f64::from(*s)).sum::<f64>() / part.samples().len() as f64;
    let window: Vec<f64> = (0..BLOCK).map(|i| 0.5 - 0.5 * cos(TAU * (i as f64 + 0.5) / BLOCK as f64)).collect();
    let value = |(i, s): (usize, &f32)| [(f64::from(*s) - mean) * window[i % BLOCK] * window[i / BLOCK], 0.0];
    let windowed: Vec<Complex> = part.samples().iter().enumerate().map(value).collect();
    let rows: Vec<Vec<Complex>> = windowed.chunks_exact(BLOCK).map(transform).collect();
    let columns: Vec<Vec<Complex>> =
        (0..BLOCK).map(|x| transform(&rows.iter().map(|row| row[x]).collect::<Vec<_>>())).collect();
    (0..BLOCK * BLOCK).map(|i| columns[i % BLOCK][i / BLOCK]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use etendue_core::maths::f64::exp;
    use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};

    fn texture(seed: u64, amplitude: f64) -> Image {
        let sample = |i: usize| {
            let pixel = Pixel { x: (i % 192) as u32, y: (i / 192) as u32 };
            (500.0 + amplitude * (NoiseStream::new(seed, 0, 0, 0, pixel, NoiseDraw::Read).unit_f64() - 0.5)) as f32
        };
        Image::from_samples(192, 192, (0..192 * 192).map(sample).collect()).expect("a square")
    }

    /// Blurred by a Gaussian with samples that sum to 1, with noise added.
    fn blurred(image: &Image, sigma: f64, noise: &Image) -> Image {
        let kernel: Vec<f64> = (-5..=5).map(|k| exp(-0.5 * f64::from(k * k) / (sigma * sigma))).collect();
        let total: f64 = kernel.iter().sum();
        let pass = |image: &Image, step: (i64, i64)| {
            let sample = |i: usize| {
                let (x, y) = ((i % 192) as i64, (i / 192) as i64);
                let at = |k: i64| {
                    let (x, y) = ((x + k * step.0).rem_euclid(192), (y + k * step.1).rem_euclid(192));
                    f64::from(image.at(x as usize, y as usize))
                };
                (kernel.iter().zip(-5..).map(|(w, k)| w * at(k)).sum::<f64>() / total) as f32
            };
            Image::from_samples(192, 192, (0..192 * 192).map(sample).collect()).expect("a square")
        };
        let soft = pass(&pass(image, (1, 0)), (0, 1));
        let sum = soft.samples().iter().zip(noise.samples()).map(|(a, b)| a + b - 500.0).collect();
        Image::from_samples(192, 192, sum).expect("a square")
    }

    #[test]
    fn a_blurred_texture_with_noise_gives_the_blur() {
        let (reference, noise, sigma) = (texture(1, 400.0), texture(2, 40.0), 0.8);
        let points = measure_texture(&blurred(&reference, sigma, &noise), &reference, Some(&noise), None);
        let points = points.expect("a texture").points;
        let truth = |f: f64| exp(-2.0 * PI * PI * sigma * sigma * f * f);
        for point in points.iter().filter(|p| p.frequency <= 0.45) {
            let expected = truth(point.frequency) / truth(points[0].frequency);
            let tolerance = 4.0 * point.response.standard_uncertainty + 0.02;
            assert!((point.response.value - expected).abs() < tolerance, "{point:?} {expected}");
            assert!((point.direct - expected).abs() < 0.08, "{point:?} {expected}");
        }
        // Noise invents structure: coherence falls with the signal.
        assert!(points[0].coherence > 0.95 && points[28].coherence < 0.8, "{points:?}");
        assert_eq!(measure_texture(&texture(3, 400.0), &reference, None, None), Err(TextureError::Unlike));
        // One pixel to the right and one up, on a torus: an integer shift, which affects only the blocks' borders.
        let moved = (0..192 * 192).map(|i| reference.at((i % 192 + 191) % 192, (i / 192 + 1) % 192)).collect();
        let moved = Image::from_samples(192, 192, moved).expect("a square");
        let response = measure_texture(&moved, &reference, None, None).expect("a texture");
        assert!(hypot(response.shift_px[0] - 1.0, response.shift_px[1] + 1.0) < 0.05, "{:?}", response.shift_px);
        for point in &response.points {
            assert!((point.response.value - 1.0).abs() < 0.05 + 4.0 * point.response.standard_uncertainty, "{point:?}");
        }
        let small = measure_texture(&reference, &reference, Some(&noise.part(0, 0, 60, 100)), None);
        assert!(matches!(small, Err(TextureError::Even { .. })), "{small:?}");
        let clipped = measure_texture(&reference, &reference, None, Some(600.0));
        assert!(matches!(clipped, Err(TextureError::Saturated { .. })), "{clipped:?}");
    }
}
