//! Pictures for looking at, 8 bits, sRGB-encoded.
//!
//! Linear values are divided by their 99th percentile of luminance, so that one lamp does not make everything black, and
//! encoded. NaN becomes magenta, which no exposure hides; +∞ becomes white.

use etendue_spectra::colour::{encode, luma};

use crate::exr::EncodeError;
use crate::png::encode_rgb8;

/// A small picture of a file's contents.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// sRGB bytes, row by row from the top.
    pub rgb: Vec<[u8; 3]>,
}

/// The colour of NaN.
const NAN_COLOUR: [u8; 3] = [255, 0, 255];

impl Preview {
    /// The bytes of a PNG.
    pub fn to_png(&self) -> Result<Vec<u8>, EncodeError> {
        encode_rgb8(self.width, self.height, self.rgb.as_flattened())
    }

    /// Exposes linear sRGB.
    pub(super) fn of_linear(width: usize, height: usize, pixels: &[[f32; 3]]) -> Self {
        let white = white_level(pixels);
        Self { width, height, rgb: pixels.iter().map(|p| byte_pixel(*p, white)).collect() }
    }

    /// One linear channel as grey, exposed so that its 99th percentile is white.
    #[must_use]
    pub fn of_grey(width: usize, height: usize, values: &[f32]) -> Self {
        let pixels: Vec<[f32; 3]> = values.iter().map(|v| [*v; 3]).collect();
        Self::of_linear(width, height, &pixels)
    }
}

/// The 99th percentile of the luminances that are finite and above 0; 1 where there is none.
fn white_level(pixels: &[[f32; 3]]) -> f32 {
    let mut lit: Vec<f32> = pixels.iter().map(|p| luma(*p)).filter(|y| y.is_finite() && *y > 0.0).collect();
    if lit.is_empty() {
        return 1.0;
    }
    let rank = (lit.len() - 1) * 99 / 100;
    *lit.select_nth_unstable_by(rank, f32::total_cmp).1
}

fn byte_pixel(pixel: [f32; 3], white: f32) -> [u8; 3] {
    if pixel.iter().any(|v| v.is_nan()) {
        return NAN_COLOUR;
    }
    pixel.map(|v| (encode((v / white).clamp(0.0, 1.0)) * 255.0).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_99th_percentile_is_white_whatever_the_scale() {
        for scale in [1e-9_f32, 1.0, 1e12] {
            let mut values: Vec<f32> = (1..=100).map(|i| i as f32 * scale).collect();
            values[99] = 1e6 * scale;
            let preview = Preview::of_grey(100, 1, &values);
            assert_eq!(preview.rgb[98], [255; 3], "rank 98 of 0 to 99 is the 99th percentile");
            assert!(preview.rgb[97][0] < 255 && preview.rgb[49][0] > 180);
        }
    }

    #[test]
    fn darkness_and_what_is_not_finite_have_their_colours() {
        assert_eq!(Preview::of_grey(1, 1, &[0.0]).rgb, [[0; 3]]);
        assert_eq!(Preview::of_grey(3, 1, &[f32::NAN, f32::INFINITY, 2.0]).rgb, [NAN_COLOUR, [255; 3], [255; 3]]);
        assert_eq!(Preview::of_grey(2, 1, &[-5.0, 1.0]).rgb, [[0; 3], [255; 3]]);
    }
}
