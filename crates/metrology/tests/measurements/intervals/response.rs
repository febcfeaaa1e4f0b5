//! Response of the camera from relatively known exposures.

use super::patches::developed;
use super::{normals, test_image};
use crate::coverage::assert_coverage;
use etendue_core::maths::f64::pow;
use etendue_metrology::oecf::ExposurePoint;
use etendue_metrology::oecf::noisy_mean;
use etendue_metrology::oecf::response::{ResponseSettings, camera_response};
use etendue_metrology::{Estimate, Image};

/// A response that is a polynomial of the reading: light = 0.3 M + 0.7 M².
#[test]
fn response() {
    assert_coverage("response", |seed| {
        let reading = |light: f64| (-0.3 + (0.09 + 2.8 * light).sqrt()) / 1.4;
        let mut normal = normals(seed, 0);
        let mut frame = |exposure: f64| {
            test_image(64, 24, |i| {
                let light: f64 = exposure * (0.02 + 0.98 * (i % 64) as f64 / 64.0);
                1000.0 * (reading(light.min(1.0)) + 0.003 * normal()).clamp(0.0, 1.0)
            })
        };
        let images: Vec<(f64, Image)> = (0..4).map(|i| pow(2.0, f64::from(i))).map(|e| (e, frame(e / 8.0))).collect();
        let exposed_images: Vec<(f64, &Image)> = images.iter().map(|(e, image)| (*e, image)).collect();
        let settings = ResponseSettings { full_scale: 1000.0, black: 0.0, degree: 5, refine: false };
        let result = camera_response(&exposed_images, &settings).expect("four pictures");
        let at = |name, m: f64| (name, result.estimate(m), 0.3 * m + 0.7 * m * m);
        vec![at("light at 25 %", 0.25), at("light at 50 %", 0.5), at("light at 75 %", 0.75)]
    });
}

/// 8-bit images with a tone curve that begins linearly and bends at 0.3 %, from a mosaic of 20 000 electrons: readings compared
/// with the curve applied to equally noisy light.
#[test]
fn tone_curve_of_developed_pictures() {
    let encoded = |light: f64| {
        let light = light.clamp(0.0, 1.0);
        255.0 * if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * pow(light, 1.0 / 2.4) - 0.055 }
    };
    assert_coverage("tone curve of developed pictures", |seed| {
        let mut normal = normals(seed, 0);
        // The phase of a mean within an ADC step differs between runs.
        let shift = 1.0 + 0.1 * super::unit(seed);
        let mut error = |name, light: f64| {
            let light = light * shift;
            let sigma = (20_000.0 * light + 100.0).sqrt() / 20_000.0;
            let linear = developed(light, sigma, &mut normal);
            let samples = linear.samples().iter().map(|l| encoded(f64::from(*l)).round());
            let patch = Image::from_samples(24, 24, samples.map(|v| v as f32).collect()).expect("a square");
            let point = ExposurePoint::from_surface(light, &patch, Some(255.0), 1);
            let own = (point.noise.expect("of the patch") * point.noise.expect("of the patch") - 1.0 / 12.0).max(0.0);
            let declared = noisy_mean(encoded, light, own.sqrt());
            (name, Estimate::new(point.reading.value - declared, point.reading.standard_uncertainty), 0.0)
        };
        vec![
            error("at 0.3 % of the light", 0.003),
            error("at 0.6 %", 0.006),
            error("at 2 %", 0.02),
            error("at 20 %", 0.2),
            error("at 80 %", 0.8),
        ]
    });
}
