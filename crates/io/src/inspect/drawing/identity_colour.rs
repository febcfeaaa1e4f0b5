//! A colour for every identity: the same one in every file, and far from that of its neighbours in number.
//!
//! Hues go on by the golden ratio of a turn, which spreads any run of numbers evenly (Knuth, The Art of Computer Programming 3, 6.4), in
//! three lightnesses by turns, at one chroma of Oklab (Ottosson 2020, "A perceptual color space for image processing").

use etendue_core::maths::f64::sin_cos;
use etendue_spectra::colour::encode;

/// (√5 − 1)/2.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
const LIGHTNESS: [f64; 3] = [0.72, 0.56, 0.86];
const CHROMA: f64 = 0.13;

/// The picture of identities.
pub(in crate::inspect) fn of_identities(ids: &[u32]) -> Vec<[u8; 3]> {
    ids.iter().map(|id| identity_colour(*id)).collect()
}

/// The colour of an identity, sRGB bytes; black for 0, the background.
#[must_use]
pub fn identity_colour(id: u32) -> [u8; 3] {
    if id == 0 {
        return [0; 3];
    }
    let turns = f64::from(id) * GOLDEN;
    let (sin, cos) = sin_cos((turns - turns.floor()) * core::f64::consts::TAU);
    let lightness = LIGHTNESS[id as usize % LIGHTNESS.len()];
    let linear = linear_of_oklab(lightness, CHROMA * cos, CHROMA * sin);
    linear.map(|v| (encode(v.clamp(0.0, 1.0) as f32) * 255.0).round() as u8)
}

/// Linear sRGB of Oklab.
fn linear_of_oklab(lightness: f64, a: f64, b: f64) -> [f64; 3] {
    let cubed = |root: f64| root * root * root;
    let l = cubed(lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let m = cubed(lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let s = cubed(lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_spectra::colour::{Lab, ciede2000, decode_byte, lab, xyz_from_linear_srgb};

    fn perceived(id: u32) -> Lab {
        let linear = identity_colour(id).map(|byte| f64::from(decode_byte(byte)));
        lab(xyz_from_linear_srgb(linear), xyz_from_linear_srgb([1.0; 3]))
    }

    #[test]
    fn oklab_has_its_white_and_its_published_red() {
        let white = linear_of_oklab(1.0, 0.0, 0.0);
        assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-6), "{white:?}");
        // sRGB red is L 0.628, a 0.225, b 0.126 (Ottosson 2020, to three digits).
        let red = linear_of_oklab(0.628, 0.225, 0.126);
        assert!((red[0] - 1.0).abs() < 5e-3 && red[1].abs() < 5e-3 && red[2].abs() < 5e-3, "{red:?}");
    }

    #[test]
    fn a_dozen_identities_in_a_row_are_told_apart_and_none_is_black() {
        for first in [1, 2, 40, 1_000, 65_530, 4_000_000_000] {
            for (i, j) in (0..12).flat_map(|i| (0..i).map(move |j| (i, j))) {
                let difference = ciede2000(perceived(first + i), perceived(first + j));
                assert!(difference > 7.0, "{} and {}: {difference}", first + i, first + j);
            }
            assert!(ciede2000(perceived(first), perceived(0)) > 30.0);
        }
        assert_eq!(of_identities(&[0, 7, 7]), [[0; 3], identity_colour(7), identity_colour(7)]);
    }
}
