//! Standard normal numbers by inversion.
//!
//! One double word gives one number: u = (52 bits + ½)/2⁵² in (0, 1), then Wichura's quantile (1988, AS 241, PPND16: relative error about 1e-16).
//! Nine in ten samples need no transcendental function. The tails end at ±8.2 standard deviations, where the probability beyond is 2⁻⁵³.

use etendue_core::{maths::f64::ln, random::NoiseStream};

/// Samples the next standard normal number of a stream.
#[must_use]
pub fn standard_normal(stream: &mut NoiseStream) -> f64 {
    let u = ((stream.double_word() >> 12) as f64 + 0.5) * (1.0 / 4_503_599_627_370_496.0);
    quantile(u)
}

/// The quantile of the standard normal distribution at `u` in (0, 1).
fn quantile(u: f64) -> f64 {
    let q = u - 0.5;
    if q.abs() <= 0.425 {
        return q * ratio(&CENTRE, 0.180_625 - q * q);
    }
    let r = (-ln(u.min(1.0 - u))).sqrt();
    let magnitude = if r <= 5.0 { ratio(&SHOULDER, r - 1.6) } else { ratio(&TAIL, r - 5.0) };
    magnitude.copysign(q)
}

/// Coefficients of a numerator and a denominator, constant term first.
type Rational = [[f64; 8]; 2];

fn ratio(coefficients: &Rational, x: f64) -> f64 {
    let [numerator, denominator] = coefficients.each_ref().map(|c| c.iter().rev().fold(0.0, |sum, k| sum * x + k));
    numerator / denominator
}

const CENTRE: Rational = [
    [
        3.387_132_872_796_366_5,
        1.331_416_678_917_843_8e2,
        1.971_590_950_306_551_3e3,
        1.373_169_376_550_946e4,
        4.592_195_393_154_987e4,
        6.726_577_092_700_87e4,
        3.343_057_558_358_813e4,
        2.509_080_928_730_122_7e3,
    ],
    [
        1.0,
        4.231_333_070_160_091e1,
        6.871_870_074_920_579e2,
        5.394_196_021_424_751e3,
        2.121_379_430_158_66e4,
        3.930_789_580_009_271e4,
        2.872_908_573_572_194_3e4,
        5.226_495_278_852_854e3,
    ],
];

const SHOULDER: Rational = [
    [
        1.423_437_110_749_683_5,
        4.630_337_846_156_546,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        2.417_807_251_774_506e-1,
        2.272_384_498_926_918_4e-2,
        7.745_450_142_783_414e-4,
    ],
    [
        1.0,
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        6.897_673_349_851e-1,
        1.481_039_764_274_800_8e-1,
        1.519_866_656_361_645_7e-2,
        5.475_938_084_995_345e-4,
        1.050_750_071_644_416_9e-9,
    ],
];

const TAIL: Rational = [
    [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        2.965_605_718_285_048_7e-1,
        2.653_218_952_657_612_4e-2,
        1.242_660_947_388_078_4e-3,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288e-7,
    ],
    [
        1.0,
        5.998_322_065_558_88e-1,
        1.369_298_809_227_358e-1,
        1.487_536_129_085_061_5e-2,
        7.868_691_311_456_133e-4,
        1.846_318_317_510_054_7e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_8e-15,
    ],
];

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::random::{NoiseDraw, Pixel};
    use etendue_stats::{Moments, chi_square, normal};

    fn stream(seed: u64) -> NoiseStream {
        NoiseStream::new(seed, 0, 0, 0, Pixel { x: 1, y: 2 }, NoiseDraw::Read)
    }

    #[test]
    fn the_quantile_is_that_of_another_method() {
        // The stats crate finds it by Halley's iteration on erfc, to 1e-12.
        for i in 1..2000 {
            let u = f64::from(i) / 2000.0;
            assert!((quantile(u) - normal::quantile(u)).abs() < 1e-12 * normal::quantile(u).abs().max(0.01), "{u}");
        }
        for exponent in [4, 8, 12, 15] {
            let u = (0..exponent).fold(1.0, |u, _| u / 10.0);
            assert!((quantile(u) / normal::quantile(u) - 1.0).abs() < 1e-12, "{u:e}");
        }
        assert!((quantile(f64::EPSILON / 2.0) / -8.209_536_151_601_387 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn draws_are_normal() {
        let mut stream = stream(11);
        let mut counts = [0_u64; 62];
        for _ in 0..400_000 {
            counts[((standard_normal(&mut stream) * 5.0).floor() + 31.0).clamp(0.0, 61.0) as usize] += 1;
        }
        let below = |i: usize| match i {
            0 => 0.0,
            62 => 1.0,
            i => normal::cdf((i as f64 - 31.0) / 5.0),
        };
        let expected: Vec<f64> = (0..62).map(|i| 400_000.0 * (below(i + 1) - below(i))).collect();
        let test = chi_square::goodness_of_fit(&counts, &expected).expect("bins");
        assert!(test.p > 1e-3, "{test:?}");
    }

    #[test]
    fn mean_and_variance() {
        let mut stream = stream(12);
        let moments = Moments::from_values((0..1_000_000).map(|_| standard_normal(&mut stream)));
        // Standard errors 1e-3 and 1.41e-3; four of each.
        assert!(moments.mean().abs() < 4e-3);
        assert!((moments.variance().expect("many") - 1.0).abs() < 5.7e-3);
    }

    #[test]
    fn bits_are_pinned() {
        let mut stream = stream(7);
        let samples = [0; 4].map(|_: i32| standard_normal(&mut stream).to_bits());
        let tails = [1e-3, 1.0 - 1e-9, 1e-14].map(|u| quantile(u).to_bits());
        let actual = [&samples[..], &tails].concat();
        assert_eq!(actual, PINNED, "changed bits change every noisy picture: is it meant?");
    }

    const PINNED: [u64; 7] = [
        4_596_005_683_809_522_291,
        13_827_233_052_823_150_994,
        4_606_034_005_120_705_980,
        13_820_898_708_576_680_028,
        13_837_513_040_186_066_032,
        4_618_438_948_792_017_425,
        13_843_671_896_739_287_092,
    ];
}
