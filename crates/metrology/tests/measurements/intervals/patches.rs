//! Uniform patches: noise, flare, contrast, colour.

use super::{normals, test_image};
use crate::coverage::assert_coverage;
use etendue_core::maths::f64::pow;
use etendue_metrology::colour::{ColourError, ColourPatch, measure_colour};
use etendue_metrology::contrast::{ContrastSettings, detection_probability, measure_contrast};
use etendue_metrology::flare::measure_flare;
use etendue_metrology::noise::measure_noise;
use etendue_metrology::oecf::ExposurePoint;
use etendue_metrology::photon_transfer::Stack;
use etendue_metrology::{Estimate, Image};
use etendue_spectra::{colour::D65_WHITE, illuminant, observer, reflectance::colorchecker};

/// Temporal noise 4, fixed pattern 3 in readings of 200 over a black of 40.
#[test]
fn noise() {
    const SIDE: usize = 24;
    assert_coverage("noise", |seed| {
        let mut normal = normals(seed, 0);
        let pattern: Vec<f64> = (0..SIDE * SIDE).map(|_| 3.0 * normal()).collect();
        let mut stack = Stack::new(SIDE, SIDE);
        for _ in 0..8 {
            stack.push(&test_image(SIDE, SIDE, |i| 200.0 + pattern[i] + 4.0 * normal())).expect("a frame");
        }
        let noise_result = measure_noise(&stack, 40.0).expect("eight frames");
        // The signal is that of these pixels.
        let signal = 160.0 + pattern.iter().sum::<f64>() / (SIDE * SIDE) as f64;
        let [total, temporal, fixed] = noise_result.snr();
        vec![
            ("signal", noise_result.signal, signal),
            ("temporal", noise_result.temporal, 4.0),
            ("fixed pattern", noise_result.fixed, 3.0),
            ("total", noise_result.total, 5.0),
            ("SNR, total", total, signal / 5.0),
            ("SNR, temporal", temporal, signal / 4.0),
            ("SNR, fixed pattern", fixed, signal / 3.0),
        ]
    });
}

#[test]
fn flare() {
    assert_coverage("flare", |seed| {
        let mut normal = normals(seed, 0);
        let mut patch = |mean: f64, sigma: f64| test_image(12, 12, |_| mean + sigma * normal());
        let (white, trap) = (patch(900.0, 30.0), patch(25.0, 3.0));
        let result = measure_flare(&trap, &[white], 20.0, None, 1).expect("regions");
        vec![("share of a trap", result, 5.0 / 880.0)]
    });
}

/// A patch with the correlation that bilinear demosaicing gives a channel of every other pixel: the others are means of their
/// neighbours.
pub(super) fn developed(mean: f64, sigma: f64, mut normal: impl FnMut() -> f64) -> Image {
    const SIDE: usize = 24;
    let own: Vec<f64> = (0..(SIDE + 2) * (SIDE + 2)).map(|_| mean + sigma * normal()).collect();
    let at = |x: usize, y: usize| own[y * (SIDE + 2) + x];
    test_image(SIDE, SIDE, |i| {
        let (x, y) = (i % SIDE + 1, i / SIDE + 1);
        let neighbour_mean = 0.25 * (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1));
        if (x + y) % 2 == 0 { at(x, y) } else { neighbour_mean }
    })
}

#[test]
fn patches_of_developed_pictures() {
    assert_coverage("developed pictures", |seed| {
        let mut normal = normals(seed, 0);
        let [white, trap] = [(900.0, 30.0), (25.0, 3.0)].map(|(m, s)| developed(m, s, &mut normal));
        let flare = measure_flare(&trap, &[white], 20.0, None, 1).expect("regions");
        let [dark, bright] = [(1000.0, 100.0), (1500.0, 120.0)].map(|(m, s)| developed(m, s, &mut normal));
        let settings = ContrastSettings { black: 0.0, full_scale: None, tolerance: 0.5, shared_px: 1 };
        let contrast = measure_contrast(&dark.clone().into(), &bright.into(), 0.5, &settings).expect("patches");
        let point = ExposurePoint::from_surface(1.0, &dark, None, 1);
        vec![
            ("flare of a trap", flare, 5.0 / 880.0),
            ("contrast", contrast.measured, 0.5),
            ("reading of an exposure", point.reading, 1000.0),
        ]
    });
}

/// A uniform patch of raw readings with row noise, half as large as the pixel noise.
fn with_rows(mean: f64, sigma: f64, mut normal: impl FnMut() -> f64) -> Image {
    const SIDE: usize = 32;
    let rows: Vec<f64> = (0..SIDE).map(|_| 0.5 * sigma * normal()).collect();
    test_image(SIDE, SIDE, |i| mean + rows[i / SIDE] + sigma * normal())
}

