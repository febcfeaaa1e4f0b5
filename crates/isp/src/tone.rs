//! From linear sRGB to what a display takes.

use etendue_core::Plane;
use etendue_core::quantity::{Display, LinearRgb};
use etendue_spectra::colour;

/// Clips to [0, 1] and encodes (IEC 61966-2-1). A NaN stays one here, and is black in 8 bits.
#[must_use]
pub fn encode(linear: &Plane<LinearRgb>) -> Plane<Display> {
    linear.map(|rgb| rgb.map(|v| colour::encode(v.clamp(0.0, 1.0))))
}

#[cfg(test)]
/// 8 bits a channel, row by row: 255 v rounded to the nearest, halves up; of a NaN, 0.
#[must_use]
pub(crate) fn to_8_bit(display: &Plane<Display>) -> Vec<[u8; 3]> {
    display.samples().iter().map(|rgb| rgb.map(|v| (255.0 * v + 0.5) as u8)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_codes() {
        let linear = [[0.0, 0.18, 1.0], [-0.1, 0.5, 1.7], [f32::NAN, 0.002, f32::INFINITY]];
        let plane = Plane::from_samples(3, 1, linear.to_vec()).expect("three pixels");
        // 255 · encode(0.18) = 117.6, of 0.5 = 187.5 (187.516), of 0.002 = 6.59.
        assert_eq!(to_8_bit(&encode(&plane)), [[0, 118, 255], [0, 188, 255], [0, 7, 255]]);
    }
}
