//! Painted textures: functions of texture coordinates, averaged over pixels and written as PNG.

pub mod brick;
pub mod grass;
pub mod ground;
pub mod letters;
pub mod plates;
pub mod roof;
pub mod signs;

use etendue_core::maths::f64 as maths;
use glam::{DVec2, DVec3};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder as _};

/// Sub-samples along each side of a pixel.
const SUBSAMPLES: u32 = 4;

/// A picture of linear colours, row 0 on top.
#[derive(Clone, Debug)]
pub struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<DVec3>,
}

impl Canvas {
    /// Paints `colour(uv)`, u to the right and v up, both in [0, 1), one sample a pixel.
    #[must_use]
    pub fn point(width: u32, height: u32, colour: impl Fn(DVec2) -> DVec3) -> Self {
        Self::sampled(width, height, 1, colour)
    }

    /// Paints `colour(uv)` averaged over the area of each pixel.
    #[must_use]
    pub fn smooth(width: u32, height: u32, colour: impl Fn(DVec2) -> DVec3) -> Self {
        Self::sampled(width, height, SUBSAMPLES, colour)
    }

    fn sampled(width: u32, height: u32, side: u32, colour: impl Fn(DVec2) -> DVec3) -> Self {
        let size = DVec2::new(f64::from(width), f64::from(height));
        let sample = |x: u32, y: u32, i: u32| {
            let at = DVec2::new(f64::from(i % side) + 0.5, f64::from(i / side) + 0.5) / f64::from(side);
            let raster = (DVec2::new(f64::from(x), f64::from(y)) + at) / size;
            colour(DVec2::new(raster.x, 1.0 - raster.y))
        };
        let pixel = |i: u32| {
            let (x, y) = (i % width, i / width);
            (0..side * side).map(|i| sample(x, y, i)).sum::<DVec3>() / f64::from(side * side)
        };
        Self { width, height, pixels: (0..width * height).map(pixel).collect() }
    }

    /// The picture as an 8 bit sRGB PNG.
    #[must_use]
    pub fn png(&self) -> Vec<u8> {
        let bytes: Vec<u8> = self.pixels.iter().flat_map(|pixel| pixel.to_array().map(encode)).collect();
        write_png(&bytes, self.width, self.height, ExtendedColorType::Rgb8)
    }

    /// The picture's first channel as an 8 bit PNG of grey in sRGB coding, in steps of `step` codes.
    #[must_use]
    pub fn grey_png(&self, step: u8) -> Vec<u8> {
        let coarse = |code: u8| (code / step) * step + step / 2;
        let bytes: Vec<u8> = self.pixels.iter().map(|pixel| coarse(encode(pixel.x))).collect();
        write_png(&bytes, self.width, self.height, ExtendedColorType::L8)
    }
}

fn write_png(bytes: &[u8], width: u32, height: u32, kind: ExtendedColorType) -> Vec<u8> {
    let mut png = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive);
    encoder.write_image(bytes, width, height, kind).expect("a PNG is written to memory");
    png
}

/// The sRGB code of a linear value in [0, 1] (IEC 61966-2-1).
fn encode(linear: f64) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let coded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * maths::pow(x, 1.0 / 2.4) - 0.055 };
    (coded * 255.0).round() as u8
}

/// The linear value of an sRGB code in [0, 1] (IEC 61966-2-1).
#[must_use]
pub fn decode(coded: f64) -> f64 {
    if coded <= 0.040_45 { coded / 12.92 } else { maths::pow((coded + 0.055) / 1.055, 2.4) }
}

/// The distance of `p` from the segment a b.
#[must_use]
pub fn segment_distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let t = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
    (p - a - (b - a) * t).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coding_round_trips() {
        for code in 0..=255_u8 {
            assert_eq!(encode(decode(f64::from(code) / 255.0)), code);
        }
    }

    #[test]
    fn row_0_is_the_top() {
        let canvas = Canvas::point(1, 2, |uv| DVec3::splat(uv.y));
        assert!(canvas.pixels[0].x > canvas.pixels[1].x);
    }
}