#[test]
fn patches_whose_rows_share_noise() {
    assert_coverage("noise of rows", |seed| {
        let mut normal = normals(seed, 0);
        let [white, trap] = [(900.0, 30.0), (25.0, 3.0)].map(|(m, s)| with_rows(m, s, &mut normal));
        let flare = measure_flare(&trap, &[white], 20.0, None, 1).expect("regions");
        let [dark, bright] = [(1000.0, 100.0), (1500.0, 120.0)].map(|(m, s)| with_rows(m, s, &mut normal));
        let settings = ContrastSettings { black: 0.0, full_scale: None, tolerance: 0.5, shared_px: 1 };
        let contrast = measure_contrast(&dark.clone().into(), &bright.into(), 0.5, &settings).expect("patches");
        vec![
            ("flare of a trap", flare, 5.0 / 880.0),
            ("contrast", contrast.measured, 0.5),
            ("reading of an exposure", ExposurePoint::from_surface(1.0, &dark, None, 1).reading, 1000.0),
        ]
    });
}

#[test]
fn contrast() {
    let settings = ContrastSettings { black: 0.0, full_scale: None, tolerance: 0.5, shared_px: 1 };
    let (dark, bright) = ([1000.0, 300.0], [1500.0, 360.0]);
    assert_coverage("cdp", |seed| {
        let mut normal = normals(seed, 0);
        let mut patch = |[mean, sigma]: [f64; 2]| test_image(20, 20, |_| mean + sigma * normal());
        let (a, b) = (patch(dark), patch(bright));
        let contrast = measure_contrast(&a.into(), &b.into(), 0.5, &settings).expect("patches");
        let square = |[mean, sigma]: [f64; 2]| [mean, sigma * sigma];
        let probability = detection_probability(square(dark), square(bright), 0.5, 0.5);
        vec![
            ("contrast", contrast.measured, 0.5),
            ("detection probability", contrast.detection, probability),
            ("transfer", contrast.transfer, 1.0),
            ("contrast to noise", contrast.contrast_snr, 500.0 / (300.0_f64 * 300.0 + 360.0 * 360.0).sqrt()),
        ]
    });
}

/// A camera whose channels are a matrix of XYZ, each raised to a power: powers of 1 leave no error.
fn patches(powers: [f64; 3], sigma: f64, side: usize, mut normal: impl FnMut() -> f64) -> Vec<ColourPatch> {
    let mut patch = |p: &etendue_spectra::reflectance::Patch| {
        let [x, y, z] = observer::xyz_of_reflectance(&p.reflectance, illuminant::d65());
        let channels = [0.5 * x + 0.09 * y, 0.04 * x + 0.6 * y + 0.02 * z, 0.07 * y + 0.45 * z];
        let pixels = [0, 1, 2].map(|c| {
            let mean = 16.0 + 900.0 * pow(channels[c], powers[c]);
            test_image(side, side, |_| mean + sigma * normal())
        });
        ColourPatch { name: p.name.to_owned(), pixels, reference: [x, y, z] }
    };
    colorchecker().iter().map(&mut patch).collect()
}

/// A camera with errors of a few ΔE, and one with exact colours, whose errors must not differ from 0.
fn colours(powers: [f64; 3], side: usize, seed: u64) -> [ColourError; 2] {
    let measure = |sigma| measure_colour(&patches(powers, sigma, side, normals(seed, 0)), 16.0, None, D65_WHITE, 1);
    [3.0, 0.0].map(|sigma| measure(sigma).expect("a chart"))
}

#[test]
fn colour_errors() {
    assert_coverage("colour", |seed| {
        let [measured, truth] = colours([0.9, 0.95, 0.85], 24, seed);
        let patch = |name, i: usize| (name, measured.differences[i], truth.differences[i].value);
        vec![
            patch("ΔE of dark skin", 0),
            patch("ΔE of blue sky", 2),
            patch("ΔE of red", 14),
            patch("ΔE of grey 5", 21),
            ("mean ΔE", measured.mean, truth.mean.value),
        ]
    });
}

/// Lengths of 0: at most one in ten patches may have an interval that excludes 0, and their mean has none.
#[test]
fn colour_errors_of_pure_noise_are_insignificant() {
    let differences: Vec<Estimate> = (0..40)
        .flat_map(|seed| {
            let [measured, _] = colours([1.0; 3], 8, seed);
            assert!(measured.mean.standard_uncertainty.is_infinite(), "{:?}", measured.mean);
            measured.differences
        })
        .collect();
    let wrong = differences.iter().filter(|d| d.value > 1.96 * d.standard_uncertainty).count();
    assert!(10 * wrong < differences.len(), "{wrong} of {}", differences.len());
}
