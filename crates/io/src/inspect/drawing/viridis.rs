//! Lengths and disparities as colours: viridis (Smith, van der Walt 2015; in the public domain), whose lightness grows evenly, for people with
//! colour-blindness as well. Seventeen of its colours, with straight lines between.

use super::percentile::percentile;
use etendue_core::maths::f64::ln;

/// Seventeen colours of viridis at even steps, sRGB bytes.
pub const VIRIDIS: [[u8; 3]; 17] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x18, 0x6a],
    [0x47, 0x2d, 0x7b],
    [0x42, 0x40, 0x86],
    [0x3b, 0x52, 0x8b],
    [0x33, 0x63, 0x8d],
    [0x2c, 0x72, 0x8e],
    [0x26, 0x82, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x1f, 0xa0, 0x88],
    [0x28, 0xae, 0x80],
    [0x3f, 0xbc, 0x73],
    [0x5e, 0xc9, 0x62],
    [0x84, 0xd4, 0x4b],
    [0xad, 0xdc, 0x30],
    [0xd8, 0xe2, 0x19],
    [0xfd, 0xe7, 0x25],
];

/// A picture, and the values at the ends of the map.
type Drawn = (Vec<[u8; 3]>, [f32; 2]);

/// The picture of lengths, near yellow and far violet by the logarithm, and the nearest and farthest that have a colour of their own: the
/// 1st and 99th percentile of those above 0.
pub(in crate::inspect) fn of_lengths(lengths: &[f32]) -> Drawn {
    let lit = || lengths.iter().copied().filter(|v| *v > 0.0);
    let [near, far] = [1, 99].map(|percent| percentile(lit(), percent).unwrap_or(1.0));
    let [low, high] = [near, far].map(|v| ln(f64::from(v)));
    let part = |v: f32| if v > 0.0 { 1.0 - share(ln(f64::from(v)), low, high) } else { 1.0 };
    (lengths.iter().map(|v| colour(*v, part)).collect(), [near, far])
}

/// The picture of numbers, small violet and large yellow, and those at the ends: the 1st and 99th percentile.
pub(in crate::inspect) fn of_differences(values: &[f32]) -> Drawn {
    let [low, high] = [1, 99].map(|percent| percentile(values.iter().copied(), percent).unwrap_or(1.0));
    let part = |v: f32| share(f64::from(v), f64::from(low), f64::from(high));
    (values.iter().map(|v| colour(*v, part)).collect(), [low, high])
}

fn share(value: f64, low: f64, high: f64) -> f64 {
    if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 }
}

/// White for what is infinite, magenta for NaN.
fn colour(value: f32, part: impl Fn(f32) -> f64) -> [u8; 3] {
    match value {
        v if v.is_nan() => [255, 0, 255],
        v if v.is_infinite() => [255; 3],
        v => between(part(v)),
    }
}

fn between(part: f64) -> [u8; 3] {
    let place = part * (VIRIDIS.len() - 1) as f64;
    let low = (place as usize).min(VIRIDIS.len() - 2);
    let (from, to) = (VIRIDIS[low], VIRIDIS[low + 1]);
    core::array::from_fn(|i| {
        let (from, to) = (f64::from(from[i]), f64::from(to[i]));
        (from + (to - from) * (place - low as f64)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_spectra::colour::{decode_byte, lab, xyz_from_linear_srgb};

    #[test]
    fn lightness_grows_evenly_along_the_map() {
        let lightness = |part: f64| {
            let linear = between(part).map(|byte| f64::from(decode_byte(byte)));
            lab(xyz_from_linear_srgb(linear), xyz_from_linear_srgb([1.0; 3])).l
        };
        let (first, last) = (lightness(0.0), lightness(1.0));
        // Viridis is even in CAM02-UCS, whose lightness is not quite CIE L*.
        for i in 0..=64 {
            let part = f64::from(i) / 64.0;
            let even = first + (last - first) * part;
            assert!((lightness(part) - even).abs() < 3.0, "{part}: {} for {even}", lightness(part));
        }
    }

    #[test]
    fn lengths_go_by_ratios_and_what_is_not_finite_is_marked() {
        let lengths = [1.0, 10.0, 100.0, f32::INFINITY, f32::NAN, 0.0, -3.0];
        let (rgb, range) = of_lengths(&lengths);
        // Of three values the 99th percentile is the second: ranks are whole.
        assert_eq!(range, [1.0, 10.0]);
        assert_eq!(rgb[..2], [VIRIDIS[16], VIRIDIS[0]]);
        assert_eq!(rgb[2..5], [VIRIDIS[0], [255; 3], [255, 0, 255]]);
        assert_eq!(rgb[5..], [VIRIDIS[16]; 2]);
        let many: Vec<f32> = (0..=200).map(|i| [1.0, 2.0, 4.0][i % 3]).collect();
        assert_eq!(of_lengths(&many).0[1], VIRIDIS[8], "2 is half-way from 1 to 4");
        assert_eq!(of_differences(&[5.0; 4]).0, [VIRIDIS[8]; 4]);
        assert!(of_lengths(&[f32::NAN]).0 == [[255, 0, 255]]);
    }
}
