//! sRGB: primaries and transfer curve of IEC 61966-2-1:1999.

use etendue_core::maths;
use std::sync::LazyLock;

/// Tristimulus values of D65, Y = 1, by this crate's tables and grid.
pub const D65_WHITE: [f64; 3] = [0.950_468_573_284_396_8, 1.0, 1.088_829_734_547_443_6];

/// From linear sRGB to XYZ (Y of white 1), row by row.
pub const XYZ_FROM_SRGB: [[f64; 3]; 3] = [
    [0.412_454_586_801_411_56, 0.357_576_568_179_580_06, 0.180_437_418_303_405_18],
    [0.212_671_896_319_477_83, 0.715_153_136_359_160_1, 0.072_174_967_321_362_07],
    [0.019_333_808_756_316_18, 0.119_192_189_393_193_47, 0.950_303_736_397_934],
];

/// From XYZ (Y of white 1) to linear sRGB, row by row.
pub const SRGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.240_468_714_638_092, -1.537_145_415_918_069_3, -0.498_533_648_405_860_34],
    [-0.969_264_700_833_152_6, 1.876_008_271_871_350_9, 0.041_555_960_522_394_72],
    [0.055_643_450_992_453_14, -0.204_025_986_972_328_13, 1.057_225_568_856_608_3],
];

/// Linear sRGB of tristimulus values; outside the gamut a component is negative.
#[must_use]
pub fn linear_srgb_from_xyz(xyz: [f64; 3]) -> [f64; 3] {
    times(&SRGB_FROM_XYZ, xyz)
}

/// Tristimulus values of linear sRGB.
#[must_use]
pub fn xyz_from_linear_srgb(rgb: [f64; 3]) -> [f64; 3] {
    times(&XYZ_FROM_SRGB, rgb)
}

fn times(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// The sRGB transfer curve: linear to encoded, 0 to 0 and 1 to 1. It does not clip: beyond 0 to 1 the curve goes on.
#[must_use]
pub fn encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        (1.055 * f64::from(maths::f32::pow(linear, 1.0 / 2.4)) - 0.055) as f32
    }
}

/// The inverse of [`encode`] (to the standard's own rounding: its two pieces meet within 1e-7).
#[must_use]
pub fn decode(encoded: f32) -> f32 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        maths::f32::pow(((f64::from(encoded) + 0.055) / 1.055) as f32, 2.4)
    }
}

/// [`decode`] of a byte (0 to 255 for 0 to 1), by table.
#[must_use]
pub fn decode_byte(encoded: u8) -> f32 {
    static TABLE: LazyLock<[f32; 256]> = LazyLock::new(|| core::array::from_fn(|i| decode(i as f32 / 255.0)));
    TABLE[usize::from(encoded)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Spectrum, illuminant, observer};

    #[test]
    fn white_is_that_of_the_tables() {
        let xyz = observer::xyz_of_reflectance(&Spectrum::constant(1.0), illuminant::d65());
        for c in 0..3 {
            // Tables are kept in f32: 6e-8 a value, averaged over hundreds.
            assert!((xyz[c] - D65_WHITE[c]).abs() < 5e-8, "{xyz:?}");
        }
        // The standard's white, x = 0.3127, y = 0.3290, rounded to four digits.
        assert!((xyz[0] - 0.3127 / 0.3290).abs() < 3e-4 && (xyz[2] - 0.3583 / 0.3290).abs() < 3e-4);
    }

    #[test]
    fn matrices_have_the_primaries_and_the_white_and_are_inverse() {
        let white = xyz_from_linear_srgb([1.0; 3]);
        for c in 0..3 {
            assert!((white[c] - D65_WHITE[c]).abs() < 1e-14);
        }
        for (i, (x, y)) in [(0.64, 0.33), (0.30, 0.60), (0.15, 0.06)].into_iter().enumerate() {
            let mut primary = [0.0; 3];
            primary[i] = 1.0;
            let xyz = xyz_from_linear_srgb(primary);
            let sum: f64 = xyz.iter().sum();
            assert!((xyz[0] / sum - x).abs() < 1e-14 && (xyz[1] / sum - y).abs() < 1e-14);
            let back = linear_srgb_from_xyz(xyz);
            assert!((0..3).all(|c| (back[c] - primary[c]).abs() < 1e-14), "{back:?}");
        }
    }

    #[test]
    fn the_curve_and_its_inverse_agree_on_every_byte() {
        for byte in 0..=255_u8 {
            let encoded = f32::from(byte) / 255.0;
            // A few rounding errors of f32 at 1, amplified at most 12.92-fold near black.
            assert!((encode(decode(encoded)) - encoded).abs() < 1e-6, "{byte}");
            assert_eq!(decode_byte(byte), decode(encoded));
        }
        assert_eq!((encode(0.0), encode(1.0)), (0.0, 1.0));
        // IEC 61966-2-1: 18 % grey is 0.4614 encoded.
        assert!((encode(0.18) - 0.461_356).abs() < 1e-5);
    }
}
