//! Extreme cases: zero time, a million seconds, no light, far too much light, wells of an electron, ADCs of one bit, and the resulting statistics.
//!
//! Frames have 256² pixels: a mean is known to σ/256, a variance of normal numbers to √2/256 = 0.55 %, a fraction s to √(s (1 − s))/256; the
//! tolerance is four of each.

use etendue_stats::normal;

use super::tests::{expose, moments, one_dn_an_electron};
use crate::{parameters::SensorParameters, parameters::tests::ideal};

const SIZE: usize = 256;
const N: f64 = (SIZE * SIZE) as f64;

/// Checks mean (above black) and variance of a flat frame, DN.
#[track_caller]
fn has(p: SensorParameters, mean_e: f32, mean_dn: f64, variance_dn2: f64) {
    let m = moments(&expose(p, mean_e, SIZE));
    let variance = m.variance().expect("many");
    assert!((m.mean() - mean_dn).abs() <= 4.0 * (variance_dn2 / N).sqrt(), "{} for {mean_dn}", m.mean());
    assert!((variance - variance_dn2).abs() <= 4.0 * variance_dn2 * (2.0 / N).sqrt(), "{variance} for {variance_dn2}");
}

/// Checks the fraction of the pixels of a flat frame that have the number.
#[track_caller]
fn check_fraction(p: SensorParameters, mean_e: f32, dn: u32, expected: f64) {
    let raw = expose(p, mean_e, SIZE);
    let actual = raw.plane.samples().iter().filter(|v| **v == dn).count() as f64 / N;
    let tolerance = 4.0 * (expected * (1.0 - expected) / N).sqrt();
    assert!((actual - expected).abs() <= tolerance, "{actual} for {expected}");
}

#[test]
fn no_time_and_no_light_leave_the_read_noise() {
    // K²σ² + 1/12.
    let dark_dn2 = 0.0625 * 25.0 + 1.0 / 12.0;
    has(ideal(), 0.0, 0.0, dark_dn2);
    let mut p = ideal();
    (p.exposure.exposure_s, p.charge.dark.current_e_s) = (0.0, 1e9);
    has(p, 0.0, 0.0, dark_dn2);
}

#[test]
fn a_well_of_an_electron_has_one_or_none() {
    let mut p = one_dn_an_electron();
    p.charge.full_well.capacity_e = 1.0;
    let none = etendue_core::maths::f64::exp(-0.7);
    check_fraction(p.clone(), 0.7, 0, none);
    check_fraction(p.clone(), 0.7, 1, 1.0 - none);
    check_fraction(p, 1e12, 1, 1.0);
}

#[test]
fn a_million_seconds_are_counted_or_fill_the_well() {
    let mut p = one_dn_an_electron();
    (p.exposure.exposure_s, p.charge.dark.current_e_s) = (1e6, 2e-4);
    // 200 dark electrons and 300 of light; Poisson, and 1/12 of rounding.
    has(p.clone(), 300.0, 500.0, 500.0);
    p.charge.dark.current_e_s = 1e9;
    check_fraction(p.clone(), 0.0, 10_000_000, 1.0);
    check_fraction(p, f32::MAX, 10_000_000, 1.0);
}

#[test]
fn a_million_million_electrons_have_their_shot_noise() {
    let mut p = one_dn_an_electron();
    (p.charge.full_well.capacity_e, p.read_out.gain_dn_e) = (1e13, 1e-5);
    // The mean as represented in f32; K² μ + 1/12.
    let mean_e = f64::from(1e12_f32);
    has(p, 1e12, 1e-5 * mean_e, 1e-10 * mean_e + 1.0 / 12.0);
}

#[test]
fn a_converter_of_one_bit_is_a_threshold() {
    let mut p = one_dn_an_electron();
    (p.read_out.bits, p.voltage.noise.white_e, p.noise) = (1, 5.0, true);
    p.read_out.gain_dn_e = 0.1;
    // Half a number is 5 e⁻: a standard deviation above black.
    check_fraction(p.clone(), 0.0, 1, normal::cdf(-1.0));
    check_fraction(p, 1e6, 1, 1.0);
}

#[test]
fn gains_may_be_tiny_and_huge() {
    let mut p = one_dn_an_electron();
    (p.read_out.bits, p.read_out.gain_dn_e) = (12, 1e9);
    let none = etendue_core::maths::f64::exp(-1.5);
    check_fraction(p.clone(), 1.5, 0, none);
    check_fraction(p.clone(), 1.5, 4095, 1.0 - none);
    p.read_out.gain_dn_e = 1e-12;
    check_fraction(p.clone(), 1e6, 0, 1.0);
    (p.read_out.gain_dn_e, p.read_out.analogue_gain, p.read_out.digital_gain) = (1e-3, 1e3, 1e6);
    check_fraction(p, 1.5, 4095, 1.0 - none);
}
