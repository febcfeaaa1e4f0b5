use etendue_core::maths::f64::pow;
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use rand_distr::{Distribution, Normal};

use super::response::{ResponseSettings, camera_response};
use super::*;
use crate::Image;

// Tests with known curves and known cameras.

fn point(exposure: f64, reading: f64) -> ExposurePoint {
    ExposurePoint { exposure, reading: Estimate::new(reading, 0.01), noise: Some(2.0), clipped: false }
}

fn series(f: impl Fn(f64) -> f64) -> Vec<ExposurePoint> {
    (1..=15).map(|i| f64::from(i) * 0.1).map(|h| point(h, f(h))).collect()
}

#[test]
fn a_straight_sensor_is_straight_up_to_its_saturation() {
    let oecf = Oecf::new(series(|h| (20.0 + 900.0 * h).min(1023.0))).expect("a curve");
    // 1.2 is the first exposure above (1023 − 20)/900 = 1.114.
    assert_eq!(oecf.points()[oecf.saturation()].exposure, 1.2000000000000002);
    let line = oecf.linearity(20.0).expect("eleven points");
    assert!((line.slope / 900.0 - 1.0).abs() < 1e-12 && (line.offset - 20.0).abs() < 1e-9 && line.largest < 1e-12);
    assert!((oecf.reading(0.55) - 515.0).abs() < 1e-9 && (oecf.gain(0.55) - 900.0).abs() < 1e-6);
    // SNR 1 where 900 H = 2, saturated from 1.1 on.
    let range = oecf.dynamic_range().expect("noise is known");
    assert!((range / (1.1 * 900.0 / 2.0) - 1.0).abs() < 0.01, "{range}");
}

#[test]
fn a_tone_curve_is_interpolated_between_its_points() {
    let tone = |h: f64| 255.0 * pow(h / 1.6, 1.0 / 2.2);
    let oecf = Oecf::new(series(tone)).expect("a curve");
    assert_eq!(oecf.saturation(), 15);
    for i in 20..150 {
        let h = f64::from(i) * 0.01;
        // A cubic over intervals of 0.1: the fourth derivative is largest at the dim end.
        assert!((oecf.reading(h) - tone(h)).abs() < 0.4, "{h}: {} {}", oecf.reading(h), tone(h));
        assert!(oecf.gain(h) > 0.0);
    }
    assert!(oecf.linearity(0.0).expect("enough points").largest > 0.1);
}

#[test]
fn curves_that_are_none_are_refused() {
    let result = |points: &[ExposurePoint]| Oecf::new(points.to_vec()).map(|_| ());
    assert_eq!(result(&[point(1.0, 5.0)]), Err(OecfError::TooFew(1)));
    assert_eq!(result(&[point(1.0, 5.0), point(1.0, 6.0), point(2.0, 7.0)]), Err(OecfError::Twice(1.0)));
    assert_eq!(result(&[point(0.0, 5.0), point(1.0, 6.0), point(2.0, 7.0)]), Err(OecfError::Exposure(0.0)));
    assert!(matches!(result(&[point(1.0, 5.0), point(2.0, 9.0), point(3.0, 7.0)]), Err(OecfError::Falls { .. })));
    assert_eq!(result(&[point(1.0, 255.0), point(2.0, 255.0), point(3.0, 255.0)]), Err(OecfError::Flat));
}

/// Noise at full scale is clipped: the mean is still rising there, but no longer correct.
#[test]
fn clipped_light_is_no_part_of_the_straight_line() {
    let shot = |i: u32| {
        let exposure = f64::from(i) * 0.1;
        let clipped = exposed_image(1.0, |_| 0.0, i);
        let sample = |s: &f32| (f64::from(*s) * 50.0 + 900.0 * exposure).min(1000.0) as f32;
        let samples = clipped.samples().iter().map(sample).collect();
        ExposurePoint::from_surface(
            exposure,
            &Image::from_samples(128, 64, samples).expect("a rectangle"),
            Some(1000.0),
            1,
        )
    };
    let points: Vec<ExposurePoint> = (1..=15).map(shot).collect();
    let curve = |points: &[ExposurePoint]| Oecf::new(points.to_vec()).expect("a curve");
    let (known, unknown) =
        (curve(&points), curve(&points.iter().map(|p| ExposurePoint { clipped: false, ..*p }).collect::<Vec<_>>()));
    assert!(known.saturation() < unknown.saturation(), "{} {}", known.saturation(), unknown.saturation());
    assert!(Oecf::new(points[13..].iter().chain(&points[12..13]).copied().collect()).is_err());
}

