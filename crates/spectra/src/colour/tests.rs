use super::*;
use crate::{Spectrum, illuminant, observer};

#[test]
fn primaries_of_xyz_and_of_rec_709_are_known() {
    let xyz = Primaries { red: [1.0, 0.0], green: [0.0, 1.0], blue: [0.0, 0.0], white: [1.0 / 3.0; 2] };
    let actual = xyz.to_linear_srgb().expect("a space");
    for (row, expected) in actual.iter().zip(&SRGB_FROM_XYZ) {
        assert!(row.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{row:?}");
    }
    let same = REC_709.to_linear_srgb().expect("a space");
    for (i, row) in same.iter().enumerate() {
        // The standard's white is rounded to four digits.
        assert!(row.iter().enumerate().all(|(j, x)| (x - f64::from(u8::from(i == j))).abs() < 2e-3), "{same:?}");
    }
}

#[test]
fn white_keeps_its_chromaticity() {
    let aces = Primaries { red: [0.713, 0.293], green: [0.165, 0.83], blue: [0.128, 0.044], white: [0.32168, 0.33767] };
    let actual = times(&aces.to_linear_srgb().expect("a space"), [1.0; 3]);
    let expected = linear_srgb_from_xyz([0.32168 / 0.33767, 1.0, (1.0 - 0.32168 - 0.33767) / 0.33767]);
    assert!(actual.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{actual:?} {expected:?}");
}

#[test]
fn what_is_no_colour_space_is_none() {
    let line = Primaries { red: [0.6, 0.3], green: [0.4, 0.3], blue: [0.2, 0.3], white: [0.3, 0.3] };
    assert_eq!(line.to_linear_srgb(), None);
    assert_eq!(Primaries { white: [0.3, 0.0], ..REC_709 }.to_linear_srgb(), None);
    assert_eq!(Primaries { red: [f64::NAN, 0.3], ..REC_709 }.to_linear_srgb(), None);
    assert!(REC_709.is_close_to(&Primaries { white: [0.31271, 0.32902], ..REC_709 }, 5e-4));
}

#[test]
fn white_is_that_of_the_tables() {
    let xyz = observer::xyz_of_reflectance(&Spectrum::constant(1.0), illuminant::d65());
    for c in 0..3 {
        // Tables are stored in f32: 6e-8 per value, averaged over hundreds.
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

#[test]
fn the_weights_are_those_of_the_primaries() {
    assert!((BT709.iter().sum::<f64>() - 1.0).abs() < 1e-15);
    let own = super::XYZ_FROM_SRGB[1];
    assert!(BT709.iter().zip(own).all(|(weight, y)| (weight - y).abs() < 1e-4));
}

type Pair = ([f64; 3], [f64; 3], f64);

/// Table 1 of Sharma, Wu & Dalal 2005: pairs of colours and their differences, as printed.
const PUBLISHED: [Pair; 34] = [
    ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
    ([50.0, 3.1571, -77.2803], [50.0, 0.0, -82.7485], 2.8615),
    ([50.0, 2.8361, -74.02], [50.0, 0.0, -82.7485], 3.4412),
    ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0),
    ([50.0, -1.1848, -84.8006], [50.0, 0.0, -82.7485], 1.0),
    ([50.0, -0.9009, -85.5211], [50.0, 0.0, -82.7485], 1.0),
    ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
    ([50.0, -1.0, 2.0], [50.0, 0.0, 0.0], 2.3669),
    ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0009], 7.1792),
    ([50.0, 2.49, -0.001], [50.0, -2.49, 0.001], 7.1792),
    ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0011], 7.2195),
    ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0012], 7.2195),
    ([50.0, -0.001, 2.49], [50.0, 0.0009, -2.49], 4.8045),
    ([50.0, -0.001, 2.49], [50.0, 0.001, -2.49], 4.8045),
    ([50.0, -0.001, 2.49], [50.0, 0.0011, -2.49], 4.7461),
    ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
    ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
    ([50.0, 2.5, 0.0], [61.0, -5.0, 29.0], 22.8977),
    ([50.0, 2.5, 0.0], [56.0, -27.0, -3.0], 31.903),
    ([50.0, 2.5, 0.0], [58.0, 24.0, 15.0], 19.4535),
    ([50.0, 2.5, 0.0], [50.0, 3.1736, 0.5854], 1.0),
    ([50.0, 2.5, 0.0], [50.0, 3.2972, 0.0], 1.0),
    ([50.0, 2.5, 0.0], [50.0, 1.8634, 0.5757], 1.0),
    ([50.0, 2.5, 0.0], [50.0, 3.2592, 0.335], 1.0),
    ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
    ([63.0109, -31.0961, -5.8663], [62.8187, -29.7946, -4.0864], 1.263),
    ([61.2901, 3.7196, -5.3901], [61.4292, 2.248, -4.962], 1.8731),
    ([35.0831, -44.1164, 3.7933], [35.0232, -40.0716, 1.5901], 1.8645),
    ([22.7233, 20.0904, -46.694], [23.0331, 14.973, -42.5619], 2.0373),
    ([36.4612, 47.858, 18.3852], [36.2715, 50.5065, 21.2231], 1.4146),
    ([90.8027, -2.0831, 1.441], [91.1528, -1.6435, 0.0447], 1.4441),
    ([90.9257, -0.5406, -0.9208], [88.6381, -0.8985, -0.7239], 1.5381),
    ([6.7747, -0.2908, -2.4247], [5.8714, -0.0985, -2.2286], 0.6377),
    ([2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514], 0.9082),
];

#[test]
fn the_published_pairs_have_their_published_differences() {
    for ([l, a, b], [l2, a2, b2], difference) in PUBLISHED {
        let (one, two) = (Lab { l, a, b }, Lab { l: l2, a: a2, b: b2 });
        for actual in [ciede2000(one, two), ciede2000(two, one)] {
            // Printed to four decimals.
            assert!((actual - difference).abs() < 5.1e-5, "{one:?} {two:?}: {actual} for {difference}");
        }
    }
}
