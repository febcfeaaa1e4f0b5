//! The camera's response from exposures known relatively.

use super::{normals, picture};
use crate::coverage::covers;
use etendue_core::maths::f64::pow;
use etendue_metrology::Image;
use etendue_metrology::oecf::response::{ResponseSettings, camera_response};

/// A response that is a polynomial of the reading: light = 0.3 M + 0.7 M².
#[test]
fn response() {
    covers("response", |seed| {
        let reading = |light: f64| (-0.3 + (0.09 + 2.8 * light).sqrt()) / 1.4;
        let mut normal = normals(seed, 0);
        let mut frame = |exposure: f64| {
            picture(64, 24, |i| {
                let light: f64 = exposure * (0.02 + 0.98 * (i % 64) as f64 / 64.0);
                1000.0 * (reading(light.min(1.0)) + 0.003 * normal()).clamp(0.0, 1.0)
            })
        };
        let images: Vec<(f64, Image)> = (0..4).map(|i| pow(2.0, f64::from(i))).map(|e| (e, frame(e / 8.0))).collect();
        let given: Vec<(f64, &Image)> = images.iter().map(|(e, image)| (*e, image)).collect();
        let settings = ResponseSettings { full_scale: 1000.0, black: 0.0, degree: 5, refine: false };
        let found = camera_response(&given, &settings).expect("four pictures");
        let at = |name, m: f64| (name, found.estimate(m), 0.3 * m + 0.7 * m * m);
        vec![at("light at 25 %", 0.25), at("light at 50 %", 0.5), at("light at 75 %", 0.75)]
    });
}