/// A scene of all light levels, captured by a camera with a given curve and noise of 0.2 %.
fn exposed_image(exposure: f64, curve: impl Fn(f64) -> f64, frame: u32) -> Image {
    let normal = Normal::new(0.0, 0.002).expect("a width");
    let sample = |i: usize| {
        let pixel = Pixel { x: (i % 128) as u32, y: (i / 128) as u32 };
        let light = 0.02 + 0.98 * (i % 128) as f64 / 128.0;
        let noise = normal.sample(&mut NoiseStream::new(1, 0, frame, 0, pixel, NoiseDraw::Read));
        (1000.0 * (curve((light * exposure).min(1.0)) + noise)).clamp(0.0, 1000.0) as f32
    };
    Image::from_samples(128, 64, (0..128 * 64).map(sample).collect()).expect("a rectangle")
}

#[test]
fn the_response_comes_back_from_relative_exposures() {
    let srgb = |l: f64| if l <= 0.003_130_8 { 12.92 * l } else { 1.055 * pow(l, 1.0 / 2.4) - 0.055 };
    let decode = |m: f64| if m <= 0.040_45 { m / 12.92 } else { pow((m + 0.055) / 1.055, 2.4) };
    let images: Vec<(f64, Image)> =
        (0..5).map(|i| (f64::from(1 << i), exposed_image(f64::from(1 << i) / 16.0, srgb, i))).collect();
    let exposed_images: Vec<(f64, &Image)> = images.iter().map(|(e, image)| (3.0 * e, image)).collect();
    let settings = ResponseSettings { full_scale: 1000.0, black: 0.0, degree: 8, refine: false };
    let response = camera_response(&exposed_images, &settings).expect("five pictures");
    for i in 1..=20 {
        let m = f64::from(i) * 0.05;
        let light = response.estimate(m);
        // The requirement is half a per cent of full scale.
        assert!(
            (light.value - decode(m)).abs() < 0.005,
            "{m}: {light:?} for {} of degree {}",
            decode(m),
            response.coefficients.len()
        );
    }
    let linear: Vec<(f64, Image)> =
        (0..4).map(|i| (f64::from(1 << i), exposed_image(f64::from(1 << i) / 8.0, |l| l, i))).collect();
    let exposed_images: Vec<(f64, &Image)> = linear.iter().map(|(e, image)| (*e, image)).collect();
    let response = camera_response(&exposed_images, &settings).expect("four pictures");
    assert!((response.light(0.5) - 0.5).abs() < 0.002, "{response:?}");
    assert_eq!(camera_response(&exposed_images[..1], &settings), Err(OecfError::TooFew(1)));
}

/// Means of rounded normal noise over all phases of a step, from the normal distribution: the variance of their errors.
#[test]
fn what_rounding_leaves_follows_from_the_noise() {
    for sigma in [0.1, 0.3, 0.5] {
        let phase_variance = |i: usize| {
            let y = i as f64 / 400.0;
            let step = |n: i32| {
                let above = |edge: f64| etendue_stats::normal::cdf((y - edge) / sigma);
                f64::from(n) * (above(f64::from(n) - 0.5) - above(f64::from(n) + 0.5))
            };
            let squares = |n: i32| f64::from(n) * step(n);
            let mean: f64 = (-6..=7).map(step).sum();
            (mean - y, (-6..=7).map(squares).sum::<f64>() - mean * mean)
        };
        let phases: Vec<(f64, f64)> = (0..400).map(phase_variance).collect();
        let left = phases.iter().map(|(error, _)| error * error).sum::<f64>() / 400.0;
        // Sheppard: the variance of a reading is σ² + 1/12, all phases together.
        let result = super::rounding_variance(sigma * sigma + 1.0 / 12.0);
        assert!((result - left).abs() < 1e-5, "{sigma}: {result} and {left}");
    }
    assert!((super::rounding_variance(0.0) - 1.0 / 12.0).abs() < 3e-4);
}

#[test]
fn a_square_s_mean_has_the_variance_more() {
    // Of L + σ z squared: mean L² + σ², variance 4 L² σ² + 2 σ⁴.
    let (light, sigma) = (3.0_f64, 0.2_f64);
    let noise = (4.0 * light * light * sigma * sigma + 2.0 * sigma * sigma * sigma * sigma).sqrt();
    let mean = noisy_mean(|l| l * l, light, noise);
    assert!((mean - light * light - sigma * sigma).abs() < 1e-5, "{mean}");
}

#[test]
fn light_at_the_saturation_reads_less() {
    // Of min(z, 0): mean −1/√(2π), variance (1 − 1/π)/2.
    let noise = (0.5 - 0.5 / core::f64::consts::PI).sqrt();
    let mean = noisy_mean(|l| l.min(1.0), 1.0, 0.01 * noise);
    assert!((mean - 1.0 + 0.01 / core::f64::consts::TAU.sqrt()).abs() < 1e-5, "{mean}");
    assert_eq!(noisy_mean(|l| l.min(1.0), 3.0, 0.0), 1.0);
}
